// G052: a hit may have no instance

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>) {
    let _table = [0; 4][hit.instance_id() as usize];
}

fn main() {}
