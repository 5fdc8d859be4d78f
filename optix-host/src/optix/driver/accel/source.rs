//! Where the data of a build comes from.

use std::sync::Arc;

use bytemuck::NoUninit;

use super::super::buffer::DeviceBuffer;
use super::super::context::Context;
use crate::error::DriverError as Error;

/// Elements on the host, which the build uploads, or already on the device.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a, T>(Place<'a, T>);

#[derive(Clone, Copy, Debug)]
enum Place<'a, T> {
    Host(&'a [T]),
    Device { buffer: &'a Arc<DeviceBuffer>, offset: usize, count: usize },
}

impl<'a, T: NoUninit> Source<'a, T> {
    /// Elements on the host. The build checks what it can: that indices are in range, for one.
    pub fn host(elements: &'a [T]) -> Self {
        Self(Place::Host(elements))
    }

    /// `count` elements in device memory, tightly packed, from `offset` bytes on.
    ///
    /// # Errors
    /// [`Error::Invalid`] when they don't fit the buffer, or the offset is no multiple of the element's alignment.
    ///
    /// # Safety
    /// The build reads the elements unchecked: vertex indices must be below the number of vertices and record indices
    /// below the number of records.
    pub unsafe fn device(buffer: &'a Arc<DeviceBuffer>, offset: usize, count: usize) -> Result<Self, Error> {
        const WHAT: &str = "build input in device memory";
        let end = count.checked_mul(size_of::<T>()).and_then(|len| len.checked_add(offset));
        if end.is_none_or(|end| end > buffer.len()) {
            let size = size_of::<T>();
            let problem = format!("{count} elements of {size} bytes at {offset} do not fit {} bytes", buffer.len());
            return Err(Error::invalid(WHAT, problem, "count the elements from the offset on"));
        }
        if !offset.is_multiple_of(align_of::<T>()) {
            let problem = format!("the offset {offset} is no multiple of {}", align_of::<T>());
            return Err(Error::invalid(WHAT, problem, "align the elements"));
        }
        Ok(Self(Place::Device { buffer, offset, count }))
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        match self.0 {
            Place::Host(elements) => elements.len(),
            Place::Device { count, .. } => count,
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The elements, where the host has them.
    pub(super) fn on_host(&self) -> Option<&'a [T]> {
        match self.0 {
            Place::Host(elements) => Some(elements),
            Place::Device { .. } => None,
        }
    }
}

impl<'a, T: NoUninit> From<&'a [T]> for Source<'a, T> {
    fn from(elements: &'a [T]) -> Self {
        Self::host(elements)
    }
}

/// Device copies of host data, alive until the build has run. Dropping it waits for the stream.
pub(super) struct Staging<'c> {
    pub(super) context: &'c Context,
    buffers: Vec<DeviceBuffer>,
}

impl<'c> Staging<'c> {
    pub(super) fn new(context: &'c Context) -> Self {
        Self { context, buffers: Vec::new() }
    }

    /// The device address of the elements, 0 without any; aligned to 256 bytes where it had to copy them.
    ///
    /// # Safety
    /// The elements must stay as they are until the stream has got past the copy.
    pub(super) unsafe fn place<T: NoUninit>(&mut self, source: &Source<'_, T>) -> Result<u64, Error> {
        match source.0 {
            Place::Host(elements) => {
                let bytes = bytemuck::cast_slice(elements);
                let buffer = DeviceBuffer::new(self.context, bytes.len())?;
                let address = buffer.address();
                // Kept before the copy begins, so that it is dropped after it.
                self.buffers.push(buffer);
                if let Some(buffer) = self.buffers.last() {
                    // SAFETY: the caller promises the elements.
                    unsafe { buffer.upload_async(0, bytes)? };
                }
                Ok(address)
            }
            Place::Device { buffer, offset, count } => {
                self.context.owns("build input", buffer.context())?;
                Ok(if count == 0 { 0 } else { buffer.address() + offset as u64 })
            }
        }
    }
}
