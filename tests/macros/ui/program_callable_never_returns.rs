// I002: a callable returns

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost,
}

#[direct_callable]
fn wood<P: Throws<Fault>>(dc: &DirectCallable<P>) -> ! {
    dc.throw(Fault::Lost)
}

fn main() {}
