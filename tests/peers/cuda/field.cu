// Signed-distance fields: the peer of `shaders/src/field.rs`.
#include "common.h"

struct Frame {
    SliceMut2d<float4> film;
    OptixTraversableHandle world;
    Pinhole camera;
    float3 sun;
};
LAUNCH_PARAMS(Frame)

struct Gyroid {
    float frequency, thickness;

    __forceinline__ __device__ float distance(float3 p) const {
        float3 turns = p * frequency;
        float2 x = sin_cos_turns(turns.x), y = sin_cos_turns(turns.y), z = sin_cos_turns(turns.z);
        float gyroid = fabsf(x.x * y.y + y.x * z.y + z.x * x.y) * (1.0f / (frequency * 10.9f)) - thickness;
        float3 q = abs(p) - splat(0.8f);
        float outside = length(max(q, splat(0.0f))) + fminf(max_element(q), 0.0f) - 0.1f;
        return fmaxf(gyroid, outside);
    }
    __forceinline__ __device__ float along(float3 p, float3 d) const { return distance(p + d) - distance(p - d); }
    __forceinline__ __device__ float3 normal(float3 p) const {
        float h = 0.001f;
        return normalize(make_float3(along(p, make_float3(h, 0.0f, 0.0f)), along(p, make_float3(0.0f, h, 0.0f)),
                                     along(p, make_float3(0.0f, 0.0f, h))));
    }
};

DEVICE void march() {
    Gyroid field = record<Gyroid>();
    float3 origin = optixGetObjectRayOrigin(), direction = optixGetObjectRayDirection();
    float len = length(direction);
    float3 inverse = splat(1.0f) / direction;
    float3 a = (splat(-1.0f) - origin) * inverse, b = (splat(1.0f) - origin) * inverse;
    float t = fmaxf(max_element(min(a, b)), optixGetRayTmin());
    float end = fminf(min_element(max(a, b)), optixGetRayTmax());
    for (u32 step = 0; t < end && step < 256; ++step) {
        float3 p = origin + direction * t;
        float d = field.distance(p);
        if (d < 0.0005f) {
            float3 n = field.normal(p);
            optixReportIntersection(t, 0, bits(n.x), bits(n.y), bits(n.z));
            return;
        }
        t += d / len;
    }
}

ENTRY(intersection, Field_march_Gyroid_Look_Custom) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    march();
}

ENTRY(intersection, Field_march_Gyroid_Sunlit_Custom) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_1);
    march();
}

ENTRY(raygen, Field_camera) {
    uint3 px = optixGetLaunchIndex();
    float3 origin = params.camera.eye, direction = params.camera.direction(middle(px, optixGetLaunchDimensions()));
    u32 p0, p1, p2, p3;
    optixTrace(OPTIX_PAYLOAD_TYPE_ID_0, params.world, origin, direction, 0.0f, FAR, 0.0f, 255, OPTIX_RAY_FLAG_NONE, 0, 2, 0,
               p0, p1, p2, p3);
    float3 normal = make_float3(real(p0), real(p1), real(p2));
    float light = 0.1f;
    if (!is_zero(normal)) {
        float facing = dot(normal, params.sun);
        if (facing > 0.0f) {
            float3 position = origin + direction * real(p3);
            u32 seen = 0;
            optixTrace(OPTIX_PAYLOAD_TYPE_ID_1, params.world, position + normal * 0.004f, params.sun, 0.0f, FAR, 0.0f, 255,
                       OPTIX_RAY_FLAG_TERMINATE_ON_FIRST_HIT | OPTIX_RAY_FLAG_DISABLE_CLOSESTHIT, 1, 2, 1, seen);
            if (seen) light += facing;
        }
    }
    float3 colour = normal * 0.25f + splat(0.75f);
    set(params.film, px, make_float4(colour.x * light, colour.y * light, colour.z * light, 0.0f * light));
}

DEVICE void set_look(float3 normal, float t) {
    optixSetPayload_0(bits(normal.x));
    optixSetPayload_1(bits(normal.y));
    optixSetPayload_2(bits(normal.z));
    optixSetPayload_3(bits(t));
}

ENTRY(closesthit, Field_look_Gyroid_Look_Custom) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    float3 n = make_float3(real(optixGetAttribute_0()), real(optixGetAttribute_1()), real(optixGetAttribute_2()));
    set_look(normalize(world_to_object().normal(n)), optixGetRayTmax());
}

ENTRY(miss, Field_nothing_Look) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    set_look(splat(0.0f), 0.0f);
}

ENTRY(miss, Field_sunlit_Sunlit) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_1);
    optixSetPayload_0(1);
}
