// T03: the toolkit is where crate = path says

use optix_device_rs::prelude::*;

#[derive(Payload)]
#[optix(crate = toolkit)]
pub struct Probe {
    #[payload(write(caller), read(closesthit))]
    pub id: u32,
}

fn main() {}
