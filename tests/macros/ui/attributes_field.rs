// G031, G032: what a hit carries travels in 32-bit words

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub normal: [usize; 3],
}

fn main() {}
