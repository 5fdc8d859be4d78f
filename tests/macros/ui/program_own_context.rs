// T03, C013: a context of the same name is not the toolkit's

use optix_device_rs::prelude::*;

pub struct Miss<P>(core::marker::PhantomData<P>);

#[miss]
pub fn sky<P: Pipeline>(_: &Miss<P>) {}

fn main() {}
