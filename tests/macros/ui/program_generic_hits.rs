// G032: hits of any kind still are hits

use optix_device_rs::prelude::*;

#[anyhit]
pub fn alpha<P: Pipeline, A>(_: &AnyHit<P, A>) -> Decision {
    Decision::Accept
}

fn main() {}
