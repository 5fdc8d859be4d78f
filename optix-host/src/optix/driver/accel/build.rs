//! The build itself: sizes, memory, compaction (guide 5, 5.8).

use std::sync::Arc;

use super::super::buffer::DeviceBuffer;
use super::super::context::Context;
use super::super::sys::{self, OptixBuildInputType as Type, OptixBuildInputUnion as Union};
use super::{Accel, AccelOptions, Inner, Traversable};
use crate::error::DriverError as Error;

/// A build input and the host arrays it points to.
pub(super) struct RawInput {
    input: sys::OptixBuildInput,
    // Boxes, whose contents stay where they are when the structure is moved.
    _buffers: Box<[u64]>,
    _flags: Box<[u32]>,
}

impl RawInput {
    /// `fill` writes the member of the union that counts, which stays zero elsewhere, with the addresses that this keeps:
    /// `buffers` has a device address for each motion key, `flags` an entry for each record.
    pub(super) fn new(
        kind: Type,
        buffers: Box<[u64]>,
        flags: Box<[u32]>,
        fill: impl FnOnce(&mut Union, *const u64, *const u32),
    ) -> Self {
        let mut input = sys::OptixBuildInput { kind, ..Default::default() };
        fill(&mut input.input, buffers.as_ptr(), flags.as_ptr());
        Self { input, _buffers: buffers, _flags: flags }
    }
}

#[cfg(test)]
impl RawInput {
    pub(super) fn kind(&self) -> Type {
        self.input.kind
    }
    pub(super) fn union(&self) -> &Union {
        &self.input.input
    }
    pub(super) fn buffers(&self) -> &[u64] {
        &self._buffers
    }
    pub(super) fn flags(&self) -> &[u32] {
        &self._flags
    }
}

/// Builds, compacts if asked to and if it saves memory, and waits.
///
/// # Safety
/// The device addresses in `inputs` are valid and hold what the build input says, until the stream has got past the
/// build; the handles in instances are those of `children`.
pub(super) unsafe fn build(
    context: &Context,
    inputs: &[RawInput],
    options: &AccelOptions,
    children: Vec<Traversable>,
    depth: u32,
) -> Result<Accel, Error> {
    let inputs: Vec<_> = inputs.iter().map(|input| input.input).collect();
    let count = u32::try_from(inputs.len()).map_err(|_| {
        Error::invalid("an acceleration structure", "more than 2^32 build inputs", "split the structure")
    })?;
    let raw_options = options.raw()?;
    let table = context.table();
    let _current = context.enter()?;
    let mut sizes = sys::OptixAccelBufferSizes::default();
    // SAFETY: the context is live, the options and inputs are locals, and the call reads no device memory.
    let result =
        unsafe { table.accel_compute_memory_usage(context.raw(), &raw_options, inputs.as_ptr(), count, &mut sizes) };
    context.check("optixAccelComputeMemoryUsage", result)?;

    let temp = DeviceBuffer::new(context, sizes.temp_size_in_bytes)?;
    let output = DeviceBuffer::new(context, sizes.output_size_in_bytes)?;
    let compacted_size = if options.compact { Some(DeviceBuffer::zeroed(context, size_of::<u64>())?) } else { None };
    let emitted = compacted_size.as_ref().map(|buffer| sys::OptixAccelEmitDesc {
        result: buffer.address(),
        kind: sys::OptixAccelPropertyType::COMPACTED_SIZE,
    });
    let mut handle = 0;
    // SAFETY: the context is live and current; the buffers have the sizes asked for, are aligned to 256 bytes and are
    // used by nothing else; the caller promises the inputs.
    let result = unsafe {
        table.accel_build(
            context.raw(),
            context.cuda_stream(),
            &raw_options,
            inputs.as_ptr(),
            count,
            temp.address(),
            temp.len(),
            output.address(),
            output.len(),
            &mut handle,
            emitted.as_ref().map_or(std::ptr::null(), |emitted| &raw const *emitted),
            emitted.is_some().into(),
        )
    };
    context.check("optixAccelBuild", result)?;

    let built_size = output.len();
    let mut built = (handle, output);
    if let Some(compacted_size) = compacted_size {
        let mut bytes = [0; size_of::<u64>()];
        compacted_size.download(0, &mut bytes)?;
        let size = usize::try_from(u64::from_ne_bytes(bytes)).unwrap_or(usize::MAX);
        if 0 < size && size < built_size {
            // SAFETY: `handle` was just built with compaction allowed, in `built.1`.
            built = unsafe { compact(context, handle, size)? };
        }
    }
    // Faults of the build are reported here, and the buffers that go now are no longer in use.
    context.synchronize()?;
    let (handle, buffer) = built;
    Ok(Accel(Arc::new(Inner { handle, depth, built_size, buffer, _children: children })))
}

/// # Safety
/// `handle` is a live acceleration structure of this context, built with compaction allowed, and its memory stays until
/// the stream has got past the copy (a [`DeviceBuffer`] waits when it is dropped).
unsafe fn compact(context: &Context, handle: u64, size: usize) -> Result<(u64, DeviceBuffer), Error> {
    let output = DeviceBuffer::new(context, size)?;
    let mut compacted = 0;
    // SAFETY: the context is current; the output is aligned to 256 bytes, has the size that the build emitted, and does
    // not overlap the input, being another allocation.
    let result = unsafe {
        let table = context.table();
        let (address, len) = (output.address(), output.len());
        table.accel_compact(context.raw(), context.cuda_stream(), handle, address, len, &mut compacted)
    };
    context.check("optixAccelCompact", result)?;
    Ok((compacted, output))
}
