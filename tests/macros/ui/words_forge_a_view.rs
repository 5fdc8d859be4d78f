// H004, T05: a view comes out of words that a view was stored in

use optix_device_rs::prelude::*;

pub fn forged(address: u32) -> Slice<f32> {
    Slice::load(&[address, 0, 1000, 0])
}

fn main() {}
