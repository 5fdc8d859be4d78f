// T03, C035: `Self` that a macro hides in a parameter's type is the parameter struct, where programs load it, too

use optix_device_rs::prelude::*;

pub trait Loaded {
    type As;
}
impl Loaded for Frame {
    type As = u64;
}
impl Loaded for FrameView<'_> {
    type As = &'static u32;
}
macro_rules! loaded {
    () => {
        <Self as Loaded>::As
    };
}

#[launch_params]
pub struct Frame {
    pub at: loaded!(),
}

fn main() {}
