//! Exponentials in `f32`.

use super::fmaf;

/// ln 2: 15 digits, whose product with an integer below 512 is exact, and the rest.
pub(super) const LN2: [f32; 2] = [0.693_145_75, 1.428_606_8e-6];

/// (e^r - 1 - r) / r^2 on |r| <= 0.35, and (2^r - 1 - r ln 2) / r^2 on |r| <= 0.505; minimax, adding 0.06 ulp.
const EXP: [f32; 5] = [0.499_999_94, 0.166_665_17, 0.041_668_285, 0.008_369_25, 0.001_382_046_8];
const EXP2: [f32; 5] = [0.240_226_48, 0.055_503_607, 0.009_618_509, 0.001_339_112_6, 0.000_153_268_24];

/// Adding it rounds to an integer, which is then in the low bits.
const ROUND: f32 = 12_582_912.0;

/// e^x. Error below 1.1 ulp (docs/maths.md).
#[inline(always)]
pub fn expf(x: f32) -> f32 {
    scaled_exp(x, 0)
}

/// `e^x * 2^scale` for a scale of 0 or -1.
#[inline(always)]
pub(super) fn scaled_exp(x: f32, scale: i32) -> f32 {
    let x = clamped(x, 110.0);
    let rounded = fmaf(x, core::f32::consts::LOG2_E, ROUND);
    let n = rounded - ROUND;
    let r = fmaf(n, -LN2[1], fmaf(n, -LN2[0], x));
    let p = fmaf(polynomial(EXP, r), r * r, r) + 1.0;
    times_power_of_2(p, integer(rounded) + scale)
}

/// 2^x. Error below 0.9 ulp (docs/maths.md).
#[inline(always)]
pub fn exp2f(x: f32) -> f32 {
    exp2_of_sum(clamped(x, 160.0), 0.0)
}

/// `2^(x + tail)` for |x| <= 200 and a tail that is small beside it.
#[inline(always)]
pub(super) fn exp2_of_sum(x: f32, tail: f32) -> f32 {
    let rounded = x + ROUND;
    let r = (x - (rounded - ROUND)) + tail;
    let p = fmaf(r, core::f32::consts::LN_2, polynomial(EXP2, r) * (r * r)) + 1.0;
    times_power_of_2(p, integer(rounded))
}

/// 10^x. Error below 1.3 ulp (docs/maths.md).
#[inline(always)]
pub fn exp10f(x: f32) -> f32 {
    // lg 2 as ln 2 above, and ln 10 in two parts.
    const LG2: [f32; 2] = [0.301_025_4, 4.605_039e-6];
    const LN10: [f32; 2] = [core::f32::consts::LN_10, -3.197_537_6e-8];
    let x = clamped(x, 50.0);
    let rounded = fmaf(x, core::f32::consts::LOG2_10, ROUND);
    let n = rounded - ROUND;
    let r = fmaf(n, -LG2[1], fmaf(n, -LG2[0], x));
    let r = fmaf(r, LN10[0], r * LN10[1]);
    let p = fmaf(polynomial(EXP, r), r * r, r) + 1.0;
    times_power_of_2(p, integer(rounded))
}

/// `x` within the limits beyond which the result is 0 or infinite anyway; a NaN stays one.
#[inline(always)]
fn clamped(x: f32, limit: f32) -> f32 {
    if x > limit {
        limit
    } else if x < -limit {
        -limit
    } else {
        x
    }
}

#[inline(always)]
fn polynomial(c: [f32; 5], r: f32) -> f32 {
    fmaf(fmaf(fmaf(fmaf(c[4], r, c[3]), r, c[2]), r, c[1]), r, c[0])
}

/// The integer that [`ROUND`] was added to.
#[inline(always)]
fn integer(rounded: f32) -> i32 {
    (rounded.to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32)
}

/// `p * 2^n` for |n| <= 252, rounded once: by two powers, the first of which leaves `p` a normal number.
#[inline(always)]
fn times_power_of_2(p: f32, n: i32) -> f32 {
    let power = |n: i32| f32::from_bits((n.wrapping_add(127) as u32) << 23);
    let half = n >> 1;
    p * power(half) * power(n.wrapping_sub(half))
}
