//! Shares contexts, streams and device memory with the crate [`cust`](::cust) (feature `cust`).
//!
//! A [`device`] on cust's stream does its work in order with everything else on that stream. Memory is shared in both
//! directions without a copy: [`buffer`] lends cust's to launches, [`slice`] lends a buffer's to cust.
//!
//! Elements may change their type, such as `[f32; 4]` to `Vec4`, because cust does not know this crate's version of
//! glam.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use optix_host::{Buffer2d, OptixOptions, cust as interop, glam::Vec4};
//! use cust::{context::Context, memory::DeviceBuffer, stream::{Stream, StreamFlags}};
//! use std::sync::Arc;
//!
//! cust::init(cust::CudaFlags::empty())?;
//! let context = Context::new(cust::device::Device::get_device(0)?)?;
//! let stream = Arc::new(Stream::new(StreamFlags::DEFAULT, None)?);
//! let device = interop::device(&context, stream.clone(), &OptixOptions::default())?;
//! let pixels = Arc::new(DeviceBuffer::from_slice(&[[0.0f32; 4]; 64 * 64])?);
//! let film: Buffer2d<Vec4> = Buffer2d::new(interop::buffer(&device, pixels.clone())?, [64, 64])?;
//! // `film` goes into launch parameters; kernels of cust on `stream` read `pixels` after the launch.
//! # Ok(())
//! # }
//! ```

use std::any::Any;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use ::cust::context::Context;
use ::cust::error::CudaError;
use ::cust::memory::{DeviceBuffer, DeviceCopy, DevicePointer, DeviceSlice};
use ::cust::stream::Stream;
use optix_device_rs::host::{Buffer, Memory};
use optix_device_rs::prelude::Element;

use crate::optix::driver::{self, ContextOptions, CudaFailure};
use crate::optix::{OptixBackend, OptixMemory};
use crate::{Device, Error, OptixOptions, Result};

/// A device that works on cust's stream, which is of `context`. It keeps the stream, and the GPU's primary context.
///
/// cust's legacy contexts are not the GPU's primary one, and their streams are refused.
pub fn device(context: &Context, stream: Arc<Stream>, options: &OptixOptions) -> Result<Device> {
    // SAFETY: `context` is live.
    let ordinal = unsafe { driver::ordinal_of(context.as_raw().cast()) }?;
    let options = ContextOptions { ordinal, validation: options.validation, ..Default::default() };
    let raw = stream.as_inner().cast();
    // SAFETY: the stream is live as long as cust's owner of it.
    let context = unsafe { driver::Context::on_stream(&options, raw, stream) }?;
    Ok(Device::on_optix(OptixBackend::of(context)))
}

/// The device's context, as cust's. cust makes it current on this thread, which its functions need.
pub fn context(device: &Device) -> Result<Context> {
    let ordinal = backend(device)?.context.info().ordinal;
    let ordinal = u32::try_from(ordinal).unwrap_or(u32::MAX);
    ::cust::device::Device::get_device(ordinal).and_then(Context::new).map_err(failed("cuDevicePrimaryCtxRetain"))
}

/// The stream that the device works on: the one that [`device`](fn@device) was given.
///
/// Any other device has a stream of its own, which can't become one of cust's: an error.
pub fn stream(device: &Device) -> Result<Arc<Stream>> {
    let owner = backend(device)?.context.stream_owner().cloned();
    owner.and_then(|owner| owner.downcast().ok()).ok_or_else(|| {
        let problem = "it is the device's own, and cust can't hold a stream that it did not make";
        invalid("cust's stream of a device", problem, "make the device with `optix_host::cust::device`")
    })
}

/// cust's memory as a buffer for launches, which keeps it; nothing is copied. Waits for what was asked of the GPU before.
///
/// An error if `T`s can't be read as `E`s by size or alignment, or the memory is of another context.
pub fn buffer<T, E>(device: &Device, buffer: Arc<DeviceBuffer<T>>) -> Result<Buffer<E>>
where
    T: DeviceCopy + Element + Send + Sync,
    E: Element,
{
    let backend = backend(device)?;
    let (address, bytes) = (buffer.as_device_ptr().as_raw(), buffer.len() * size_of::<T>());
    let len = count::<E>(address, bytes)?;
    // SAFETY: cust's owner keeps the memory, and shows it to the host as copies only; any bytes are a `T` (`Element`).
    let buffer = unsafe { driver::DeviceBuffer::of_other_code(&backend.context, address, bytes, buffer) }?;
    let memory: Arc<dyn Memory> = Arc::new(OptixMemory { device: crate::backend::Backend::id(backend), buffer });
    // SAFETY: `count` found room for `len` elements, aligned for them, of which any bytes are one (`Element`).
    Ok(unsafe { Buffer::from_memory(memory, len) })
}

/// A buffer's memory as cust's, which keeps it; nothing is copied. Waits for the launches that were begun before; with
/// those that come later cust's work has to be put in order by the [`stream`] or by waiting.
///
/// An error if `T`s can't be read as `E`s by size or alignment, or the buffer is the CPU's.
pub fn slice<T: Element, E: DeviceCopy + Element>(buffer: &Buffer<T>) -> Result<Slice<E>> {
    let memory: Arc<dyn Any + Send + Sync> = buffer.memory().clone();
    let memory: Arc<OptixMemory> = memory.downcast().map_err(|_| on_cpu())?;
    memory.buffer.context().synchronize()?;
    let address = memory.buffer.address();
    let len = count::<E>(address, buffer.len() * size_of::<T>())?;
    // SAFETY: `len` elements are allocated there as long as `memory` lives, and any bytes are an `E` (`Element`).
    let slice = unsafe { DeviceSlice::from_raw_parts(DevicePointer::from_raw(address), len) };
    Ok(Slice { slice, _memory: memory })
}

/// Memory of a [`Buffer`] that cust copies from and to.
pub struct Slice<E: DeviceCopy> {
    slice: DeviceSlice<E>,
    _memory: Arc<OptixMemory>,
}

impl<E: DeviceCopy> Deref for Slice<E> {
    type Target = DeviceSlice<E>;

    fn deref(&self) -> &DeviceSlice<E> {
        &self.slice
    }
}

impl<E: DeviceCopy> DerefMut for Slice<E> {
    fn deref_mut(&mut self) -> &mut DeviceSlice<E> {
        &mut self.slice
    }
}

fn backend(device: &Device) -> Result<&OptixBackend> {
    let backend: &dyn Any = &*device.backend;
    backend.downcast_ref().ok_or_else(on_cpu)
}

/// How many `E`s the memory holds.
fn count<E>(address: u64, bytes: usize) -> Result<usize> {
    let (size, align) = (size_of::<E>().max(1), align_of::<E>() as u64);
    if bytes.is_multiple_of(size) && address.is_multiple_of(align) {
        return Ok(bytes / size);
    }
    let problem = format!("{bytes} bytes at {address:#x} are not whole elements of {size} bytes, aligned to {align}");
    Err(invalid("shared memory", problem, "share it as elements of the same size and alignment"))
}

fn on_cpu() -> Error {
    invalid("sharing with cust", "the device is the CPU", "use a GPU: `Device::optix` or `optix_host::cust::device`")
}

fn invalid(what: &'static str, problem: impl Into<String>, remedy: &'static str) -> Error {
    driver::Error::Invalid { what, problem: problem.into(), remedy }.into()
}

fn failed(call: &'static str) -> impl FnOnce(CudaError) -> Error {
    move |error| {
        // `Display` is not used: it fails if the driver has no sentence for the code.
        let (name, text, code) = (format!("{error:?}"), "reported by cust".into(), error as i32);
        let remedy = driver::remedy::cuda_remedy(code);
        driver::Error::Cuda(Box::new(CudaFailure { call, name, code, text, remedy, messages: Vec::new() })).into()
    }
}
