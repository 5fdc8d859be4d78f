// I023, I027: an exception program returns nothing

use optix_device_rs::prelude::*;

#[exception]
fn report<P: Pipeline>(ex: &Exception<P>) -> i32 {
    ex.exception_code()
}

fn main() {}
