//! Values through attributes: from intersection programs to any-hit and closest-hit programs.

use crate::Trip;
use crate::cargo::*;
use glam::*;
use optix_device_rs::prelude::*;

/// Where a value arrives: the row of the output is `hit * STATIONS + station`.
pub const STATIONS: usize = 3;

/// Where box `hit` stands: its centre.
pub fn place(hit: usize) -> Vec3 {
    Vec3::X * (4 * hit) as f32
}

/// A payload that only says where the ray went.
#[derive(Payload)]
pub struct Found {
    /// Whether the box was hit.
    #[payload(write(closesthit, miss), read(caller))]
    pub hit: bool,
}

/// Nothing is there.
#[miss]
fn nothing(_: &Miss<Hits>) -> FoundFromMiss {
    FoundFromMiss { hit: false }
}

/// Traces a ray at the box of this launch index.
#[raygen]
fn aim(rg: &RayGen<Hits>) {
    let at = place(rg.launch_index().x as usize);
    let _ = rg.trace::<Found>(rg.params().world(), Ray::new(at - Vec3::Z * 2.0, Vec3::Z), ());
}

macro_rules! hits {
    ($($module:ident $hit:literal { $($field:ident: $ty:ty),* } |$cargo:ident, $world:ident| $($value:expr),*;)*) => {
        /// How many kinds of hit there are.
        pub const HITS: usize = [$($hit),*].len();

        $(
            #[expect(missing_docs)]
            pub mod $module {
                use super::*;

                /// What is hit.
                #[derive(Clone, Copy, SbtRecord)]
                #[repr(C)]
                pub struct Material {}

                /// What arrives.
                #[derive(Clone, Copy, Debug, Attributes)]
                pub struct Hit {
                    $(pub $field: $ty),*
                }

                fn put(frame: &crate::TripView<'_>, station: usize, hit: Hit) {
                    let mut words = [0; 8];
                    hit.store(&mut words);
                    frame.put($hit * STATIONS + station, words);
                }

                #[intersection]
                pub fn meet(isect: &Intersection<Hits, Hit>, _: &Material) {
                    let ($cargo, $world) = (isect.params().cargo(), isect.params().world());
                    let ($($field,)*) = ($($value,)*);
                    let hit = Hit { $($field),* };
                    put(&isect.params(), 0, hit);
                    isect.report(1.5, 0, hit);
                }

                #[anyhit]
                pub fn check(hit: &AnyHit<Hits, Hit>) -> Decision {
                    put(&hit.params(), 1, hit.attributes());
                    Decision::Accept
                }

                #[closesthit]
                pub fn shade(hit: &ClosestHit<Hits, Hit>) -> FoundFromClosestHit {
                    put(&hit.params(), 2, hit.attributes());
                    FoundFromClosestHit { hit: true }
                }
            }
        )*

        pipeline! {
            /// Sends values through attributes.
            pub struct Hits {
                params: Trip,
                raygen: [aim],
                rays: { Found { miss: nothing } },
                hitgroups: {
                    $($module::Material on Custom => {
                        Found { intersection: $module::meet, anyhit: $module::check, closesthit: $module::shade }
                    }),*
                },
            }
        }
    };
}

hits! {
    numbers 0 { a: f32, b: u32, c: i32, d: u16, e: i16, f: u8, g: i8, h: bool } |cargo, _world| cargo.numbers.f32,
        cargo.numbers.u32, cargo.numbers.i32, cargo.numbers.u16, cargo.numbers.i16, cargo.numbers.u8, cargo.numbers.i8,
        cargo.numbers.bool;
    wide 1 { a: char, b: u64, c: i64, d: f64 } |cargo, _world| cargo.numbers.char, cargo.numbers.u64, cargo.numbers.i64,
        cargo.numbers.f64;
    nested 2 { a: Inner, b: [bool; 3] } |cargo, _world| cargo.nested.inner, cargo.nested.flags;
    floats 3 { a: Vec2, b: Vec3, c: Vec3A } |cargo, _world| cargo.floats.vec2, cargo.floats.vec3, cargo.floats.vec3a;
    quats 4 { a: Vec4, b: Quat } |cargo, _world| cargo.floats.vec4, cargo.floats.quat;
    maps 5 { a: Affine2, b: UVec2 } |cargo, _world| cargo.floats.affine2, cargo.integers.uvec2;
    doubles 6 { a: Mat2, b: DVec2 } |cargo, _world| cargo.floats.mat2, cargo.doubles.vec2;
    triples 7 { a: DVec3, b: IVec2 } |cargo, _world| cargo.doubles.vec3, cargo.integers.ivec2;
    quadruples 8 { a: DVec4 } |cargo, _world| cargo.doubles.vec4;
    dquats 9 { a: DQuat } |cargo, _world| cargo.doubles.quat;
    integers 10 { a: UVec3, b: IVec3, c: U16Vec2 } |cargo, _world| cargo.integers.uvec3, cargo.integers.ivec3,
        cargo.integers.u16vec2;
    signed 11 { a: UVec4, b: IVec4 } |cargo, _world| cargo.integers.uvec4, cargo.integers.ivec4;
    halves 12 { a: U16Vec3, b: I16Vec3, c: I16Vec2 } |cargo, _world| cargo.integers.u16vec3, cargo.large.i16vec3,
        cargo.large.i16vec2;
    more_halves 13 { a: U16Vec4, b: I16Vec4 } |cargo, _world| cargo.integers.u16vec4, cargo.integers.i16vec4;
    options 14 { a: Option<u64>, b: (u8, f64), c: Option<bool> } |cargo, _world| Some(cargo.numbers.u64),
        (cargo.numbers.u8, cargo.numbers.f64), None;
    views 15 { a: Slice<u32>, b: SliceMut<u32> } |cargo, _world| cargo.views.slice, cargo.views.slice_mut;
    more_views 16 { a: SliceMut2d<f32>, b: Traversable, c: *const u32 } |cargo, world| cargo.views.film, world,
        core::ptr::without_provenance(cargo.numbers.u64 as usize);
}
