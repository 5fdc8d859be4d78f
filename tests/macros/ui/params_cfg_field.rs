// C035, T04: host and device see the same launch parameters

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub count: u32,
    #[cfg(target_arch = "nvptx64")]
    pub device_only: u32,
}

fn main() {}
