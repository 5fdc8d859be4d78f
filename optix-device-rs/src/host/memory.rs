//! Owners of what device views point to.

use crate::view::Element;
use core::marker::PhantomData;
use std::any::Any;
use std::sync::Arc;
use std::vec::Vec;

/// Which device memory or an acceleration structure belongs to; unique in the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DeviceId(pub u64);

/// What can go wrong with device memory.
#[derive(Clone)]
#[non_exhaustive]
pub enum MemoryError {
    /// Elements for a buffer that has more or fewer.
    Length {
        /// How many elements were given.
        given: usize,
        /// How many the buffer has.
        buffer: usize,
    },
    /// A buffer that has more or fewer elements than the two-dimensional one that it is to be.
    Size {
        /// How many elements the buffer has.
        buffer: usize,
        /// Width and height.
        size: [u32; 2],
    },
    /// More bytes than addresses can count.
    TooLarge {
        /// How many elements.
        elements: usize,
        /// Bytes of each.
        element: usize,
    },
    /// More bytes than there are.
    OutOfMemory {
        /// How many bytes were asked for.
        bytes: usize,
    },
    /// A copy that goes beyond the memory.
    OutOfRange {
        /// Where it begins, in bytes.
        offset: usize,
        /// How many bytes.
        bytes: usize,
        /// How many bytes the memory has.
        memory: usize,
    },
    /// A copy that begins or ends within what programs access at once.
    PartialWord {
        /// Where it begins, in bytes.
        offset: usize,
        /// How many bytes.
        bytes: usize,
        /// How many bytes programs access at once.
        width: usize,
    },
    /// What the driver says.
    Driver(Arc<dyn std::error::Error + Send + Sync>),
}

impl core::fmt::Display for MemoryError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let remedy = match self {
            Self::Length { given, buffer } => {
                write!(f, "{given} elements were given for a buffer of {buffer}")?;
                "give as many as the buffer has, or make another buffer"
            }
            Self::Size { buffer, size: [width, height] } => {
                write!(f, "a buffer of {buffer} elements is not {width} x {height}")?;
                "make the buffer as long as width times height"
            }
            Self::TooLarge { elements, element } => {
                write!(f, "a buffer of {elements} elements of {element} bytes is larger than memory can be")?;
                "make a smaller buffer"
            }
            Self::OutOfMemory { bytes } => {
                write!(f, "there is not enough memory for {bytes} bytes")?;
                "free memory, or make a smaller buffer"
            }
            Self::OutOfRange { offset, bytes, memory } => {
                write!(f, "{bytes} bytes at {offset} are outside of a buffer of {memory} bytes")?;
                "copy less"
            }
            Self::PartialWord { offset, bytes, width } => {
                write!(f, "{bytes} bytes at {offset} are not whole words of {width} bytes")?;
                "copy whole elements"
            }
            Self::Driver(error) => return core::fmt::Display::fmt(error, f),
        };
        write!(f, "\n  what to do: {remedy}")
    }
}

impl std::error::Error for MemoryError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Driver(error) => error.source(),
            _ => None,
        }
    }
}

/// As [`Display`](core::fmt::Display): what `main` prints of an error that it returns, and `unwrap` of one that it meets.
impl core::fmt::Debug for MemoryError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        core::fmt::Display::fmt(self, f)
    }
}

/// An allocation on a device; copies are ordered with the device's launches. For backends.
///
/// # Safety
/// Programs of `device` that are given `address` in a view may read and write [`Memory::byte_len`] bytes there while this value
/// lives, from launches that keep it; `read` writes all of the bytes it is given.
pub unsafe trait Memory: Any + Send + Sync {
    /// Whose it is.
    fn device(&self) -> DeviceId;
    /// What views on that device hold: an address on a GPU, a [`Handle`](super::Handle)'s number on the CPU.
    fn address(&self) -> u64;
    /// Bytes.
    fn byte_len(&self) -> usize;
    /// Copies `bytes.len()` bytes from `offset` once earlier launches are done.
    fn read(&self, offset: usize, bytes: &mut [u8]) -> Result<(), MemoryError>;
    /// Copies `bytes` to `offset` once earlier launches are done.
    fn write(&self, offset: usize, bytes: &[u8]) -> Result<(), MemoryError>;
}

/// A buffer of `T` on a device: the host counterpart of [`Slice`](crate::view::Slice) and
/// [`SliceMut`](crate::view::SliceMut). A clone is the same buffer.
pub struct Buffer<T> {
    pub(super) memory: Arc<dyn Memory>,
    pub(super) len: usize,
    elements: PhantomData<fn(T) -> T>,
}

impl<T> Clone for Buffer<T> {
    fn clone(&self) -> Self {
        Self { memory: self.memory.clone(), len: self.len, elements: PhantomData }
    }
}

impl<T> core::fmt::Debug for Buffer<T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Buffer({} elements)", self.len)
    }
}

impl<T: Element> Buffer<T> {
    /// For backends.
    ///
    /// # Safety
    /// The allocation has room for `len` elements and is aligned for them; any bytes in it are elements. Where programs run on
    /// the CPU, all buffers of an allocation have elements of one width ([`shared::width`](super::shared::width)).
    #[doc(hidden)]
    pub unsafe fn from_memory(memory: Arc<dyn Memory>, len: usize) -> Self {
        debug_assert!(len.checked_mul(size_of::<T>()).is_some_and(|bytes| bytes <= memory.byte_len()));
        Self { memory, len, elements: PhantomData }
    }

    /// The allocation; for backends.
    #[doc(hidden)]
    pub fn memory(&self) -> &Arc<dyn Memory> {
        &self.memory
    }

    /// How many elements it has.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Copies all elements to the host, after the launches that were begun before.
    pub fn read(&self) -> Result<Vec<T>, MemoryError> {
        let mut elements: Vec<T> = Vec::with_capacity(self.len);
        // Fits: the allocation has room for them.
        let bytes = self.len * size_of::<T>();
        // SAFETY: the vector's memory, zeroed so that the slice is of initialised bytes.
        let target = unsafe {
            core::ptr::write_bytes(elements.as_mut_ptr(), 0, self.len);
            core::slice::from_raw_parts_mut(elements.as_mut_ptr().cast::<u8>(), bytes)
        };
        self.memory.read(0, target)?;
        // SAFETY: `len` elements were written, and any bytes are a `T` (`Element`).
        unsafe { elements.set_len(self.len) };
        Ok(elements)
    }

    /// Overwrites the buffer; `elements` is as long as the buffer.
    pub fn write(&self, elements: &[T]) -> Result<(), MemoryError> {
        if elements.len() != self.len {
            return Err(MemoryError::Length { given: elements.len(), buffer: self.len });
        }
        // SAFETY: an `Element` has no padding, so all its bytes are initialised.
        let bytes = unsafe { core::slice::from_raw_parts(elements.as_ptr().cast::<u8>(), size_of_val(elements)) };
        self.memory.write(0, bytes)
    }
}

/// A two-dimensional buffer: the host counterpart of [`SliceMut2d`](crate::view::SliceMut2d). A clone is the same buffer.
pub struct Buffer2d<T> {
    pub(super) buffer: Buffer<T>,
    pub(super) size: [u32; 2],
}

impl<T> Clone for Buffer2d<T> {
    fn clone(&self) -> Self {
        Self { buffer: self.buffer.clone(), size: self.size }
    }
}

impl<T> core::fmt::Debug for Buffer2d<T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Buffer2d({} x {})", self.size[0], self.size[1])
    }
}

impl<T: Element> Buffer2d<T> {
    /// `size[1]` rows of `size[0]` elements: `buffer` is as long as that.
    pub fn new(buffer: Buffer<T>, size: [u32; 2]) -> Result<Self, MemoryError> {
        let [width, height] = size;
        if buffer.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(MemoryError::Size { buffer: buffer.len(), size });
        }
        Ok(Self { buffer, size })
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Copies all elements to the host, row by row, after the launches that were begun before.
    pub fn read(&self) -> Result<Vec<T>, MemoryError> {
        self.buffer.read()
    }

    /// Overwrites the buffer, row by row.
    pub fn write(&self, elements: &[T]) -> Result<(), MemoryError> {
        self.buffer.write(elements)
    }
}

/// The instances of an IAS: the host counterpart of [`Instances`](crate::accel::Instances). A clone is of the same structure.
#[derive(Clone, Debug)]
pub struct InstanceTable {
    pub(super) ias: World,
    pub(super) len: u32,
}

impl InstanceTable {
    /// For backends.
    ///
    /// # Safety
    /// `ias` is of an IAS with `len` instances, built with random instance access.
    #[doc(hidden)]
    pub unsafe fn new(ias: World, len: u32) -> Self {
        Self { ias, len }
    }
}

/// The triangles of a GAS: the host counterpart of [`TriangleVertices`](crate::primitive::TriangleVertices). A clone is of the same
/// structure.
#[derive(Clone, Debug)]
pub struct TriangleTable {
    pub(super) gas: World,
    pub(super) counts: Buffer<u32>,
}

impl TriangleTable {
    /// For backends.
    ///
    /// # Safety
    /// `gas` is of a GAS of triangles, built with random vertex access, that has as many records as `counts`, each of a build
    /// input with so many triangles. Nobody writes to `counts`.
    #[doc(hidden)]
    pub unsafe fn new(gas: World, counts: Buffer<u32>) -> Self {
        Self { gas, counts }
    }
}

/// An acceleration structure of a scene: the host counterpart of [`Traversable`](crate::ray::Traversable). A clone is the same structure.
#[derive(Clone)]
pub struct World {
    pub(super) handle: u64,
    pub(super) device: DeviceId,
    pub(super) machine: Arc<dyn Any + Send + Sync>,
    pub(super) scene: Arc<dyn Any + Send + Sync>,
}

impl core::fmt::Debug for World {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("World")
    }
}

impl World {
    /// For scenes. `machine` is the backend's own, which keeps `handle` alive on `device`; `scene` is what a launch asks whether
    /// it may trace rays against the structure.
    ///
    /// # Safety
    /// `handle` is of an acceleration structure on `device` for as long as `machine` lives, and `scene` tells truly which
    /// records it needs.
    #[doc(hidden)]
    pub unsafe fn new(
        handle: u64,
        device: DeviceId,
        machine: Arc<dyn Any + Send + Sync>,
        scene: Arc<dyn Any + Send + Sync>,
    ) -> Self {
        Self { handle, device, machine, scene }
    }

    /// The backend's own structure.
    #[doc(hidden)]
    pub fn machine(&self) -> &Arc<dyn Any + Send + Sync> {
        &self.machine
    }

    /// What [`World::new`] was given as `scene`, if it is a `T`.
    #[doc(hidden)]
    pub fn scene<T: Any>(&self) -> Option<&T> {
        self.scene.downcast_ref()
    }
}
