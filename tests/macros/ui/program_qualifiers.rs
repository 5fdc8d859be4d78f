// T06: a program is an ordinary function

use optix_device_rs::prelude::*;

#[raygen]
pub async fn one<P: Pipeline>(_: &RayGen<P>) {}

#[raygen]
pub unsafe fn two<P: Pipeline>(_: &RayGen<P>) {}

#[raygen]
pub const fn three<P: Pipeline>(_: &RayGen<P>) {}

#[raygen]
pub extern "C" fn four<P: Pipeline>(_: &RayGen<P>) {}

fn main() {}
