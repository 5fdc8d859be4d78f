//! Formats of texels.

use bytemuck::Pod;
use glam::{Vec2, Vec4};
use optix_device_rs::texture::Texel;

/// How a texel is stored, with the number of its channels: 1, 2 or 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Numbers.
    Float32(usize),
    /// 0 to 255 are 0 to 1.
    Unorm8(usize),
    /// -127 to 127 are -1 to 1; -128 is -1 as well.
    Snorm8(usize),
    /// 0 to 65535 are 0 to 1.
    Unorm16(usize),
    /// -32767 to 32767 are -1 to 1; -32768 is -1 as well.
    Snorm16(usize),
}

impl Format {
    /// 1, 2 or 4.
    pub fn channels(self) -> usize {
        let (Self::Float32(n) | Self::Unorm8(n) | Self::Snorm8(n) | Self::Unorm16(n) | Self::Snorm16(n)) = self;
        n
    }

    /// Bytes of a texel.
    pub fn bytes(self) -> usize {
        let channel = match self {
            Self::Float32(_) => 4,
            Self::Unorm8(_) | Self::Snorm8(_) => 1,
            Self::Unorm16(_) | Self::Snorm16(_) => 2,
        };
        channel * self.channels()
    }
}

/// A texel as the host stores it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a texel",
    label = "no format of textures",
    note = "texels are `f32`, `u8`, `i8`, `u16` or `i16`, arrays of 2 or 4 of these, `Vec2` or `Vec4`; three channels take a fourth"
)]
pub trait TexelFormat: Pod + sealed::Sealed {
    /// What programs see.
    type Texel: Texel;
    /// How it is stored.
    const FORMAT: Format;
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! formats {
    ($($ty:ty: $format:ident($channels:literal) as $texel:ty;)*) => {$(
        impl sealed::Sealed for $ty {}
        impl TexelFormat for $ty {
            type Texel = $texel;
            const FORMAT: Format = Format::$format($channels);
        }
    )*};
}
formats! {
    f32: Float32(1) as f32;
    [f32; 2]: Float32(2) as Vec2;
    [f32; 4]: Float32(4) as Vec4;
    Vec2: Float32(2) as Vec2;
    Vec4: Float32(4) as Vec4;
    u8: Unorm8(1) as f32;
    [u8; 2]: Unorm8(2) as Vec2;
    [u8; 4]: Unorm8(4) as Vec4;
    i8: Snorm8(1) as f32;
    [i8; 2]: Snorm8(2) as Vec2;
    [i8; 4]: Snorm8(4) as Vec4;
    u16: Unorm16(1) as f32;
    [u16; 2]: Unorm16(2) as Vec2;
    [u16; 4]: Unorm16(4) as Vec4;
    i16: Snorm16(1) as f32;
    [i16; 2]: Snorm16(2) as Vec2;
    [i16; 4]: Snorm16(4) as Vec4;
}
