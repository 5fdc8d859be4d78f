// H008, H022: only the derive says which words a party touches

use optix_device_rs::payload::Part;
use optix_device_rs::prelude::*;
use optix_device_rs::words::WordBuffer;

#[derive(Clone, Copy)]
pub struct Everything(pub Vec3);

impl Part for Everything {
    const MASK: u32 = !0;
    fn load(_: &WordBuffer) -> Self {
        Self(Vec3::ZERO)
    }
    fn store(self, _: &mut WordBuffer) {}
}

fn main() {}
