//! Inverse trigonometric functions in `f32`.

use super::{fmaf, sqrtf};

/// pi/2 and pi in two parts.
const HALF_PI: [f32; 2] = [core::f32::consts::FRAC_PI_2, -4.371_139e-8];
const PI: [f32; 2] = [core::f32::consts::PI, -8.742_278e-8];

/// (atan(r) - r) / r^3 on |r| <= 1 and (asin(r) - r) / r^3 on |r| <= 1/2, as polynomials of r^2; minimax, adding 0.05 ulp.
const ATAN: [f32; 9] = [
    -0.333_333,
    0.199_985_34,
    -0.142_641_02,
    0.109_515_06,
    -0.084_015_82,
    0.057_927_23,
    -0.031_148_937,
    0.010_899_697,
    -0.001_790_405_8,
];
const ASIN: [f32; 6] = [0.166_666_6, 0.075_005_21, 0.044_513_587, 0.031_836_998, 0.014_323_436, 0.037_684_295];

/// Arctangent. Error below 1.5 ulp (docs/maths.md).
#[inline(always)]
pub fn atanf(x: f32) -> f32 {
    let a = x.abs();
    let is_steep = a > 1.0;
    let r = atan_below_1(if is_steep { 1.0 / a } else { a });
    (if is_steep { (HALF_PI[0] - r) + HALF_PI[1] } else { r }).copysign(x)
}

/// The angle of the vector `(x, y)` from the x axis. Error below 2 ulp (docs/maths.md).
#[inline(always)]
pub fn atan2f(y: f32, x: f32) -> f32 {
    let (a, b) = (x.abs(), y.abs());
    let is_steep = b > a;
    let (small, large) = if is_steep { (a, b) } else { (b, a) };
    // 0 / 0 counts as 0, and inf / inf as 1; a NaN stays.
    let tangent = if small == large && (large == 0.0 || large == f32::INFINITY) {
        if large == 0.0 { 0.0 } else { 1.0 }
    } else {
        small / large
    };
    let r = atan_below_1(tangent);
    let r = if is_steep { (HALF_PI[0] - r) + HALF_PI[1] } else { r };
    let r = if x.is_sign_negative() { (PI[0] - r) + PI[1] } else { r };
    if a.is_nan() || b.is_nan() { f32::NAN } else { r.copysign(y) }
}

#[inline(always)]
fn atan_below_1(r: f32) -> f32 {
    let z = r * r;
    let mut p = ATAN[8];
    p = fmaf(p, z, ATAN[7]);
    p = fmaf(p, z, ATAN[6]);
    p = fmaf(p, z, ATAN[5]);
    p = fmaf(p, z, ATAN[4]);
    p = fmaf(p, z, ATAN[3]);
    p = fmaf(p, z, ATAN[2]);
    p = fmaf(p, z, ATAN[1]);
    p = fmaf(p, z, ATAN[0]);
    fmaf(p, z * r, r)
}

/// Arcsine. Error below 1.9 ulp (docs/maths.md).
#[inline(always)]
pub fn asinf(x: f32) -> f32 {
    let a = x.abs();
    let angle = if a <= 0.5 {
        asin_below_half(a, a * a)
    } else {
        let z = fmaf(a, -0.5, 0.5);
        fmaf(asin_below_half(sqrtf(z), z), -2.0, HALF_PI[0]) + HALF_PI[1]
    };
    angle.copysign(x)
}

/// Arccosine. Error below 1.5 ulp (docs/maths.md).
#[inline(always)]
pub fn acosf(x: f32) -> f32 {
    let a = x.abs();
    if a <= 0.5 {
        HALF_PI[0] - (asin_below_half(x, x * x) - HALF_PI[1])
    } else {
        let z = fmaf(a, -0.5, 0.5);
        let angle = 2.0 * asin_below_half(sqrtf(z), z);
        if x > 0.0 { angle } else { (PI[0] - angle) + PI[1] }
    }
}

/// `asin(r)`, given `z = r^2`.
#[inline(always)]
fn asin_below_half(r: f32, z: f32) -> f32 {
    let mut p = ASIN[5];
    p = fmaf(p, z, ASIN[4]);
    p = fmaf(p, z, ASIN[3]);
    p = fmaf(p, z, ASIN[2]);
    p = fmaf(p, z, ASIN[1]);
    p = fmaf(p, z, ASIN[0]);
    fmaf(p, z * r, r)
}
