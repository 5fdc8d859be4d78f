//! Sine and cosine in `f32` arithmetic.
//!
//! The original computes both in `f64`, at which a GPU is 32 to 64 times slower. Here the argument is reduced by a
//! multiple of pi/2 in three parts, and a polynomial gives the result.
//!
//! Error, found by trying every `f32` up to [`LIMIT`] in magnitude: below 1.6 ulp for both. Larger arguments, infinities
//! and NaN go to the original.

use super::{fmaf, software};

/// The greatest magnitude that is reduced here.
///
/// The quotient's rounding makes the reduced argument exceed pi/4 by up to `2^-24 * LIMIT`, 0.4 per cent, and the
/// polynomials hold for 0.8.
const LIMIT: f32 = 65_536.0;

/// pi/2 as a sum of parts rounded down, so that each is positive and -0 reduces to -0. The first is a multiple of 2^-23,
/// and so its product is subtracted without rounding.
const HALF_PI: [f32; 3] = [1.570_796_3, 7.549_789_4e-8, 5.390_302_5e-15];

/// (sin(r) - r) / r^3 and (cos(r) - 1 + r^2/2) / r^4 as polynomials of r^2: minimax for relative error on |r| <= 0.8, where
/// they add 0.04 and 0.001 ulp.
const SIN: [f32; 3] = [-0.166_666_54, 0.008_332_071, -0.000_195_030_69];
const COS: [f32; 3] = [0.041_666_64, -0.001_388_719_4, 2.441_919_6e-5];

/// `(sin(x), cos(x))`, `x` in radians.
#[inline(always)]
pub fn sincosf(x: f32) -> (f32, f32) {
    // Also true for a NaN.
    if !(x.abs() <= LIMIT) {
        return original(x);
    }
    // Adding 1.5 * 2^23 rounds to an integer, which is then in the low bits.
    const ROUND: f32 = 12_582_912.0;
    let rounded = fmaf(x, core::f32::consts::FRAC_2_PI, ROUND);
    let quadrant = rounded.to_bits();
    let n = rounded - ROUND;
    let r = fmaf(n, -HALF_PI[0], x);
    let r = fmaf(n, -HALF_PI[1], r);
    let r = fmaf(n, -HALF_PI[2], r);

    let r2 = r * r;
    let sin = fmaf(fmaf(SIN[2], r2, SIN[1]), r2, SIN[0]);
    // The zero keeps sin(-0) a -0.
    let sin = fmaf(sin, fmaf(r2, r, 0.0), r);
    let cos = fmaf(fmaf(COS[2], r2, COS[1]), r2, COS[0]);
    let cos = fmaf(fmaf(cos, r2, -0.5), r2, 1.0);

    // Each quadrant turns (sin, cos) into (cos, -sin).
    let (sin, cos) = if quadrant & 1 == 0 {
        (sin, cos)
    } else {
        (cos, sin)
    };
    let negate = |value: f32, by: u32| f32::from_bits(value.to_bits() ^ ((by & 2) << 30));
    (negate(sin, quadrant), negate(cos, quadrant.wrapping_add(1)))
}

/// `sin(x)`, `x` in radians.
#[inline(always)]
pub fn sinf(x: f32) -> f32 {
    sincosf(x).0
}

/// `cos(x)`, `x` in radians.
#[inline(always)]
pub fn cosf(x: f32) -> f32 {
    sincosf(x).1
}

/// Kept out of line: it is large, and next to never called.
#[cold]
#[inline(never)]
fn original(x: f32) -> (f32, f32) {
    software::sincosf(x)
}
