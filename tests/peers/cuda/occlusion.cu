// Ambient occlusion: the peer of `shaders/src/occlusion.rs`.
#include "common.h"

struct Frame {
    SliceMut2d<float> film;
    OptixTraversableHandle world;
    Pinhole camera;
    u32 samples;
    float radius;
};
LAUNCH_PARAMS(Frame)

ENTRY(raygen, Occlusion_camera) {
    uint3 px = optixGetLaunchIndex(), size = optixGetLaunchDimensions();
    u32 p0, p1, p2, p3, p4, p5, p6;
    optixTrace(OPTIX_PAYLOAD_TYPE_ID_0, params.world, params.camera.eye, params.camera.direction(middle(px, size)), 0.0f,
               FAR, 0.0f, 255, OPTIX_RAY_FLAG_NONE, 0, 2, 0, p0, p1, p2, p3, p4, p5, p6);
    u32 open = 0;
    float error = real(p6);
    if (error >= 0.0f) {
        SurfacePoint point{make_float3(real(p0), real(p1), real(p2)), make_float3(real(p3), real(p4), real(p5)), error};
        Onb basis = Onb::around(point.normal);
        Pcg32 rng = Pcg32::hashed((u64)px.y * size.x + px.x, 0);
        for (u32 sample = 0; sample < params.samples; ++sample) {
            float3 direction = basis.to_world(cosine(rng.next_vec2()));
            u32 seen = 0;
            optixTrace(OPTIX_PAYLOAD_TYPE_ID_1, params.world, point.origin(direction), direction, 0.0f, params.radius, 0.0f,
                       255, OPTIX_RAY_FLAG_TERMINATE_ON_FIRST_HIT | OPTIX_RAY_FLAG_DISABLE_CLOSESTHIT, 1, 2, 1, seen);
            open += seen;
        }
    }
    set(params.film, px, (float)open / (float)params.samples);
}

DEVICE void set_surface(float3 position, float3 normal, float error) {
    optixSetPayload_0(bits(position.x));
    optixSetPayload_1(bits(position.y));
    optixSetPayload_2(bits(position.z));
    optixSetPayload_3(bits(normal.x));
    optixSetPayload_4(bits(normal.y));
    optixSetPayload_5(bits(normal.z));
    optixSetPayload_6(bits(error));
}

ENTRY(closesthit, Occlusion_clay_Clay_Surface_Triangles) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    SurfacePoint point = SurfacePoint::of_triangle_hit();
    float3 normal = dot(point.normal, optixGetWorldRayDirection()) > 0.0f ? -point.normal : point.normal;
    set_surface(point.position, normal, point.error);
}

ENTRY(miss, Occlusion_nothing_Surface) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    set_surface(splat(0.0f), splat(0.0f), -1.0f);
}

ENTRY(miss, Occlusion_free_Open) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_1);
    optixSetPayload_0(1);
}
