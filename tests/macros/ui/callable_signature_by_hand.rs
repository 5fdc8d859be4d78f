// I003: signatures are function types, and kinds are two

use optix_device_rs::prelude::*;
use optix_device_rs::callable::{CallableKind, Signature};

pub struct Texture;
impl Signature for Texture {
    type Arguments = (Vec2,);
    type Result = Vec3;
}

pub struct Third;
impl CallableKind for Third {
    const IS_CONTINUATION: bool = true;
}

fn main() {}
