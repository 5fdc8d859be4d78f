// H004, T05: a view does not travel in registers

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Path {
    #[payload(write(caller), read(closesthit))]
    pub next: Traversable,
}

fn main() {}
