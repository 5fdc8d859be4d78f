// What the peers share: vectors, random numbers, transforms and surface points, with the arithmetic of the Rust crates.
//
// Views are as the host lays them out. C++ programmers don't check indices, so neither does this.
#pragma once

#include <optix.h>

using u32 = unsigned int;
using u64 = unsigned long long;
#define DEVICE static __forceinline__ __device__

// Where the host puts the launch parameters; the harness gives the symbol its Rust name.
#define LAUNCH_PARAMS(Type) extern "C" { __constant__ Type params; }

// An entry point: kind, pipeline, program. The harness appends the hash that Rust names end with.
#define ENTRY(kind, name) extern "C" __global__ void __##kind##__##name()

template <class T> struct Slice { const T* data; u64 length; };
template <class T> struct SliceMut2d {
    T* data;
    u32 width, height;
};
template <class T> DEVICE void set(const SliceMut2d<T>& film, uint3 px, T value) {
    film.data[(u64)px.y * film.width + px.x] = value;
}
template <class T> DEVICE const T& record() { return *(const T*)optixGetSbtDataPointer(); }

DEVICE float3 operator+(float3 a, float3 b) { return make_float3(a.x + b.x, a.y + b.y, a.z + b.z); }
DEVICE float3 operator-(float3 a, float3 b) { return make_float3(a.x - b.x, a.y - b.y, a.z - b.z); }
DEVICE float3 operator*(float3 a, float3 b) { return make_float3(a.x * b.x, a.y * b.y, a.z * b.z); }
DEVICE float3 operator/(float3 a, float3 b) { return make_float3(a.x / b.x, a.y / b.y, a.z / b.z); }
DEVICE float3 operator*(float3 a, float b) { return make_float3(a.x * b, a.y * b, a.z * b); }
DEVICE float3 operator/(float3 a, float b) { return make_float3(a.x / b, a.y / b, a.z / b); }
DEVICE float3 operator-(float3 a) { return make_float3(-a.x, -a.y, -a.z); }
DEVICE float3 splat(float x) { return make_float3(x, x, x); }
DEVICE float dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
DEVICE float3 cross(float3 a, float3 b) {
    return make_float3(a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y);
}
DEVICE float length(float3 a) { return sqrtf(dot(a, a)); }
DEVICE float3 normalize(float3 a) { return a * (1.0f / length(a)); }
DEVICE float3 abs(float3 a) { return make_float3(fabsf(a.x), fabsf(a.y), fabsf(a.z)); }
DEVICE float3 min(float3 a, float3 b) { return make_float3(fminf(a.x, b.x), fminf(a.y, b.y), fminf(a.z, b.z)); }
DEVICE float3 max(float3 a, float3 b) { return make_float3(fmaxf(a.x, b.x), fmaxf(a.y, b.y), fmaxf(a.z, b.z)); }
DEVICE float max_element(float3 a) { return fmaxf(a.x, fmaxf(a.y, a.z)); }
DEVICE float min_element(float3 a) { return fminf(a.x, fminf(a.y, a.z)); }
DEVICE float4 extend(float3 a, float w) { return make_float4(a.x, a.y, a.z, w); }
DEVICE bool is_zero(float3 a) { return a.x == 0.0f && a.y == 0.0f && a.z == 0.0f; }

struct Pcg32 {
    u64 state, increment;
    DEVICE Pcg32 hashed(u64 index, u64 seed) {
        u64 z = (index ^ (index >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        z ^= z >> 31;
        u64 increment = seed << 1 | 1;
        return {(z + increment) * 6364136223846793005ull + increment, increment};
    }
    __forceinline__ __device__ u32 next_u32() {
        u64 old = state;
        state = old * 6364136223846793005ull + increment;
        u32 x = (u32)(((old >> 18) ^ old) >> 27), r = (u32)(old >> 59);
        return __funnelshift_r(x, x, r);
    }
    __forceinline__ __device__ float next_f32() { return (float)(next_u32() >> 8) * (1.0f / 16777216.0f); }
    __forceinline__ __device__ float2 next_vec2() {
        float x = next_f32();
        return make_float2(x, next_f32());
    }
};

DEVICE float2 sin_cos_turns(float turns) {
    float shifted = turns * 4.0f + 12582912.0f;
    float r = turns * 4.0f - (shifted - 12582912.0f);
    u32 quarters = __float_as_uint(shifted);
    float z = r * r;
    float s = r * (1.5707964f + z * (-0.6459641f + z * (0.07969258f + z * (-0.0046812664f + z * 0.00015820653f))));
    float c = 1.0f + z * (-1.2337005f + z * (0.25366923f + z * (-0.020860264f + z * 0.00090397545f)));
    float sine = quarters & 1 ? c : s, cosine = quarters & 1 ? s : c;
    return make_float2(quarters & 2 ? -sine : sine, (quarters + 1) & 2 ? -cosine : cosine);
}

// A direction around +z, by the cosine.
DEVICE float3 cosine(float2 at) {
    float radius = sqrtf(at.x);
    float2 sc = sin_cos_turns(at.y);
    return make_float3(radius * sc.y, radius * sc.x, sqrtf(fmaxf(1.0f - at.x, 0.0f)));
}

struct Onb {
    float3 tangent, bitangent, normal;
    DEVICE Onb around(float3 n) {
        float sign = copysignf(1.0f, n.z);
        float a = 1.0f / (-sign - n.z);
        float b = n.x * n.y * a;
        return {make_float3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x),
                make_float3(b, sign + n.y * n.y * a, -n.y), n};
    }
    __forceinline__ __device__ float3 to_world(float3 l) const {
        return tangent * l.x + bitangent * l.y + normal * l.z;
    }
};

struct Transform {
    float m[12];
    __forceinline__ __device__ float3 vector(float3 v) const {
        return make_float3(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
                           m[8] * v.x + m[9] * v.y + m[10] * v.z);
    }
    __forceinline__ __device__ float3 point(float3 p) const { return vector(p) + make_float3(m[3], m[7], m[11]); }
    __forceinline__ __device__ float3 normal(float3 n) const {
        return make_float3(m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z,
                           m[2] * n.x + m[6] * n.y + m[10] * n.z);
    }
    __forceinline__ __device__ float3 magnitudes(float3 v) const {
        return make_float3(fabsf(m[0]) * v.x + fabsf(m[1]) * v.y + fabsf(m[2]) * v.z,
                           fabsf(m[4]) * v.x + fabsf(m[5]) * v.y + fabsf(m[6]) * v.z,
                           fabsf(m[8]) * v.x + fabsf(m[9]) * v.y + fabsf(m[10]) * v.z);
    }
    __forceinline__ __device__ float magnitude_along(float3 n, int i) const {
        return fabsf(m[i]) * n.x + fabsf(m[4 + i]) * n.y + fabsf(m[8 + i]) * n.z;
    }
};
DEVICE Transform object_to_world() {
    Transform t;
    optixGetObjectToWorldTransformMatrix(t.m);
    return t;
}
DEVICE Transform world_to_object() {
    Transform t;
    optixGetWorldToObjectTransformMatrix(t.m);
    return t;
}

static constexpr float U = 1.0f / 16777216.0f;
template <u32 n> struct Gamma {
    static constexpr float value = (float)((double)n / 16777216.0 / (1.0 - (double)n / 16777216.0)) * (1.0f + 2.0f * U);
};

DEVICE float difference_of_products(float a, float b, float c, float d) {
    float cd = __fmul_rn(c, d);
    return __fadd_rn(__fmaf_rn(a, b, -cd), __fmaf_rn(-c, d, cd));
}

// The bound is derived in optix-device-rs/src/spawn.rs. These scenes have one level of instances.
struct SurfacePoint {
    float3 position, normal;
    float error;
    float error_per_length = 3.0f * Gamma<20>::value;

    DEVICE SurfacePoint of_object(float3 point, float3 normal, float3 error, const Transform& to_world,
                                  const Transform& to_object) {
        float3 position = to_world.point(point);
        float residual = fabsf(dot(normal, to_object.point(position) - point));
        float3 n = abs(normal);
        float3 across = make_float3(to_object.magnitude_along(n, 0), to_object.magnitude_along(n, 1),
                                    to_object.magnitude_along(n, 2));
        float translation = to_object.magnitude_along(n, 3);
        float3 world = to_world.magnitudes(error) + abs(position) * Gamma<7>::value;
        float height = dot(across, world) + translation * Gamma<3>::value + residual;
        float3 world_normal = to_object.normal(normal);
        float per_length = 1.0f / length(world_normal);
        float error_per_length = (across.x + across.y + across.z) * per_length * Gamma<20>::value;
        return {position, world_normal * per_length, height * per_length * (1.0f + Gamma<16>::value + error_per_length),
                error_per_length};
    }
    DEVICE SurfacePoint of_triangle_hit() {
        float3 p[3];
        optixGetTriangleVertexData(p);
        float2 b = optixGetTriangleBarycentrics();
        float3 e1 = p[1] - p[0], e2 = p[2] - p[0];
        float3 extents = max(max(abs(e1), abs(e2)), abs(e1 - e2));
        float extent = max_element(extents);
        float3 object = p[0] + (e1 * b.x + e2 * b.y);
        int exponent = __float_as_int(extent) & 0x7f800000;
        float scale = __int_as_float(max(0x7f000000 - exponent, 0x00800000));
        float3 s = e1 * scale, t = e2 * scale;
        float3 n = normalize(make_float3(difference_of_products(s.y, t.z, s.z, t.y),
                                         difference_of_products(s.z, t.x, s.x, t.z),
                                         difference_of_products(s.x, t.y, s.y, t.x)));
        float3 error = extents * Gamma<22>::value + abs(object) * (2.0f * U) +
                       splat(extent * Gamma<4>::value + 16.0f * 1.17549435e-38f);
        return of_object(object, n, error, object_to_world(), world_to_object());
    }
    __forceinline__ __device__ float3 moved(float3 direction, float distance) const {
        return position + normal * copysignf(distance, dot(normal, direction));
    }
    __forceinline__ __device__ float3 origin(float3 direction) const { return moved(direction, error); }
    // Where a ray to `target` ends.
    __forceinline__ __device__ float3 end(const SurfacePoint& target) const {
        float3 way = target.position - position;
        return target.moved(-way, target.error + target.error_per_length * max_element(abs(way)));
    }
};

struct Pinhole {
    float3 eye, forward, right, up;
    __forceinline__ __device__ float3 direction(float2 at) const {
        return normalize(forward + right * (2.0f * at.x - 1.0f) + up * (1.0f - 2.0f * at.y));
    }
};
DEVICE float2 middle(uint3 px, uint3 size) {
    return make_float2(((float)px.x + 0.5f) / (float)size.x, ((float)px.y + 0.5f) / (float)size.y);
}

DEVICE u32 bits(float f) { return __float_as_uint(f); }
DEVICE float real(u32 u) { return __uint_as_float(u); }
static constexpr float FAR = 3.402823466e38f;
