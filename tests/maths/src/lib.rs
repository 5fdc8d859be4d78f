//! Kernels that measure the error of the device's maths: one fills in arguments, one for each function computes values, one the
//! exact ones in `f64`, and one compares. What makes the PTX of the values makes nothing else of a measurement.
#![cfg_attr(target_arch = "nvptx64", no_std)]

#[cfg(target_arch = "nvptx64")]
mod device;
#[cfg(all(target_arch = "nvptx64", feature = "harness"))]
mod harness;
#[cfg(target_arch = "nvptx64")]
mod library;
#[cfg(not(target_arch = "nvptx64"))]
pub mod table;

/// How an error is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Measure {
    /// In units of the last place that an `f32` has at the true value.
    Ulps,
    /// As the distance from the true value.
    Absolute,
    /// As the distance from the true value, divided by it.
    Relative,
}

/// What one thread found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Worst {
    /// The largest error.
    pub error: f32,
    /// The bits of the arguments that it is at.
    pub at: [u32; 2],
    /// How many results are the `f32` nearest to the true value.
    pub correct: u32,
    /// How many arguments were tried.
    pub tried: u32,
}

impl Worst {
    /// One more result.
    pub fn add(&mut self, measure: Measure, arguments: [f32; 2], value: f32, exact: f64) {
        let error = error(measure, value, exact);
        self.tried += 1;
        self.correct += u32::from(value == exact as f32 || value.is_nan() && exact.is_nan());
        if error > self.error {
            (self.error, self.at) = (error, arguments.map(f32::to_bits));
        }
    }

    /// What another one found as well.
    pub fn merge(&mut self, other: Self) {
        if other.error > self.error {
            (self.error, self.at) = (other.error, other.at);
        }
        self.tried += other.tried;
        self.correct += other.correct;
    }
}

/// The error of `value`. From 2^128 on a number stands for infinity; a NaN in the wrong place is infinitely far.
fn error(measure: Measure, value: f32, exact: f64) -> f32 {
    const LEAST: u64 = (1023 - 126) << 52;
    const GREATEST: u64 = (1023 + 127) << 52;
    const INFINITY: f64 = 340_282_366_920_938_463_463_374_607_431_768_211_456.0;
    if exact.is_nan() || value.is_nan() || exact.is_infinite() {
        let same = exact.is_nan() && value.is_nan() || value as f64 == exact;
        return if same { 0.0 } else { f32::INFINITY };
    }
    let distance = ((value as f64).clamp(-INFINITY, INFINITY) - exact.clamp(-INFINITY, INFINITY)).abs();
    let unit = match measure {
        Measure::Ulps => f64::from_bits((exact.to_bits() & 0x7ff0_0000_0000_0000).clamp(LEAST, GREATEST) - (23 << 52)),
        Measure::Absolute => 1.0,
        Measure::Relative => exact.abs().max(f64::MIN_POSITIVE),
    };
    (distance / unit) as f32
}

/// Numbers where functions are special, of either sign.
const SPECIAL: [f32; 22] = [
    0.0,
    1e-45,
    f32::MIN_POSITIVE,
    1e-20,
    0.1,
    0.333_333_34,
    0.5,
    0.999_999_94,
    1.0,
    1.000_000_1,
    1.5,
    2.0,
    3.0,
    127.0,
    128.0,
    149.0,
    16_777_215.0,
    16_777_216.0,
    1e20,
    f32::MAX,
    f32::INFINITY,
    f32::NAN,
];

/// The pair of arguments of this number: first all pairs of special numbers, then random ones, by turns of any bits, of numbers
/// between 2^-16 and 2^16, and of one near 1 with one between 1 and 2^24, where a power is most sensitive.
pub fn pair(number: u64) -> [f32; 2] {
    const SIGNED: u64 = 2 * SPECIAL.len() as u64;
    if number < SIGNED * SIGNED {
        let special = |i: u64| if i & 1 == 0 { SPECIAL[i as usize / 2] } else { -SPECIAL[i as usize / 2] };
        return [special(number / SIGNED), special(number % SIGNED)];
    }
    // splitmix64
    let hash = number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let hash = (hash ^ hash >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let hash = (hash ^ hash >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    let hash = hash ^ hash >> 31;
    let halves = [hash as u32, (hash >> 32) as u32];
    match number % 3 {
        0 => halves.map(f32::from_bits),
        1 => halves.map(|bits| f32::from_bits(bits & 0x80ff_ffff | 0x3000_0000 | (bits >> 3 & 0x0f00_0000))),
        _ => {
            let near_1 = 0x3f7f_0000 + (halves[0] & 0x1_ffff);
            let exponent = 127 + (halves[1] >> 8) % 24;
            [
                f32::from_bits(near_1),
                f32::from_bits(halves[1] & 0x8000_00ff | (halves[1] & 0x7fff) << 8 | exponent << 23),
            ]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_those_of_the_definition() {
        let ulps = |value, exact| error(Measure::Ulps, value, exact);
        assert_eq!((ulps(1.0, 1.0), ulps(1.0 + f32::EPSILON, 1.0)), (0.0, 1.0));
        assert_eq!((ulps(0.0, f64::from(f32::from_bits(3))), ulps(0.0, 1e-60) < 1e-10), (3.0, true));
        assert_eq!((ulps(f32::INFINITY, 1e300), ulps(f32::NEG_INFINITY, f64::NEG_INFINITY)), (0.0, 0.0));
        assert_eq!((ulps(f32::MAX, 1e300), ulps(f32::MAX, f64::INFINITY)), (1.0, f32::INFINITY));
        assert_eq!((ulps(1.0, 1e300) > 1e6, ulps(f32::NAN, 1.0), ulps(f32::NAN, f64::NAN)), (true, f32::INFINITY, 0.0));
        assert_eq!(error(Measure::Absolute, 3.0, 2.5), 0.5);
    }

    #[test]
    fn pairs_are_special_then_spread() {
        assert_eq!(pair(0), [0.0, 0.0]);
        assert_eq!(pair(44 * 2), [1e-45, 0.0]);
        let exponents = |i: usize, turn: u64| {
            let mut seen = [false; 256];
            (1_000_000..1_030_000)
                .filter(|n| n % 3 == turn)
                .for_each(|n| seen[(pair(n)[i].to_bits() >> 23 & 255) as usize] = true);
            seen.iter().filter(|seen| **seen).count()
        };
        assert_eq!((exponents(0, 0), exponents(1, 0)), (256, 256));
        assert_eq!((exponents(0, 1), exponents(1, 1)), (32, 32));
        assert_eq!((exponents(0, 2), exponents(1, 2)), (2, 24));
    }
}
