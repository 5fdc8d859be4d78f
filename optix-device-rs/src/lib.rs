//! What an OptiX device program written in Rust sees.
//!
//! The same shader crate is compiled twice: for `nvptx64-nvidia-cuda`, where the device functions of this crate are
//! OptiX intrinsics, and for the host, where they read the frame that the CPU executor made for the program call.
//! Nothing a program writes depends on which of the two it is.
//!
//! "Guide" is the [NVIDIA OptiX 9.0 Programming Guide](https://raytracing-docs.nvidia.com/optix9/guide/index.html), with the
//! number of the chapter or section.
//!
//! A device program is a typed function. What it may read are its arguments, what it must write is its return value:
//!
//! ```
//! use optix_device_rs::prelude::*;
//!
//! #[launch_params]
//! pub struct Frame {
//!     pub film: SliceMut2d<Vec4>,
//!     pub world: Traversable,
//! }
//!
//! #[derive(Payload)]
//! pub struct Radiance {
//!     #[payload(write(closesthit, miss), read(caller))]
//!     pub light: Vec3,
//! }
//!
//! #[derive(Clone, Copy, SbtRecord)]
//! #[repr(C)]
//! pub struct Paint {
//!     pub colour: Vec3,
//! }
//!
//! #[raygen]
//! fn camera(rg: &RayGen<Flat>) {
//!     let px = rg.launch_index().xy();
//!     let ray = Ray::new(px.as_vec2().extend(-1.0), Vec3::Z);
//!     let hit = rg.trace::<Radiance>(rg.params().world(), ray, ());
//!     rg.params().film().set(px, hit.light.extend(1.0));
//! }
//!
//! #[closesthit]
//! fn paint(_hit: &ClosestHit<Flat, Triangles>, record: &Paint) -> RadianceFromClosestHit {
//!     RadianceFromClosestHit { light: record.colour }
//! }
//!
//! #[miss]
//! fn black(_ms: &Miss<Flat>) -> RadianceFromMiss {
//!     RadianceFromMiss { light: Vec3::ZERO }
//! }
//!
//! pipeline! {
//!     pub struct Flat {
//!         params: Frame,
//!         raygen: [camera],
//!         rays: { Radiance { miss: black } },
//!         hitgroups: { Paint on Triangles => { Radiance { closesthit: paint } } },
//!     }
//! }
//! # fn main() {}
//! ```
#![no_std]

#[cfg(not(target_arch = "nvptx64"))]
extern crate std;

#[doc(hidden)]
#[macro_use]
pub mod intrinsics;

pub mod accel;
pub mod callable;
#[doc(hidden)]
pub mod check;
pub mod data;
pub mod exception;
#[cfg(not(target_arch = "nvptx64"))]
pub mod host;
pub mod layout;
pub mod limits;
pub mod math;
pub mod params;
pub mod payload;
pub mod pipeline;
pub mod prelude;
pub mod primitive;
pub mod program;
pub mod ray;
pub mod record;
pub mod rng;
pub mod surface;
pub mod texture;
pub mod view;
pub mod words;

/// What only this crate implements: the traits above it have a fixed set of types.
mod sealed {
    #[diagnostic::on_unimplemented(
        message = "`{Self}` is none of the types that this trait is for",
        label = "the trait describes types of optix-device-rs, and is implemented for all of them"
    )]
    pub trait Sealed {}
}

/// What the macros' output refers to; not for users.
#[doc(hidden)]
pub mod macro_support {
    pub use crate::intrinsics::Invocation;
    pub use crate::program::entry;
    pub use core;
    pub use glam;
}

/// A panic in device code ends the program: OptiX has nothing to unwind to and the PTX carries no message.
#[cfg(target_arch = "nvptx64")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    intrinsics::trap()
}
