// T03, T05: a record out of a macro is checked like any other

use optix_device_rs::prelude::*;

macro_rules! record {
    ($name:ident, $ty:ty) => {
        #[derive(Clone, Copy, SbtRecord)]
        #[repr(C)]
        pub struct $name {
            pub data: $ty,
        }
    };
}
type Texture = Slice<Vec4>;
record!(Painted, Texture);

fn main() {}
