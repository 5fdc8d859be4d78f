// H024, H040: a field that nobody writes has no value

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(read(caller))]
    pub light: Vec3,
}

fn main() {}
