//! Texels: as they are stored, filtered, and as programs see them.

use crate::texture::Format;
use std::sync::LazyLock;

/// The texels of a level.
pub enum Texels {
    Float32(usize, Box<[f32]>),
    Unorm8(usize, Box<[u8]>),
    /// Channels red, green and blue are decoded when they are read.
    Srgb8(Box<[u8]>),
    Snorm8(usize, Box<[i8]>),
    Unorm16(usize, Box<[u16]>),
    Snorm16(usize, Box<[i16]>),
}

impl Texels {
    /// `bytes` are whole texels.
    pub fn new(format: Format, srgb: bool, bytes: &[u8]) -> Self {
        fn numbers<T: bytemuck::Pod>(bytes: &[u8]) -> Box<[T]> {
            bytemuck::pod_collect_to_vec(bytes).into()
        }
        match format {
            Format::Float32(n) => Self::Float32(n, numbers(bytes)),
            Format::Unorm8(_) if srgb => Self::Srgb8(bytes.into()),
            Format::Unorm8(n) => Self::Unorm8(n, bytes.into()),
            Format::Snorm8(n) => Self::Snorm8(n, numbers(bytes)),
            Format::Unorm16(n) => Self::Unorm16(n, numbers(bytes)),
            Format::Snorm16(n) => Self::Snorm16(n, numbers(bytes)),
        }
    }

    /// A texel, as it is stored: channels that it does not have are 0.
    #[inline]
    pub fn get(&self, index: usize) -> [f32; 4] {
        fn channels<T: Copy>(n: usize, numbers: &[T], index: usize, of: impl Fn(T) -> f32) -> [f32; 4] {
            let mut texel = [0.0; 4];
            for (channel, number) in texel.iter_mut().zip(&numbers[n * index..n * index + n]) {
                *channel = of(*number);
            }
            texel
        }
        match self {
            Self::Float32(n, numbers) => channels(*n, numbers, index, |v| v),
            Self::Unorm8(n, numbers) => channels(*n, numbers, index, f32::from),
            Self::Srgb8(numbers) => {
                let mut texel = channels(4, numbers, index, |v| DECODED[v as usize]);
                texel[3] = f32::from(numbers[4 * index + 3]) / 255.0;
                texel
            }
            // The least number is as far from 0 as the greatest.
            Self::Snorm8(n, numbers) => channels(*n, numbers, index, |v| f32::from(v.max(-i8::MAX))),
            Self::Unorm16(n, numbers) => channels(*n, numbers, index, f32::from),
            Self::Snorm16(n, numbers) => channels(*n, numbers, index, |v| f32::from(v.max(-i16::MAX))),
        }
    }
}

/// What a number of 8 bits is by sRGB (IEC 61966-2-1).
static DECODED: LazyLock<[f32; 256]> = LazyLock::new(|| {
    core::array::from_fn(|number| {
        let encoded = number as f64 / 255.0;
        let linear = if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) };
        linear as f32
    })
});

/// What the greatest stored number stands for 1 by, in formats that store whole numbers.
fn one(format: Format) -> Option<f64> {
    match format {
        Format::Float32(_) => None,
        Format::Unorm8(_) => Some(255.0),
        Format::Snorm8(_) => Some(127.0),
        Format::Unorm16(_) => Some(65535.0),
        Format::Snorm16(_) => Some(32767.0),
    }
}

/// How a channel of the border is stored.
pub fn stored(format: Format, channel: f32) -> f32 {
    let Some(one) = one(format) else { return channel };
    let least = if matches!(format, Format::Snorm8(_) | Format::Snorm16(_)) { -1.0 } else { 0.0 };
    ((f64::from(channel.clamp(least, 1.0)) * one + 0.5).floor()) as f32
}

/// What programs see of a stored channel.
#[inline]
pub fn value(format: Format, srgb: bool, stored: f64) -> f32 {
    match one(format) {
        Some(one) if !srgb => (stored / one) as f32,
        _ => stored as f32,
    }
}

/// What programs see of a mean of stored channels: whole numbers have 16 bits then.
#[inline]
pub fn filtered(format: Format, srgb: bool, mean: f64) -> f32 {
    let Some(one) = one(format).filter(|_| !srgb) else { return mean as f32 };
    let wide = if matches!(format, Format::Snorm8(_) | Format::Snorm16(_)) { 32767.0 } else { 65535.0 };
    ((mean * (wide / one) + 0.5).floor() / wide) as f32
}
