// T01: a party is named once

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(caller, caller), read(miss))]
    pub seed: u32,
}

fn main() {}
