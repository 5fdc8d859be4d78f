//! Reads accessors (glTF 2.0, section 3.6.2), with every offset checked.

use gltf::Accessor;
use gltf::accessor::sparse::IndexType;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;

/// Most elements of an accessor that has none but sparse values.
const MAX_UNBACKED: usize = 1 << 24;

/// Three finite `f32` an element.
pub(super) fn vectors(accessor: &Accessor<'_>, buffers: &[Vec<u8>]) -> Result<Vec<[f32; 3]>, String> {
    if (accessor.data_type(), accessor.dimensions()) != (DataType::F32, Dimensions::Vec3) {
        let (what, shape) = (accessor.data_type(), accessor.dimensions());
        return Err(format!("accessor {} holds {what:?} {shape:?}, F32 Vec3 is needed", accessor.index()));
    }
    let bytes: Vec<[u8; 12]> = elements(accessor, buffers)?;
    let vectors: Vec<[f32; 3]> = bytes
        .iter()
        .map(|b| std::array::from_fn(|i| f32::from_le_bytes([b[4 * i], b[4 * i + 1], b[4 * i + 2], b[4 * i + 3]])))
        .collect();
    match vectors.iter().position(|v| !v.iter().all(|x| x.is_finite())) {
        Some(i) => Err(format!("element {i} of accessor {} is not finite: {:?}", accessor.index(), vectors[i])),
        None => Ok(vectors),
    }
}

/// Unsigned integers of 8, 16 or 32 bits.
pub(super) fn indices(accessor: &Accessor<'_>, buffers: &[Vec<u8>]) -> Result<Vec<u32>, String> {
    if accessor.dimensions() != Dimensions::Scalar {
        return Err(format!("accessor {} holds {:?}, Scalar is needed", accessor.index(), accessor.dimensions()));
    }
    match accessor.data_type() {
        DataType::U8 => Ok(elements(accessor, buffers)?.iter().map(|&[b]| u32::from(b)).collect()),
        DataType::U16 => Ok(elements(accessor, buffers)?.iter().map(|&b| u32::from(u16::from_le_bytes(b))).collect()),
        DataType::U32 => Ok(elements(accessor, buffers)?.iter().map(|&b| u32::from_le_bytes(b)).collect()),
        other => Err(format!("accessor {} holds {other:?}, an unsigned integer is needed", accessor.index())),
    }
}

/// The accessor's elements as raw bytes, sparse ones replaced. `N` is the size of an element.
fn elements<const N: usize>(accessor: &Accessor<'_>, buffers: &[Vec<u8>]) -> Result<Vec<[u8; N]>, String> {
    let (index, count) = (accessor.index(), accessor.count());
    let mut all = match accessor.view() {
        Some(view) => strided::<N>(&view, accessor.offset(), count, buffers)
            .ok_or_else(|| format!("accessor {index} reaches past the end of its buffer"))?,
        // Without a view the elements are zero. A count that no data backs must not become a huge allocation.
        None if accessor.sparse().is_none() => return Err(format!("accessor {index} has no data")),
        None if count > MAX_UNBACKED => {
            return Err(format!("accessor {index} has {count} elements but no data"));
        }
        None => vec![[0; N]; count],
    };
    let Some(sparse) = accessor.sparse() else {
        return Ok(all);
    };
    let past_end = || format!("sparse accessor {index} reaches past the end of its buffer");
    let (places, count) = (sparse.indices(), sparse.count());
    let places: Vec<u32> = {
        let (view, offset) = (places.view(), places.offset());
        match places.index_type() {
            IndexType::U8 => {
                strided::<1>(&view, offset, count, buffers).map(|b| b.iter().map(|&[b]| u32::from(b)).collect())
            }
            IndexType::U16 => strided::<2>(&view, offset, count, buffers)
                .map(|b| b.iter().map(|&b| u32::from(u16::from_le_bytes(b))).collect()),
            IndexType::U32 => {
                strided::<4>(&view, offset, count, buffers).map(|b| b.iter().map(|&b| u32::from_le_bytes(b)).collect())
            }
        }
        .ok_or_else(past_end)?
    };
    let values = sparse.values();
    let values = strided::<N>(&values.view(), values.offset(), count, buffers).ok_or_else(past_end)?;
    for (place, value) in places.into_iter().zip(values) {
        let slot = all.get_mut(place as usize);
        *slot.ok_or_else(|| format!("sparse accessor {index} replaces element {place}, which is not there"))? = value;
    }
    Ok(all)
}

/// `count` elements of `N` bytes, `stride` apart, from `offset` in the view. `None` if they are not all inside it.
fn strided<const N: usize>(view: &View<'_>, offset: usize, count: usize, buffers: &[Vec<u8>]) -> Option<Vec<[u8; N]>> {
    let buffer = buffers.get(view.buffer().index())?;
    let bytes = buffer.get(view.offset()..view.offset().checked_add(view.length())?)?.get(offset..)?;
    // Tightly packed where no stride is given; elements must not overlap.
    let stride = view.stride().unwrap_or(N);
    if count == 0 {
        return Some(Vec::new());
    }
    if stride < N || (count - 1).checked_mul(stride)?.checked_add(N)? > bytes.len() {
        return None;
    }
    bytes.chunks(stride).take(count).map(|chunk| chunk.first_chunk::<N>().copied()).collect()
}
