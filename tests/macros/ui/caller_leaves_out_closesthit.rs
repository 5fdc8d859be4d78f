// G022, H024: without its closest-hit program a ray leaves what only that program writes

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
}

pub fn seen<P: HasRay<Radiance>>(rg: &RayGen<P>, world: Traversable, ray: Ray) -> Vec3 {
    rg.trace_without_closesthit::<Radiance>(world, ray, ()).light
}

fn main() {}
