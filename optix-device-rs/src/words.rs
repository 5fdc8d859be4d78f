//! Values as 32-bit words, the way payload and attribute registers carry them (guide 13.3, 13.4).

use glam::{Mat3, Quat, UVec2, UVec3, UVec4, Vec2, Vec3, Vec4};

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
/// Implemented for `f32`, `u32`, `i32`, `f64`, `u64`, `i64`, `u16`, `u8`, `bool`, glam's `f32` and `u32` vectors, `Quat` and
/// `Mat3`, arrays of these, and by `#[derive(Words)]` for structs of these. Smaller integers and `bool` take a whole
/// word each.
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
    ($($ty:ty: $to:expr, $from:expr;)*) => {$(
        impl Words for $ty {
            const COUNT: usize = 1;
            #[inline(always)]
            fn store(self, words: &mut WordBuffer, at: usize) {
                let to: fn($ty) -> u32 = $to;
                words.0[at] = to(self);
            }
            #[inline(always)]
            fn load(words: &WordBuffer, at: usize) -> Self {
                let from: fn(u32) -> $ty = $from;
                from(words.0[at])
            }
        }
    )*};
}

one_word! {
    u32: u32::from, u32::from;
    i32: i32::cast_unsigned, u32::cast_signed;
    f32: f32::to_bits, f32::from_bits;
    bool: u32::from, |w| w != 0;
    u16: u32::from, |w| w as u16;
    u8: u32::from, |w| w as u8;
}

macro_rules! two_words {
    ($($ty:ty: $to:expr, $from:expr;)*) => {$(
        impl Words for $ty {
            const COUNT: usize = 2;
            #[inline(always)]
            fn store(self, words: &mut WordBuffer, at: usize) {
                let to: fn($ty) -> u64 = $to;
                let bits = to(self);
                words.0[at] = bits as u32;
                words.0[at + 1] = (bits >> 32) as u32;
            }
            #[inline(always)]
            fn load(words: &WordBuffer, at: usize) -> Self {
                let from: fn(u64) -> $ty = $from;
                from(words.0[at] as u64 | (words.0[at + 1] as u64) << 32)
            }
        }
    )*};
}

two_words! {
    u64: u64::from, u64::from;
    i64: i64::cast_unsigned, u64::cast_signed;
    f64: f64::to_bits, f64::from_bits;
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
    Quat => [f32; 4], to_array, from_array;
}

impl Words for Mat3 {
    const COUNT: usize = 9;
    #[inline(always)]
    fn store(self, words: &mut WordBuffer, at: usize) {
        self.to_cols_array().store(words, at);
    }
    #[inline(always)]
    fn load(words: &WordBuffer, at: usize) -> Self {
        Mat3::from_cols_array(&<[f32; 9]>::load(words, at))
    }
}
