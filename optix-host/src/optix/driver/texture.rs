//! Textures: CUDA arrays, and the texture objects that programs look them up by.

use cudarc::driver::sys as cu;
use std::ptr;

use super::context::Context;
use crate::error::DriverError as Error;
use crate::texture::{AddressMode, FilterMode, Format, Sampling, TextureInput, TextureShape};

/// A texture on the GPU, freed when it is dropped, after all work that was asked for before.
#[derive(Debug)]
pub struct Texture {
    context: Context,
    array: Array,
    /// 0 until it is made.
    object: cu::CUtexObject,
}

/// Where texels are.
#[derive(Clone, Copy, Debug)]
enum Array {
    One(cu::CUarray),
    Levels(cu::CUmipmappedArray),
}

// SAFETY: the handles are the driver's, which any thread may use.
unsafe impl Send for Texture {}
// SAFETY: as above; shared use reads only.
unsafe impl Sync for Texture {}

impl Texture {
    /// Copies the texels.
    ///
    /// # Errors
    /// [`Error::Cuda`] when memory is short, or where the GPU has no such texture.
    pub fn new(context: &Context, input: &TextureInput<'_>) -> Result<Self, Error> {
        let _current = context.enter()?;
        let levels = input.levels();
        let count = levels.len() as u32;
        let Some((size, _)) = input.levels().next() else {
            return Err(Error::invalid("a texture", "no level", "give it at least one"));
        };
        let descriptor = descriptor(input.shape(), size, input.format());
        let array = if count == 1 {
            let mut array = ptr::null_mut();
            // SAFETY: a context is current, and both are valid for the call.
            let result = unsafe { cu::cuArray3DCreate_v2(&mut array, &descriptor) }.result();
            context.cuda("cuArray3DCreate", result)?;
            Array::One(array)
        } else {
            let mut array = ptr::null_mut();
            // SAFETY: as above.
            let result = unsafe { cu::cuMipmappedArrayCreate(&mut array, &descriptor, count) }.result();
            context.cuda("cuMipmappedArrayCreate", result)?;
            Array::Levels(array)
        };
        // From here on dropping it frees the array.
        let mut texture = Self { context: context.clone(), array, object: 0 };
        for (level, (size, texels)) in (0..).zip(levels) {
            texture.upload(level, size, input.format(), texels)?;
        }
        texture.object = texture.make_object(input.sampling(), count)?;
        Ok(texture)
    }

    /// What programs look it up by.
    pub fn object(&self) -> u64 {
        self.object
    }

    fn upload(&self, level: u32, size: [u32; 3], format: Format, texels: &[u8]) -> Result<(), Error> {
        let array = match self.array {
            Array::One(array) => array,
            Array::Levels(levels) => {
                let mut array = ptr::null_mut();
                // SAFETY: the array lives and has that level; a context is current.
                let result = unsafe { cu::cuMipmappedArrayGetLevel(&mut array, levels, level) }.result();
                self.context.cuda("cuMipmappedArrayGetLevel", result)?;
                array
            }
        };
        let [width, height, depth] = size.map(|n| n as usize);
        let row = width * format.bytes();
        let copy = cu::CUDA_MEMCPY3D {
            srcXInBytes: 0,
            srcY: 0,
            srcZ: 0,
            srcLOD: 0,
            srcMemoryType: cu::CUmemorytype::CU_MEMORYTYPE_HOST,
            srcHost: texels.as_ptr().cast(),
            srcDevice: 0,
            srcArray: ptr::null_mut(),
            reserved0: ptr::null_mut(),
            srcPitch: row,
            srcHeight: height,
            dstXInBytes: 0,
            dstY: 0,
            dstZ: 0,
            dstLOD: 0,
            dstMemoryType: cu::CUmemorytype::CU_MEMORYTYPE_ARRAY,
            dstHost: ptr::null_mut(),
            dstDevice: 0,
            dstArray: array,
            reserved1: ptr::null_mut(),
            dstPitch: 0,
            dstHeight: 0,
            WidthInBytes: row,
            Height: height,
            Depth: depth,
        };
        // SAFETY: `texels` has so many rows of so many bytes (`TextureInput::new`), and so has the level; the call returns when the
        // texels are copied. Nobody has the texture yet.
        let result = unsafe { cu::cuMemcpy3D_v2(&copy) }.result();
        self.context.cuda("cuMemcpy3D", result)
    }

    fn make_object(&self, sampling: &Sampling, levels: u32) -> Result<cu::CUtexObject, Error> {
        // SAFETY: integers, null pointers and unions of these, for which 0 is a value.
        let mut resource: cu::CUDA_RESOURCE_DESC = unsafe { std::mem::zeroed() };
        match self.array {
            Array::One(array) => {
                resource.resType = cu::CUresourcetype::CU_RESOURCE_TYPE_ARRAY;
                resource.res.array.hArray = array;
            }
            Array::Levels(array) => {
                resource.resType = cu::CUresourcetype::CU_RESOURCE_TYPE_MIPMAPPED_ARRAY;
                resource.res.mipmap.hMipmappedArray = array;
            }
        }
        let sampling = sampling_descriptor(sampling, levels);
        let mut object = 0;
        // SAFETY: the array lives, the descriptors are valid for the call, and a context is current.
        let result = unsafe { cu::cuTexObjectCreate(&mut object, &resource, &sampling, ptr::null()) }.result();
        self.context.cuda("cuTexObjectCreate", result)?;
        Ok(object)
    }
}

impl Drop for Texture {
    fn drop(&mut self) {
        if let Ok(_current) = self.context.enter() {
            // Launches hold the texture and wait when dropped, but one that failed half-way may have left work behind.
            let _ = self.context.synchronize();
            // SAFETY: both were made here and are destroyed here only, and no launch runs.
            unsafe {
                if self.object != 0 {
                    let _ = cu::cuTexObjectDestroy(self.object);
                }
                let _ = match self.array {
                    Array::One(array) => cu::cuArrayDestroy(array),
                    Array::Levels(array) => cu::cuMipmappedArrayDestroy(array),
                };
            }
        }
    }
}

/// `CUDA_ARRAY3D_LAYERED`.
const LAYERED: u32 = 1;
/// `CUDA_ARRAY3D_CUBEMAP`.
const CUBEMAP: u32 = 4;
/// `CU_TRSF_NORMALIZED_COORDINATES`.
const NORMALIZED_COORDINATES: u32 = 2;
/// `CU_TRSF_SRGB`.
const SRGB: u32 = 16;

fn descriptor(shape: TextureShape, [width, height, depth]: [u32; 3], format: Format) -> cu::CUDA_ARRAY3D_DESCRIPTOR {
    use cu::CUarray_format as F;
    // 0 where the shape has no such dimension.
    let (height, depth, flags) = match shape {
        TextureShape::D1 => (0, 0, 0),
        TextureShape::D2 => (height, 0, 0),
        TextureShape::D3 => (height, depth, 0),
        TextureShape::D2Array => (height, depth, LAYERED),
        TextureShape::Cube => (height, 6, CUBEMAP),
    };
    cu::CUDA_ARRAY3D_DESCRIPTOR {
        Width: width as usize,
        Height: height as usize,
        Depth: depth as usize,
        Format: match format {
            Format::Float32(_) => F::CU_AD_FORMAT_FLOAT,
            Format::Unorm8(_) => F::CU_AD_FORMAT_UNSIGNED_INT8,
            Format::Snorm8(_) => F::CU_AD_FORMAT_SIGNED_INT8,
            Format::Unorm16(_) => F::CU_AD_FORMAT_UNSIGNED_INT16,
            Format::Snorm16(_) => F::CU_AD_FORMAT_SIGNED_INT16,
        },
        NumChannels: format.channels() as u32,
        Flags: flags,
    }
}

fn sampling_descriptor(sampling: &Sampling, levels: u32) -> cu::CUDA_TEXTURE_DESC {
    use cu::CUaddress_mode as A;
    let filter = |filter| match filter {
        FilterMode::Point => cu::CUfilter_mode::CU_TR_FILTER_MODE_POINT,
        FilterMode::Linear => cu::CUfilter_mode::CU_TR_FILTER_MODE_LINEAR,
    };
    let flag = |on, flag| if on { flag } else { 0 };
    cu::CUDA_TEXTURE_DESC {
        addressMode: sampling.address.map(|mode| match mode {
            AddressMode::Wrap => A::CU_TR_ADDRESS_MODE_WRAP,
            AddressMode::Mirror => A::CU_TR_ADDRESS_MODE_MIRROR,
            AddressMode::Clamp => A::CU_TR_ADDRESS_MODE_CLAMP,
            AddressMode::Border => A::CU_TR_ADDRESS_MODE_BORDER,
        }),
        filterMode: filter(sampling.filter),
        flags: flag(sampling.normalized, NORMALIZED_COORDINATES) | flag(sampling.srgb, SRGB),
        maxAnisotropy: 1,
        mipmapFilterMode: filter(sampling.mip_filter),
        mipmapLevelBias: 0.0,
        minMipmapLevelClamp: 0.0,
        maxMipmapLevelClamp: (levels - 1) as f32,
        borderColor: sampling.border,
        reserved: [0; 12],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_become_dimensions_and_flags() {
        let of = |shape, size| {
            let made = descriptor(shape, size, Format::Unorm8(4));
            [made.Width, made.Height, made.Depth, made.Flags as usize]
        };
        assert_eq!(of(TextureShape::D1, [7, 1, 1]), [7, 0, 0, 0]);
        assert_eq!(of(TextureShape::D2, [7, 5, 1]), [7, 5, 0, 0]);
        assert_eq!(of(TextureShape::D3, [7, 5, 1]), [7, 5, 1, 0]);
        assert_eq!(of(TextureShape::D2Array, [7, 5, 3]), [7, 5, 3, 1]);
        assert_eq!(of(TextureShape::Cube, [8, 8, 6]), [8, 8, 6, 4]);
    }

    #[test]
    fn sampling_becomes_modes_and_flags() {
        let address = [AddressMode::Wrap, AddressMode::Border, AddressMode::Clamp];
        let made = sampling_descriptor(&Sampling { address, srgb: true, ..Sampling::default() }, 4);
        assert_eq!(made.addressMode.map(|mode| mode as u32), [0, 3, 1]);
        assert_eq!((made.flags, made.maxMipmapLevelClamp, made.filterMode as u32), (18, 3.0, 1));
    }
}
