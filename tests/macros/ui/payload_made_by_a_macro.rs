// T03, H024: a payload out of a macro is checked like any other

use optix_device_rs::prelude::*;

macro_rules! payload {
    ($name:ident { $($field:ident: $ty:ty),* }) => {
        #[derive(Payload)]
        pub struct $name {
            $(#[payload(write(closesthit), read(caller))] pub $field: $ty,)*
        }
    };
}
payload!(Radiance { light: Vec3, depth: u32 });

fn main() {}
