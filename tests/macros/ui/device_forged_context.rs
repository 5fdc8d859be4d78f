// G005, I005: the contexts of programs are the toolkit's

use optix_device_rs::prelude::*;

pub struct Both<'a, P>(&'a DirectCallable<P>);

impl<P> Context for Both<'_, P> {
    fn machine(&self, here: optix_device_rs::program::Here) -> &optix_device_rs::machine::Cx {
        self.0.machine(here)
    }
}

fn main() {}
