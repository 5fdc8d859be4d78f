//! NVIDIA's functions, for those who want CUDA's results to the bit.
//!
//! Under C's names, which the translation to libNVVM's IR takes for libdevice's.

macro_rules! functions {
    ($($float:ident: $($name:ident($($arg:ident),+))+;)+) => {$($(
        #[inline(always)]
        pub fn $name($($arg: $float),+) -> $float {
            unsafe extern "C" {
                fn $name($($arg: $float),+) -> $float;
            }
            // SAFETY: it computes with its arguments.
            unsafe { $name($($arg),+) }
        }
    )+)+};
}

functions! {
    f32:
    sinf(x) cosf(x) tanf(x) asinf(x) acosf(x) atanf(x) sinhf(x) coshf(x) tanhf(x) asinhf(x) acoshf(x) atanhf(x)
    expf(x) exp2f(x) exp10f(x) expm1f(x) logf(x) log2f(x) log10f(x) log1pf(x) cbrtf(x) erff(x) erfcf(x) tgammaf(x)
    lgammaf(x) atan2f(y, x) hypotf(x, y) powf(x, y) fmodf(x, y) fdimf(x, y);
    f64:
    sin(x) cos(x) tan(x) asin(x) acos(x) atan(x) sinh(x) cosh(x) tanh(x) asinh(x) acosh(x) atanh(x)
    exp(x) exp2(x) exp10(x) expm1(x) log(x) log2(x) log10(x) log1p(x) cbrt(x) erf(x) erfc(x) tgamma(x)
    lgamma(x) atan2(y, x) hypot(x, y) pow(x, y) fmod(x, y) fdim(x, y);
}

#[inline(always)]
pub fn sincosf(x: f32) -> (f32, f32) {
    (sinf(x), cosf(x))
}

#[inline(always)]
pub fn sincos(x: f64) -> (f64, f64) {
    (sin(x), cos(x))
}
