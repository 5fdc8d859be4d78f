//! Transform traversables (guide §5.9, §5.10.4, §5.10.5).

use std::sync::Arc;

use super::accel::{Motion, Traversable};
use super::buffer::DeviceBuffer;
use super::context::Context;
use super::error::Error;
use super::sys::{self, OptixTraversableType as Type};

/// A transform above another traversable. Cheap to clone; keeps its memory and its child alive.
#[derive(Clone, Debug)]
pub struct Transform(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    handle: u64,
    child: Traversable,
    // The handle is made from the address, so the buffer never moves (B106).
    _buffer: DeviceBuffer,
}

impl Transform {
    /// A constant row-major 3x4 matrix. Meant for use below motion transforms; without motion an instance does the same
    /// (B108).
    ///
    /// # Errors
    /// [`Error::Invalid`] for a matrix without an inverse.
    pub fn fixed(child: impl Into<Traversable>, matrix: [f32; 12]) -> Result<Self, Error> {
        let Some(inverse) = invert(matrix) else {
            let problem = format!("{matrix:?} has no inverse");
            return Err(Error::invalid("a static transform", problem, "give a matrix of full rank and finite numbers"));
        };
        let child = child.into();
        let mut bytes = Bytes::new(&child);
        bytes.padding(8).floats(&matrix).floats(&inverse);
        Self::new(child, Type::STATIC_TRANSFORM, bytes, size_of::<sys::OptixStaticTransform>())
    }

    /// Row-major 3x4 matrices, one a motion key, interpolated element by element.
    ///
    /// # Errors
    /// [`Error::Invalid`] for motion options that don't fit the keys.
    pub fn matrix_motion(child: impl Into<Traversable>, keys: &[[f32; 12]], motion: &Motion) -> Result<Self, Error> {
        Self::motion(child.into(), Type::MATRIX_MOTION_TRANSFORM, keys.len(), keys.as_flattened(), motion)
    }

    /// Scale with shear and pivot, rotation, translation, one a motion key, interpolated separately (guide §5.10.5). The
    /// order of the 16 numbers is that of [`sys::OptixSRTData`]; the quaternions must have unit length.
    ///
    /// # Errors
    /// [`Error::Invalid`] for motion options that don't fit the keys.
    pub fn srt_motion(child: impl Into<Traversable>, keys: &[[f32; 16]], motion: &Motion) -> Result<Self, Error> {
        Self::motion(child.into(), Type::SRT_MOTION_TRANSFORM, keys.len(), keys.as_flattened(), motion)
    }

    fn motion(child: Traversable, kind: Type, keys: usize, floats: &[f32], motion: &Motion) -> Result<Self, Error> {
        if keys != usize::from(motion.keys) {
            let problem = format!("{keys} keys are given, the motion has {}", motion.keys);
            return Err(Error::invalid("a motion transform", problem, "give one entry a motion key"));
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
        // Aligned to 256 bytes, more than the 64 that are asked for (B105).
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

/// The inverse of an affine row-major 3x4 matrix, computed in double precision.
fn invert(m: [f32; 12]) -> Option<[f32; 12]> {
    let [a, b, c, tx, d, e, f, ty, g, h, i, tz] = m.map(f64::from);
    let cofactors = [e * i - f * h, f * g - d * i, d * h - e * g];
    let determinant = a * cofactors[0] + b * cofactors[1] + c * cofactors[2];
    let rows = [
        [cofactors[0], c * h - b * i, b * f - c * e],
        [cofactors[1], a * i - c * g, c * d - a * f],
        [cofactors[2], b * g - a * h, a * e - b * d],
    ]
    .map(|row| row.map(|x| x / determinant));
    let mut inverse = [0.0; 12];
    for (out, [x, y, z]) in inverse.as_chunks_mut::<4>().0.iter_mut().zip(rows) {
        *out = [x, y, z, -(x * tx + y * ty + z * tz)].map(|x| x as f32);
    }
    inverse.iter().all(|x: &f32| x.is_finite()).then_some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_affine_matrix_times_its_inverse_is_the_identity() {
        let m = [2.0, 1.0, 0.5, 3.0, -1.0, 4.0, 0.0, -2.0, 0.25, 0.0, 5.0, 7.0];
        let n = invert(m).unwrap();
        for row in 0..3 {
            for column in 0..4 {
                let product: f32 = (0..3).map(|k| m[row * 4 + k] * n[k * 4 + column]).sum();
                let value = product + if column == 3 { m[row * 4 + 3] } else { 0.0 };
                let expected = if row == column { 1.0 } else { 0.0 };
                assert!((value - expected).abs() < 1e-5, "row {row} column {column}: {value}");
            }
        }
    }

    #[test]
    fn a_flat_or_broken_matrix_has_no_inverse() {
        assert_eq!(invert([0.0; 12]), None);
        assert_eq!(invert([f32::NAN; 12]), None);
        assert_eq!(invert([1.0, 2.0, 3.0, 0.0, 2.0, 4.0, 6.0, 0.0, 0.0, 0.0, 1.0, 0.0]), None);
    }
}
