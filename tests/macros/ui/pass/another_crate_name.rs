//! The device crate under another name.
#![deny(warnings)]

mod toolkit {
    pub mod rt {
        pub use optix_device_rs::*;
    }
}
use toolkit::rt::prelude::*;

#[launch_params(crate = crate::toolkit::rt)]
pub struct Frame {
    pub world: Traversable,
}

#[derive(Payload)]
#[optix(crate = crate::toolkit::rt)]
pub struct Probe {
    #[payload(write(caller), read(closesthit))]
    pub id: Id,
}

#[derive(Clone, Copy, Debug, Words)]
#[optix(crate = crate::toolkit::rt)]
pub struct Id(pub u32);

#[derive(Clone, Copy, SbtRecord)]
#[optix(crate = crate::toolkit::rt)]
#[repr(C)]
pub struct Paint {
    pub colour: Vec3,
}

#[raygen(crate = crate::toolkit::rt)]
fn camera(rg: &RayGen<Flat>) {
    rg.trace::<Probe>(rg.params().world(), Ray::new(Vec3::ZERO, Vec3::X), ProbeFromCaller { id: Id(3) });
}

#[closesthit(crate = crate::toolkit::rt)]
fn paint(_: &ClosestHit<Flat, Triangles>, _: &Paint, ray: ProbeAtClosestHit) {
    let _ = ray.id;
}

pipeline! {
    pub struct Flat {
        crate: crate::toolkit::rt,
        params: Frame,
        raygen: [camera],
        rays: { Probe {} },
        hitgroups: { Paint on Triangles => { Probe { closesthit: paint } } },
    }
}

fn main() {}
