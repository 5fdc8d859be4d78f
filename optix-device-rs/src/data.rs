//! Plain data with one layout on host and device.

use crate::layout::Layout;
use crate::ray::Traversable;
use crate::view::{Slice, SliceMut, SliceMut2d};
use glam::{
    Affine2, Affine3A, DAffine2, DAffine3, DMat2, DMat3, DMat4, DQuat, DVec2, DVec3, DVec4, I16Vec2, I16Vec3, I16Vec4,
    IVec2, IVec3, IVec4, Mat2, Mat3, Mat3A, Mat4, Quat, U16Vec2, U16Vec3, U16Vec4, UVec2, UVec3, UVec4, Vec2, Vec3,
    Vec3A, Vec4,
};

/// Plain data with one layout on host and device, which may cross by a copy of its bytes.
///
/// Implemented for numbers, `bool`, `char`, glam types, arrays, [`Slice`] and its kin, and by `#[derive(DeviceData)]` for `#[repr(C)]`
/// structs of these.
///
/// # Safety
/// The layout is the same for every compiler and target (`#[repr(C)]` or a primitive), and the bytes that the host
/// writes through [`DeviceData::write_to`] are a valid value on the device.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't cross from host to device",
    label = "has no layout that host and device share",
    note = "use numbers (`u32`, not `usize`, whose size is the machine's), glam vectors, arrays, `Slice` and its kin, or `#[derive(DeviceData)]` with `#[repr(C)]` on your struct"
)]
pub unsafe trait DeviceData: Copy + 'static {
    /// How its bytes are made up.
    #[doc(hidden)]
    const LAYOUT: Layout = Layout::of_size(size_of::<Self>(), align_of::<Self>());

    /// Writes the value's bytes to `bytes`, which is `size_of::<Self>()` long and zero: padding stays zero.
    fn write_to(&self, bytes: &mut [u8]);

    /// Bytes that a program loads at a time where the value is a launch parameter: 1, 2, 4 or 8. Eight only for 64-bit
    /// numbers, so that neither they are put together from halves nor vectors of `f32` taken apart.
    #[doc(hidden)]
    const UNIT: usize = if align_of::<Self>() < 4 { align_of::<Self>() } else { 4 };
}

macro_rules! primitive {
    ($($ty:ty),*) => {$(
        // SAFETY: a primitive without padding, the same on both machines (both little endian).
        unsafe impl DeviceData for $ty {
            #[inline]
            fn write_to(&self, bytes: &mut [u8]) {
                bytes.copy_from_slice(&self.to_le_bytes());
            }
            const LAYOUT: Layout = Layout::of(stringify!($ty));
            const UNIT: usize = size_of::<Self>();
        }
    )*};
}
primitive!(u8, i8, u16, i16, u32, i32, u64, i64, f32, f64);

// SAFETY: 0 and 1 are the valid values on both machines.
unsafe impl DeviceData for bool {
    #[inline]
    fn write_to(&self, bytes: &mut [u8]) {
        bytes[0] = *self as u8;
    }
    const LAYOUT: Layout = Layout::of("bool");
}

// SAFETY: a Unicode scalar value here is one there.
unsafe impl DeviceData for char {
    #[inline]
    fn write_to(&self, bytes: &mut [u8]) {
        u32::from(*self).write_to(bytes);
    }
    const LAYOUT: Layout = Layout::of("char");
}

// SAFETY: no bytes.
unsafe impl DeviceData for () {
    fn write_to(&self, _: &mut [u8]) {}
}

// SAFETY: an array has its elements' layout, one after the other.
unsafe impl<T: DeviceData, const N: usize> DeviceData for [T; N] {
    #[inline]
    fn write_to(&self, bytes: &mut [u8]) {
        for (value, bytes) in self.iter().zip(bytes.chunks_exact_mut(size_of::<T>().max(1))) {
            value.write_to(bytes);
        }
    }
    const LAYOUT: Layout = Layout::of("array").number(N).with(T::LAYOUT);
    const UNIT: usize = T::UNIT;
}

macro_rules! glam_type {
    ($($ty:ty: $size:literal, $align:literal, $to:ident $(, $unit:literal)?;)*) => {$(
        // glam chooses alignment by target and feature; host and device are held to one choice here.
        const _: () = assert!(size_of::<$ty>() == $size && align_of::<$ty>() == $align);
        // SAFETY: size and alignment are asserted for each target; the components come first and in order.
        unsafe impl DeviceData for $ty {
            #[inline]
            fn write_to(&self, bytes: &mut [u8]) {
                let components = self.$to();
                components.write_to(&mut bytes[..size_of_val(&components)]);
            }
            const LAYOUT: Layout = Layout::of(stringify!($ty));
            $(const UNIT: usize = $unit;)?
        }
    )*};
}

glam_type! {
    Vec2: 8, 8, to_array;
    Vec3: 12, 4, to_array;
    Vec3A: 16, 16, to_array;
    Vec4: 16, 16, to_array;
    UVec2: 8, 8, to_array;
    UVec3: 12, 4, to_array;
    UVec4: 16, 16, to_array;
    IVec2: 8, 8, to_array;
    IVec3: 12, 4, to_array;
    IVec4: 16, 16, to_array;
    DVec2: 16, 16, to_array, 8;
    DVec3: 24, 8, to_array, 8;
    DVec4: 32, 16, to_array, 8;
    U16Vec2: 4, 4, to_array;
    U16Vec3: 6, 2, to_array;
    U16Vec4: 8, 8, to_array;
    I16Vec2: 4, 4, to_array;
    I16Vec3: 6, 2, to_array;
    I16Vec4: 8, 8, to_array;
    Quat: 16, 16, to_array;
    DQuat: 32, 8, to_array, 8;
    Mat2: 16, 16, to_cols_array;
    Mat3: 36, 4, to_cols_array;
    Mat4: 64, 16, to_cols_array;
    DMat2: 32, 16, to_cols_array, 8;
    DMat3: 72, 8, to_cols_array, 8;
    DMat4: 128, 16, to_cols_array, 8;
    DAffine2: 48, 16, to_cols_array, 8;
    DAffine3: 96, 8, to_cols_array, 8;
}

macro_rules! glam_columns {
    ($($ty:ty: $size:literal, $align:literal, |$value:ident| $columns:expr;)*) => {$(
        const _: () = assert!(size_of::<$ty>() == $size && align_of::<$ty>() == $align);
        // SAFETY: size and alignment are asserted for each target; the columns follow each other, each with its padding.
        unsafe impl DeviceData for $ty {
            #[inline]
            fn write_to(&self, bytes: &mut [u8]) {
                let $value = self;
                let columns = $columns;
                columns.write_to(&mut bytes[..size_of_val(&columns)]);
            }
            const LAYOUT: Layout = Layout::of(stringify!($ty));
        }
    )*};
}

glam_columns! {
    Mat3A: 48, 16, |m| [m.x_axis, m.y_axis, m.z_axis];
    Affine2: 32, 16, |a| a.to_cols_array();
    Affine3A: 64, 16, |a| [a.matrix3.x_axis, a.matrix3.y_axis, a.matrix3.z_axis, a.translation];
}

macro_rules! view {
    ($($name:ident),*) => {$(
        // SAFETY: `#[repr(C)]` integers and a pointer, 64 bits on both machines.
        unsafe impl<T: Element> DeviceData for $name<T> {
            // With that of what it shows.
            const LAYOUT: Layout = Layout::of(stringify!($name)).with(T::LAYOUT);
            #[inline]
            fn write_to(&self, bytes: &mut [u8]) {
                self.to_raw().write_to(bytes);
            }
            const UNIT: usize = u64::UNIT;
        }
    )*};
}
use crate::view::Element;
view!(Slice, SliceMut, SliceMut2d);

// SAFETY: a transparent `u64`.
unsafe impl DeviceData for Traversable {
    #[inline]
    fn write_to(&self, bytes: &mut [u8]) {
        self.to_raw().write_to(bytes);
    }
    const LAYOUT: Layout = Layout::of("Traversable");
    const UNIT: usize = u64::UNIT;
}

/// Data in which no view of device memory is hidden: what a field of parameters or records may be without `#[view]`.
///
/// Made by the derives that make [`DeviceData`], for structs without views.
///
/// # Safety
/// As said: nothing would keep alive what a view in it shows.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be a plain field that crosses from host to device",
    label = "neither plain data nor known to be a view",
    note = "plain data are numbers (`u32`, not `usize`, whose size is the machine's), glam vectors, arrays of these, and your `#[repr(C)]` structs of these with `#[derive(Clone, Copy, DeviceData)]`; the elements of a `Vec`, `Box` or `String` are in the host's memory, so they go into a buffer, and the field is a `Slice` of it",
    note = "if the type holds a view (`Slice`, `Traversable`, `Instances`, `Callable` and their kin), perhaps under another name, put `#[view]` on the field"
)]
pub unsafe trait Plain: DeviceData {
    /// [`DeviceData::LAYOUT`].
    #[doc(hidden)]
    const PLAIN_LAYOUT: Layout = Self::LAYOUT;
    /// [`DeviceData::write_to`].
    #[doc(hidden)]
    #[inline(always)]
    fn write_plain(&self, bytes: &mut [u8]) {
        self.write_to(bytes);
    }
}

macro_rules! plain {
    ($($ty:ty),*) => {$(
        // SAFETY: numbers.
        unsafe impl Plain for $ty {}
    )*};
}
plain!(u8, i8, u16, i16, u32, i32, u64, i64, f32, f64, bool, char, ());
plain!(Vec2, Vec3, Vec3A, Vec4, DVec2, DVec3, DVec4, UVec2, UVec3, UVec4, IVec2, IVec3, IVec4);
plain!(U16Vec2, U16Vec3, U16Vec4, I16Vec2, I16Vec3, I16Vec4, Quat, DQuat, Mat2, Mat3, Mat3A, Mat4, DMat2, DMat3, DMat4);
plain!(Affine2, Affine3A, DAffine2, DAffine3);
// SAFETY: as its elements.
unsafe impl<T: Plain, const N: usize> Plain for [T; N] {}
