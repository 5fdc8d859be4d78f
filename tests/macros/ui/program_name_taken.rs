// T03: a program's name is its type's too

use optix_device_rs::prelude::*;

#[allow(non_camel_case_types)]
pub struct sky;

#[miss]
pub fn sky<P: Pipeline>(_: &Miss<P>) {}

fn main() {}
