//! References to callables: functions of the shader binding table that a program chooses while it runs (guide 15).
//!
//! [`Callable`] is one of them, with the data of its record; [`Callables`] is a table of them, chosen by number. Both are
//! fields of records and launch parameters, filled in by the host, so that the target may change without compiling
//! anything anew. `call` is checked against the signature, and against what the caller may call:
//!
//! ```
//! use optix_device_rs::prelude::*;
//!
//! /// How a texture is looked up: the signature that caller and callable agree on.
//! type Texture = fn(Vec2) -> Vec3;
//!
//! #[derive(Clone, Copy, SbtRecord)]
//! #[repr(C)]
//! pub struct Checker {
//!     pub squares: f32,
//!     pub other: Callable<Texture>, // callables call callables
//! }
//!
//! #[direct_callable]
//! fn checker<P: Pipeline>(dc: &DirectCallable<P>, record: &Checker, uv: Vec2) -> Vec3 {
//!     let square = (uv * record.squares).as_ivec2();
//!     if (square.x + square.y) & 1 == 0 { Vec3::ONE } else { record.other.call(dc, uv) }
//! }
//! ```

use crate::data::DeviceData;
use crate::layout::Layout;
use crate::sealed::Sealed;
use crate::view::OfLaunch;
use crate::words::{FromRaw, Words, words_of_raw};
use core::marker::PhantomData;

/// A kind of callable: [`Direct`] or [`Continuation`].
pub trait CallableKind: Sealed + 'static {
    /// Which of the two it is.
    const IS_CONTINUATION: bool;
}

/// Runs at once, like a function call; traces no rays (guide 15.1).
#[derive(Clone, Copy, Debug)]
pub enum Direct {}

/// Runs through the scheduler, and may trace rays (guide 15.1).
#[derive(Clone, Copy, Debug)]
pub enum Continuation {}

impl Sealed for Direct {}
impl Sealed for Continuation {}
impl CallableKind for Direct {
    const IS_CONTINUATION: bool = false;
}
impl CallableKind for Continuation {
    const IS_CONTINUATION: bool = true;
}

/// What a callable takes and returns, as a function type: `fn(Vec2, f32) -> Vec3`. Up to eight arguments, and arguments
/// and result of 32 words each at most.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not the signature of a callable",
    label = "expected a function type such as `fn(Vec2, f32) -> Vec3`",
    note = "at most eight arguments, passed and returned by value, each of which can travel in registers (`Words`)"
)]
pub trait Signature: Sealed + 'static {
    /// The arguments, as a tuple.
    type Arguments: Words;
    /// What comes back.
    type Result: Words;
    /// How both are made up.
    #[doc(hidden)]
    const LAYOUT: Layout =
        Layout::of("signature").with(<Self::Arguments as Words>::LAYOUT).with(<Self::Result as Words>::LAYOUT);
}

macro_rules! signature {
    ($(($($argument:ident)*))*) => {$(
        impl<$($argument: Words,)* R: Words> Sealed for fn($($argument),*) -> R {}
        impl<$($argument: Words,)* R: Words> Signature for fn($($argument),*) -> R {
            type Arguments = ($($argument,)*);
            type Result = R;
        }
    )*};
}
signature! { () (A) (A B) (A B C) (A B C D) (A B C D E) (A B C D E F) (A B C D E F G) (A B C D E F G H) }

/// What crosses in a call on the device. With four bytes as its alignment it goes word by word: more would pair words up.
#[doc(hidden)]
#[derive(Clone, Copy)]
#[repr(C, packed(4))]
pub struct Packed<T>(pub T);

/// A callable with signature `F` and the data of its record: `record.texture.call(hit, uv)`.
///
/// `Callable<fn(Vec2) -> Vec3>` is a direct one; `Callable<fn(Vec2) -> Vec3, Continuation>` may trace rays. On the host
/// it is a [`CallableRecord`](crate::host::CallableRecord), which a scene makes.
#[repr(transparent)]
pub struct Callable<F, K = Direct> {
    /// Index in the callables section, or on the CPU a number that stands for it, of a record whose program has signature `F` and
    /// kind `K`.
    index: u32,
    types: PhantomData<fn() -> (F, K)>,
    of: OfLaunch,
}

/// A table of callables with signature `F`, chosen by number: `frame.textures().get(i).call(hit, uv)`.
///
/// On the host it is a [`CallableTable`](crate::host::CallableTable), which a scene makes.
#[repr(C)]
pub struct Callables<F, K = Direct> {
    /// The same of the first one; all `len` from there on have signature `F` and kind `K`.
    first: u32,
    len: u32,
    types: PhantomData<fn() -> (F, K)>,
    of: OfLaunch,
}

macro_rules! references {
    ($($name:ident)*) => {$(
        impl<F, K> Clone for $name<F, K> {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }
        impl<F, K> Copy for $name<F, K> {}

        // SAFETY: `#[repr(C)]` integers, the same on both machines.
        unsafe impl<F: Signature, K: CallableKind> DeviceData for $name<F, K> {
            const LAYOUT: Layout = Layout::of(stringify!($name)).with(F::LAYOUT).number(K::IS_CONTINUATION as usize);
            #[inline]
            fn write_to(&self, bytes: &mut [u8]) {
                self.to_raw().write_to(bytes);
            }
        }
    )*};
}
references!(Callable Callables);

impl<F: 'static, K: 'static> Words for Callable<F, K> {
    const COUNT: usize = 1;
    // Without the signature, whose arguments may hold such a reference.
    const LAYOUT: Layout = Layout::of("Callable");
    #[inline(always)]
    fn store(self, words: &mut [u32]) {
        self.index.store(words);
    }
    #[inline(always)]
    unsafe fn load(words: &[u32]) -> Self {
        // SAFETY: a `Callable` of this type was stored.
        unsafe { Self::from_raw(u32::load(words)) }
    }
}

words_of_raw! {
    [F: 'static, K: 'static] Callables<F, K>: [u32; 2], |raw| Self::from_raw(raw);
}

impl<F, K> core::fmt::Debug for Callable<F, K> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Callable({})", self.index)
    }
}

impl<F, K> core::fmt::Debug for Callables<F, K> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Callables({} to {})", self.first, self.first + self.len)
    }
}

/// # Safety
/// In the tables of the launches that get it, the record of this index is there, of a program with signature `F` and kind `K`.
impl<F, K> FromRaw for Callable<F, K> {
    type Raw = u32;
    #[inline(always)]
    unsafe fn from_raw(index: u32) -> Self {
        Self { index, types: PhantomData, of: OfLaunch::NEW }
    }
}

/// # Safety
/// As for [`Callable`], each of the `len` records from `first` on.
impl<F, K> FromRaw for Callables<F, K> {
    type Raw = [u32; 2];
    #[inline(always)]
    unsafe fn from_raw([first, len]: [u32; 2]) -> Self {
        Self { first, len, types: PhantomData, of: OfLaunch::NEW }
    }
}

impl<F, K> Callable<F, K> {
    #[doc(hidden)]
    #[inline(always)]
    pub const fn to_raw(self) -> u32 {
        self.index
    }
}

impl<F, K> Callables<F, K> {
    #[doc(hidden)]
    #[inline(always)]
    pub const fn to_raw(self) -> [u32; 2] {
        [self.first, self.len]
    }

    /// How many there are.
    #[inline(always)]
    pub const fn len(self) -> u32 {
        self.len
    }

    /// Whether there is none.
    #[inline(always)]
    pub const fn is_empty(self) -> bool {
        self.len == 0
    }

    /// Number `index` of the table.
    ///
    /// # Panics
    /// Ends the program if `index >= len`.
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub fn get(self, index: u32) -> Callable<F, K> {
        let len = self.len;
        let message = format_args!("callable {index} is out of range: the table has {len}");
        crate::intrinsics::check(index, len, message);
        Callable { index: self.first + index, types: PhantomData, of: OfLaunch::NEW }
    }
}
