// I021, I024: a code is not cut to one that is allowed

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
#[repr(i128)]
pub enum Fault {
    View { at: Slice<u32> } = 1 << 64,
    Numbers { low: u64, high: u64 } = 0,
}

#[derive(Clone, Copy, UserException)]
#[repr(u128)]
pub enum Huge {
    Most = u128::MAX,
}

fn main() {}
