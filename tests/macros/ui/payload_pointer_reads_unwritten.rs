// H004, H024: in memory, too, what is read has been written

use optix_device_rs::prelude::*;

#[derive(Payload)]
#[payload(transport = pointer)]
pub struct Path {
    #[payload(write(closesthit), read(caller))]
    pub vertices: [Vec3; 20],
}

fn main() {}
