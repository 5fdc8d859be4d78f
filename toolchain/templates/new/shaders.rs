//! The device programs of {{name}}.
#![no_std]

pub use optix_device_rs;
