//! Textures: images that programs look up at any place, filtered (CUDA texture objects; guide 13 leaves them to CUDA).
//!
//! A texture is a field of launch parameters or records and travels in payloads, as other [views](crate::view) do. On the host its
//! place is taken by a [`Texture`](crate::host::Texture), which a device makes: `device.texture_2d(size, &texels).build()`.
//!
//! ```
//! use optix_device_rs::prelude::*;
//!
//! #[derive(Clone, Copy, SbtRecord)]
//! #[repr(C)]
//! pub struct Painted {
//!     pub colour: Texture2d<Vec4>,
//! }
//!
//! fn colour(record: &Painted, uv: Vec2) -> Vec3 {
//!     record.colour.sample(uv).truncate()
//! }
//! ```
//!
//! # Coordinates
//!
//! Coordinates are normalized, from 0 at one edge to 1 at the other, unless the host says otherwise; then they count texels. The
//! middle of the first texel is at 0.5 texels. Outside of that the host's address mode counts.
//!
//! # What a lookup gives
//!
//! The CPU follows what a GPU was measured to do (one NVIDIA H200; docs/measurements.md): normalized coordinates are taken down to a
//! multiple of 2^-21, places between texels to the nearest 256th, and weights of the four texels around to whole 256ths, so that
//! the unevenness of filtered steps is the same on both machines. Filtered texels of 8 and 16 bits are rounded to 16 bits. Coordinates
//! that are not finite count as 0.
//!
//! Programs have no neighbours to compare with, so [`sample`](Texture2d::sample) looks up level 0 of a mip-mapped texture:
//! `sample_level` takes a level, and `sample_gradient` chooses one by how far apart lookups are (ray differentials, say).

#[cfg(target_arch = "nvptx64")]
mod ptx;

use crate::data::DeviceData;
use crate::layout::Layout;
use crate::words::{FromRaw, words_of_raw};
use core::marker::PhantomData;
use glam::{Vec2, Vec3, Vec4};

/// What a lookup gives: as many channels as the texture has.
#[diagnostic::on_unimplemented(
    message = "a texture lookup can't give `{Self}`",
    label = "not a number of channels that textures have",
    note = "textures have 1, 2 or 4 channels: `f32`, `Vec2` or `Vec4`"
)]
pub trait Texel: Sealed + Copy + 'static {
    /// 1, 2 or 4.
    const CHANNELS: usize;
    /// From four channels, of which the last ones may mean nothing.
    #[doc(hidden)]
    fn of_channels(channels: [f32; 4]) -> Self;
}

impl Sealed for f32 {}
impl Texel for f32 {
    const CHANNELS: usize = 1;
    #[inline(always)]
    fn of_channels([x, ..]: [f32; 4]) -> Self {
        x
    }
}
impl Sealed for Vec2 {}
impl Texel for Vec2 {
    const CHANNELS: usize = 2;
    #[inline(always)]
    fn of_channels([x, y, ..]: [f32; 4]) -> Self {
        Vec2::new(x, y)
    }
}
impl Sealed for Vec4 {}
impl Texel for Vec4 {
    const CHANNELS: usize = 4;
    #[inline(always)]
    fn of_channels(channels: [f32; 4]) -> Self {
        Vec4::from_array(channels)
    }
}

/// Texels and views are these.
mod sealed {
    pub trait Sealed {}
}
use sealed::Sealed;

/// How a texture's texels are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureShape {
    /// A row.
    D1,
    /// A rectangle.
    D2,
    /// A box.
    D3,
    /// Rectangles, one for each layer; lookups are in one of them.
    D2Array,
    /// Six squares, the sides of a cube; lookups are by direction.
    Cube,
}

/// A kind of texture view.
pub trait TextureView: Sealed + DeviceData {
    /// How its texels are laid out.
    const SHAPE: TextureShape;
    /// What its lookups give.
    type Texel: Texel;
}

/// One lookup.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lookup {
    /// As many as the shape has dimensions; of a cube a direction.
    pub coordinates: [f32; 3],
    /// Of a layered texture.
    pub layer: u32,
    /// Of a mip-mapped texture.
    pub level: Level,
}

/// Which level of a mip-mapped texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// This one, from 0 for the largest; between two of them a fraction.
    Lod(f32),
    /// The one at which neighbouring lookups are a texel apart, given how coordinates change from lookup to lookup.
    Gradient([[f32; 3]; 2]),
}

#[cfg(not(target_arch = "nvptx64"))]
#[inline(always)]
fn lookup(texture: u64, _: TextureShape, lookup: Lookup) -> [f32; 4] {
    crate::host::sample(texture, &lookup)
}
#[cfg(target_arch = "nvptx64")]
use ptx::lookup;

macro_rules! texture {
    ($(#[$doc:meta])* $name:ident, $shape:ident, $coordinates:ty, $to:expr $(, $layer:ident)?) => {
        $(#[$doc])*
        #[repr(C)]
        pub struct $name<T> {
            texture: u64,
            texels: PhantomData<*const T>,
        }

        impl<T> Clone for $name<T> {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }
        impl<T> Copy for $name<T> {}

        impl<T> core::fmt::Debug for $name<T> {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(stringify!($name))
            }
        }

        /// # Safety
        /// It is the number of a texture of this shape with the channels of `T`, which launches that use the view keep.
        impl<T: Texel> FromRaw for $name<T> {
            type Raw = u64;
            #[inline(always)]
            unsafe fn from_raw(texture: u64) -> Self {
                Self { texture, texels: PhantomData }
            }
        }

        impl<T: Texel> Sealed for $name<T> {}
        impl<T: Texel> TextureView for $name<T> {
            const SHAPE: TextureShape = TextureShape::$shape;
            type Texel = T;
        }

        // SAFETY: a transparent `u64`.
        unsafe impl<T: Texel> DeviceData for $name<T> {
            const LAYOUT: Layout = Layout::of(stringify!($name)).number(T::CHANNELS);
            #[inline]
            fn write_to(&self, bytes: &mut [u8]) {
                self.to_raw().write_to(bytes);
            }
            const UNIT: usize = u64::UNIT;
        }

        words_of_raw! {
            [T: Texel] $name<T>: u64, |raw| Self::from_raw(raw);
        }

        impl<T: Texel> $name<T> {
            #[doc(hidden)]
            pub const fn to_raw(self) -> u64 {
                self.texture
            }

            #[inline(always)]
            #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
            fn at(self, at: $coordinates, layer: u32, level: Level) -> T {
                let to: fn($coordinates) -> [f32; 3] = $to;
                T::of_channels(lookup(self.texture, TextureShape::$shape, Lookup { coordinates: to(at), layer, level }))
            }

            /// What is there, in the largest level.
            #[inline(always)]
            #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
            pub fn sample(self, $($layer: u32,)? at: $coordinates) -> T {
                self.at(at, texture!(@layer $($layer)?), Level::Lod(0.0))
            }

            /// What is there in a level of a mip-mapped texture, from 0 for the largest; between two of them as the mip filter says.
            #[inline(always)]
            #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
            pub fn sample_level(self, $($layer: u32,)? at: $coordinates, level: f32) -> T {
                self.at(at, texture!(@layer $($layer)?), Level::Lod(level))
            }

            /// What is there in the level that fits how far `at` changes from lookup to lookup, in two directions: in normalized
            /// coordinates, or in texels where coordinates are.
            #[inline(always)]
            #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
            pub fn sample_gradient(self, $($layer: u32,)? at: $coordinates, dx: $coordinates, dy: $coordinates) -> T {
                let to: fn($coordinates) -> [f32; 3] = $to;
                self.at(at, texture!(@layer $($layer)?), Level::Gradient([to(dx), to(dy)]))
            }
        }
    };
    (@layer) => { 0 };
    (@layer $layer:ident) => { $layer };
}

texture! {
    /// A row of texels, or several for its levels.
    Texture1d, D1, f32, |x| [x, 0.0, 0.0]
}
texture! {
    /// A rectangle of texels: an image. `u` goes along rows, `v` from row to row.
    Texture2d, D2, Vec2, |at| [at.x, at.y, 0.0]
}
texture! {
    /// A box of texels.
    Texture3d, D3, Vec3, |at| at.to_array()
}
texture! {
    /// Images of one size, a layer each; a lookup filters within one. A layer beyond the last is the last.
    Texture2dArray, D2Array, Vec2, |at| [at.x, at.y, 0.0], layer
}
texture! {
    /// Six images around the origin, which are looked up by direction, of any length. The faces are those of +x, -x, +y, -y, +z
    /// and -z; lookups filter within one. Gradients are changes of the direction.
    TextureCube, Cube, Vec3, |at| at.to_array()
}
