// H034, D017: a program's where-clause holds in its pipeline

mod common;
use common::*;

#[miss]
pub fn haze<P>(ms: &Miss<P>) -> RadianceFromMiss
where
    P: HasRay<Radiance> + HasRay<Shadow>,
{
    RadianceFromMiss { light: ms.world_ray_direction() }
}

pipeline! {
    pub struct PathTracer { params: Frame, raygen: [camera], rays: { Radiance { miss: haze } } }
}

fn main() {}
