//! Less precise functions, of one or two of the device's special instructions each: what `nvcc --use_fast_math` makes of
//! `sinf` and the like.
//!
//! The stated errors are NVIDIA's for the instructions (PTX ISA). On the host these are the precise functions of
//! [`Math`], so results on the two machines differ by the errors that are stated.
//!
//! ```
//! use optix_device_rs::math::fast;
//! assert!((fast::sin(0.5) - 0.479_425_54).abs() < 1e-6);
//! ```

#[cfg(not(target_arch = "nvptx64"))]
use super::Math;

macro_rules! instructions {
    ($($(#[$doc:meta])* $name:ident = $host:expr;)*) => {$(
        $(#[$doc])*
        #[inline(always)]
        pub fn $name(x: f32) -> f32 {
            #[cfg(target_arch = "nvptx64")]
            return crate::intrinsics::approximate::$name(x);
            #[cfg(not(target_arch = "nvptx64"))]
            return $host(x);
        }
    )*};
}

instructions! {
    /// Sine of `x` radians: within 2^-20.5 of it for |x| <= 2 pi, and 2^-14.7 for |x| <= 100 pi.
    sin = Math::sin;
    /// Cosine of `x` radians: within 2^-20.4 of it (measured) for |x| <= 2 pi, and 2^-14.7 for |x| <= 100 pi.
    cos = Math::cos;
    /// 2^x: relative error below 2^-22.
    exp2 = Math::exp2;
    /// Logarithm of base 2: within 2^-22 of it for `x` from 1/2 to 2, relative error below 2^-22 elsewhere.
    log2 = Math::log2;
    /// 1/x: within 1 ulp.
    recip = f32::recip;
    /// Square root: relative error below 2^-23.
    sqrt = Math::sqrt;
    /// 1/sqrt(x): relative error below 2^-22.9.
    rsqrt = |x: f32| 1.0 / Math::sqrt(x);
}

/// Tangent of `x` radians: [`sin`] by [`cos`], so of no use near the cosine's zeros.
#[inline(always)]
pub fn tan(x: f32) -> f32 {
    sin(x) * recip(cos(x))
}

/// e^x: relative error below 2^-22 and what rounding `x log2(e)` adds, 2^-24 of |x|.
#[inline(always)]
pub fn exp(x: f32) -> f32 {
    exp2(x * core::f32::consts::LOG2_E)
}

/// Natural logarithm: [`log2`] with one more rounding.
#[inline(always)]
pub fn ln(x: f32) -> f32 {
    log2(x) * core::f32::consts::LN_2
}

/// Logarithm of base 10: [`log2`] with one more rounding.
#[inline(always)]
pub fn log10(x: f32) -> f32 {
    log2(x) * core::f32::consts::LOG10_2
}

/// Hyperbolic tangent: within 2^-20 of it. (`tanh.approx` is within 2^-11, and no part of PTX 6.3.)
#[inline(always)]
pub fn tanh(x: f32) -> f32 {
    1.0 - 2.0 * recip(exp(x + x) + 1.0)
}

/// `x` to the power `y`, for `x >= 0`: the relative error grows with `|y log2(x)|`, by about 2^-22 of it.
#[inline(always)]
pub fn powf(x: f32, y: f32) -> f32 {
    exp2(y * log2(x))
}
