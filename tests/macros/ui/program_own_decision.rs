// T03, G076: a decision of the same name is not the toolkit's

use optix_device_rs::prelude::*;

pub enum Decision {
    Accept,
    Ignore,
}

#[anyhit]
pub fn alpha<P: Pipeline>(hit: &AnyHit<P, Triangles>) -> Decision {
    if hit.barycentrics().x > 0.5 { Decision::Ignore } else { Decision::Accept }
}

fn main() {}
