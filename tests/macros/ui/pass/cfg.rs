//! T01, T07: `#[cfg]` on an item holds for all that is made of it, above or below the attribute, and on each field of a
//! derive's struct.
#![deny(warnings)]

use optix_device_rs::prelude::*;

#[launch_params]
#[cfg(target_pointer_width = "64")]
pub struct Frame {
    pub world: Traversable,
}

#[cfg(not(target_pointer_width = "64"))]
#[launch_params]
pub struct Frame {
    pub film: SliceMut2d<Vec4>,
}

#[derive(Payload)]
pub struct Probe {
    #[payload(write(caller), read(closesthit))]
    pub id: u32,
    #[cfg(any())]
    #[payload(nonsense)]
    pub never: NoSuchType,
}

#[derive(Clone, Copy, SbtRecord)]
#[cfg_attr(all(), repr(C))]
pub struct Paint {
    pub colour: Vec3,
    #[cfg(any())]
    pub never: NoSuchType,
}

#[raygen]
#[cfg(target_pointer_width = "64")]
fn camera(rg: &RayGen<Flat>) {
    rg.trace::<Probe>(rg.params().world(), Ray::new(Vec3::ZERO, Vec3::X), ProbeFromCaller { id: 3 });
}

#[closesthit]
#[cfg(any())]
fn never(_: &NoSuchType) {}

pipeline! {
    pub struct Flat {
        params: Frame,
        raygen: [camera],
        rays: { Probe {} },
        hitgroups: { Paint on Triangles => { Probe {} } },
    }
}

#[cfg(any())]
pipeline! {
    pub struct Never { params: NoSuchType }
}

fn main() {}
