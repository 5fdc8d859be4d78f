// I023: an exception program has no payload

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
}

#[exception]
fn report<P: Pipeline>(_: &Exception<P>, _: RadianceAtMiss) {}

fn main() {}
