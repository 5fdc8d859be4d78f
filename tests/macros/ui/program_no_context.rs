// T06: a program takes its context first

use optix_device_rs::prelude::*;

#[miss]
pub fn sky(index: u32) {
    let _ = index;
}

#[miss]
pub fn ground(index: &u32) {
    let _ = index;
}

fn main() {}
