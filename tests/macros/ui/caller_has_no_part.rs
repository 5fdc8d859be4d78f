// H022, H023: a caller that writes or reads no field gives or gets nothing of the payload

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub world: Traversable,
}

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
}

#[derive(Payload)]
pub struct Touch {
    #[payload(write(caller), read(closesthit))]
    pub strength: f32,
}

fn gives<P: Pipeline<Params = Frame> + HasRay<Radiance>>(rg: &RayGen<P>, ray: Ray) -> Vec3 {
    let seen = rg.trace::<Radiance>(rg.params().world(), ray, RadianceFromCaller { light: Vec3::ZERO });
    seen.light
}

fn gets<P: Pipeline<Params = Frame> + HasRay<Touch>>(rg: &RayGen<P>, ray: Ray) -> f32 {
    let seen: TouchAtCaller = rg.trace::<Touch>(rg.params().world(), ray, TouchFromCaller { strength: 1.0 });
    seen.strength
}

fn main() {}
