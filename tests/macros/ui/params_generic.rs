// C035: launch parameters have one type for the whole pipeline

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame<T> {
    pub value: T,
}

fn main() {}
