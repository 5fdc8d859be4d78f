//! Values as 32-bit words, the way payload and attribute registers carry them (guide 13.3, 13.4).

use crate::layout::Layout;
use crate::limits::MAX_PAYLOAD_WORDS;
use glam::{
    Affine2, Affine3A, DAffine2, DAffine3, DMat2, DMat3, DMat4, DQuat, DVec2, DVec3, DVec4, I16Vec2, I16Vec3, I16Vec4,
    IVec2, IVec3, IVec4, Mat2, Mat3, Mat3A, Mat4, Quat, U16Vec2, U16Vec3, U16Vec4, UVec2, UVec3, UVec4, Vec2, Vec3,
    Vec3A, Vec4,
};

/// Room for the registers of one payload or attribute set.
///
/// On the device this is never memory: every index is a constant after inlining, so it becomes registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct WordBuffer(pub [u32; MAX_PAYLOAD_WORDS]);

impl WordBuffer {
    /// All words zero.
    pub const ZERO: Self = Self([0; MAX_PAYLOAD_WORDS]);
}

/// A value that travels in a payload, in attributes or in a call as `COUNT` words of 32 bits, bit for bit.
///
/// Implemented for `f32`, `f64`, integers up to 64 bits, `bool` and `char`; glam's vectors, quaternions, matrices and affine
/// maps of `f32`, `f64` and 16- and 32-bit integers; raw pointers and the views of device memory
/// ([`Slice`](crate::view::Slice) and its kin, [`Traversable`](crate::ray::Traversable)); `Option` (a word more, 0 for
/// `None`), tuples of up to eight and arrays of these; and by `#[derive(Words)]` for structs of these. Smaller integers, `bool` and `char`
/// take a whole word each.
///
/// ```
/// use optix_device_rs::words::Words;
/// let mut words = [0; 4];
/// [1.5f32, 2.5].store(&mut words[1..3]);
/// assert_eq!(words, [0, 1.5f32.to_bits(), 2.5f32.to_bits(), 0]);
/// assert_eq!(<[f32; 2]>::COUNT, 2);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't travel in a payload, in attributes or in a call",
    label = "has no encoding in 32-bit words",
    note = "use numbers (`u32`, not `usize`, whose size is the machine's), `bool`, a glam type, a view such as `Slice`, an `Option`, pair or array of these, or your struct of these with `#[derive(Clone, Copy, Words)]`; the elements of a `Vec`, `Box` or `String` are in the host's memory, so they go into a buffer, and the field is a `Slice` of it"
)]
pub trait Words: Copy + 'static {
    /// How many 32-bit words the value takes.
    const COUNT: usize;
    /// How its words are made up.
    #[doc(hidden)]
    const LAYOUT: Layout = Layout::of("words").number(Self::COUNT);
    /// Writes the value to `words`, which are `COUNT` long.
    fn store(self, words: &mut [u32]);
    /// Reads the value back from `words`, which are `COUNT` long.
    ///
    /// # Safety
    /// [`Words::store`] of the same type wrote the words: any others could forge a view of memory that is not there. Or all are
    /// zero, which is a value of every type: what comes back from a trace call that runs no program.
    unsafe fn load(words: &[u32]) -> Self;
}

/// Where each of several values in a row begins, and where the last one ends: `N` is one more than there are values.
#[doc(hidden)]
pub const fn begins<const N: usize>(counts: &[usize]) -> [usize; N] {
    let mut all = [0; N];
    let mut i = 0;
    while i < counts.len() {
        all[i + 1] = all[i] + counts[i];
        i += 1;
    }
    all
}

/// `words[at..end]`, inlined before any other optimisation: what is a register must not look like memory for long.
#[doc(hidden)]
#[inline(always)]
pub const fn part(words: &[u32], at: usize, end: usize) -> &[u32] {
    assert!(at <= end && end <= words.len());
    // SAFETY: inside of the slice.
    unsafe { core::slice::from_raw_parts(words.as_ptr().add(at), end - at) }
}

/// `&mut words[at..end]`, as [`part`].
#[doc(hidden)]
#[inline(always)]
pub const fn part_mut(words: &mut [u32], at: usize, end: usize) -> &mut [u32] {
    assert!(at <= end && end <= words.len());
    // SAFETY: inside of the slice.
    unsafe { core::slice::from_raw_parts_mut(words.as_mut_ptr().add(at), end - at) }
}

macro_rules! one_word {
    ($($ty:ty: |$value:ident| $to:expr, |$word:ident| $from:expr;)*) => {$(
        impl Words for $ty {
            const COUNT: usize = 1;
            const LAYOUT: Layout = Layout::of(stringify!($ty));
            #[inline(always)]
            fn store(self, words: &mut [u32]) {
                let $value = self;
                words[0] = $to;
            }
            #[inline(always)]
            unsafe fn load(words: &[u32]) -> Self {
                let $word = words[0];
                $from
            }
        }
    )*};
}

one_word! {
    u32: |v| v, |w| w;
    i32: |v| v.cast_unsigned(), |w| w.cast_signed();
    f32: |v| v.to_bits(), |w| f32::from_bits(w);
    bool: |v| u32::from(v), |w| {
        // SAFETY: a `bool` was stored. So a sum of them needs no comparison.
        unsafe { core::hint::assert_unchecked(w <= 1) };
        w == 1
    };
    u16: |v| u32::from(v), |w| w as u16;
    u8: |v| u32::from(v), |w| w as u8;
    i16: |v| v as u32, |w| w as i16;
    i8: |v| v as u32, |w| w as i8;
    // SAFETY: a `char` was stored.
    char: |v| u32::from(v), |w| unsafe { char::from_u32_unchecked(w) };
}

macro_rules! two_words {
    ($([$($generics:tt)*] $ty:ty: |$value:ident| $to:expr, |$bits:ident| $from:expr;)*) => {$(
        impl<$($generics)*> Words for $ty {
            const COUNT: usize = 2;
            const LAYOUT: Layout = Layout::of(stringify!($ty));
            #[inline(always)]
            fn store(self, words: &mut [u32]) {
                let $value = self;
                let bits: u64 = $to;
                words[0] = bits as u32;
                words[1] = (bits >> 32) as u32;
            }
            #[inline(always)]
            unsafe fn load(words: &[u32]) -> Self {
                let $bits = crate::intrinsics::join_words(words[0], words[1]);
                $from
            }
        }
    )*};
}

two_words! {
    [] u64: |v| v, |w| w;
    [] i64: |v| v.cast_unsigned(), |w| w.cast_signed();
    [] f64: |v| v.to_bits(), |w| f64::from_bits(w);
    [T: 'static] *const T: |v| v.expose_provenance() as u64, |w| core::ptr::with_exposed_provenance(w as usize);
    [T: 'static] *mut T: |v| v.expose_provenance() as u64, |w| core::ptr::with_exposed_provenance_mut(w as usize);
}

/// What views and handles are made of. A trait of this crate, and no function of each type: rustc offers such a function, even
/// a private one, to whoever tries to make a view by hand.
pub(crate) trait FromRaw {
    /// Addresses, lengths, indices.
    type Raw;
    /// A view of what is there.
    ///
    /// # Safety
    /// As said at the type's implementation.
    unsafe fn from_raw(raw: Self::Raw) -> Self;
}

/// Types that travel as the array of integers that their `to_raw` gives, and come back by a constructor for the stored ones.
macro_rules! words_of_raw {
    ($([$($generics:tt)*] $ty:ty: $raw_ty:ty, |$raw:ident| $from:expr;)*) => {$(
        impl<$($generics)*> $crate::words::Words for $ty {
            const COUNT: usize = <$raw_ty as $crate::words::Words>::COUNT;
            const LAYOUT: $crate::layout::Layout = $crate::layout::Layout::of(stringify!($ty));
            #[inline(always)]
            fn store(self, words: &mut [u32]) {
                $crate::words::Words::store(self.to_raw(), words);
            }
            #[inline(always)]
            unsafe fn load(words: &[u32]) -> Self {
                // SAFETY: the words are of a value of this type that was stored, so what it promises holds for this one too.
                unsafe {
                    let $raw = <$raw_ty as $crate::words::Words>::load(words);
                    $from
                }
            }
        }
    )*};
}
pub(crate) use words_of_raw;

impl Words for () {
    const COUNT: usize = 0;
    #[inline(always)]
    fn store(self, _: &mut [u32]) {}
    #[inline(always)]
    unsafe fn load(_: &[u32]) -> Self {}
}

impl<T: Words, const N: usize> Words for [T; N] {
    const COUNT: usize = T::COUNT * N;
    const LAYOUT: Layout = Layout::of("array").number(N).with(T::LAYOUT);
    #[inline(always)]
    fn store(self, words: &mut [u32]) {
        // `enumerate` and `+` check for overflow where that is asked for, and the array stays in memory then.
        let mut at = 0_usize;
        for value in self {
            let end = at.wrapping_add(T::COUNT);
            value.store(part_mut(words, at, end));
            at = end;
        }
    }
    #[inline(always)]
    unsafe fn load(words: &[u32]) -> Self {
        // SAFETY: the array's `store` wrote each element with its own.
        core::array::from_fn(|i| unsafe { T::load(part(words, i * T::COUNT, (i + 1) * T::COUNT)) })
    }
}

impl<T: Words> Words for Option<T> {
    const COUNT: usize = 1 + T::COUNT;
    const LAYOUT: Layout = Layout::of("option").with(T::LAYOUT);
    #[inline(always)]
    fn store(self, words: &mut [u32]) {
        self.is_some().store(part_mut(words, 0, 1));
        if let Some(value) = self {
            value.store(part_mut(words, 1, Self::COUNT));
        }
    }
    #[inline(always)]
    unsafe fn load(words: &[u32]) -> Self {
        // SAFETY: the first word says whether a value was stored behind it.
        unsafe { bool::load(part(words, 0, 1)).then(|| T::load(part(words, 1, Self::COUNT))) }
    }
}

macro_rules! tuple {
    ($(($($name:ident)*))*) => {$(
        #[allow(non_snake_case, unused_assignments, reason = "one name for type and value; the last place is not used")]
        // In messages they would take the place of types that are looked for.
        #[diagnostic::do_not_recommend]
        impl<$($name: Words),*> Words for ($($name,)*) {
            const COUNT: usize = 0 $(+ $name::COUNT)*;
            const LAYOUT: Layout = Layout::of("tuple")$(.with($name::LAYOUT))*;
            #[inline(always)]
            fn store(self, words: &mut [u32]) {
                let ($($name,)*) = self;
                let mut at = 0;
                $(
                    $name.store(part_mut(words, at, at + $name::COUNT));
                    at += $name::COUNT;
                )*
            }
            #[inline(always)]
            unsafe fn load(words: &[u32]) -> Self {
                let mut at = 0;
                $(
                    // SAFETY: the tuple's `store` wrote each part with its own.
                    let $name = unsafe { $name::load(part(words, at, at + $name::COUNT)) };
                    at += $name::COUNT;
                )*
                ($($name,)*)
            }
        }
    )*};
}
tuple! { (A) (A B) (A B C) (A B C D) (A B C D E) (A B C D E F) (A B C D E F G) (A B C D E F G H) }

/// Types that go by way of an array.
macro_rules! as_array {
    ($($ty:ty => [$of:ty; $n:literal], $to:ident, |$array:ident| $from:expr;)*) => {$(
        impl Words for $ty {
            const COUNT: usize = <[$of; $n]>::COUNT;
            const LAYOUT: Layout = Layout::of(stringify!($ty));
            #[inline(always)]
            fn store(self, words: &mut [u32]) {
                let array: [$of; $n] = self.$to();
                array.store(words);
            }
            #[inline(always)]
            unsafe fn load(words: &[u32]) -> Self {
                // SAFETY: `store` wrote the array.
                let $array = unsafe { <[$of; $n]>::load(words) };
                $from
            }
        }
    )*};
}

macro_rules! vectors {
    ($($ty:ty => [$of:ty; $n:literal];)*) => {
        as_array! { $($ty => [$of; $n], to_array, |array| <$ty>::from_array(array);)* }
    };
}

vectors! {
    Vec2 => [f32; 2];
    Vec3 => [f32; 3];
    Vec3A => [f32; 3];
    Vec4 => [f32; 4];
    Quat => [f32; 4];
    DVec2 => [f64; 2];
    DVec3 => [f64; 3];
    DVec4 => [f64; 4];
    DQuat => [f64; 4];
    UVec2 => [u32; 2];
    UVec3 => [u32; 3];
    UVec4 => [u32; 4];
    IVec2 => [i32; 2];
    IVec3 => [i32; 3];
    IVec4 => [i32; 4];
    U16Vec2 => [u16; 2];
    U16Vec3 => [u16; 3];
    U16Vec4 => [u16; 4];
    I16Vec2 => [i16; 2];
    I16Vec3 => [i16; 3];
    I16Vec4 => [i16; 4];
}

macro_rules! matrices {
    ($($ty:ty => [$of:ty; $n:literal];)*) => {
        as_array! { $($ty => [$of; $n], to_cols_array, |array| <$ty>::from_cols_array(&array);)* }
    };
}

matrices! {
    Mat2 => [f32; 4];
    Mat3 => [f32; 9];
    Mat3A => [f32; 9];
    Mat4 => [f32; 16];
    Affine2 => [f32; 6];
    Affine3A => [f32; 12];
    DMat2 => [f64; 4];
    DMat3 => [f64; 9];
    DMat4 => [f64; 16];
    DAffine2 => [f64; 6];
    DAffine3 => [f64; 12];
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::fmt::Debug;

    /// Stores and loads between words that must not change.
    #[track_caller]
    fn round_trip<T: Words + PartialEq + Debug>(value: T) {
        let mut words = [0xdead_beef; 40];
        let place = 4..4 + T::COUNT;
        value.store(&mut words[place.clone()]);
        // SAFETY: stored in the line above.
        assert_eq!(unsafe { T::load(&words[place.clone()]) }, value);
        words[place].fill(0xdead_beef);
        assert_eq!(words, [0xdead_beef; 40], "{value:?} leaves its words");
    }

    #[test]
    fn every_type_comes_back() {
        let mut rng = crate::rng::Pcg32::hashed(1, 2);
        for _ in 0..if cfg!(miri) { 2 } else { 200 } {
            let (a, b) = (rng.next_u32(), rng.next_u32());
            let wide = u64::from(a) << 32 | u64::from(b);
            let f = rng.next_f32() * 2e9 - 1e9;
            round_trip(a);
            round_trip(a.cast_signed());
            round_trip((a as u16, b as u8));
            round_trip((a as i16, b as i8));
            round_trip((a, b as u8, f, wide, (), [b], Some(a), (f,)));
            round_trip(wide);
            round_trip(wide.cast_signed());
            round_trip(f64::from(f) * f64::from(b));
            round_trip([a & 1 == 0, b & 1 == 0]);
            round_trip(Vec3::new(f, -f, 1.0 / f));
            round_trip((Vec2::splat(f), Vec4::splat(-f)));
            round_trip((UVec3::new(a, b, 7), IVec4::splat(a.cast_signed())));
            round_trip(Quat::from_xyzw(f, 1.0, 2.0, -f));
            round_trip(char::from_u32(a % 0xd800));
            round_trip((U16Vec3::splat(a as u16), I16Vec4::splat(b as i16)));
            round_trip((DVec3::splat(f64::from(f)), DQuat::from_xyzw(1.0, f64::from(-f), 2.0, 3.0)));
            round_trip((Vec3A::splat(f), core::ptr::without_provenance::<u64>(a as usize)));
            round_trip(Affine3A::from_cols_array(&core::array::from_fn(|i| f + i as f32)));
            round_trip(DMat4::from_cols_array(&core::array::from_fn(|i| f64::from(f) * i as f64)));
            round_trip(Mat3::from_cols_array(&core::array::from_fn(|i| f * i as f32)));
            round_trip(Mat4::from_cols_array(&core::array::from_fn(|i| f - i as f32)));
            round_trip(Some((wide, f)));
            round_trip([Some(a as u8), None, Some(b as u8)]);
        }
        round_trip(Option::<[f64; 3]>::None);
    }

    #[test]
    fn bits_survive_that_are_not_equal_to_themselves() {
        for bits in [0x7fc0_1234, 0xff80_0001, 0x8000_0000, 1] {
            let mut words = [0];
            f32::from_bits(bits).store(&mut words);
            // SAFETY: stored in the line above.
            assert_eq!(unsafe { f32::load(&words) }.to_bits(), bits);
        }
    }
}
