// T05, G058: a traversable comes from the host

use optix_device_rs::prelude::*;

pub fn world() -> Traversable {
    Traversable(0xdead_beef)
}

fn main() {}
