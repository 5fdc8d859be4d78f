//! Roots in `f32`.

use super::{fmaf, sqrtf};

/// Square root, correctly rounded (docs/maths.md). The instruction `sqrt.rn` is more code, with a branch to
/// a function for 0 and subnormal numbers that the rest of the warp waits for.
#[inline(always)]
pub fn sqrt_rn(x: f32) -> f32 {
    // By 2^64, so that no rest is subnormal.
    let is_small = x < 3.944_304_5e-31;
    let scaled = if is_small { x * 1.844_674_4e19 } else { x };
    let r = approximate_rsqrt(scaled);
    let half = 0.5 * r;
    let root = scaled * r;
    let rest = fmaf(-root, root, scaled);
    let root = fmaf(rest, half, root);
    let root = if is_small { root * 2.328_306_4e-10 } else { root };
    // Infinite for 0, and 0 for infinity.
    if r == half { scaled } else { root }
}

/// 1/sqrt(x) within 2^-22.9 of it, subnormal numbers taken for 0.
#[cfg(target_arch = "nvptx64")]
#[inline(always)]
fn approximate_rsqrt(x: f32) -> f32 {
    let bits: u32;
    // SAFETY: arithmetic.
    unsafe {
        core::arch::asm!(
            "{{ .reg .f32 f; mov.b32 f, {x}; rsqrt.approx.ftz.f32 f, f; mov.b32 {y}, f; }}",
            x = in(reg32) x.to_bits(),
            y = out(reg32) bits,
            options(pure, nomem, nostack, preserves_flags)
        )
    };
    f32::from_bits(bits)
}

/// The worst that the instruction does.
#[cfg(not(target_arch = "nvptx64"))]
fn approximate_rsqrt(x: f32) -> f32 {
    let error = if x.to_bits() & 1 == 0 { 1.25e-7 } else { -1.25e-7 };
    ((1.0 + error) / f64::from(x).sqrt()) as f32
}

/// Cube root. Error below 0.6 ulp (docs/maths.md).
#[inline(always)]
pub fn cbrtf(x: f32) -> f32 {
    let a = x.abs();
    if !(a > 0.0 && a < f32::INFINITY) {
        return x;
    }
    // By 2^96, so that nothing below is subnormal.
    let is_small = a < 1e-20;
    let a = if is_small { a * 7.922_816_3e28 } else { a };
    // A third of the exponent is a third of the bits: 1/cbrt(a) within 4 per cent. Each step squares the error.
    let mut r = f32::from_bits(0x54a2_1d2a - a.to_bits() / 3);
    for _ in 0..3 {
        let error = fmaf(-a * r, r * r, 1.0);
        r = fmaf(r, error * (1.0 / 3.0), r);
    }
    let root = a * (r * r);
    // What the cube misses, to first order.
    let square = root * root;
    let square_rest = fmaf(root, root, -square);
    let missing = fmaf(-root, square_rest, fmaf(-root, square, a));
    let root = fmaf(missing * (1.0 / 3.0), r * r, root);
    (if is_small { root * 2.328_306_4e-10 } else { root }).copysign(x)
}

/// The length of the vector `(x, y)`. Error below 0.8 ulp, and 0.6 where it is not subnormal (docs/maths.md).
#[inline(always)]
pub fn hypotf(x: f32, y: f32) -> f32 {
    let (a, b) = (x.abs(), y.abs());
    let (large, small) = if a >= b { (a, b) } else { (b, a) };
    if large == f32::INFINITY || small == f32::INFINITY {
        return f32::INFINITY;
    }
    // Squares neither overflow nor vanish.
    let (scale, back) = if large > 1e18 {
        (8.271_806e-25, 1.208_925_8e24)
    } else if large < 1e-18 {
        (1.208_925_8e24, 8.271_806e-25)
    } else {
        (1.0, 1.0)
    };
    let (large, small) = (large * scale, small * scale);
    let square = large * large;
    let square_rest = fmaf(large, large, -square);
    let sum = fmaf(small, small, square);
    let sum_rest = fmaf(small, small, square - sum) + square_rest;
    let root = sqrtf(sum);
    let root = if root > 0.0 { root + (fmaf(-root, root, sum) + sum_rest) * (0.5 / root) } else { root + small };
    root * back
}
