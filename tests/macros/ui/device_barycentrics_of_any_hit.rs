// G054: a program for any kind of hit knows of no triangle

use optix_device_rs::prelude::*;

#[anyhit]
pub fn cut_out<P: Pipeline, A: Attributes>(hit: &AnyHit<P, A>) -> Decision {
    if hit.barycentrics().x > 0.5 { Decision::Ignore } else { Decision::Accept }
}

fn main() {}
