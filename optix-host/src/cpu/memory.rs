//! Host memory that programs on all threads may read and write.

use core::cell::UnsafeCell;
use core::ptr::NonNull;
use optix_device_rs::host::{DeviceId, Handle, Memory, MemoryError, shared};

/// Device data is aligned to 16 bytes at most.
#[repr(C, align(16))]
struct Block(UnsafeCell<[u8; 16]>);

/// An allocation. All accesses are atomics of one width, on either side ([`shared`]).
pub(super) struct CpuMemory {
    device: DeviceId,
    handle: Handle,
    blocks: Box<[Block]>,
    len: usize,
    width: usize,
}

// SAFETY: threads share bytes by atomics only (`read`, `write`, `Reach::insert`).
unsafe impl Send for CpuMemory {}
// SAFETY: as above.
unsafe impl Sync for CpuMemory {}

impl CpuMemory {
    /// For elements that are accessed `width` bytes at a time: 1, 2 or 4.
    pub fn zeroed(device: DeviceId, len: usize, width: usize) -> Result<Self, MemoryError> {
        let count = len.div_ceil(size_of::<Block>());
        let mut blocks = Vec::new();
        blocks.try_reserve_exact(count).map_err(|_| MemoryError::OutOfMemory { bytes: len })?;
        blocks.resize_with(count, || Block(UnsafeCell::new([0; 16])));
        Ok(Self { device, handle: Handle::issue(), blocks: blocks.into(), len, width })
    }

    pub fn handle(&self) -> &Handle {
        &self.handle
    }

    /// The first byte.
    pub fn bytes(&self) -> NonNull<u8> {
        NonNull::from(&*self.blocks).cast()
    }

    /// Where `len` bytes at `offset` begin.
    fn place(&self, offset: usize, len: usize) -> Result<*mut u8, MemoryError> {
        if offset.checked_add(len).is_none_or(|end| end > self.len) {
            return Err(MemoryError::OutOfRange { offset, bytes: len, memory: self.len });
        }
        if !offset.is_multiple_of(self.width) || !len.is_multiple_of(self.width) {
            return Err(MemoryError::PartialWord { offset, bytes: len, width: self.width });
        }
        Ok(self.bytes().as_ptr().wrapping_add(offset))
    }
}

// SAFETY: views hold the handle's number, which a launch that keeps this value knows as `bytes`, with `len` bytes there.
unsafe impl Memory for CpuMemory {
    fn device(&self) -> DeviceId {
        self.device
    }

    fn address(&self) -> u64 {
        self.handle.number()
    }

    fn byte_len(&self) -> usize {
        self.len
    }

    fn read(&self, offset: usize, bytes: &mut [u8]) -> Result<(), MemoryError> {
        let from = self.place(offset, bytes.len())?;
        // SAFETY: inside the allocation, in whole words of its width.
        unsafe { shared::read(from, bytes.as_mut_ptr(), bytes.len(), self.width) };
        Ok(())
    }

    fn write(&self, offset: usize, bytes: &[u8]) -> Result<(), MemoryError> {
        let to = self.place(offset, bytes.len())?;
        // SAFETY: as in `read`.
        unsafe { shared::write(to, bytes.as_ptr(), bytes.len(), self.width) };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_range_of_whole_words_reads_back() {
        for width in [1, 2, 4] {
            let memory = CpuMemory::zeroed(DeviceId(0), 44, width).unwrap();
            memory.write(2 * width, &[1, 2, 3, 4, 5, 6, 7, 8]).unwrap();
            let mut bytes = [9; 12];
            memory.read(width, &mut bytes).unwrap();
            let expected = [[0; 4], [0; 4]].concat();
            assert_eq!(bytes[..width], expected[..width]);
            assert_eq!(bytes[width..width + 8], [1, 2, 3, 4, 5, 6, 7, 8]);
            assert_eq!(memory.bytes().as_ptr().addr() % 16, 0);
            assert!(memory.read(40, &mut [0; 8]).is_err());
            assert!(memory.write(usize::MAX, &[1]).is_err());
            assert_eq!(memory.write(1, &[1; 4]).is_err(), width > 1);
        }
        assert!(CpuMemory::zeroed(DeviceId(0), isize::MAX as usize, 1).is_err());
    }
}
