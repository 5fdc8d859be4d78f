//! `libm` for the device: what the machine has an instruction for is that instruction; the elementary functions of `f32`
//! are computed in `f32`, at which a GPU is 32 to 64 times faster than at `f64`; the rest is the original.
//!
//! Errors are stated for correctly rounded division and square root. `fmaf` stands where a bound needs it, so they hold
//! whether or not the compiler contracts the other operations.
#![no_std]
#![feature(core_float_math)]
// The device build's flags: `optix_approximate_sqrt` for `sqrt.approx`, `optix_libdevice` for NVIDIA's functions.
#![allow(unexpected_cfgs, dead_code)]

mod exp;
mod hyperbolic;
mod inverse;
mod libdevice;
mod log;
mod root;
mod sin_cos;

#[cfg(optix_libdevice)]
pub use libdevice::{
    acos, acosf, acosh, acoshf, asin, asinf, asinh, asinhf, atan, atan2, atan2f, atanf, atanh, atanhf, cbrt, cbrtf, cos,
    cosf, cosh, coshf, erf, erfc, erfcf, erff, exp, exp2, exp2f, exp10, exp10f, expf, expm1, expm1f, fdim, fdimf, fmod,
    fmodf, hypot, hypotf, lgamma, lgammaf, log, log1p, log1pf, log2, log2f, log10, log10f, logf, pow, powf, sin, sincos,
    sincosf, sinf, sinh, sinhf, tan, tanf, tanh, tanhf, tgamma, tgammaf,
};
#[cfg(not(optix_approximate_sqrt))]
pub use root::sqrt_rn as sqrtf;
pub use software::*;
#[cfg(not(optix_libdevice))]
pub use {
    exp::{exp2f, exp10f, expf},
    hyperbolic::{acosh, acoshf, coshf, sinhf, tanhf},
    inverse::{acosf, asinf, atan2f, atanf},
    log::{log2f, log10f, logf, powf},
    root::{cbrtf, hypotf},
    sin_cos::{cosf, sincosf, sinf, tanf},
};

/// Functions of one float type that are instructions. Each is an item of its own, and so goes before the glob import.
macro_rules! instructions {
    ($float:ident: $($name:ident($($arg:ident),+) = $function:path;)+) => {$(
        #[inline(always)]
        pub fn $name($($arg: $float),+) -> $float {
            $function($($arg),+)
        }
    )+};
}

instructions! {
    f32:
    floorf(x) = core::f32::math::floor;
    ceilf(x) = core::f32::math::ceil;
    truncf(x) = core::f32::math::trunc;
    roundf(x) = core::f32::math::round;
    rintf(x) = core::f32::math::round_ties_even;
    roundevenf(x) = core::f32::math::round_ties_even;
    fmaf(x, y, z) = core::f32::math::mul_add;
    fabsf(x) = f32::abs;
    copysignf(x, y) = f32::copysign;
    fminf(x, y) = f32::min;
    fmaxf(x, y) = f32::max;
}

#[cfg(optix_approximate_sqrt)]
instructions! {
    f32:
    sqrtf(x) = core::f32::math::sqrt;
}

instructions! {
    f64:
    sqrt(x) = core::f64::math::sqrt;
    floor(x) = core::f64::math::floor;
    ceil(x) = core::f64::math::ceil;
    trunc(x) = core::f64::math::trunc;
    round(x) = core::f64::math::round;
    rint(x) = core::f64::math::round_ties_even;
    roundeven(x) = core::f64::math::round_ties_even;
    fma(x, y, z) = core::f64::math::mul_add;
    fabs(x) = f64::abs;
    copysign(x, y) = f64::copysign;
    fmin(x, y) = f64::min;
    fmax(x, y) = f64::max;
}
