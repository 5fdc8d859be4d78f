// Paths with a payload of 24 words: the peer of `shaders/src/wide.rs`.
#include "common.h"

struct Frame {
    SliceMut2d<float4> film, albedo, normal;
    OptixTraversableHandle world;
    Pinhole camera;
    u32 samples, segments;
};
LAUNCH_PARAMS(Frame)

struct Paint {
    float3 albedo;
};

ENTRY(raygen, Wide_camera) {
    uint3 px = optixGetLaunchIndex(), size = optixGetLaunchDimensions();
    float3 eye = params.camera.eye, forward = params.camera.direction(middle(px, size));
    float3 light = splat(0.0f), albedo = splat(0.0f), normal = splat(0.0f);
    for (u32 sample = 0; sample < params.samples; ++sample) {
        Pcg32 rng = Pcg32::hashed(((u64)px.y * size.x + px.x) << 32 | sample, 0);
        u32 p[24] = {(u32)rng.state, (u32)(rng.state >> 32), (u32)rng.increment, (u32)(rng.increment >> 32),
                     bits(1.0f), bits(1.0f), bits(1.0f), 0, 0, 0,
                     bits(eye.x), bits(eye.y), bits(eye.z), bits(forward.x), bits(forward.y), bits(forward.z),
                     0, 0, 0, 0, 0, 0, 0, 1};
        while (p[23] && p[22] < params.segments)
            optixTrace(OPTIX_PAYLOAD_TYPE_ID_0, params.world, make_float3(real(p[10]), real(p[11]), real(p[12])),
                       make_float3(real(p[13]), real(p[14]), real(p[15])), 0.0f, FAR, 0.0f, 255, OPTIX_RAY_FLAG_NONE, 0, 1, 0,
                       p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11], p[12], p[13], p[14], p[15],
                       p[16], p[17], p[18], p[19], p[20], p[21], p[22], p[23]);
        light = light + make_float3(real(p[7]), real(p[8]), real(p[9]));
        albedo = albedo + make_float3(real(p[16]), real(p[17]), real(p[18]));
        normal = normal + make_float3(real(p[19]), real(p[20]), real(p[21]));
    }
    set(params.film, px, extend(light, 0.0f));
    set(params.albedo, px, extend(albedo, 0.0f));
    set(params.normal, px, extend(normal, 0.0f));
}

ENTRY(closesthit, Wide_paint_Paint_Path_Triangles) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    const Paint& paint = record<Paint>();
    SurfacePoint point = SurfacePoint::of_triangle_hit();
    float3 normal = dot(point.normal, optixGetWorldRayDirection()) > 0.0f ? -point.normal : point.normal;
    Pcg32 rng{optixGetPayload_0() | (u64)optixGetPayload_1() << 32, optixGetPayload_2() | (u64)optixGetPayload_3() << 32};
    float3 direction = Onb::around(normal).to_world(cosine(rng.next_vec2()));
    float3 origin = point.origin(direction);
    u32 segment = optixGetPayload_22();
    optixSetPayload_0((u32)rng.state);
    optixSetPayload_1((u32)(rng.state >> 32));
    optixSetPayload_2((u32)rng.increment);
    optixSetPayload_3((u32)(rng.increment >> 32));
    optixSetPayload_4(bits(real(optixGetPayload_4()) * paint.albedo.x));
    optixSetPayload_5(bits(real(optixGetPayload_5()) * paint.albedo.y));
    optixSetPayload_6(bits(real(optixGetPayload_6()) * paint.albedo.z));
    optixSetPayload_10(bits(origin.x));
    optixSetPayload_11(bits(origin.y));
    optixSetPayload_12(bits(origin.z));
    optixSetPayload_13(bits(direction.x));
    optixSetPayload_14(bits(direction.y));
    optixSetPayload_15(bits(direction.z));
    if (segment == 0) {
        optixSetPayload_16(bits(paint.albedo.x));
        optixSetPayload_17(bits(paint.albedo.y));
        optixSetPayload_18(bits(paint.albedo.z));
        optixSetPayload_19(bits(normal.x));
        optixSetPayload_20(bits(normal.y));
        optixSetPayload_21(bits(normal.z));
    }
    optixSetPayload_22(segment + 1);
}

ENTRY(miss, Wide_sky_Path) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    float up = 0.5f * optixGetWorldRayDirection().y + 0.5f;
    float s = 0.25f + up;
    optixSetPayload_7(bits(real(optixGetPayload_7()) + real(optixGetPayload_4()) * s));
    optixSetPayload_8(bits(real(optixGetPayload_8()) + real(optixGetPayload_5()) * s));
    optixSetPayload_9(bits(real(optixGetPayload_9()) + real(optixGetPayload_6()) * s));
    optixSetPayload_23(0);
}
