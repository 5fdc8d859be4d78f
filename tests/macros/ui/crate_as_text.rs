// T01, T03: a path is no text

use optix_device_rs::prelude::*;

#[derive(Payload)]
#[optix(crate = "optix_device_rs")]
pub struct Probe {
    #[payload(write(caller), read(closesthit))]
    pub id: u32,
}

#[closesthit(crate = "optix_device_rs")]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}

fn main() {}
