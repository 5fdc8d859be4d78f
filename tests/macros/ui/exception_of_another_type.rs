// I024: an exception program is told of what its pipeline throws

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost,
}

#[derive(Clone, Copy, UserException)]
pub enum Other {
    Broken(u32),
}

#[exception]
fn report<P: Pipeline<Exception = Fault>>(ex: &Exception<P>) {
    if let Raised::User(Other::Broken(_)) = ex.raised() {}
}

fn main() {}
