// H012, H029: a payload type is known where it is declared

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance<T> {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: T,
}

fn main() {}
