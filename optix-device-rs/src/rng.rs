//! Random numbers in registers.

use crate::words::Words;
use glam::Vec2;

/// PCG32 (O'Neill 2014, pcg-random.org): 64 bits of state, one stream for each `sequence`.
///
/// ```
/// use optix_device_rs::rng::Pcg32;
/// let mut rng = Pcg32::new(42, 54);
/// assert_eq!(rng.next_u32(), 0xa15c02b7); // the reference implementation's first output for this seed
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pcg32 {
    state: u64,
    increment: u64,
}

impl Pcg32 {
    const MULTIPLIER: u64 = 6_364_136_223_846_793_005;

    /// The generator of `seed` in stream `sequence`.
    #[inline(always)]
    pub const fn new(seed: u64, sequence: u64) -> Self {
        let increment = sequence << 1 | 1;
        let state = seed.wrapping_add(increment);
        Self { state: state.wrapping_mul(Self::MULTIPLIER).wrapping_add(increment), increment }
    }

    /// The generator for item `index` (a pixel's sample, say) of a family chosen by `seed`.
    ///
    /// The index is hashed (SplitMix64's finaliser, Steele et al. 2014), since sequences whose seeds differ in a few bits
    /// begin alike.
    #[inline(always)]
    pub const fn hashed(index: u64, seed: u64) -> Self {
        let z = (index ^ (index >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        Self::new(z ^ (z >> 31), seed)
    }

    /// The next 32 bits.
    #[inline(always)]
    pub const fn next_u32(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(Self::MULTIPLIER).wrapping_add(self.increment);
        ((((old >> 18) ^ old) >> 27) as u32).rotate_right((old >> 59) as u32)
    }

    /// Uniform in [0, 1), a multiple of 2^-24: every value is exact in `f32` and 1 never comes.
    #[inline(always)]
    pub const fn next_f32(&mut self) -> f32 {
        (self.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    /// Two uniform numbers in [0, 1).
    #[inline(always)]
    pub const fn next_vec2(&mut self) -> Vec2 {
        let x = self.next_f32();
        Vec2::new(x, self.next_f32())
    }
}

impl Words for Pcg32 {
    const COUNT: usize = 4;
    #[inline(always)]
    fn store(self, words: &mut [u32]) {
        [self.state, self.increment].store(words);
    }
    #[inline(always)]
    unsafe fn load(words: &[u32]) -> Self {
        // SAFETY: `store` wrote the array.
        let [state, increment] = unsafe { Words::load(words) };
        Self { state, increment }
    }
}
