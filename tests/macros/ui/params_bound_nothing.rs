// C042: a bound value has a size

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    #[bound]
    pub nothing: (),
}

fn main() {}
