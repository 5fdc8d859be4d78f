//! The machine a program runs on: OptiX intrinsics on the device, the executor's frame on the host.
//!
//! [`Cx`] has the same methods on both, so that everything above this module has one body.

#[cfg(target_arch = "nvptx64")]
mod ptx;
#[cfg(target_arch = "nvptx64")]
