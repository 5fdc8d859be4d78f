// The examples' path tracer: the peer of `examples/path-tracer/shaders`.
#include "common.h"

struct AreaLight {
    float3 corner, side, other, normal;
    float area;
    float3 emission;
};

struct Frame {
    SliceMut2d<float4> sum, squares;
    OptixTraversableHandle world;
    Pinhole camera;
    AreaLight light;
    u32 first_sample, samples;
    u64 seed;
    u32 max_bounces;
};
LAUNCH_PARAMS(Frame)

struct Lambert {
    float3 albedo;
};
struct Smooth {
    float3 albedo;
    Slice<float3> normals;
    Slice<uint3> indices;
};
struct Emitter {
    float3 emission;
};
struct Leaf {
    float3 albedo;
};
struct Ball {
    float radius;
    float3 reflectance;
};

static constexpr OptixPayloadTypeID RADIANCE = OPTIX_PAYLOAD_TYPE_ID_0, SHADOW = OPTIX_PAYLOAD_TYPE_ID_1;

struct Traced {
    float3 light;
    u32 rays;
};

DEVICE Traced path(float3 origin, float3 direction, Pcg32 rng) {
    float3 light = splat(0.0f), weight = splat(1.0f);
    u32 sees_light = 1, rays = 0;
    for (u32 bounce = 0;; ++bounce) {
        u32 p0 = (u32)rng.state, p1 = (u32)(rng.state >> 32), p2 = (u32)rng.increment, p3 = (u32)(rng.increment >> 32);
        u32 p5, p6, p7, p8, p9, p10, p11, p12, p13, p14, p15, p16, p17, p18;
        optixTrace(RADIANCE, params.world, origin, direction, 0.0f, FAR, 0.0f, 255, OPTIX_RAY_FLAG_NONE, 0, 2, 0, p0, p1, p2,
                   p3, sees_light, p5, p6, p7, p8, p9, p10, p11, p12, p13, p14, p15, p16, p17, p18);
        light = light + weight * make_float3(real(p5), real(p6), real(p7));
        rays += 1 + p18;
        weight = weight * make_float3(real(p8), real(p9), real(p10));
        if (bounce == params.max_bounces || is_zero(weight)) return {light, rays};
        rng = {p0 | (u64)p1 << 32, p2 | (u64)p3 << 32};
        sees_light = p17;
        origin = make_float3(real(p11), real(p12), real(p13));
        direction = make_float3(real(p14), real(p15), real(p16));
    }
}

ENTRY(raygen, PathTracer_camera_camera) {
    uint3 px = optixGetLaunchIndex(), size = optixGetLaunchDimensions();
    float3 sum = splat(0.0f), squares = splat(0.0f);
    u32 rays = 0;
    for (u32 sample = 0; sample < params.samples; ++sample) {
        u32 number = params.first_sample + sample;
        u64 pixel = ((u64)px.y * size.x + px.x) << 32 | number;
        Pcg32 rng = Pcg32::hashed(pixel, params.seed);
        float2 jitter = rng.next_vec2();
        float2 at = make_float2(((float)px.x + jitter.x) / (float)size.x, ((float)px.y + jitter.y) / (float)size.y);
        Traced traced = path(params.camera.eye, params.camera.direction(at), rng);
        sum = sum + traced.light;
        squares = squares + traced.light * traced.light;
        rays += traced.rays;
    }
    set(params.sum, px, extend(sum, (float)rays));
    set(params.squares, px, extend(squares, 0.0f));
}

// What a closest-hit or miss program returns, but for the random sequence.
DEVICE void answer(float3 light, float3 weight, float3 origin, float3 direction, bool specular, u32 shadow_rays) {
    optixSetPayload_5(bits(light.x));
    optixSetPayload_6(bits(light.y));
    optixSetPayload_7(bits(light.z));
    optixSetPayload_8(bits(weight.x));
    optixSetPayload_9(bits(weight.y));
    optixSetPayload_10(bits(weight.z));
    optixSetPayload_11(bits(origin.x));
    optixSetPayload_12(bits(origin.y));
    optixSetPayload_13(bits(origin.z));
    optixSetPayload_14(bits(direction.x));
    optixSetPayload_15(bits(direction.y));
    optixSetPayload_16(bits(direction.z));
    optixSetPayload_17(specular);
    optixSetPayload_18(shadow_rays);
}

// Light from a point of the area light, reflected by a white diffuse surface; `shadow_rays` counts what it took.
DEVICE float3 direct(const SurfacePoint& point, float3 geometric, float3 normal, float2 at, u32& shadow_rays) {
    shadow_rays = 0;
    AreaLight area_light = params.light;
    float3 to = area_light.corner + area_light.side * at.x + area_light.other * at.y;
    float3 d = to - point.position;
    float distance2 = dot(d, d);
    float cos_light = -dot(area_light.normal, d), cos_surface = dot(normal, d);
    if (cos_light <= 0.0f || cos_surface <= 0.0f || dot(geometric, d) <= 0.0f) return splat(0.0f);
    SurfacePoint light{to, area_light.normal, max_element(abs(to)) * Gamma<16>::value};
    float3 end = point.end(light), origin = point.origin(end - point.position);
    float share = cos_light * cos_surface / (3.14159265f * distance2 * distance2);
    u32 visible = 0;
    optixTrace(SHADOW, params.world, origin, end - origin, 0.0f, 1.0f, 0.0f, 255,
               OPTIX_RAY_FLAG_TERMINATE_ON_FIRST_HIT | OPTIX_RAY_FLAG_DISABLE_CLOSESTHIT, 1, 2, 1, visible);
    shadow_rays = 1;
    if (!visible) return splat(0.0f);
    return area_light.emission * (area_light.area * share);
}

DEVICE void diffuse(const SurfacePoint& point, float3 shading, float3 albedo) {
    Pcg32 rng{optixGetPayload_0() | (u64)optixGetPayload_1() << 32, optixGetPayload_2() | (u64)optixGetPayload_3() << 32};
    float3 incoming = optixGetWorldRayDirection();
    float3 geometric = dot(point.normal, incoming) > 0.0f ? -point.normal : point.normal;
    float3 normal = dot(shading, geometric) < 0.0f ? -shading : shading;
    if (dot(normal, incoming) > 0.0f) normal = geometric;
    float2 on_light = rng.next_vec2();
    float3 direction = Onb::around(normal).to_world(cosine(rng.next_vec2()));
    float3 weight = dot(direction, geometric) > 0.0f ? albedo : splat(0.0f);
    float3 origin = point.origin(direction);
    u32 shadow_rays;
    float3 light = direct(point, geometric, normal, on_light, shadow_rays);
    optixSetPayload_0((u32)rng.state);
    optixSetPayload_1((u32)(rng.state >> 32));
    optixSetPayload_2((u32)rng.increment);
    optixSetPayload_3((u32)(rng.increment >> 32));
    answer(light * albedo, weight, origin, direction, false, shadow_rays);
}

ENTRY(closesthit, PathTracer_surface_lambert_Lambert_Radiance_Triangles) {
    optixSetPayloadTypes(RADIANCE);
    SurfacePoint point = SurfacePoint::of_triangle_hit();
    diffuse(point, point.normal, record<Lambert>().albedo);
}

ENTRY(closesthit, PathTracer_surface_smooth_Smooth_Radiance_Triangles) {
    optixSetPayloadTypes(RADIANCE);
    const Smooth& smooth = record<Smooth>();
    uint3 i = smooth.indices.data[optixGetPrimitiveIndex()];
    float3 a = smooth.normals.data[i.x], b = smooth.normals.data[i.y], c = smooth.normals.data[i.z];
    float2 at = optixGetTriangleBarycentrics();
    float3 normal = a * (1.0f - at.x - at.y) + b * at.x + c * at.y;
    SurfacePoint point = SurfacePoint::of_triangle_hit();
    float3 world = world_to_object().normal(normal);
    float reciprocal = 1.0f / length(world);
    float3 shading = isfinite(reciprocal) && reciprocal > 0.0f ? world * reciprocal : point.normal;
    diffuse(point, shading, smooth.albedo);
}

ENTRY(closesthit, PathTracer_light_emitter_Emitter_Radiance_Triangles) {
    optixSetPayloadTypes(RADIANCE);
    bool counts = optixGetPayload_4() && optixIsTriangleFrontFaceHit();
    answer(counts ? record<Emitter>().emission : splat(0.0f), splat(0.0f), splat(0.0f), splat(0.0f), false, 0);
}

DEVICE float2 place() {
    float2 b = optixGetTriangleBarycentrics();
    return optixGetPrimitiveIndex() == 0 ? make_float2(b.x + b.y, b.y) : make_float2(b.x, b.x + b.y);
}

DEVICE bool is_leaf(float2 at) {
    float across = fabsf(at.y - 0.5f);
    float teeth = 0.02f * ((at.x * 16.0f) - floorf(at.x * 16.0f));
    float along = (at.x - 0.12f) / 0.88f;
    float width = 1.6f * along * (1.0f - along) * (1.15f - 0.5f * along) - teeth;
    return across < width || (across < 0.012f && at.x < 0.2f);
}

ENTRY(anyhit, PathTracer_leaf_cut_out_Leaf_Radiance_Triangles) {
    optixSetPayloadTypes(RADIANCE);
    if (!is_leaf(place())) optixIgnoreIntersection();
}

ENTRY(anyhit, PathTracer_leaf_cut_out_Leaf_Shadow_Triangles) {
    optixSetPayloadTypes(SHADOW);
    if (!is_leaf(place())) optixIgnoreIntersection();
}

ENTRY(closesthit, PathTracer_leaf_leaf_Leaf_Radiance_Triangles) {
    optixSetPayloadTypes(RADIANCE);
    float2 at = place();
    float across = fabsf(at.y - 0.5f);
    float stripe = (at.x - 0.6f * across) * 9.0f;
    bool vein = across < 0.012f || stripe - floorf(stripe) < 0.09f;
    float3 albedo = record<Leaf>().albedo;
    if (vein) albedo = albedo * 1.6f;
    SurfacePoint point = SurfacePoint::of_triangle_hit();
    diffuse(point, point.normal, albedo);
}

DEVICE bool report(float t, u32 kind, float3 o, float3 d, float radius) {
    float3 n = normalize((o + d * t) / radius);
    return optixReportIntersection(t, kind, bits(n.x), bits(n.y), bits(n.z));
}

DEVICE void intersect_ball() {
    float radius = record<Ball>().radius;
    float3 o = optixGetObjectRayOrigin(), d = optixGetObjectRayDirection();
    float dd = dot(d, d);
    float b = -dot(o, d);
    float3 nearest = o + d * (b / dd);
    float discriminant = radius * radius - dot(nearest, nearest);
    if (discriminant < 0.0f) return;
    float root = sqrtf(discriminant * dd);
    float q = b + copysignf(root, b);
    float c = dot(o, o) - radius * radius;
    float t0 = c / q, t1 = q / dd;
    float near = t0 < t1 ? t0 : t1, far = t0 < t1 ? t1 : t0;
    if (!report(near, 0, o, d, radius)) report(far, 1, o, d, radius);
}

ENTRY(intersection, PathTracer_ball_ball_Ball_Radiance_Custom) {
    optixSetPayloadTypes(RADIANCE);
    intersect_ball();
}

ENTRY(intersection, PathTracer_ball_ball_Ball_Shadow_Custom) {
    optixSetPayloadTypes(SHADOW);
    intersect_ball();
}

ENTRY(closesthit, PathTracer_ball_mirror_Ball_Radiance_Custom) {
    optixSetPayloadTypes(RADIANCE);
    const Ball& ball = record<Ball>();
    float3 n = make_float3(real(optixGetAttribute_0()), real(optixGetAttribute_1()), real(optixGetAttribute_2()));
    float3 error = splat(ball.radius * Gamma<16>::value);
    SurfacePoint point = SurfacePoint::of_object(n * ball.radius, n, error, object_to_world(), world_to_object());
    float3 incoming = optixGetWorldRayDirection();
    float3 direction = incoming - point.normal * (2.0f * dot(incoming, point.normal));
    answer(splat(0.0f), ball.reflectance, point.origin(direction), direction, true, 0);
}

ENTRY(miss, PathTracer_dark_Radiance) {
    optixSetPayloadTypes(RADIANCE);
    answer(splat(0.0f), splat(0.0f), splat(0.0f), splat(0.0f), false, 0);
}

ENTRY(miss, PathTracer_lit_Shadow) {
    optixSetPayloadTypes(SHADOW);
    optixSetPayload_0(1);
}
