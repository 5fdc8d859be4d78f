// I020, I024: that a pipeline throws an exception is said by the pipeline

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub faults: SliceMut<u32>,
}

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    View { at: Slice<u32> },
}

#[derive(Clone, Copy, UserException)]
pub enum Other {
    Numbers { low: u64, high: u64 },
}

impl optix_device_rs::exception::ThrownBy<Flat> for Other {}

#[raygen]
fn camera(rg: &RayGen<Flat>) {
    rg.throw(Other::Numbers { low: 0x1000, high: 100 })
}

pipeline! {
    pub struct Flat {
        params: Frame,
        raygen: [camera],
        throws: Fault,
    }
}

fn main() {}
