// T05: a view lasts as long as a launch keeps its owner

use optix_device_rs::host::{KeepAlive, HostData};
use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Painted {
    pub texels: Slice<Vec4>,
}

pub fn texels(record: &PaintedHost) -> Slice<Vec4> {
    record.lower(&mut KeepAlive::default()).texels
}

fn main() {}
