//! Nothing that is in scope matters to the macros.
#![no_implicit_prelude]
#![deny(warnings)]
#![allow(dead_code, non_camel_case_types)]

mod core {}
mod std {}
struct Option;
struct Result;
struct Clone;
struct Copy;
struct Debug;
struct From;
struct Sized;
struct Payload;
struct Words;
struct Twin;
struct Field;
struct Bound;
struct Default;
struct Part;
struct Entry;
#[allow(unused_macros)]
macro_rules! assert {
    ($($t:tt)*) => {
        compile_error!("not this one")
    };
}

use ::optix_device_rs::prelude as rt;
use ::optix_device_rs::prelude::{AnyHit, ClosestHit, Decision, Intersection, Miss, RayGen};

#[rt::launch_params]
pub struct Frame {
    pub world: rt::Traversable,
    pub film: rt::SliceMut2d<rt::Vec4>,
    #[bound]
    pub size: u32,
    pub bytes: u32,
    pub keep: f32,
}

#[derive(rt::Payload)]
pub struct Radiance {
    #[payload(write(caller, closesthit, miss), read(caller, closesthit))]
    pub words: rt::Vec3,
    #[payload(write(caller, anyhit), read(caller, anyhit))]
    pub at: u32,
    #[payload(write(caller, intersection), read(closesthit, intersection))]
    pub i: u32,
}

#[derive(::core::clone::Clone, ::core::marker::Copy, rt::SbtRecord)]
#[repr(C)]
pub struct Matte {
    pub keep: rt::Slice<u32>,
    pub bytes: Inner,
}

#[derive(::core::clone::Clone, ::core::marker::Copy, rt::Element)]
#[repr(C)]
pub struct Inner {
    pub value: u32,
}

#[derive(::core::clone::Clone, ::core::marker::Copy, rt::Attributes, rt::Words)]
pub struct Hit {
    pub words: u32,
    pub at: u32,
}

#[rt::raygen]
fn begin(_: &RayGen<Flat>) {}

#[rt::miss]
fn nothing(_: &Miss<Flat>) -> RadianceFromMiss {
    RadianceFromMiss { words: rt::Vec3::ONE }
}

#[rt::closesthit]
fn shade(_: &ClosestHit<Flat, Hit>, _: &Matte, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    RadianceFromClosestHit { words: ray.words }
}

#[rt::anyhit]
fn test(_: &AnyHit<Flat, Hit>, _: &Matte, ray: RadianceAtAnyHit) -> (Decision, RadianceFromAnyHit) {
    (Decision::Accept, RadianceFromAnyHit { at: ray.at })
}

#[rt::intersection]
fn find(_: &Intersection<Flat, Hit>, _: &Matte, ray: RadianceAtIntersection) -> RadianceFromIntersection {
    RadianceFromIntersection { i: ray.i }
}

rt::pipeline! {
    pub struct Flat {
        params: Frame,
        raygen: [begin],
        rays: { Radiance { miss: nothing } },
        hitgroups: { Matte on Custom => { Radiance { intersection: find, anyhit: test, closesthit: shade } } },
    }
}

fn main() {}
