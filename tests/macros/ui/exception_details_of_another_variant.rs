// I024: details are those of the code

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost,
    At { pixel: UVec2 },
}

#[exception]
fn report<P: Pipeline<Exception = Fault>>(ex: &Exception<P>) {
    if let Raised::User(Fault::Lost { pixel }) = ex.raised() {
        let _ = pixel;
    }
}

fn main() {}
