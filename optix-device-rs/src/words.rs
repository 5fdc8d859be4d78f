//! Values as 32-bit words, the way payload and attribute registers carry them (guide 13.3, 13.4).

use glam::{IVec2, IVec3, IVec4, Mat3, Mat4, Quat, UVec2, UVec3, UVec4, Vec2, Vec3, Vec4};

/// The most words a payload has (guide 14).
pub const MAX_PAYLOAD_WORDS: usize = 32;
/// The most words an attribute set has (guide 13.4).
pub const MAX_ATTRIBUTE_WORDS: usize = 8;

/// Room for the words of one payload or attribute set.
///
/// On the device this is never memory: every index is a constant after inlining, so it becomes registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct WordBuffer(pub [u32; MAX_PAYLOAD_WORDS]);

impl WordBuffer {
    /// All words zero.
    pub const ZERO: Self = Self([0; MAX_PAYLOAD_WORDS]);
}

/// A value that travels in payload or attribute registers as `COUNT` words of 32 bits, bit for bit.
///
/// Implemented for `f32`, `f64`, integers, `bool`, glam's `f32`, `u32` and `i32` vectors, `Quat`, `Mat3` and `Mat4`; for
/// `Option` (a word more, 0 for `None`), pairs and arrays of these; and by `#[derive(Words)]` for structs of these. Smaller
/// integers and `bool` take a whole word each.
///
/// ```
/// use optix_device_rs::words::{WordBuffer, Words};
/// let mut words = WordBuffer::ZERO;
/// (1.5f32).store(&mut words, 3);
/// assert_eq!(f32::load(&words, 3), 1.5);
/// assert_eq!(<[f32; 4]>::COUNT, 4);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't travel in payload or attribute registers",
    label = "has no encoding in 32-bit words",
    note = "use f32, u32, i32, bool, a glam vector, an array of these, or `#[derive(Words)]` on your struct of these"
)]
pub trait Words: Copy + 'static {
    /// How many 32-bit words the value takes.
    const COUNT: usize;
    /// Writes the value's words at `at..at + COUNT`.
    fn store(self, words: &mut WordBuffer, at: usize);
    /// Reads the value back from `at..at + COUNT`.
    fn load(words: &WordBuffer, at: usize) -> Self;
}

macro_rules! one_word {
    ($($ty:ty: |$value:ident| $to:expr, |$word:ident| $from:expr;)*) => {$(
        impl Words for $ty {
            const COUNT: usize = 1;
            #[inline(always)]
            fn store(self, words: &mut WordBuffer, at: usize) {
                let $value = self;
                words.0[at] = $to;
            }
            #[inline(always)]
            fn load(words: &WordBuffer, at: usize) -> Self {
                let $word = words.0[at];
                $from
            }
        }
    )*};
}

one_word! {
    u32: |v| v, |w| w;
    i32: |v| v.cast_unsigned(), |w| w.cast_signed();
    f32: |v| v.to_bits(), |w| f32::from_bits(w);
    bool: |v| u32::from(v), |w| w != 0;
    u16: |v| u32::from(v), |w| w as u16;
    u8: |v| u32::from(v), |w| w as u8;
    i16: |v| v as u32, |w| w as i16;
    i8: |v| v as u32, |w| w as i8;
}

macro_rules! two_words {
    ($($ty:ty: |$value:ident| $to:expr, |$bits:ident| $from:expr;)*) => {$(
        impl Words for $ty {
            const COUNT: usize = 2;
            #[inline(always)]
            fn store(self, words: &mut WordBuffer, at: usize) {
                let $value = self;
                let bits: u64 = $to;
                words.0[at] = bits as u32;
                words.0[at + 1] = (bits >> 32) as u32;
            }
            #[inline(always)]
            fn load(words: &WordBuffer, at: usize) -> Self {
                let $bits = u64::from(words.0[at]) | u64::from(words.0[at + 1]) << 32;
                $from
            }
        }
    )*};
}

two_words! {
    u64: |v| v, |w| w;
    i64: |v| v.cast_unsigned(), |w| w.cast_signed();
    f64: |v| v.to_bits(), |w| f64::from_bits(w);
}

impl Words for () {
    const COUNT: usize = 0;
    #[inline(always)]
    fn store(self, _: &mut WordBuffer, _: usize) {}
    #[inline(always)]
    fn load(_: &WordBuffer, _: usize) -> Self {}
}

impl<T: Words, const N: usize> Words for [T; N] {
    const COUNT: usize = T::COUNT * N;
    #[inline(always)]
    fn store(self, words: &mut WordBuffer, at: usize) {
        for (i, value) in self.into_iter().enumerate() {
            value.store(words, at + i * T::COUNT);
        }
    }
    #[inline(always)]
    fn load(words: &WordBuffer, at: usize) -> Self {
        core::array::from_fn(|i| T::load(words, at + i * T::COUNT))
    }
}

macro_rules! as_array {
    ($($ty:ty => [$of:ty; $n:literal], $to:ident, $from:ident;)*) => {$(
        impl Words for $ty {
            const COUNT: usize = $n;
            #[inline(always)]
            fn store(self, words: &mut WordBuffer, at: usize) {
                <[$of; $n]>::store(self.$to(), words, at);
            }
            #[inline(always)]
            fn load(words: &WordBuffer, at: usize) -> Self {
                <$ty>::$from(<[$of; $n]>::load(words, at).into())
            }
        }
    )*};
}

as_array! {
    Vec2 => [f32; 2], to_array, from_array;
    Vec3 => [f32; 3], to_array, from_array;
    Vec4 => [f32; 4], to_array, from_array;
    UVec2 => [u32; 2], to_array, from_array;
    UVec3 => [u32; 3], to_array, from_array;
    UVec4 => [u32; 4], to_array, from_array;
    IVec2 => [i32; 2], to_array, from_array;
    IVec3 => [i32; 3], to_array, from_array;
    IVec4 => [i32; 4], to_array, from_array;
    Quat => [f32; 4], to_array, from_array;
}

macro_rules! as_columns {
    ($($ty:ty => $n:literal;)*) => {$(
        impl Words for $ty {
            const COUNT: usize = $n;
            #[inline(always)]
            fn store(self, words: &mut WordBuffer, at: usize) {
                self.to_cols_array().store(words, at);
            }
            #[inline(always)]
            fn load(words: &WordBuffer, at: usize) -> Self {
                <$ty>::from_cols_array(&<[f32; $n]>::load(words, at))
            }
        }
    )*};
}

as_columns! {
    Mat3 => 9;
    Mat4 => 16;
}

impl<T: Words> Words for Option<T> {
    const COUNT: usize = 1 + T::COUNT;
    #[inline(always)]
    fn store(self, words: &mut WordBuffer, at: usize) {
        self.is_some().store(words, at);
        if let Some(value) = self {
            value.store(words, at + 1);
        }
    }
    #[inline(always)]
    fn load(words: &WordBuffer, at: usize) -> Self {
        bool::load(words, at).then(|| T::load(words, at + 1))
    }
}

impl<A: Words, B: Words> Words for (A, B) {
    const COUNT: usize = A::COUNT + B::COUNT;
    #[inline(always)]
    fn store(self, words: &mut WordBuffer, at: usize) {
        self.0.store(words, at);
        self.1.store(words, at + A::COUNT);
    }
    #[inline(always)]
    fn load(words: &WordBuffer, at: usize) -> Self {
        (A::load(words, at), B::load(words, at + A::COUNT))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::fmt::Debug;

    /// Stores and loads at every place that has room, between words that must not change.
    #[track_caller]
    fn round_trip<T: Words + PartialEq + Debug>(value: T) {
        for at in 0..=MAX_PAYLOAD_WORDS - T::COUNT {
            let mut words = WordBuffer([0xdead_beef; MAX_PAYLOAD_WORDS]);
            value.store(&mut words, at);
            assert_eq!(T::load(&words, at), value);
            let around = words.0.iter().enumerate().filter(|(i, _)| *i < at || *i >= at + T::COUNT);
            assert!(around.map(|(_, word)| *word).all(|word| word == 0xdead_beef), "{value:?} at {at}");
        }
    }

    #[test]
    fn every_type_comes_back() {
        let mut rng = crate::rng::Pcg32::hashed(1, 2);
        for _ in 0..200 {
            let (a, b) = (rng.next_u32(), rng.next_u32());
            let wide = u64::from(a) << 32 | u64::from(b);
            let f = rng.next_f32() * 2e9 - 1e9;
            round_trip(a);
            round_trip(a.cast_signed());
            round_trip((a as u16, b as u8));
            round_trip((a as i16, b as i8));
            round_trip(wide);
            round_trip(wide.cast_signed());
            round_trip(f64::from(f) * f64::from(b));
            round_trip([a & 1 == 0, b & 1 == 0]);
            round_trip(Vec3::new(f, -f, 1.0 / f));
            round_trip((Vec2::splat(f), Vec4::splat(-f)));
            round_trip((UVec3::new(a, b, 7), IVec4::splat(a.cast_signed())));
            round_trip(Quat::from_xyzw(f, 1.0, 2.0, -f));
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
            let mut words = WordBuffer::ZERO;
            f32::from_bits(bits).store(&mut words, 0);
            assert_eq!(f32::load(&words, 0).to_bits(), bits);
        }
    }
}
