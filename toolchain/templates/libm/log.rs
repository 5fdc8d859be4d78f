//! Logarithms and powers in `f32`.

use super::exp::{LN2, exp2_of_sum};
use super::fmaf;

/// (ln(1 + f) - f) / f^2 on |f| <= 1/3, the same for the logarithms of base 2 and 10; minimax, adding 0.08 ulp.
const LN: [f32; 9] = [
    -0.5,
    0.333_332_15,
    -0.249_997_99,
    0.200_104_5,
    -0.166_804_42,
    0.140_051_83,
    -0.121_848_13,
    0.139_877,
    -0.128_895_82,
];
const LOG2: [f32; 9] = [
    -0.721_347_5,
    0.480_896_7,
    -0.360_671_5,
    0.288_686_57,
    -0.240_633_76,
    0.202_096_64,
    -0.175_921_13,
    0.201_606_26,
    -0.185_522_48,
];
const LOG10: [f32; 9] = [
    -0.217_147_25,
    0.144_764_29,
    -0.108_572_41,
    0.086_905_39,
    -0.072_449_96,
    0.060_808_52,
    -0.052_844_908,
    0.060_813_304,
    -0.056_224_55,
];

/// 1/ln 2, 1/ln 10 and lg 2 in two parts; lg 2's first has 15 digits, so that its product with an exponent is exact.
const LOG2_E: [f32; 2] = [core::f32::consts::LOG2_E, 1.925_963e-8];
const LOG10_E: [f32; 2] = [core::f32::consts::LOG10_E, -1.010_305e-8];
const LOG10_2: [f32; 2] = [0.301_025_4, 4.605_039e-6];

/// Natural logarithm. Error below 1 ulp (docs/maths.md).
#[inline(always)]
pub fn logf(x: f32) -> f32 {
    let (e, f) = split(x);
    let tail = fmaf(e, LN2[1], polynomial(&LN, f) * (f * f));
    special(x, sum(e * LN2[0], f, tail))
}

/// Logarithm of base 2. Error below 1.1 ulp (docs/maths.md).
#[inline(always)]
pub fn log2f(x: f32) -> f32 {
    let (e, f) = split(x);
    // By `fmaf`: a product may be contracted, and is then not the number whose rest is in `tail`.
    let head = fmaf(f, LOG2_E[0], 0.0);
    let tail = fmaf(f, LOG2_E[0], -head) + fmaf(f, LOG2_E[1], polynomial(&LOG2, f) * (f * f));
    special(x, sum(e, head, tail))
}

/// Logarithm of base 10. Error below 1.3 ulp (docs/maths.md).
#[inline(always)]
pub fn log10f(x: f32) -> f32 {
    let (e, f) = split(x);
    let head = fmaf(f, LOG10_E[0], 0.0);
    let tail = fmaf(f, LOG10_E[0], -head) + fmaf(f, LOG10_E[1], polynomial(&LOG10, f) * (f * f));
    special(x, sum(e * LOG10_2[0], head, fmaf(e, LOG10_2[1], tail)))
}

/// `x` to the power `y`. Error below 1.3 ulp (docs/maths.md).
#[inline(always)]
pub fn powf(x: f32, y: f32) -> f32 {
    let (head, tail) = log2_twofold(x.abs());
    let product = y * head;
    // Beyond 200 the result is 0 or infinite.
    let (exponent, rest) = if product.abs() <= 200.0 {
        (product, fmaf(y, tail, fmaf(y, head, -product)))
    } else if product.is_nan() {
        (product, 0.0)
    } else {
        (200f32.copysign(product), 0.0)
    };
    let power = exp2_of_sum(exponent, rest);
    // Even from 2^24 on.
    let is_integer = y.abs() >= 16_777_216.0 || (y as i32) as f32 == y;
    let is_odd = y.abs() < 16_777_216.0 && is_integer && (y as i32) & 1 == 1;
    let signed = if is_odd { power.copysign(x) } else { power };
    let is_bad = x < 0.0 && !is_integer && x != f32::NEG_INFINITY;
    if x == 1.0 || y == 0.0 || x == -1.0 && y.abs() == f32::INFINITY {
        1.0
    } else if is_bad || x.is_nan() || y.is_nan() {
        f32::NAN
    } else {
        signed
    }
}

/// `x` as `2^e * (1 + f)` with `|f| <= 1/3`.
#[inline(always)]
fn split(x: f32) -> (f32, f32) {
    let is_subnormal = x < f32::MIN_POSITIVE;
    let x = if is_subnormal { x * 8_388_608.0 } else { x };
    // From 2/3 on.
    let e = ((x.to_bits() as i32).wrapping_sub(0x3f2a_aaab)) & !0x007f_ffff;
    let f = f32::from_bits((x.to_bits() as i32).wrapping_sub(e) as u32) - 1.0;
    ((e >> 23) as f32 - if is_subnormal { 23.0 } else { 0.0 }, f)
}

/// `a + b + tail`, where `a` is 0 or greater than `b`.
#[inline(always)]
fn sum(a: f32, b: f32, tail: f32) -> f32 {
    let sum = a + b;
    sum + ((a - sum) + b + tail)
}

#[inline(always)]
fn polynomial(c: &[f32; 9], f: f32) -> f32 {
    let mut p = c[8];
    p = fmaf(p, f, c[7]);
    p = fmaf(p, f, c[6]);
    p = fmaf(p, f, c[5]);
    p = fmaf(p, f, c[4]);
    p = fmaf(p, f, c[3]);
    p = fmaf(p, f, c[2]);
    p = fmaf(p, f, c[1]);
    fmaf(p, f, c[0])
}

/// `log`, which holds for a positive finite `x`, or what belongs to another.
#[inline(always)]
fn special(x: f32, log: f32) -> f32 {
    if x > 0.0 && x < f32::INFINITY {
        log
    } else if x == 0.0 {
        f32::NEG_INFINITY
    } else if x > 0.0 {
        x
    } else {
        f32::NAN
    }
}

/// The logarithm of base 2 of `x >= 0` as a sum of two numbers, within 2^-33 of it; infinite for 0 and infinity.
///
/// With `s = f / (2 + f)` it is `e + 2/ln 2 * (s + s^3/3 + s^5/5 ..)`; all but the last terms are done in two parts.
#[inline(always)]
fn log2_twofold(x: f32) -> (f32, f32) {
    const C: [f32; 2] = [2.885_39, 3.851_926e-8];
    const C_3: [f32; 2] = [0.961_796_7, -7.028_462e-9];
    const TAIL: [f32; 3] = [0.577_080_3, 0.411_837_94, 0.338_105_95];
    let (e, f) = split_at_root(x);
    let q = 2.0 + f;
    let q_rest = f - (q - 2.0);
    let s = f / q;
    let s_rest = fmaf(-s, q_rest, fmaf(-s, q, f)) / q;

    let z = s * s;
    let z_rest = fmaf(s + s, s_rest, fmaf(s, s, -z));
    let tail = z * fmaf(fmaf(TAIL[2], z, TAIL[1]), z, TAIL[0]);
    // u = C/3 + tail
    let u = C_3[0] + tail;
    let u_rest = (C_3[0] - u) + tail + C_3[1];
    // v = z * u
    let v = z * u;
    let v_rest = fmaf(z, u_rest, fmaf(z_rest, u, fmaf(z, u, -v)));
    // w = C + v
    let w = C[0] + v;
    let w_rest = (C[0] - w) + v + v_rest + C[1];
    // l = s * w
    let l = s * w;
    let l_rest = fmaf(s, w_rest, fmaf(s_rest, w, fmaf(s, w, -l)));
    // e + l
    let sum = e + l;
    let rest = (e - sum) + l + l_rest;
    let head = sum + rest;
    if x == 0.0 {
        (f32::NEG_INFINITY, 0.0)
    } else if x == f32::INFINITY {
        (x, 0.0)
    } else {
        (head, (sum - head) + rest)
    }
}

/// `x` as `2^e * (1 + f)` with `1 + f` from the root of 1/2 to the root of 2.
#[inline(always)]
fn split_at_root(x: f32) -> (f32, f32) {
    let is_subnormal = x < f32::MIN_POSITIVE;
    let x = if is_subnormal { x * 8_388_608.0 } else { x };
    let e = ((x.to_bits() as i32).wrapping_sub(0x3f35_04f3)) & !0x007f_ffff;
    let f = f32::from_bits((x.to_bits() as i32).wrapping_sub(e) as u32) - 1.0;
    ((e >> 23) as f32 - if is_subnormal { 23.0 } else { 0.0 }, f)
}
