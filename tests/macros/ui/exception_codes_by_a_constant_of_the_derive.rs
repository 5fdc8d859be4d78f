// I021, T03: two variants of an exception have two codes, whatever constants their numbers name

use optix_device_rs::prelude::*;

const __CODE_0: u32 = 9;

#[derive(Clone, Copy, UserException)]
#[repr(u32)]
pub enum Fault {
    View { at: Slice<u32> } = 3,
    Words { words: [u32; 4] } = __CODE_0 as u32,
}

fn main() {}
