// T04: a field is there on both machines, and for the same programs

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    #[cfg(target_arch = "nvptx64")]
    pub extra: u32,
    pub colour: Vec3,
}

#[derive(Clone, Copy, Element)]
#[repr(C)]
pub struct Lamp {
    #[cfg(debug_assertions)]
    pub number: u32,
    pub colour: Vec3,
}

#[derive(Payload)]
pub struct Probe {
    #[cfg(not(target_arch = "nvptx64"))]
    #[payload(write(caller), read(miss))]
    pub extra: u32,
    #[cfg_attr(target_arch = "nvptx64", payload(write(caller), read(miss)))]
    #[cfg_attr(not(target_arch = "nvptx64"), payload(write(caller), read(closesthit)))]
    pub id: u32,
}

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    #[cfg(all(unix, feature = "normals"))]
    pub normal: Vec3,
    pub id: u32,
}

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost {
        #[cfg(target_pointer_width = "64")]
        id: u32,
    },
}

fn main() {}
