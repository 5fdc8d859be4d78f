// G056, G058: the owner of triangles is a GAS that is built for it

use optix_device_rs::host::{InstanceTable, TriangleTable};
use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub bulb: TriangleVertices,
}

pub fn frame(instances: InstanceTable, triangles: TriangleTable) -> FrameHost {
    let _ = (&instances, &triangles);
    FrameHost { bulb: instances }
}

fn main() {}
