// T03, T04: what the crate calls `optix_device_rs` checks nothing for it

extern crate optix_device_rs as real;
extern crate self as optix_device_rs;
pub use real::*;
pub mod check {
    pub use real::check::*;
    pub const fn no_padding(_: &str, _: usize, _: usize) {}
    pub const fn nothing_to_write<T>() {}
}

use real::prelude::*;

#[derive(Clone, Copy, Element)]
#[repr(C)]
pub struct Padded {
    pub flag: u8,
    pub number: u32,
}

#[launch_params]
pub struct Frame {
    pub world: Traversable,
}

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    pub colour: Vec3,
}

#[raygen]
fn camera(_: &RayGen<Flat>) {}

#[miss]
fn sky(_: &Miss<Flat>) -> RadianceFromMiss {
    RadianceFromMiss { light: Vec3::ONE }
}

pipeline! {
    pub struct Flat {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky } },
        hitgroups: { Paint on Triangles => { Radiance {} } },
    }
}

fn main() {}
