// I002: the result of a callable travels in registers

use optix_device_rs::prelude::*;

#[direct_callable]
fn wood<P: Pipeline>(_: &DirectCallable<P>) -> &'static str {
    "oak"
}

#[direct_callable]
fn stone<P: Pipeline>(_: &DirectCallable<P>) -> Result<f32, ()> {
    Ok(1.0)
}

fn main() {}
