// I009, D017: a callable traces rays of its pipeline

mod common;
use common::*;

#[derive(Payload)]
pub struct Thick {
    #[payload(write(closesthit, miss), read(caller))]
    pub depth: f32,
}

#[continuation_callable]
fn mirror<P: HasRay<Thick>>(cc: &ContinuationCallable<P>) -> f32 {
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    cc.trace::<Thick>(Traversable::NULL, ray, ()).depth
}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        continuation_callables: [mirror],
    }
}

fn main() {}
