//! T03: names of primitives and of the prelude that mean something else, raw identifiers, empty structs, clauses.
#![deny(warnings)]
#![allow(non_camel_case_types, dead_code)]

mod u8 {}
mod bool {}
struct u32;
struct usize;
struct str;
struct u64;
struct f32;
mod core {}
#[allow(unused_macros)]
macro_rules! compile_error {
    ($($t:tt)*) => {};
}

use optix_device_rs::prelude::*;

type Word = ::core::primitive::u32;

#[launch_params]
pub struct r#Frame {
    #[bound]
    pub r#type: Word,
    pub r#loop: SliceMut<Word>,
}

#[derive(Payload)]
pub struct r#Ray2
where
    Word: Copy,
{
    #[payload(
        write(caller, closesthit, miss, anyhit, intersection),
        read(caller, closesthit, miss, anyhit, intersection)
    )]
    pub r#fn: Word,
    #[payload(write(caller), read(closesthit))]
    pub clone: [Word; 2],
}

#[derive(Payload)]
pub struct Ping;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct r#Paint {
    pub r#struct: Slice<Word>,
    pub r#in: Word,
}

#[derive(Clone, Copy, Element)]
#[repr(C)]
pub struct Pair(pub Word, pub Word);

#[derive(Clone, Copy, Attributes)]
pub struct Nothing;

#[raygen]
fn r#loop(rg: &RayGen<r#Flat>) {
    rg.params().r#loop().set(0, rg.params().r#type());
}

#[miss]
fn r#match(_: &Miss<r#Flat>, ray: Ray2AtMiss) -> Ray2FromMiss {
    Ray2FromMiss { r#fn: ray.r#fn }
}

#[closesthit]
fn r#ref(_: &ClosestHit<r#Flat, Nothing>, record: &r#Paint, ray: r#Ray2AtClosestHit) -> r#Ray2FromClosestHit {
    Ray2FromClosestHit { r#fn: ray.r#fn + record.r#in + ray.clone[0] }
}

#[anyhit]
fn r#move(_: &AnyHit<r#Flat, Nothing>, ray: Ray2AtAnyHit) -> (Decision, Ray2FromAnyHit) {
    (Decision::Accept, Ray2FromAnyHit { r#fn: ray.r#fn })
}

#[intersection]
fn r#box(isect: &Intersection<r#Flat, Nothing>, _: &r#Paint, ray: Ray2AtIntersection) -> Ray2FromIntersection {
    isect.report(1.0, 0, Nothing);
    Ray2FromIntersection { r#fn: ray.r#fn }
}

#[intersection]
fn r#unsized(isect: &Intersection<r#Flat, Nothing>) {
    isect.report(1.0, 0, Nothing);
}

pipeline! {
    pub struct r#Flat {
        params: r#Frame,
        raygen: [r#loop],
        rays: { r#Ray2 { miss: r#match }, Ping {} },
        hitgroups: {
            r#Paint on Custom => {
                r#Ray2 { intersection: r#box, closesthit: r#ref, anyhit: r#move },
                Ping { intersection: r#unsized },
            },
        },
    }
}

fn main() {
    assert_eq!(Flat::DESCRIPTION.params.size, 24);
    assert_eq!(Ping::WORDS, 0);
}
