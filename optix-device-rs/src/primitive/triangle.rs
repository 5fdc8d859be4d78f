//! Built-in triangles.

use super::{Attributes, Primitive, PrimitiveType};
use crate::check::FitsEverywhere;
use crate::data::DeviceData;
use crate::intrinsics::{Invocation, Private, check};
use crate::layout::Layout;
#[cfg(target_arch = "nvptx64")]
use crate::math::Math;
use crate::program::{Context, Face, HitKind, Transform};
use crate::surface::{SurfacePoint, TINY, U, gamma};
use crate::view::Slice;
use crate::words::{FromRaw, Words, words_of_raw};
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;
use core::ops::RangeInclusive;
use glam::{Vec2, Vec3};

/// A hit on a built-in triangle; its attributes are the barycentrics.
///
/// The hit point is `(1 - u - v) * p0 + u * p1 + v * p2` (guide 13.4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangles {
    /// Weight of the second vertex, 0 to 1.
    pub u: f32,
    /// Weight of the third vertex, 0 to 1.
    pub v: f32,
}

impl Primitive for Triangles {
    const TYPE: PrimitiveType = PrimitiveType::Triangle;
    const OPTIX_TYPE: u32 = 0x2531;
    const HIT_KINDS: RangeInclusive<u8> = FRONT_FACE..=BACK_FACE;
    const HAS_INTERSECTION_PROGRAM: bool = false;
    const QUERIES: &'static [&'static str] =
        &["_optix_get_triangle_barycentrics", "_optix_get_triangle_vertex_data_current_hit"];
    type Hits<Reported: Attributes> = Self;
    type IntersectionProgram<Program> = FitsEverywhere;
    type ProgramOfBuiltIn<Program> = Program;
}

impl Attributes for Triangles {
    const NAME: &'static str = "Triangles";
    const WORDS: usize = 2;
    #[inline(always)]
    unsafe fn load(words: &[u32]) -> Self {
        // SAFETY: two numbers were stored, or a backend wrote their bits.
        let [u, v] = unsafe { Words::load(words) };
        Self { u, v }
    }
    #[inline(always)]
    fn store(self, words: &mut [u32]) {
        [self.u, self.v].store(words);
    }
}

// ---- Hit kinds -----------------------------------------------------------------------------------------------------

const FRONT_FACE: u8 = 254;
const BACK_FACE: u8 = 255;

impl HitKind {
    /// The front of a built-in triangle.
    pub const TRIANGLE_FRONT_FACE: Self = Self::of_number(FRONT_FACE);
    /// The back of a built-in triangle.
    pub const TRIANGLE_BACK_FACE: Self = Self::of_number(BACK_FACE);

    /// Whether it is a triangle's (`optixIsTriangleHit`).
    #[inline(always)]
    pub fn is_triangle(self) -> bool {
        self.get() >= FRONT_FACE
    }
}

// ---- What programs ask about the triangle that was hit -------------------------------------------------------------

/// Hits on triangles.
///
/// # Safety
/// As the name says: other hits have no triangle to ask about.
#[diagnostic::on_unimplemented(
    message = "hits that carry `{Self}` are not hits on triangles",
    label = "only hits on triangles have barycentrics, a face, vertices and a surface point (guide 13.4, 13.9)",
    note = "read what the intersection program reported: `hit.attributes()`; in a program for any kind of hit, ask for `Triangles` in its context"
)]
pub unsafe trait OnTriangles {}
// SAFETY: the attributes of the built-in intersection.
unsafe impl OnTriangles for Triangles {}

/// An intrinsic that gives three vertices, with what goes before its call. Needs `unsafe`: what it asks about is to be a
/// triangle.
#[cfg(target_arch = "nvptx64")]
macro_rules! vertices {
    ($($before:literal,)? call $call:literal $(, $name:ident = $class:ident $value:expr)*) => {{
        let (a, b, c, d, e, f, g, h, i): (f32, f32, f32, f32, f32, f32, f32, f32, f32);
        asm!(
            "{{ .reg .f32 f<9>;",
            $($before,)?
            concat!("call (f0, f1, f2, f3, f4, f5, f6, f7, f8), ", $call, ";"),
            "mov.b32 {a}, f0; mov.b32 {b}, f1; mov.b32 {c}, f2;",
            "mov.b32 {d}, f3; mov.b32 {e}, f4; mov.b32 {f}, f5;",
            "mov.b32 {g}, f6; mov.b32 {h}, f7; mov.b32 {i}, f8; }}",
            $($name = in($class) $value,)*
            a = out(reg32) a, b = out(reg32) b, c = out(reg32) c,
            d = out(reg32) d, e = out(reg32) e, f = out(reg32) f,
            g = out(reg32) g, h = out(reg32) h, i = out(reg32) i,
            options(pure, nomem, nostack, preserves_flags)
        );
        [Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::new(g, h, i)]
    }};
}

device_functions! {
    in hit else HasHit {
        /// Weights of the second and third vertex (guide 13.4).
        "optixGetTriangleBarycentrics"
        fn barycentrics(&self) -> Vec2 where A: OnTriangles {
            ptx {
                let (u, v): (f32, f32);
                // SAFETY: the hit is a triangle's, by the context's type.
                unsafe {
                    asm!(
                        "{{ .reg .f32 f<2>; call (f0, f1), _optix_get_triangle_barycentrics, ();",
                        "mov.b32 {u}, f0; mov.b32 {v}, f1; }}",
                        u = out(reg32) u,
                        v = out(reg32) v,
                        options(pure, nomem, nostack, preserves_flags)
                    )
                };
                Vec2::new(u, v)
            }
            host {
                let [u, v, ..] = self.frame().hit.attributes;
                Vec2::new(f32::from_bits(u), f32::from_bits(v))
            }
        }

        /// Which side was hit; an instance may flip it.
        "optixIsFrontFaceHit()" "optixIsBackFaceHit()" "optixIsTriangleFrontFaceHit" "optixIsTriangleBackFaceHit"
        fn face(&self) -> Face where A: OnTriangles {
            self.hit_kind().side()
        }

        /// The triangle's vertices in object space (guide 13.9).
        "optixGetTriangleVertexData"
        fn vertices(&self) -> [Vec3; 3] where A: OnTriangles {
            ptx {
                // SAFETY: the hit is a triangle's, by the context's type.
                unsafe { vertices!(call "_optix_get_triangle_vertex_data_current_hit, ()") }
            }
            host { self.frame().executor.triangle_vertices() }
        }

        /// The hit point in world space with its normal and error bound, to shade and to spawn rays from.
        fn surface_point(&self) -> SurfacePoint where A: OnTriangles {
            SurfacePoint::of_triangle(
                self.vertices(),
                self.barycentrics(),
                &self.object_to_world(),
                &self.world_to_object(),
            )
        }
    }
}

// ---- Triangles of a structure, by number ---------------------------------------------------------------------------

/// The triangles of a GAS.
///
/// On the host it is a [`TriangleTable`](crate::host::TriangleTable).
#[derive(Clone, Copy)]
#[repr(C)]
pub struct TriangleVertices {
    gas: u64,
    /// Per record of the GAS: triangles in its build input.
    counts: Slice<u32>,
}

/// # Safety
/// The handle is of a GAS of triangles, built with random vertex access on the machine that launches, and stays alive while
/// programs may use the view; it has as many records as `counts`, each of a build input with so many triangles.
impl FromRaw for TriangleVertices {
    type Raw = (u64, Slice<u32>);
    #[inline(always)]
    unsafe fn from_raw((gas, counts): (u64, Slice<u32>)) -> Self {
        Self { gas, counts }
    }
}

impl TriangleVertices {
    #[doc(hidden)]
    pub const fn to_raw(self) -> [u64; 3] {
        let [address, len] = self.counts.to_raw();
        [self.gas, address, len]
    }

    /// How many records the GAS has: one for each material of each geometry, in order.
    #[inline(always)]
    pub const fn records(self) -> u32 {
        self.counts.len() as u32
    }

    /// How many triangles the geometry of a record has. A record out of range ends the program.
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub fn triangles(self, sbt_gas_index: u32) -> u32 {
        self.counts.get(sbt_gas_index)
    }

    /// The vertices of a triangle, in object space: triangle `primitive_index` of the geometry that has the record
    /// `sbt_gas_index`; the two as a hit's context gives them. `context` is that of the running program
    /// (`optixGetTriangleVertexDataFromHandle`). For a triangle without area, which no ray meets, NaN or its vertices: the CPU
    /// says NaN, and a driver may. An index out of range ends the program.
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub fn get<C: Context>(self, context: &C, sbt_gas_index: u32, primitive_index: u32) -> [Vec3; 3] {
        let count = self.triangles(sbt_gas_index);
        let message = format_args!("triangle {primitive_index} is out of range: record {sbt_gas_index} has {count}");
        check(primitive_index, count, message);
        // SAFETY: the structure has such a triangle, and was built for this (`from_raw`).
        unsafe {
            context.invocation(Private(())).triangle_vertices_from_handle(self.gas, primitive_index, sbt_gas_index)
        }
    }
}

impl Invocation {
    /// The vertices of a triangle of a structure (`optixGetTriangleVertexDataFromHandle`).
    ///
    /// # Safety
    /// `gas` is of triangles and was built with random vertex access; `sbt_gas_index` is a record of one of its build
    /// inputs, which has a triangle `primitive`.
    #[inline(always)]
    unsafe fn triangle_vertices_from_handle(&self, gas: u64, primitive: u32, sbt_gas_index: u32) -> [Vec3; 3] {
        body! {
            ptx {
                // SAFETY: the caller's.
                unsafe {
                    vertices!(
                        ".reg .f32 time; mov.f32 time, 0f00000000;",
                        call "_optix_get_triangle_vertex_data_from_handle, ({gas}, {primitive}, {sbt}, time)",
                        gas = reg64 gas,
                        primitive = reg32 primitive,
                        sbt = reg32 sbt_gas_index
                    )
                }
            }
            host {
                // SAFETY: the caller's.
                unsafe { self.frame().executor.triangle_vertices_from_handle(gas, primitive, sbt_gas_index) }
            }
        }
    }
}

words_of_raw! {
    [] TriangleVertices: [u64; 3], |raw| Self::from_raw((raw[0], Slice::from_raw([raw[1], raw[2]])));
}

// SAFETY: `#[repr(C)]` integers of 64 bits, the same on both machines.
unsafe impl DeviceData for TriangleVertices {
    const LAYOUT: Layout = Layout::of("TriangleVertices");
    #[inline]
    fn write_to(&self, bytes: &mut [u8]) {
        self.to_raw().write_to(bytes);
    }
    const UNIT: usize = u64::UNIT;
}

impl core::fmt::Debug for TriangleVertices {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "TriangleVertices({} records)", self.records())
    }
}

// ---- Points on a triangle, with their error ------------------------------------------------------------------------

impl SurfacePoint {
    /// The point at `barycentrics` of a triangle given in object space. What the triangle brings to the bound, in the words and symbols of
    /// [the type's documentation](SurfacePoint):
    ///
    /// 1. *vertices*, `gamma(9) |n|.l + u |n|.|p|`: how far a vertex is above the computed point. The cross product is
    ///    computed so that each element is good to `2 u` (Jeannerod, Louvet and Muller 2013, "Further Analysis of Kahan's
    ///    Algorithm"; in `f64` where that is cheaper), `3 u` with the scaling to length 1. So even a needle's `n` is perpendicular
    ///    to its computed edges but for `3 u |n|.|e|`, whatever angle it makes with the true normal, which is not needed. Edges
    ///    are rounded (1), `b1 e1 + b2 e2` rounds twice: over all vertices, at most `4 |e1| + 5 |e2|` or the like. Adding `p0`
    ///    rounds `p`. The hit's own barycentrics may be off by any amount: they name a point of the plane.
    /// 2. *the test*, `2 u |n|.l + 3 u L |n|_1`. After Woop, Benthin and Wald (2013, "Watertight Ray/Triangle Intersection")
    ///    vertices are translated to the origin and sheared so that the ray is the `z` axis, which mixes axes: this is why the
    ///    error of a plane `y = 0` is one of distances *within* the plane. From distances `a` and slopes `s <= 1`, a vertex gets
    ///    `z = a_z` within `u |a_z|` and `x = a_x - s z` within `u (2 |a_x| + 2 s |z|)`, and `u s |z|` more since `s` is rounded. On the
    ///    CPU all else is exact (`cpu/traversal/primitive/triangle/intersect.rs` of optix-host), so there are weights `w >= 0` of sum 1 with
    ///    `sum w a = z s + E`, where `|E|` is `2 u l + 3 u L` at most: the hit is on the ray but for `E`. Its height is negative
    ///    and the ray rises, so `z < 0` where `h > |n|.|E|`, for grazing rays as for others.
    #[inline(always)]
    pub fn of_triangle(
        [p0, p1, p2]: [Vec3; 3],
        barycentrics: Vec2,
        object_to_world: &Transform,
        world_to_object: &Transform,
    ) -> Self {
        let (e1, e2) = (p1 - p0, p2 - p0);
        let extents = larger(larger(e1.abs(), e2.abs()), (e1 - e2).abs());
        let extent = extents.x.max(extents.y).max(extents.z);
        let object = p0 + (e1 * barycentrics.x + e2 * barycentrics.y);
        // By a power of two, which is exact, so that no product over- or underflows.
        let scale = reciprocal_power(extent);
        let normal = cross(e1 * scale, e2 * scale).normalize();

        let error = extents * gamma(22) + object.abs() * (2.0 * U) + (extent * gamma(4) + TINY);
        Self::of_object(object, normal, error, object_to_world, world_to_object)
    }
}

/// The larger of each element, in one instruction each.
#[inline(always)]
fn larger(a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(a.x.max(b.x), a.y.max(b.y), a.z.max(b.z))
}

/// A power of two from the exponent alone: `2^-e` for `length` from `2^e` to `2^(e+1)`.
#[inline(always)]
fn reciprocal_power(length: f32) -> f32 {
    let exponent = length.to_bits() & 0x7f80_0000;
    f32::from_bits(0x7f00_0000u32.saturating_sub(exponent).max(0x0080_0000))
}

/// The cross product, each element good to 2 u.
#[inline(always)]
fn cross(a: Vec3, b: Vec3) -> Vec3 {
    let difference = difference_of_products;
    Vec3::new(difference(a.y, b.z, a.z, b.y), difference(a.z, b.x, a.x, b.z), difference(a.x, b.y, a.y, b.x))
}

/// `a b - c d`, by Kahan's algorithm.
#[cfg(target_arch = "nvptx64")]
#[inline(always)]
fn difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    let cd = c * d;
    a.mul_add(b, -cd) + (-c).mul_add(d, cd)
}

/// `a b - c d`, by products that are exact in `f64`: processors have that at hand, but not always a fused multiply-add.
#[cfg(not(target_arch = "nvptx64"))]
#[inline(always)]
fn difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    (f64::from(a) * f64::from(b) - f64::from(c) * f64::from(d)) as f32
}
