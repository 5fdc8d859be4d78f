//! Textures as both machines take them: what an image is made of, how lookups treat it, and the only checks of that.

mod format;

pub use format::{Format, TexelFormat};

use crate::error::TextureError;
use crate::limits::{MAX_CUBE_WIDTH, MAX_TEXTURE_1D, MAX_TEXTURE_2D, MAX_TEXTURE_3D, MAX_TEXTURE_LAYERS};
pub use optix_device_rs::texture::TextureShape;

/// What a coordinate outside of the texture means (`CUaddress_mode`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum AddressMode {
    /// The texture is repeated. For normalized coordinates.
    #[default]
    Wrap,
    /// The texture is repeated, every other time in reverse. For normalized coordinates.
    Mirror,
    /// The texel at the edge.
    Clamp,
    /// The border colour.
    Border,
}

/// What lies between texels or levels (`CUfilter_mode`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FilterMode {
    /// What is nearest.
    Point,
    /// What is nearest on each side, mixed.
    #[default]
    Linear,
}

/// How lookups treat a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// For each dimension.
    pub address: [AddressMode; 3],
    /// Between texels.
    pub filter: FilterMode,
    /// Between levels.
    pub mip_filter: FilterMode,
    /// Coordinates go from 0 to 1; otherwise they count texels.
    pub normalized: bool,
    /// For [`AddressMode::Border`]. Textures of 8 and 16 bits have what they can hold of it.
    pub border: [f32; 4],
    /// The first three channels are encoded by sRGB.
    pub srgb: bool,
}

impl Default for Sampling {
    fn default() -> Self {
        Self {
            address: [AddressMode::default(); 3],
            filter: FilterMode::default(),
            mip_filter: FilterMode::default(),
            normalized: true,
            border: [0.0; 4],
            srgb: false,
        }
    }
}

/// A checked texture: its levels have the sizes that follow from the first one's, and its sampling is one that machines have.
pub struct TextureInput<'a> {
    shape: TextureShape,
    size: [u32; 3],
    format: Format,
    levels: Vec<&'a [u8]>,
    sampling: Sampling,
}

impl<'a> TextureInput<'a> {
    /// Checks a texture of this size: width, height and depth, where height and depth are 1 in shapes without them, and depth
    /// is the number of layers or of faces of shapes with these.
    pub fn new<F: TexelFormat>(
        shape: TextureShape,
        size: [u32; 3],
        levels: &[&'a [F]],
        sampling: Sampling,
    ) -> Result<Self, TextureError> {
        let limit = match shape {
            TextureShape::D1 => [MAX_TEXTURE_1D, 1, 1],
            TextureShape::D2 => [MAX_TEXTURE_2D, MAX_TEXTURE_2D, 1],
            TextureShape::D3 => [MAX_TEXTURE_3D; 3],
            TextureShape::D2Array => [MAX_TEXTURE_2D, MAX_TEXTURE_2D, MAX_TEXTURE_LAYERS],
            TextureShape::Cube => [MAX_CUBE_WIDTH, MAX_CUBE_WIDTH, 6],
        };
        if size.contains(&0) {
            return Err(TextureError::Empty { size });
        }
        if (0..3).any(|axis| size[axis] > limit[axis]) {
            return Err(TextureError::TooLarge { size, limit });
        }
        let most = level_count(shape, size);
        if levels.len() > most as usize {
            return Err(TextureError::TooManyLevels { levels: levels.len(), most });
        }
        for (level, texels) in levels.iter().enumerate() {
            let size = level_size(shape, size, level as u32);
            let needed = size.iter().map(|&n| n as usize).product();
            if texels.len() != needed {
                return Err(TextureError::Texels { level, size, given: texels.len(), needed });
            }
        }
        // The sides of a cube have no outside.
        let clamp = [AddressMode::Clamp; 3];
        let sampling = if shape == TextureShape::Cube { Sampling { address: clamp, ..sampling } } else { sampling };
        if sampling.srgb && F::FORMAT != Format::Unorm8(4) {
            return Err(TextureError::SrgbFormat);
        }
        let repeats = |mode: &AddressMode| matches!(mode, AddressMode::Wrap | AddressMode::Mirror);
        if !sampling.normalized && sampling.address.iter().any(repeats) {
            return Err(TextureError::RepeatedTexels);
        }
        if !sampling.normalized && (levels.len() > 1 || shape == TextureShape::Cube) {
            return Err(TextureError::UnnormalizedLevels);
        }
        if !sampling.border.iter().all(|channel| channel.is_finite()) {
            return Err(TextureError::Border { border: sampling.border });
        }
        let levels = levels.iter().map(|texels| bytemuck::cast_slice(texels)).collect();
        Ok(Self { shape, size, format: F::FORMAT, levels, sampling })
    }

    /// The shape.
    pub fn shape(&self) -> TextureShape {
        self.shape
    }

    /// The format of a texel.
    pub fn format(&self) -> Format {
        self.format
    }

    /// How lookups treat it.
    pub fn sampling(&self) -> &Sampling {
        &self.sampling
    }

    /// Size and bytes of each level, the largest first.
    pub fn levels(&self) -> impl ExactSizeIterator<Item = ([u32; 3], &'a [u8])> {
        self.levels.iter().enumerate().map(|(level, &bytes)| (level_size(self.shape, self.size, level as u32), bytes))
    }
}

/// The size of a level: each level halves the one before, but not its layers or faces.
pub fn level_size(shape: TextureShape, [width, height, depth]: [u32; 3], level: u32) -> [u32; 3] {
    let half = |n: u32| (n >> level).max(1);
    let layers = matches!(shape, TextureShape::D2Array | TextureShape::Cube);
    [half(width), half(height), if layers { depth } else { half(depth) }]
}

/// How many levels there are down to one texel.
pub fn level_count(shape: TextureShape, [width, height, depth]: [u32; 3]) -> u32 {
    let largest = match shape {
        TextureShape::D2Array | TextureShape::Cube => width.max(height),
        _ => width.max(height).max(depth),
    };
    largest.ilog2() + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(size: [u32; 3], levels: &[&[[u8; 4]]], sampling: Sampling) -> Result<(), TextureError> {
        TextureInput::new(TextureShape::D2, size, levels, sampling).map(|_| ())
    }

    #[test]
    fn levels_halve() {
        assert_eq!(level_count(TextureShape::D2, [7, 5, 1]), 3);
        let sizes = [0, 1, 2].map(|level| level_size(TextureShape::D2, [7, 5, 1], level));
        assert_eq!(sizes, [[7, 5, 1], [3, 2, 1], [1, 1, 1]]);
        assert_eq!(level_size(TextureShape::D2Array, [4, 4, 9], 1), [2, 2, 9]);
        assert_eq!(level_size(TextureShape::D3, [4, 4, 9], 1), [2, 2, 4]);
        assert_eq!(level_count(TextureShape::Cube, [1, 1, 6]), 1);
    }

    #[test]
    fn wrong_input_is_named() {
        let texels = [[0; 4]; 35];
        let sampling = Sampling::default();
        assert_eq!(input([7, 5, 1], &[&texels], sampling), Ok(()));
        assert_eq!(input([7, 5, 1], &[&texels, &texels[..6], &texels[..1]], sampling), Ok(()));
        assert_eq!(input([7, 0, 1], &[&[]], sampling), Err(TextureError::Empty { size: [7, 0, 1] }));
        let short = TextureError::Texels { level: 1, size: [3, 2, 1], given: 5, needed: 6 };
        assert_eq!(input([7, 5, 1], &[&texels, &texels[..5]], sampling), Err(short));
        let levels = [&texels[..], &texels[..6], &texels[..1], &texels[..1]];
        assert_eq!(input([7, 5, 1], &levels, sampling), Err(TextureError::TooManyLevels { levels: 4, most: 3 }));
        let unnormalized = Sampling { normalized: false, ..sampling };
        assert_eq!(input([7, 5, 1], &[&texels], unnormalized), Err(TextureError::RepeatedTexels));
        let clamped = Sampling { address: [AddressMode::Clamp; 3], ..unnormalized };
        assert_eq!(input([7, 5, 1], &[&texels], clamped), Ok(()));
        assert_eq!(input([7, 5, 1], &[&texels, &texels[..6]], clamped), Err(TextureError::UnnormalizedLevels));
        let border = [0.0, f32::NAN, 0.0, 0.0];
        assert!(matches!(
            input([7, 5, 1], &[&texels], Sampling { border, ..sampling }),
            Err(TextureError::Border { .. })
        ));
        let srgb = Sampling { srgb: true, ..sampling };
        assert_eq!(input([7, 5, 1], &[&texels], srgb), Ok(()));
        let row = TextureInput::new(TextureShape::D1, [2, 1, 1], &[&[0.0, 1.0f32]], srgb);
        assert_eq!(row.map(|_| ()), Err(TextureError::SrgbFormat));
        let wide = TextureInput::new(TextureShape::D3, [1 << 15, 1, 1], &[&[0u8; 1 << 15]], sampling);
        assert!(matches!(wide.map(|_| ()), Err(TextureError::TooLarge { .. })));
    }
}
