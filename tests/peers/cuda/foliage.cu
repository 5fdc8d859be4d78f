// Foliage: the peer of `shaders/src/foliage.rs`.
#include "common.h"

struct Frame {
    SliceMut2d<float4> film;
    OptixTraversableHandle world;
    Pinhole camera;
    float3 sun;
};
LAUNCH_PARAMS(Frame)

struct Blade {
    float3 albedo;
    float transmittance;
};
struct Ground {
    float3 albedo;
};

ENTRY(raygen, Foliage_camera) {
    uint3 px = optixGetLaunchIndex();
    u32 p0, p1, p2, p3, p4, p5, p6, p7, p8, p9;
    optixTrace(OPTIX_PAYLOAD_TYPE_ID_0, params.world, params.camera.eye,
               params.camera.direction(middle(px, optixGetLaunchDimensions())), 0.0f, FAR, 0.0f, 255, OPTIX_RAY_FLAG_NONE, 0,
               2, 0, p0, p1, p2, p3, p4, p5, p6, p7, p8, p9);
    float3 colour = make_float3(real(p7), real(p8), real(p9));
    float error = real(p6);
    if (error >= 0.0f) {
        SurfacePoint point{make_float3(real(p0), real(p1), real(p2)), make_float3(real(p3), real(p4), real(p5)), error};
        float3 sun = params.sun;
        u32 light = bits(1.0f), seen = 0;
        optixTrace(OPTIX_PAYLOAD_TYPE_ID_1, params.world, point.origin(sun), sun, 0.0f, FAR, 0.0f, 255,
                   OPTIX_RAY_FLAG_DISABLE_CLOSESTHIT, 1, 2, 1, light, seen);
        float direct = seen ? real(light) * fabsf(dot(point.normal, sun)) : 0.0f;
        colour = colour * (0.25f + direct);
    }
    set(params.film, px, extend(colour, 1.0f));
}

DEVICE bool is_leaf() {
    float2 b = optixGetTriangleBarycentrics();
    bool even = (optixGetPrimitiveIndex() & 1) == 0;
    float x = even ? b.x + b.y : b.x, y = even ? b.y : b.x + b.y;
    float across = fabsf(y - 0.5f);
    float teeth = 0.03f * (x * 24.0f - floorf(x * 24.0f));
    float width = 1.7f * x * (1.0f - x) - teeth;
    float hx = x * 7.0f - floorf(x * 7.0f) - 0.5f, hy = y * 7.0f - floorf(y * 7.0f) - 0.5f;
    bool hole = hx * hx + hy * hy < 0.03f;
    return across < width && !hole;
}

ENTRY(anyhit, Foliage_cut_out_Blade_Seen_Triangles) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    if (!is_leaf()) optixIgnoreIntersection();
}

ENTRY(anyhit, Foliage_shade_Blade_Sun_Triangles) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_1);
    float light = real(optixGetPayload_0());
    if (is_leaf()) light = light * record<Blade>().transmittance;
    optixSetPayload_0(bits(light));
    if (light < 0.01f) optixTerminateRay();
    optixIgnoreIntersection();
}

DEVICE void set_seen(float3 position, float3 normal, float error, float3 colour) {
    optixSetPayload_0(bits(position.x));
    optixSetPayload_1(bits(position.y));
    optixSetPayload_2(bits(position.z));
    optixSetPayload_3(bits(normal.x));
    optixSetPayload_4(bits(normal.y));
    optixSetPayload_5(bits(normal.z));
    optixSetPayload_6(bits(error));
    optixSetPayload_7(bits(colour.x));
    optixSetPayload_8(bits(colour.y));
    optixSetPayload_9(bits(colour.z));
}

DEVICE void surface(float3 colour) {
    SurfacePoint point = SurfacePoint::of_triangle_hit();
    float3 normal = dot(point.normal, optixGetWorldRayDirection()) > 0.0f ? -point.normal : point.normal;
    set_seen(point.position, normal, point.error, colour);
}

ENTRY(closesthit, Foliage_blade_Blade_Seen_Triangles) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    surface(record<Blade>().albedo);
}

ENTRY(closesthit, Foliage_ground_Ground_Seen_Triangles) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    surface(record<Ground>().albedo);
}

ENTRY(miss, Foliage_sky_Seen) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_0);
    float up = 0.5f * optixGetWorldRayDirection().y + 0.5f;
    float3 colour = make_float3(0.7f, 0.8f, 0.9f) * (1.0f - up) + make_float3(0.2f, 0.4f, 0.8f) * up;
    set_seen(splat(0.0f), splat(0.0f), -1.0f, colour);
}

ENTRY(miss, Foliage_lit_Sun) {
    optixSetPayloadTypes(OPTIX_PAYLOAD_TYPE_ID_1);
    optixSetPayload_1(1);
}
