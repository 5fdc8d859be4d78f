//! Device memory.

use std::any::Any;
use std::sync::Arc;

use cudarc::driver::result;
use cudarc::driver::sys as cu;

use super::context::Context;
use super::sys::CUdeviceptr;
use crate::error::DriverError as Error;

/// A range of device memory, freed when it is dropped. Its address is a multiple of 256 (cuMemAlloc), which covers the
/// 128 bytes of acceleration structures and the 16 bytes of records.
///
/// Copies run on the context's stream, so they come after everything asked for before them: what a launch writes
/// can't be read before the launch is done.
#[derive(Debug)]
pub struct DeviceBuffer {
    context: Context,
    address: CUdeviceptr,
    len: usize,
    /// The owner of the memory, if other code allocated it.
    owner: Option<Arc<dyn Any + Send + Sync>>,
}

impl DeviceBuffer {
    /// `len` bytes of undefined content. 0 is allowed and takes no memory; its address is 0.
    ///
    /// # Errors
    /// [`Error::Cuda`] when memory is short.
    pub fn new(context: &Context, len: usize) -> Result<Self, Error> {
        let mut address = 0;
        if len > 0 {
            let _current = context.enter()?;
            // SAFETY: the CUDA context is current; the memory is freed by `drop` only.
            address = context.cuda("cuMemAlloc", unsafe { result::malloc_sync(len) })?;
        }
        Ok(Self { context: context.clone(), address, len, owner: None })
    }

    /// Memory of other CUDA code, which `owner` keeps alive; it is not copied, and not freed here. Waits for all work of
    /// the CUDA context, so that what was written before is there. The address is aligned as the other code's is.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the memory is not of this CUDA context, [`Error::Cuda`] for a fault of earlier work.
    ///
    /// # Safety
    /// `len` bytes at `address` are allocated as long as `owner` lives, and `owner` gives nobody a view of them that
    /// launches must not change.
    pub unsafe fn of_other_code(
        context: &Context,
        address: CUdeviceptr,
        len: usize,
        owner: Arc<dyn Any + Send + Sync>,
    ) -> Result<Self, Error> {
        let _current = context.enter()?;
        if len > 0 {
            let mut home: cu::CUcontext = std::ptr::null_mut();
            let attribute = cu::CUpointer_attribute::CU_POINTER_ATTRIBUTE_CONTEXT;
            // SAFETY: the attribute's value is a context, for which `home` has room.
            let result = unsafe { cu::cuPointerGetAttribute((&raw mut home).cast(), attribute, address) }.result();
            context.cuda("cuPointerGetAttribute", result)?;
            // Memory from a pool belongs to the device and to no context.
            if !home.is_null() && home != context.cuda_context() {
                let remedy = "allocate it with this GPU's primary context";
                return Err(Error::invalid("memory of other code", "it is of another CUDA context", remedy));
            }
        }
        // SAFETY: the context is current.
        context.cuda("cuCtxSynchronize", unsafe { cu::cuCtxSynchronize() }.result())?;
        Ok(Self { context: context.clone(), address, len, owner: Some(owner) })
    }

    /// `len` bytes of 0.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn zeroed(context: &Context, len: usize) -> Result<Self, Error> {
        let buffer = Self::new(context, len)?;
        buffer.zero()?;
        Ok(buffer)
    }

    /// A copy of `bytes`.
    ///
    /// # Errors
    /// As [`Self::new`] and [`Self::upload`].
    pub fn from_bytes(context: &Context, bytes: &[u8]) -> Result<Self, Error> {
        let buffer = Self::new(context, bytes.len())?;
        buffer.upload(0, bytes)?;
        Ok(buffer)
    }

    /// Length in bytes.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether the length is 0.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The device address of byte 0; 0 for an empty buffer. It is valid as long as the buffer lives.
    pub fn address(&self) -> u64 {
        self.address
    }

    /// The context it belongs to.
    pub fn context(&self) -> &Context {
        &self.context
    }

    /// Copies `bytes` to the buffer at `offset` bytes, and returns when the copy is done.
    ///
    /// # Errors
    /// [`Error::Invalid`] when the range is not inside the buffer, [`Error::Cuda`] for a fault of earlier work.
    pub fn upload(&self, offset: usize, bytes: &[u8]) -> Result<(), Error> {
        // SAFETY: the stream is waited for before `bytes` can go.
        unsafe { self.upload_async(offset, bytes)? };
        if bytes.is_empty() { Ok(()) } else { self.context.synchronize() }
    }

    /// As [`Self::upload`], without waiting.
    ///
    /// # Safety
    /// `bytes` must stay as they are until the stream has got past the copy.
    pub(super) unsafe fn upload_async(&self, offset: usize, bytes: &[u8]) -> Result<(), Error> {
        self.contains(offset, bytes.len())?;
        if bytes.is_empty() {
            return Ok(());
        }
        let _current = self.context.enter()?;
        // SAFETY: the range is inside the allocation, and the caller keeps `bytes` alive.
        let result =
            unsafe { result::memcpy_htod_async(self.address + offset as u64, bytes, self.context.cuda_stream()) };
        self.context.cuda("cuMemcpyHtoDAsync", result)
    }

    /// Copies from the buffer at `offset` bytes, after all work asked for before.
    ///
    /// # Errors
    /// As [`Self::upload`].
    pub fn download(&self, offset: usize, bytes: &mut [u8]) -> Result<(), Error> {
        self.contains(offset, bytes.len())?;
        if bytes.is_empty() {
            return Ok(());
        }
        let _current = self.context.enter()?;
        let stream = self.context.cuda_stream();
        // SAFETY: the range is inside the allocation, and the stream is waited for before `bytes` can go. If waiting
        // fails the CUDA context is lost and copies nothing more.
        let result = unsafe { result::memcpy_dtoh_async(bytes, self.address + offset as u64, stream) };
        self.context.cuda("cuMemcpyDtoHAsync", result)?;
        self.context.synchronize()
    }

    /// Sets every byte to 0, after all work asked for before, without waiting.
    ///
    /// # Errors
    /// [`Error::Cuda`] for a fault of earlier work.
    pub fn zero(&self) -> Result<(), Error> {
        if self.len == 0 {
            return Ok(());
        }
        let _current = self.context.enter()?;
        // SAFETY: the range is the whole allocation.
        let result = unsafe { result::memset_d8_async(self.address, 0, self.len, self.context.cuda_stream()) };
        self.context.cuda("cuMemsetD8Async", result)
    }

    fn contains(&self, offset: usize, len: usize) -> Result<(), Error> {
        match offset.checked_add(len) {
            Some(end) if end <= self.len => Ok(()),
            _ => Err(Error::invalid(
                "a copy of device memory",
                format!("{len} bytes at offset {offset} do not fit a buffer of {} bytes", self.len),
                "make the buffer as large as what is copied",
            )),
        }
    }
}

impl Drop for DeviceBuffer {
    fn drop(&mut self) {
        if self.address == 0 {
            return;
        }
        if let Ok(_current) = self.context.enter() {
            // Work on the stream may still use the memory. A fault shows up at the next checked call.
            let _ = self.context.synchronize();
            if self.owner.is_none() {
                // SAFETY: allocated by `new`, freed here only, and no longer in use.
                let _ = unsafe { result::free_sync(self.address) };
            }
        }
    }
}

/// Page-locked host memory. Only copies of such memory run while the host goes on.
#[derive(Debug)]
pub(super) struct PinnedBuffer {
    context: Context,
    pointer: *mut u8,
    len: usize,
}

// SAFETY: it owns its memory, and CUDA's page-locked memory is usable from any thread.
unsafe impl Send for PinnedBuffer {}
// SAFETY: `&self` gives no access to the memory, other than to CUDA.
unsafe impl Sync for PinnedBuffer {}

impl PinnedBuffer {
    /// `len` bytes, more than 0, of 0.
    pub(super) fn new(context: &Context, len: usize) -> Result<Self, Error> {
        let _current = context.enter()?;
        // SAFETY: the CUDA context is current; the memory is freed by `drop` only.
        let pointer = context.cuda("cuMemHostAlloc", unsafe { result::malloc_host(len, 0) })?.cast::<u8>();
        // SAFETY: `len` bytes were just allocated there.
        unsafe { pointer.write_bytes(0, len) };
        Ok(Self { context: context.clone(), pointer, len })
    }

    pub(super) fn bytes(&self) -> &[u8] {
        // SAFETY: `len` bytes, initialised by `new`; CUDA only reads them.
        unsafe { std::slice::from_raw_parts(self.pointer, self.len) }
    }

    pub(super) fn bytes_mut(&mut self) -> &mut [u8] {
        // SAFETY: as in `bytes`, borrowed exclusively.
        unsafe { std::slice::from_raw_parts_mut(self.pointer, self.len) }
    }
}

impl Drop for PinnedBuffer {
    fn drop(&mut self) {
        if let Ok(_current) = self.context.enter() {
            // SAFETY: allocated by `new`, freed here only; whoever enqueued a copy from it waited for the copy.
            let _ = unsafe { cu::cuMemFreeHost(self.pointer.cast()) };
        }
    }
}
