//! Sine and cosine in `f32` and integer arithmetic.
//!
//! The original computes both in `f64`, at which a GPU is 32 to 64 times slower. Here the argument is reduced by a
//! multiple of pi/2, and a polynomial gives the result.
//!
//! Error, for every finite argument: below 1.6 ulp for both, found by trying every `f32`.

use super::fmaf;

/// The greatest magnitude that the fast reduction takes.
///
/// The quotient's rounding makes the reduced argument exceed pi/4 by up to `2^-24 * LIMIT`, 0.4 per cent, and the
/// polynomials hold for 0.8.
const LIMIT: f32 = 65_536.0;

/// pi/2 as a sum of parts rounded down, so that each is positive and -0 reduces to -0. The first is a multiple of 2^-23,
/// and so its product is subtracted without rounding.
#[allow(clippy::approx_constant, reason = "the constant is rounded up")]
const HALF_PI: [f32; 3] = [1.570_796_3, 7.549_789_4e-8, 5.390_302_5e-15];

/// 2/pi: 32 binary digits before the point, and 224 after it.
const TWO_OVER_PI: [u32; 8] =
    [0, 0xa2f9_836e, 0x4e44_1529, 0xfc27_57d1, 0xf534_ddc0, 0xdb62_9599, 0x3c43_9041, 0xfe51_63ab];

/// (sin(r) - r) / r^3 and (cos(r) - 1 + r^2/2) / r^4 as polynomials of r^2: minimax for relative error on |r| <= 0.8, where
/// they add 0.04 and 0.001 ulp.
const SIN: [f32; 3] = [-0.166_666_54, 0.008_332_071, -0.000_195_030_69];
const COS: [f32; 3] = [0.041_666_64, -0.001_388_719_4, 2.441_919_6e-5];

/// `(sin(x), cos(x))`, `x` in radians.
#[inline(always)]
pub fn sincosf(x: f32) -> (f32, f32) {
    // Not true for a NaN.
    let (quadrant, r) = if x.abs() <= LIMIT { reduce(x) } else { reduce_large(x) };

    let r2 = r * r;
    let sin = fmaf(fmaf(SIN[2], r2, SIN[1]), r2, SIN[0]);
    // The zero keeps sin(-0) a -0.
    let sin = fmaf(sin, fmaf(r2, r, 0.0), r);
    let cos = fmaf(fmaf(COS[2], r2, COS[1]), r2, COS[0]);
    let cos = fmaf(fmaf(cos, r2, -0.5), r2, 1.0);

    // Each quadrant turns (sin, cos) into (cos, -sin).
    let (sin, cos) = if quadrant & 1 == 0 { (sin, cos) } else { (cos, sin) };
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

/// (tan(r) - r) / r^3 as a polynomial of r^2, on |r| <= 0.8.
const TAN: [f32; 7] =
    [0.333_333_55, 0.133_324_68, 0.054_082_677, 0.021_162_005, 0.011_152_945, -0.000_318_390_5, 0.004_579_930_6];

/// `tan(x)`, `x` in radians. Error below 3.1 ulp (docs/maths.md).
#[inline(always)]
pub fn tanf(x: f32) -> f32 {
    let (quadrant, r) = if x.abs() <= LIMIT { reduce(x) } else { reduce_large(x) };
    let r2 = r * r;
    let mut p = TAN[6];
    p = fmaf(p, r2, TAN[5]);
    p = fmaf(p, r2, TAN[4]);
    p = fmaf(p, r2, TAN[3]);
    p = fmaf(p, r2, TAN[2]);
    p = fmaf(p, r2, TAN[1]);
    p = fmaf(p, r2, TAN[0]);
    let tan = fmaf(p, r2 * r, r);
    if quadrant & 1 == 0 { tan } else { -1.0 / tan }
}

/// `x` as a multiple of pi/2, of which the low two bits matter, plus the rest.
#[inline(always)]
fn reduce(x: f32) -> (u32, f32) {
    // Adding 1.5 * 2^23 rounds to an integer, which is then in the low bits.
    const ROUND: f32 = 12_582_912.0;
    let rounded = fmaf(x, core::f32::consts::FRAC_2_PI, ROUND);
    let n = rounded - ROUND;
    let r = fmaf(n, -HALF_PI[0], x);
    let r = fmaf(n, -HALF_PI[1], r);
    (rounded.to_bits(), fmaf(n, -HALF_PI[2], r))
}

/// The same for what is greater than [`LIMIT`], infinite or a NaN, after Payne and Hanek: `|x|` is `m * 2^e` with a 24-bit
/// integer `m`, and of the product with 2/pi only 96 digits matter: those before count whole turns, those behind them
/// add less than 2^-70. Kept out of line, because it is next to never called.
#[cold]
#[inline(never)]
fn reduce_large(x: f32) -> (u32, f32) {
    if !x.is_finite() {
        return (0, f32::NAN);
    }
    let bits = x.to_bits();
    let m = u64::from(bits & 0x007f_ffff | 0x0080_0000);
    // The first digit that counts is the one that `m * 2^e` brings to weight 2. `e` is at least -7 here.
    let first = ((bits >> 23) & 0xff) + 30 - 150;
    let (word, shift) = (first / 32, first % 32);
    // The masks do nothing, except to spare a bounds check.
    let digits = |i: u32| {
        let pair = |i: u32| u64::from(TWO_OVER_PI[(i & 7) as usize]);
        ((pair(word + i) << 32 | pair(word + i + 1)) << shift) >> 32
    };
    let low = m * digits(2);
    let middle = m * digits(1) + (low >> 32);
    let high = m * digits(0) + (middle >> 32);

    // 2 binary digits of the quadrant, then the fraction, which becomes a signed one of at most a half.
    let quadrant = (high as u32) >> 30;
    let fraction = high << 34 | (middle & 0xffff_ffff) << 2 | (low & 0xffff_ffff) >> 30;
    let quadrant = quadrant.wrapping_add((fraction >> 63) as u32);
    let fraction = fraction as i64;
    // To f32 in two parts, times pi/2.
    const UNIT: f32 = 1.0 / 18_446_744_073_709_551_616.0;
    let head = fraction as f32;
    let tail = fraction.wrapping_sub(head as i64) as f32;
    let (head, tail) = (head * UNIT, tail * UNIT);
    let r = fmaf(head, HALF_PI[0], fmaf(head, HALF_PI[1], tail * HALF_PI[0]));
    if x < 0.0 { (quadrant.wrapping_neg(), -r) } else { (quadrant, r) }
}
