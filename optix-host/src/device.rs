//! The machine that programs run on.

use crate::Result;
use crate::backend::Backend;
use crate::cpu::CpuBackend;
use crate::optix::{OptixBackend, OptixOptions};
use optix_device_rs::host::{Buffer, Buffer2d, MemoryError, shared};
use optix_device_rs::prelude::Element;
use std::sync::Arc;

/// A machine that runs device programs: a GPU through OptiX, or the CPU. A clone is the same device.
///
/// ```
/// let device = optix_host::Device::cpu()?;
/// assert_eq!(device.kind(), optix_host::BackendKind::Cpu);
/// let buffer = device.buffer(&[1.0f32, 2.0])?;
/// assert_eq!(buffer.read()?, [1.0, 2.0]);
/// # Ok::<(), optix_host::Error>(())
/// ```
#[derive(Clone)]
pub struct Device {
    pub(crate) backend: Arc<dyn Backend>,
    kind: BackendKind,
    name: Arc<str>,
    description: Arc<str>,
}

/// Which kind of machine a [`Device`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BackendKind {
    /// The embedded CPU executor.
    Cpu,
    /// NVIDIA OptiX.
    Optix,
}

impl Device {
    /// OptiX if the driver is there, otherwise the CPU; [`Device::description`] says which, and why.
    pub fn best() -> Result<Self> {
        match Self::optix() {
            Ok(device) => Ok(device),
            Err(why) => {
                let cpu = Self::cpu()?;
                let why = why.to_string();
                let why = why.lines().next().unwrap_or_default();
                let description = format!("{}; {why}", cpu.name).into();
                Ok(Self { description, ..cpu })
            }
        }
    }

    /// The CPU, on all cores (rayon's global pool).
    ///
    /// Programs run on the threads' own stacks: 2 MiB each, unless `RUST_MIN_STACK` in the environment or the pool that a launch is
    /// made in says otherwise, and the calling thread's for small launches. Traces and calls that nest too deep
    /// for that end the launch with an error, and so do those that a program makes on another stack. A program whose own
    /// functions recurse without an end, or that holds larger arrays than the stack, ends the process, as any Rust program
    /// would: there is no program and no launch index in what Rust says then. On a GPU a stack is some kilobytes, so bound the
    /// depth of what recurses.
    pub fn cpu() -> Result<Self> {
        Ok(Self::on_cpu(CpuBackend::new()))
    }

    /// The CPU, in checked mode: a launch ends with an error that names launch index, program and rule where a program
    /// does what the OptiX guide calls undefined and neither types nor the host rule out; `docs/checked.md` has the list. Slower
    /// than [`Device::cpu`]; pictures are the same.
    pub fn cpu_checked() -> Result<Self> {
        Ok(Self::on_cpu(CpuBackend::checked()))
    }

    fn on_cpu(backend: CpuBackend) -> Self {
        let name: Arc<str> = backend.description().into();
        Self { backend: Arc::new(backend), kind: BackendKind::Cpu, description: name.clone(), name }
    }

    /// The first GPU, through OptiX.
    pub fn optix() -> Result<Self> {
        Self::optix_with(&OptixOptions::default())
    }

    /// The first GPU, through OptiX, with options.
    pub fn optix_with(options: &OptixOptions) -> Result<Self> {
        Ok(Self::on_optix(OptixBackend::new(options)?))
    }

    pub(crate) fn on_optix(backend: OptixBackend) -> Self {
        let name: Arc<str> = backend.description().into();
        Self { backend: Arc::new(backend), kind: BackendKind::Optix, description: name.clone(), name }
    }

    /// Which kind of machine it is.
    pub fn kind(&self) -> BackendKind {
        self.kind
    }

    /// The machine, described in a line.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The machine, described in a line, and for [`Device::best`] why it was chosen.
    pub fn description(&self) -> &str {
        &self.description
    }

    /// Takes the warnings and errors that were reported since the last call: what the driver logged, which in validation mode is what
    /// it found, or the exceptions of launches on the CPU that no program was told of.
    pub fn take_messages(&self) -> Vec<String> {
        self.backend.take_messages()
    }

    /// A buffer that holds `elements`.
    pub fn buffer<T: Element>(&self, elements: &[T]) -> Result<Buffer<T>> {
        let buffer = self.zeroed(elements.len())?;
        buffer.write(elements)?;
        Ok(buffer)
    }

    /// A buffer of `len` elements, all bytes zero.
    pub fn zeroed<T: Element>(&self, len: usize) -> Result<Buffer<T>> {
        let bytes = len.checked_mul(size_of::<T>());
        let bytes = bytes.ok_or(MemoryError::TooLarge { elements: len, element: size_of::<T>() })?;
        let memory = self.backend.allocate(bytes, shared::width::<T>())?;
        // SAFETY: as many bytes as the elements have, aligned to 16 and more, zeroed, and nobody else's.
        Ok(unsafe { Buffer::from_memory(memory, len) })
    }

    /// A two-dimensional buffer of `size[1]` rows of `size[0]` elements, all bytes zero.
    pub fn zeroed_2d<T: Element>(&self, size: [u32; 2]) -> Result<Buffer2d<T>> {
        // 2^32 times 2^32 elements fit 64 bits, which `usize` has wherever OptiX is.
        Ok(Buffer2d::new(self.zeroed(size[0] as usize * size[1] as usize)?, size)?)
    }
}
