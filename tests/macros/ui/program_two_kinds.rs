// C013: a program is of one kind

use optix_device_rs::prelude::*;

#[closesthit]
#[anyhit]
pub fn alpha<P: Pipeline>(_: &AnyHit<P, Triangles>) -> Decision {
    Decision::Accept
}

fn main() {}
