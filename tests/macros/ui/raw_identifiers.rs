// T03, H024: messages name raw identifiers as the user thinks of them

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct r#Type {
    #[payload(write(closesthit), read(caller))]
    pub r#fn: u32,
}

#[closesthit]
pub fn r#match<P: Pipeline>(_: &ClosestHit<P, Triangles>, r#in: r#TypeFromMiss) -> TypeFromClosestHit {
    TypeFromClosestHit { r#fn: r#in.r#fn }
}

fn main() {}
