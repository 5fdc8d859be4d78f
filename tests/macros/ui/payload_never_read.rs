// H040: a field that nobody reads takes registers for nothing

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss))]
    pub light: Vec3,
}

fn main() {}
