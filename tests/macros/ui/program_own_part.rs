// T03, H022: a struct with a part's name is not a part

use optix_device_rs::prelude::*;

pub struct GlowAtClosestHit {
    pub light: Vec3,
}

#[closesthit]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: GlowAtClosestHit) {
    let _ = ray.light;
}

fn main() {}
