// C039, T05: an address is not a constant to bind

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    #[bound]
    pub world: Traversable,
}

fn main() {}
