// G005, I005: the contexts of programs are the toolkit's

use optix_device_rs::prelude::*;

pub struct Both<'a, P>(&'a DirectCallable<P>);

impl<P> Context for Both<'_, P> {
    fn invocation(&self, private: optix_device_rs::intrinsics::Private) -> &optix_device_rs::intrinsics::Invocation {
        self.0.invocation(private)
    }
}

fn main() {}
