use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame<T> {
    pub value: T,
}

fn main() {}
