// H024: only the caller comes before the closest-hit program on every path

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(closesthit, caller))]
    pub seed: u32,
}

fn main() {}
