//! Typed views of device memory: what a `Slice<T>` field of parameters or records is inside a program.
//!
//! An index out of range ends the launch (on the device by an access to an address that no memory can have, which costs no
//! branch; on the CPU with an error that names the launch index); no access is to memory outside the buffer. See
//! [below](#checks) for what that costs. Memory that programs write is shared by all launch indices: writes of one may be seen by
//! another at any time until the launch ends (guide 6.2). An element that is written while it is read may arrive in parts: each
//! aligned 32-bit word of it is of one write, or each part of the element's alignment if that is less.
//!
//! Views come from the host, in parameters and records, and travel in payloads and attributes, whose words are loaded only
//! where they were stored ([`Words::load`](crate::words::Words::load)). They are for the programs of a launch that keeps the memory:
//! they are neither [`Send`] nor [`Sync`], so that no static keeps them and no other thread gets them, and on the CPU, where a
//! program may keep one in a variable of its thread, a view that the running launch was not given ends the launch.
//!
//! ```compile_fail
//! use optix_device_rs::prelude::*;
//! static KEPT: std::sync::Mutex<Option<Slice<u32>>> = std::sync::Mutex::new(None);
//! ```
//!
//! # Checks
//!
//! A check is a comparison and a select, without a branch. To have fewer:
//!
//! - Let an element be what is read together. A `Slice<[u32; 3]>` of triangles has one check where a `Slice<u32>` has three,
//!   and one field of a struct costs what all of them do.
//! - Put a table whose size is known into a parameter or record as an array. An index that is a constant, or that the compiler
//!   can bound (`table[i & 7]` of eight), has no check.
//! - Where the index is in range for a reason that the compiler does not see, [`Slice::get_unchecked`] leaves the check to builds
//!   with debug assertions, so the profile decides.

use crate::data::DeviceData;
#[cfg(not(target_arch = "nvptx64"))]
use crate::host::shared;
use crate::layout::Layout;
use crate::words::{FromRaw, words_of_raw};
use core::marker::PhantomData;
use glam::UVec2;

/// Marks what is for the programs of a launch, and neither [`Send`] nor [`Sync`], so that no safe code of one launch leaves it to
/// another: on a device nothing else stands in the way.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct OfLaunch(PhantomData<*const ()>);

impl OfLaunch {
    pub const NEW: Self = Self(PhantomData);
}

/// What views hold: plain data without views inside, so that no program can forge a view by writing one.
///
/// # Safety
/// Any bytes are a valid value, and there is no padding.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be an element of a device buffer",
    label = "not plain data",
    note = "use numbers (`u32`, not `usize`, whose size is the machine's), glam vectors, arrays of these, or `#[derive(Element)]` with `#[repr(C)]` on your struct of these"
)]
pub unsafe trait Element: DeviceData {
    /// The size, where only an element will do; for the derive.
    #[doc(hidden)]
    const SIZE: usize = size_of::<Self>();
    /// [`DeviceData::LAYOUT`], where only an element will do.
    #[doc(hidden)]
    const ELEMENT_LAYOUT: Layout = Self::LAYOUT;
    /// [`DeviceData::write_to`], where only an element will do; for the derive.
    #[doc(hidden)]
    #[inline(always)]
    fn write_element(&self, bytes: &mut [u8]) {
        self.write_to(bytes);
    }
}

macro_rules! element {
    ($($ty:ty),*) => {$(
        // SAFETY: any bytes are valid and there is no padding.
        unsafe impl Element for $ty {}
    )*};
}
element!(u8, i8, u16, i16, u32, i32, u64, i64, f32, f64);
element!(glam::Vec2, glam::Vec3, glam::Vec4, glam::UVec2, glam::UVec3, glam::UVec4);
element!(glam::IVec2, glam::IVec3, glam::IVec4, glam::Quat, glam::Mat2, glam::Mat3, glam::Mat4);
element!(glam::DVec2, glam::DVec3, glam::DVec4, glam::DQuat, glam::DMat2, glam::DMat3, glam::DMat4, glam::DAffine3);
element!(glam::U16Vec2, glam::U16Vec3, glam::U16Vec4, glam::I16Vec2, glam::I16Vec3, glam::I16Vec4);
// SAFETY: as its elements.
unsafe impl<T: Element, const N: usize> Element for [T; N] {}

/// Copies an element out of memory that other launch indices may write.
///
/// # Safety
/// `at` is aligned for `T` and valid for reads of `T` while the call lasts.
#[inline(always)]
unsafe fn read<T: Element>(at: *const T) -> T {
    #[cfg(target_arch = "nvptx64")]
    // SAFETY: the caller's; device memory is not under Rust's host memory model (guide 6.2).
    return unsafe { at.read() };
    #[cfg(not(target_arch = "nvptx64"))]
    {
        let mut value = core::mem::MaybeUninit::<T>::uninit();
        // SAFETY: the caller's, and the value is nobody else's.
        unsafe { shared::read(at.cast(), value.as_mut_ptr().cast(), size_of::<T>(), shared::width::<T>()) };
        // SAFETY: every byte is written, and any bytes are a `T` (`Element`).
        unsafe { value.assume_init() }
    }
}

/// Copies an element into memory that other launch indices may read or write.
///
/// # Safety
/// `at` is aligned for `T` and valid for writes of `T` while the call lasts.
#[inline(always)]
unsafe fn write<T: Element>(at: *mut T, value: T) {
    #[cfg(target_arch = "nvptx64")]
    // SAFETY: the caller's.
    return unsafe { at.write(value) };
    #[cfg(not(target_arch = "nvptx64"))]
    // SAFETY: the caller's; the value has no padding (`Element`).
    unsafe {
        shared::write(at.cast(), (&raw const value).cast(), size_of::<T>(), shared::width::<T>())
    };
}

/// Where element `index` of `len` elements of type `T` is, in the memory that a view holds as `address`.
#[inline(always)]
#[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
fn element<T>(what: &str, address: u64, index: u32, len: u32) -> *mut T {
    let message = format_args!("{what} index {index} is out of range: the buffer has {len} elements");
    let offset = u64::from(index) * size_of::<T>() as u64;
    crate::intrinsics::checked_address([(index, len)], address, offset, message).cast()
}

macro_rules! linear_view {
    ($(#[$doc:meta])* $name:ident, $what:literal, $ptr:ty) => {
        $(#[$doc])*
        #[repr(C)]
        pub struct $name<T> {
            address: u64,
            len: u32,
            zero: u32,
            elements: PhantomData<$ptr>,
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
                write!(f, concat!(stringify!($name), "({} elements)"), self.len)
            }
        }

        /// # Safety
        /// `address` is a [`Memory`](crate::host::Memory)'s, which has `len` elements, aligned for `T`, while launches that keep
        /// it use the view.
        impl<T: Element> FromRaw for $name<T> {
            type Raw = [u64; 2];
            #[inline(always)]
            unsafe fn from_raw([address, len]: [u64; 2]) -> Self {
                let len = if len > u32::MAX as u64 { u32::MAX } else { len as u32 };
                Self { address, len, zero: 0, elements: PhantomData }
            }
        }

        impl<T: Element> $name<T> {
            /// No elements.
            pub const EMPTY: Self = Self { address: 0, len: 0, zero: 0, elements: PhantomData };

            #[doc(hidden)]
            pub const fn to_raw(self) -> [u64; 2] {
                [self.address, self.len as u64]
            }

            /// How many elements there are. Of a larger buffer the first 2^32 - 1 are in the view.
            #[inline(always)]
            pub const fn len(self) -> usize {
                self.len as usize
            }

            /// Whether there are none.
            #[inline(always)]
            pub const fn is_empty(self) -> bool {
                self.len == 0
            }

            /// The element at `index`. An index out of range ends the launch.
            #[inline(always)]
            #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
            pub fn get(self, index: u32) -> T {
                let at = element::<T>($what, self.address, index, self.len);
                // SAFETY: in range, and `from_raw` promised `len` valid elements; otherwise no address at all.
                unsafe { read(at) }
            }

            /// The element at `index`, which is checked only where debug assertions are on.
            ///
            /// # Safety
            /// `index` is less than the length.
            #[inline(always)]
            #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
            pub unsafe fn get_unchecked(self, index: u32) -> T {
                if cfg!(debug_assertions) {
                    return self.get(index);
                }
                // SAFETY: in range, says the caller, and `from_raw` promised `len` valid elements.
                unsafe { read(crate::intrinsics::address_of(self.address).cast::<T>().add(index as usize)) }
            }
        }
    };
}

linear_view! {
    /// Elements that programs read.
    ///
    /// ```
    /// use optix_device_rs::prelude::*;
    /// fn third(normals: Slice<Vec3>) -> Vec3 {
    ///     normals.get(2)
    /// }
    /// ```
    Slice, "Slice", *const T
}
linear_view! {
    /// Elements that programs read and write.
    SliceMut, "SliceMut", *mut T
}

impl<T: Element> SliceMut<T> {
    /// Sets the element at `index`. An index out of range ends the launch.
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub fn set(self, index: u32, value: T) {
        let at = element::<T>("SliceMut", self.address, index, self.len);
        // SAFETY: in range, and `from_raw` promised `len` valid elements; otherwise no address at all.
        unsafe { write(at, value) }
    }

    /// Sets the element at `index`, which is checked only where debug assertions are on.
    ///
    /// # Safety
    /// `index` is less than the length.
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub unsafe fn set_unchecked(self, index: u32, value: T) {
        if cfg!(debug_assertions) {
            return self.set(index, value);
        }
        // SAFETY: in range, says the caller, and `from_raw` promised `len` valid elements.
        unsafe { write(crate::intrinsics::address_of(self.address).cast::<T>().add(index as usize), value) }
    }
}

/// A two-dimensional array that programs read and write, row by row: the film of a camera.
#[repr(C)]
pub struct SliceMut2d<T> {
    address: u64,
    width: u32,
    height: u32,
    elements: PhantomData<*mut T>,
}

impl<T> Clone for SliceMut2d<T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for SliceMut2d<T> {}

impl<T> core::fmt::Debug for SliceMut2d<T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "SliceMut2d({} x {} elements)", self.width, self.height)
    }
}

/// # Safety
/// `width * height` elements at `address`, aligned for `T`, stay valid on the launching machine while programs may use the
/// view.
impl<T: Element> FromRaw for SliceMut2d<T> {
    type Raw = (u64, [u32; 2]);
    #[inline(always)]
    unsafe fn from_raw((address, [width, height]): (u64, [u32; 2])) -> Self {
        Self { address, width, height, elements: PhantomData }
    }
}

impl<T: Element> SliceMut2d<T> {
    #[doc(hidden)]
    pub const fn to_raw(self) -> [u64; 2] {
        [self.address, self.width as u64 | (self.height as u64) << 32]
    }

    /// Width and height.
    #[inline(always)]
    pub const fn size(self) -> UVec2 {
        UVec2::new(self.width, self.height)
    }

    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    fn at(self, at: UVec2) -> *mut T {
        let size = self.size();
        let message =
            format_args!("({}, {}) is out of range: the array has {} x {} elements", at.x, at.y, size.x, size.y);
        let index = u64::from(at.y) * u64::from(size.x) + u64::from(at.x);
        let offset = index.wrapping_mul(size_of::<T>() as u64);
        crate::intrinsics::checked_address([(at.x, size.x), (at.y, size.y)], self.address, offset, message).cast()
    }

    /// The element in column `at.x` of row `at.y`. A place outside ends the launch.
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub fn get(self, at: UVec2) -> T {
        // SAFETY: `at` is in range, and `from_raw` promised valid elements; otherwise no address at all.
        unsafe { read(self.at(at)) }
    }

    /// Sets the element in column `at.x` of row `at.y`. A place outside ends the launch.
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub fn set(self, at: UVec2, value: T) {
        // SAFETY: `at` is in range, and `from_raw` promised valid elements; otherwise no address at all.
        unsafe { write(self.at(at), value) }
    }
}

words_of_raw! {
    [T: Element] Slice<T>: [u64; 2], |raw| Self::from_raw(raw);
    [T: Element] SliceMut<T>: [u64; 2], |raw| Self::from_raw(raw);
    [T: Element] SliceMut2d<T>: [u64; 2], |raw| Self::from_raw((raw[0], [raw[1] as u32, (raw[1] >> 32) as u32]));
}
