//! Hyperbolic functions in `f32`, and the inverse of the cosine within its domain.

use super::exp::{expf, scaled_exp};
use super::fmaf;

/// (sinh(r) - r) / r^3 on |r| <= 1 and (tanh(r) - r) / r^3 on |r| <= 0.6, as polynomials of r^2; minimax.
const SINH: [f32; 4] = [0.166_666_67, 0.008_333_31, 0.000_198_428_91, 2.782_267e-6];
const TANH: [f32; 6] = [-0.333_333_3, 0.133_332_3, -0.053_950_02, 0.021_719_87, -0.008_227_973, 0.002_192_140_8];

/// Hyperbolic sine. Error below 1.7 ulp (docs/maths.md).
#[inline(always)]
pub fn sinhf(x: f32) -> f32 {
    let a = x.abs();
    let value = if a <= 1.0 {
        let z = a * a;
        let p = fmaf(fmaf(fmaf(SINH[3], z, SINH[2]), z, SINH[1]), z, SINH[0]);
        fmaf(p, z * a, a)
    } else {
        let half = scaled_exp(a, -1);
        half - 0.25 / half
    };
    value.copysign(x)
}

/// Hyperbolic cosine. Error below 1.5 ulp (docs/maths.md).
#[inline(always)]
pub fn coshf(x: f32) -> f32 {
    let half = scaled_exp(x.abs(), -1);
    half + 0.25 / half
}

/// Hyperbolic tangent. Error below 1.5 ulp (docs/maths.md).
#[inline(always)]
pub fn tanhf(x: f32) -> f32 {
    let a = x.abs();
    let value = if a <= 0.6 {
        let z = a * a;
        let mut p = TANH[5];
        p = fmaf(p, z, TANH[4]);
        p = fmaf(p, z, TANH[3]);
        p = fmaf(p, z, TANH[2]);
        p = fmaf(p, z, TANH[1]);
        p = fmaf(p, z, TANH[0]);
        fmaf(p, z * a, a)
    } else {
        1.0 - 2.0 / (expf(a + a) + 1.0)
    };
    value.copysign(x)
}

/// Inverse hyperbolic cosine. The original cancels at large negative numbers, and has a value of what is left.
#[inline(always)]
pub fn acoshf(x: f32) -> f32 {
    if x < 1.0 { f32::NAN } else { software::acoshf(x) }
}

/// Inverse hyperbolic cosine of an `f64`, as [`acoshf`].
#[inline(always)]
pub fn acosh(x: f64) -> f64 {
    if x < 1.0 { f64::NAN } else { software::acosh(x) }
}
