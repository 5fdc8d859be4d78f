// G005: a context comes from the machine

use optix_device_rs::prelude::*;

#[anyhit]
pub fn alpha<P: Pipeline>(hit: &AnyHit<P, Triangles>) -> Decision {
    let pretend = ClosestHit::<P, Triangles> { invocation: hit.invocation, types: hit.types };
    let _ = pretend.primitive_index();
    Decision::Accept
}

fn main() {}
