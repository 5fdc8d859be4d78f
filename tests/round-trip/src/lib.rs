//! Device programs that send values of every type that can travel on every way there is: from launch parameters and records
//! through payloads in registers and by pointer, and through attributes. What arrives anywhere is written out as words, which
//! are to be the same everywhere.
#![no_std]

pub mod cargo;
pub mod hits;
pub mod rays;

use cargo::*;
use optix_device_rs::prelude::*;

/// The launch parameters.
#[launch_params]
#[expect(missing_docs)]
pub struct Trip {
    /// What arrived: rows of [`ROW`] words.
    pub out: SliceMut<u32>,
    /// What rays are traced against.
    pub world: Traversable,
    pub numbers: Numbers,
    pub nested: Nested,
    pub floats: Floats,
    pub matrices: Matrices,
    pub doubles: Doubles,
    pub integers: Integers,
    pub large: Large,
    #[view]
    pub views: Views,
}

impl TripView<'_> {
    /// The values in the parameters.
    pub fn cargo(&self) -> Cargo {
        Cargo {
            numbers: self.numbers(),
            nested: self.nested(),
            floats: self.floats(),
            matrices: self.matrices(),
            doubles: self.doubles(),
            integers: self.integers(),
            large: self.large(),
            views: self.views(),
        }
    }

    /// Writes a value's words to row `row` of the output.
    pub fn put(&self, row: usize, value: impl Written) {
        value.write(self.out(), row * ROW);
    }
}

/// Writes the words of a value from index `at` on, 32 at most, each from a register; gives the index behind them.
#[inline(always)]
fn write<T: Words>(out: SliceMut<u32>, at: usize, value: T) -> usize {
    let mut words = [0; 32];
    value.store(&mut words[..T::COUNT]);
    macro_rules! set {
        ($($i:literal)*) => {$(
            if $i < T::COUNT {
                out.set((at + $i) as u32, words[$i]);
            }
        )*};
    }
    set!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31);
    at + T::COUNT
}

/// A value that is written out as words.
pub trait Written: Words {
    /// Writes them from index `at` on.
    #[inline(always)]
    fn write(self, out: SliceMut<u32>, at: usize) {
        write(out, at, self);
    }
}

impl Written for (Numbers, Nested) {}
impl Written for Floats {}
impl Written for Matrices {}
impl Written for Doubles {}
impl Written for Integers {}
impl Written for Optional {}
impl Written for Addresses {}
impl Written for [u32; 8] {}

impl Written for Everything {
    #[inline(always)]
    fn write(self, out: SliceMut<u32>, at: usize) {
        let Cargo { numbers, nested, floats, matrices, doubles, integers, large, views } = self.cargo;
        let at = write(out, at, (numbers, nested));
        let at = write(out, at, floats);
        let at = write(out, at, matrices);
        let at = write(out, at, doubles);
        let at = write(out, at, integers);
        let at = write(out, at, (large.mat4, large.dmat2));
        let at = write(out, at, large.dmat3);
        let at = write(out, at, large.dmat4);
        let at = write(out, at, large.daffine2);
        let at = write(out, at, large.daffine3);
        let at = write(out, at, (large.i16vec2, (large.i16vec3, large.array)));
        let at = write(out, at, views);
        let at = write(out, at, self.optional);
        write(out, at, self.addresses);
    }
}

/// Words in a row of the output: enough for all there is.
pub const ROW: usize = Everything::COUNT;
