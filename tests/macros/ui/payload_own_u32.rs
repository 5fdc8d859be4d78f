// T03: a type of a primitive's name is not the primitive

use optix_device_rs::prelude::*;

#[allow(non_camel_case_types)]
type u32 = usize;

#[derive(Payload)]
pub struct Count {
    #[payload(write(caller, anyhit), read(anyhit, caller))]
    pub hits: u32,
}

fn main() {}
