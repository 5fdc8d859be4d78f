// I002, D018: a reference comes from the host

use optix_device_rs::prelude::*;

pub fn texture() -> Callable<fn(Vec2) -> Vec3> {
    Callable::from_raw(7)
}

pub fn textures() -> Callables<fn(Vec2) -> Vec3> {
    Callables { first: 0, len: 100 }
}

fn main() {}
