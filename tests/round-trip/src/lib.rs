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
    pub fn put<T: Words>(&self, row: usize, value: T) {
        let mut words = [0; ROW];
        value.store(&mut words[..T::COUNT]);
        let mut i = 0;
        while i < T::COUNT {
            self.out().set((row * ROW + i) as u32, words[i]);
            i += 1;
        }
    }
}

/// Words in a row of the output: enough for all there is.
pub const ROW: usize = Everything::COUNT;
