// H023, H040: the caller reads only what comes back

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Probe {
    #[payload(write(caller), read(closesthit))]
    pub id: u32,
    #[payload(write(closesthit, miss), read(caller))]
    pub found: bool,
}

#[raygen]
pub fn camera<P: HasRay<Probe>>(rg: &RayGen<P>) {
    let back = rg.trace::<Probe>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ProbeFromCaller { id: 7 });
    let _ = (back.found, back.id);
}

fn main() {}
