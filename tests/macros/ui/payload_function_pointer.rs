// I016: a payload holds no function pointer

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(caller), read(closesthit))]
    pub texture: fn(Vec2) -> Vec3,
}

fn main() {}
