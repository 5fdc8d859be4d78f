//! Transform traversables (guide 5.9, 5.10.4, 5.10.5).

use std::sync::Arc;

use super::accel::{Motion, Traversable};
use super::buffer::DeviceBuffer;
use super::context::Context;
use super::sys::{self, OptixTraversableType as Type};
use crate::affine::Affine;
use crate::error::DriverError as Error;

/// A transform above another traversable. Cheap to clone; keeps its memory and its child alive.
#[derive(Clone, Debug)]
pub struct Transform(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    handle: u64,
    child: Traversable,
    // The handle is made from the address, so the buffer never moves.
    _buffer: DeviceBuffer,
}

impl Transform {
    /// A constant row-major 3x4 matrix. It is meant for use below motion transforms; without motion an instance does the same.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a matrix without an inverse.
    pub fn fixed(child: impl Into<Traversable>, matrix: [f32; 12]) -> Result<Self, Error> {
        let Some(inverse) = Affine::from_f32(&matrix).inverse() else {
            let problem = format!("{matrix:?} has no inverse");
            return Err(Error::invalid("a static transform", problem, "give a matrix of full rank and finite numbers"));
        };
        let child = child.into();
        let mut bytes = Bytes::new(&child);
        bytes.padding(8).floats(&matrix).floats(&inverse.to_f32());
        Self::new(child, Type::STATIC_TRANSFORM, bytes, size_of::<sys::OptixStaticTransform>())
    }

    /// Row-major 3x4 matrices, one for each motion key, interpolated element by element.
    ///
    /// # Errors
    /// [`Error::Invalid`] for motion options that don't fit the keys.
    pub fn matrix_motion(child: impl Into<Traversable>, keys: &[[f32; 12]], motion: &Motion) -> Result<Self, Error> {
        Self::motion(child.into(), Type::MATRIX_MOTION_TRANSFORM, keys.len(), keys.as_flattened(), motion)
    }

    /// Scale with shear and pivot, rotation and translation for each motion key, which are interpolated separately
    /// (guide 5.10.5). The order of the 16 numbers is that of [`sys::OptixSRTData`]; the quaternions must have unit
    /// length.
    ///
    /// # Errors
    /// [`Error::Invalid`] for motion options that don't fit the keys.
    pub fn srt_motion(child: impl Into<Traversable>, keys: &[[f32; 16]], motion: &Motion) -> Result<Self, Error> {
        Self::motion(child.into(), Type::SRT_MOTION_TRANSFORM, keys.len(), keys.as_flattened(), motion)
    }

    fn motion(child: Traversable, kind: Type, keys: usize, floats: &[f32], motion: &Motion) -> Result<Self, Error> {
        if keys != usize::from(motion.keys) {
            let problem = format!("{keys} keys are given, the motion has {}", motion.keys);
            return Err(Error::invalid("a motion transform", problem, "give an entry for each motion key"));
        }
        let raw = motion.raw()?;
        let mut bytes = Bytes::new(&child);
        bytes.half(raw.num_keys).half(raw.flags.0).floats(&[raw.time_begin, raw.time_end]).padding(12).floats(floats);
        let size = std::mem::offset_of!(sys::OptixMatrixMotionTransform, transform) + size_of_val(floats);
        Self::new(child, kind, bytes, size)
    }

    fn new(child: Traversable, kind: Type, bytes: Bytes, size: usize) -> Result<Self, Error> {
        debug_assert_eq!(bytes.0.len(), size);
        let context = child.context().clone();
        // Aligned to 256 bytes, more than the 64 that are asked for.
        let buffer = DeviceBuffer::from_bytes(&context, &bytes.0)?;
        let mut handle = 0;
        // SAFETY: the context is live, the address is that of a transform of this kind, and `handle` is valid for a write.
        let result = unsafe {
            let table = context.table();
            table.convert_pointer_to_traversable_handle(context.raw(), buffer.address(), kind, &mut handle)
        };
        context.check("optixConvertPointerToTraversableHandle", result)?;
        Ok(Self(Arc::new(Inner { handle, child, _buffer: buffer })))
    }

    /// The traversable handle.
    pub fn handle(&self) -> u64 {
        self.0.handle
    }

    /// Traversables on the longest path from here to a leaf.
    pub fn depth(&self) -> u32 {
        self.0.child.depth() + 1
    }

    /// The context it belongs to.
    pub fn context(&self) -> &Context {
        self.0.child.context()
    }
}

/// A structure written field by field, since motion transforms have as many keys as the caller likes.
struct Bytes(Vec<u8>);

impl Bytes {
    fn new(child: &Traversable) -> Self {
        Self(child.handle().to_ne_bytes().to_vec())
    }

    fn half(&mut self, value: u16) -> &mut Self {
        self.0.extend(value.to_ne_bytes());
        self
    }

    fn floats(&mut self, values: &[f32]) -> &mut Self {
        self.0.extend(values.iter().flat_map(|value| value.to_ne_bytes()));
        self
    }

    fn padding(&mut self, bytes: usize) -> &mut Self {
        self.0.resize(self.0.len() + bytes, 0);
        self
    }
}
