//! Host memory that programs on all threads may read and write.

use optix_device_rs::host::{DeviceId, Memory, MemoryError};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Four words; device data is aligned to 16 bytes at most.
#[repr(C, align(16))]
#[derive(Default)]
struct Block([AtomicU32; 4]);

/// An allocation. All accesses are relaxed atomics, on either side, so that racing ones are no worse than on a GPU.
pub(super) struct CpuMemory {
    device: DeviceId,
    blocks: Box<[Block]>,
    len: usize,
}

impl CpuMemory {
    pub fn zeroed(device: DeviceId, len: usize) -> Result<Self, MemoryError> {
        let count = len.div_ceil(size_of::<Block>());
        let mut blocks = Vec::new();
        blocks
            .try_reserve_exact(count)
            .map_err(|_| MemoryError(format!("there is not enough memory for {len} bytes")))?;
        blocks.resize_with(count, Block::default);
        Ok(Self { device, blocks: blocks.into(), len })
    }

    fn check(&self, offset: usize, len: usize) -> Result<(), MemoryError> {
        match offset.checked_add(len) {
            Some(end) if end <= self.len => Ok(()),
            _ => Err(MemoryError(format!("{len} bytes at {offset} are outside a buffer of {} bytes", self.len))),
        }
    }

    /// The word that holds byte `at`, and the byte's place in it.
    fn word(&self, at: usize) -> (&AtomicU32, usize) {
        (&self.blocks[at / 16].0[at / 4 % 4], at % 4)
    }
}

impl Memory for CpuMemory {
    fn device(&self) -> DeviceId {
        self.device
    }

    fn address(&self) -> u64 {
        self.blocks.as_ptr().expose_provenance() as u64
    }

    fn byte_len(&self) -> usize {
        self.len
    }

    fn read(&self, offset: usize, bytes: &mut [u8]) -> Result<(), MemoryError> {
        self.check(offset, bytes.len())?;
        for (i, byte) in bytes.iter_mut().enumerate() {
            let (word, lane) = self.word(offset + i);
            *byte = word.load(Relaxed).to_le_bytes()[lane];
        }
        Ok(())
    }

    fn write(&self, offset: usize, bytes: &[u8]) -> Result<(), MemoryError> {
        self.check(offset, bytes.len())?;
        let mut at = 0;
        while at < bytes.len() {
            let (word, lane) = self.word(offset + at);
            let count = (4 - lane).min(bytes.len() - at);
            let mut value = word.load(Relaxed).to_le_bytes();
            value[lane..lane + count].copy_from_slice(&bytes[at..at + count]);
            word.store(u32::from_le_bytes(value), Relaxed);
            at += count;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_range_reads_back() {
        let memory = CpuMemory::zeroed(DeviceId(0), 45).unwrap();
        memory.write(3, &[1, 2, 3, 4, 5, 6, 7]).unwrap();
        let mut bytes = [9; 12];
        memory.read(1, &mut bytes).unwrap();
        assert_eq!(bytes, [0, 0, 1, 2, 3, 4, 5, 6, 7, 0, 0, 0]);
        assert_eq!(memory.address() % 16, 0);
        assert!(memory.read(40, &mut [0; 6]).is_err());
        assert!(memory.write(usize::MAX, &[1]).is_err());
    }
}
