// T05: an alias does not hide a view

use optix_device_rs::prelude::*;

type World = Traversable;

#[launch_params]
pub struct Frame {
    pub world: World,
    pub worlds: [World; 2],
}

fn main() {}
