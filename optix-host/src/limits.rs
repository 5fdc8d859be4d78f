//! Limits of OptiX that the host checks, on either machine. Those of a GPU are asked from its driver
//! ([`Limits`](crate::optix::driver::Limits)); those that concern programs are the device crate's.

pub use optix_device_rs::limits::*;

/// The most structures on a way from the root of a graph to a primitive, the GAS included (guide 12).
pub const MAX_GRAPH_DEPTH: usize = 31;
/// The most primitives of a GAS, over all build inputs (guide 12).
pub const MAX_PRIMITIVES: usize = 1 << 29;
/// The most hit-group records that one GAS refers to (guide 12).
pub const MAX_RECORDS_OF_GAS: usize = 1 << 24;
/// The most instances of an IAS (guide 12).
pub const MAX_INSTANCES: usize = 1 << 28;
/// The bits of an instance's id, and of a record offset and the sum of those on a way down a graph (guide 5.4, 12).
pub const INSTANCE_BITS: u32 = 28;
/// The greatest id of an instance, and the greatest record offset: see [`INSTANCE_BITS`].
pub const MAX_INSTANCE_NUMBER: u32 = (1 << INSTANCE_BITS) - 1;
/// The greatest width of a texture of one row, mip-mapped or not (CUDA programming guide, technical specifications; the least of
/// compute capabilities from 5.0 on, as for the others).
pub const MAX_TEXTURE_1D: u32 = 1 << 14;
/// The greatest width and height of a texture, mip-mapped or layered.
pub const MAX_TEXTURE_2D: u32 = 1 << 14;
/// The greatest width, height and depth of a texture that is a box.
pub const MAX_TEXTURE_3D: u32 = 1 << 12;
/// The greatest width of the sides of a cube.
pub const MAX_CUBE_WIDTH: u32 = 1 << 14;
/// The most layers of a texture.
pub const MAX_TEXTURE_LAYERS: u32 = 2048;
/// The most launch indices of a launch (guide 12).
pub const MAX_LAUNCH_SIZE: u64 = 1 << 30;
/// The launch indices of a launch with these dimensions; none if that is no index at all, or more than [`MAX_LAUNCH_SIZE`].
pub fn launch_size(dimensions: [u32; 3]) -> Option<u64> {
    // Two factors fit 64 bits, the third is checked for.
    let size = dimensions.iter().try_fold(1u64, |size, &dimension| size.checked_mul(dimension.into()))?;
    (1..=MAX_LAUNCH_SIZE).contains(&size).then_some(size)
}

/// Bytes of a record's header, `OPTIX_SBT_RECORD_HEADER_SIZE` (guide 7.2).
pub const RECORD_HEADER_SIZE: usize = 32;
/// What addresses and strides of records are multiples of, `OPTIX_SBT_RECORD_ALIGNMENT` (guide 7.2).
pub const RECORD_ALIGNMENT: usize = 16;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_launch_has_1_to_2_pow_30_indices() {
        for dims in [[1, 1, 1], [1 << 30, 1, 1], [1 << 15, 1 << 15, 1], [1, 1 << 20, 1 << 10]] {
            assert!(launch_size(dims).is_some(), "{dims:?}");
        }
        for dims in
            [[0, 1, 1], [1, 1, 0], [(1 << 30) + 1, 1, 1], [1 << 15, 1 << 15, 2], [u32::MAX; 3], [1 << 31, 1 << 31, 4]]
        {
            assert!(launch_size(dims).is_none(), "{dims:?}");
        }
    }
}
