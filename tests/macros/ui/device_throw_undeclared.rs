// I017, I020: a program throws what its pipeline says

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost,
}

#[raygen]
pub fn program<P: Pipeline>(rg: &RayGen<P>) {
    rg.throw(Fault::Lost);
}

fn main() {}
