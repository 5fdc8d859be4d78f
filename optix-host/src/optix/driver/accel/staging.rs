//! Device copies of what the host gives to a build.

use super::super::buffer::DeviceBuffer;
use super::super::context::Context;
use crate::error::DriverError as Error;
use bytemuck::NoUninit;

/// Where the arrays of build inputs are copied to.
pub(super) trait Upload {
    /// The device address of a copy, 0 of nothing; a multiple of 256 bytes.
    ///
    /// # Safety
    /// The bytes must stay as they are until the stream has got past the copy.
    unsafe fn upload(&mut self, bytes: &[u8]) -> Result<u64, Error>;

    /// The device address of a copy of these elements; see [`Upload::upload`].
    ///
    /// # Safety
    /// As [`Upload::upload`].
    unsafe fn elements<T: NoUninit>(&mut self, elements: &[T]) -> Result<u64, Error> {
        // SAFETY: the caller's.
        unsafe { self.upload(bytemuck::cast_slice(elements)) }
    }
}

/// Copies that live until the build has run. Dropping it waits for the stream.
pub(super) struct Staging<'c> {
    context: &'c Context,
    buffers: Vec<DeviceBuffer>,
}

impl<'c> Staging<'c> {
    pub(super) fn new(context: &'c Context) -> Self {
        Self { context, buffers: Vec::new() }
    }
}

impl Upload for Staging<'_> {
    unsafe fn upload(&mut self, bytes: &[u8]) -> Result<u64, Error> {
        let buffer = DeviceBuffer::new(self.context, bytes.len())?;
        let address = buffer.address();
        // Kept before the copy begins, so that it is dropped after it.
        self.buffers.push(buffer);
        if let Some(buffer) = self.buffers.last() {
            // SAFETY: the caller's.
            unsafe { buffer.upload_async(0, bytes)? };
        }
        Ok(address)
    }
}

/// Copies for tests: each in a place of its own, which is remembered.
#[cfg(test)]
#[derive(Default)]
pub(super) struct Remembered(Vec<Vec<u8>>);

#[cfg(test)]
impl Remembered {
    /// The elements that were copied to this address.
    pub fn at<T: bytemuck::AnyBitPattern + NoUninit>(&self, address: u64) -> &[T] {
        match address {
            0 => &[],
            place => bytemuck::cast_slice(&self.0[place as usize / 256 - 1]),
        }
    }
}

#[cfg(test)]
impl Upload for Remembered {
    unsafe fn upload(&mut self, bytes: &[u8]) -> Result<u64, Error> {
        self.0.push(bytes.to_vec());
        Ok(if bytes.is_empty() { 0 } else { 256 * self.0.len() as u64 })
    }
}
