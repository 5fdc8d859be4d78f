// T03, T04: a field's type means the same in the struct and where the derive writes it

#![allow(non_camel_case_types)]

use core::ops::Deref;
use optix_device_rs::prelude::*;

#[derive(Clone, Copy)]
pub struct Hidden(&'static u32);
impl Deref for Hidden {
    type Target = u64;
    fn deref(&self) -> &u64 {
        &7
    }
}

mod __core {
    pub mod primitive {
        pub type u64 = crate::Hidden;
    }
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    pub id: __core::primitive::u64,
}

fn main() {}
