// C020: a program written by hand reports the same hits for every ray type

use optix_device_rs::prelude::*;
use optix_device_rs::program::IntersectionProgram;

#[launch_params]
pub struct Frame {
    pub world: Traversable,
}

#[derive(Payload)]
pub struct First {
    #[payload(write(caller, anyhit), read(anyhit, caller))]
    pub count: u32,
}

#[derive(Payload)]
pub struct Second {
    #[payload(write(caller, anyhit), read(anyhit, caller))]
    pub count: u32,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Ball {
    pub radius: f32,
}

#[derive(Clone, Copy, Attributes)]
pub struct Small {
    pub number: u32,
}

#[derive(Clone, Copy, Attributes)]
pub struct Large {
    pub numbers: [u32; 8],
}

#[raygen]
fn camera(_: &RayGen<Flat>) {}

#[allow(non_camel_case_types)]
pub struct ball {}
impl IntersectionProgram<Flat, Ball, First> for ball {
    type Attributes = Small;
    fn run(isect: &Intersection<Flat, Small>, _: &Ball, _: ()) {
        isect.report(1.0, 0, Small { number: 1 });
    }
}
impl IntersectionProgram<Flat, Ball, Second> for ball {
    type Attributes = Large;
    fn run(isect: &Intersection<Flat, Large>, _: &Ball, _: ()) {
        isect.report(1.0, 0, Large { numbers: [1; 8] });
    }
}

pipeline! {
    pub struct Flat {
        params: Frame,
        raygen: [camera],
        rays: { First {}, Second {} },
        hitgroups: { Ball on Custom => { First { intersection: ball }, Second { intersection: ball } } },
    }
}

fn main() {}
