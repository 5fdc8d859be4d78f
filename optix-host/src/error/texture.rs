//! What can be wrong with textures.

use super::words::{Words, errors};

/// What is wrong with a texture. Sizes are width, height, and depth, layers or faces.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum TextureError {
    /// No texel.
    Empty {
        /// The size.
        size: [u32; 3],
    },
    /// Larger than GPUs have them.
    TooLarge {
        /// The size.
        size: [u32; 3],
        /// The largest.
        limit: [u32; 3],
    },
    /// More or fewer texels than the size says.
    Texels {
        /// Which level.
        level: usize,
        /// Its size.
        size: [u32; 3],
        /// How many texels were given.
        given: usize,
        /// How many it has.
        needed: usize,
    },
    /// More levels than there are down to one texel.
    TooManyLevels {
        /// How many were given.
        levels: usize,
        /// How many there are.
        most: u32,
    },
    /// An encoding that the format does not have.
    SrgbFormat,
    /// Coordinates in texels with an address mode that repeats the texture.
    RepeatedTexels,
    /// Coordinates in texels where there are several levels or faces.
    UnnormalizedLevels,
    /// A border colour that is not finite.
    Border {
        /// The colour.
        border: [f32; 4],
    },
}

impl TextureError {
    fn words(&self) -> Words {
        let by = |[width, height, depth]: [u32; 3]| format!("{width} x {height} x {depth}");
        let (problem, remedy): (String, &str) = match *self {
            Self::Empty { size } => (format!("the texture is {} texels", by(size)), "give it at least one"),
            Self::TooLarge { size, limit } => (
                format!("the texture is {} texels, and textures of its shape are {} at most", by(size), by(limit)),
                "divide it, or make it smaller",
            ),
            Self::Texels { level, size, given, needed } => (
                format!("level {level} of the texture is {}, {needed} texels, and was given {given}", by(size)),
                "give each level its texels, row by row; each level halves the one before, rounded down to at least 1",
            ),
            Self::TooManyLevels { levels, most } => (
                format!("the texture has {levels} levels, and down to one texel there are {most}"),
                "leave out the last ones",
            ),
            Self::SrgbFormat => (
                "sRGB is an encoding of textures with four channels of 8 bits, which this one is not".into(),
                "give texels as `[u8; 4]`, or decode them",
            ),
            Self::RepeatedTexels => (
                "coordinates that count texels can't be repeated, and the address mode is `Wrap` or `Mirror`".into(),
                "choose `AddressMode::Clamp` or `Border`, or keep coordinates normalized",
            ),
            Self::UnnormalizedLevels => (
                "coordinates that count texels are for textures with one level that are no cube".into(),
                "keep coordinates normalized",
            ),
            Self::Border { border } => {
                (format!("the border colour is not finite: {border:?}"), "give all of its channels finite values")
            }
        };
        (problem, remedy.into())
    }
}

errors!(TextureError);
