// T03: without a prelude a mistake is still one error

#![no_implicit_prelude]

use ::optix_device_rs::prelude as rt;

#[derive(rt::Payload)]
pub struct Radiance {
    #[payload(write(closesthit), read(caller))]
    pub light: rt::Vec3,
}

fn main() {}
