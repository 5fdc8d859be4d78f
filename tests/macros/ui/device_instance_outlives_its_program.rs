// G069: a handle lasts as long as its program

use optix_device_rs::prelude::*;

pub fn first<P>(rg: &RayGen<P>, lamps: Instances) -> InstanceHandle<'static> {
    lamps.get(rg, 0)
}

fn main() {}
