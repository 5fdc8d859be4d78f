// I002: a callable has eight arguments at most

use optix_device_rs::prelude::*;

#[direct_callable]
fn wood<P: Pipeline>(_: &DirectCallable<P>, a: u8, b: u8, c: u8, d: u8, e: u8, f: u8, g: u8, h: u8, i: u8) -> u8 {
    a | b | c | d | e | f | g | h | i
}

fn main() {}
