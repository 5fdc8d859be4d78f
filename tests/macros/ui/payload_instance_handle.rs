// G069, H001: a handle does not travel; its key and its id do

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Found {
    #[payload(write(caller, closesthit), read(caller))]
    pub instance: InstanceHandle<'static>,
}

fn main() {}
