// G072, G073: the owner of instances is a structure that is built for it

use optix_device_rs::host::{InstanceTable, World};
use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub lamps: Instances,
}

pub fn frame(world: World, instances: InstanceTable) -> FrameHost {
    let _ = (&world, &instances);
    FrameHost { lamps: world }
}

fn main() {}
