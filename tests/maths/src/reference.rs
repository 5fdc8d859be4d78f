//! Functions of `f64`, whose error is no more than a hundred-millionth of what an `f32` resolves.

#[cfg(target_arch = "nvptx64")]
pub use libm::{
    acos, asin, atan, atan2, cbrt, cos, cosh, exp, exp2, hypot, log, log2, log10, pow, sin, sinh, sqrt, tan, tanh,
};

#[cfg(not(target_arch = "nvptx64"))]
pub use host::*;

#[cfg(not(target_arch = "nvptx64"))]
mod host {
    extern crate std;

    macro_rules! functions {
        ($($name:ident($($arg:ident),*) = $method:ident;)*) => {$(
            pub fn $name($($arg: f64),*) -> f64 {
                f64::$method($($arg),*)
            }
        )*};
    }

    functions! {
        acos(x) = acos;
        asin(x) = asin;
        atan(x) = atan;
        atan2(y, x) = atan2;
        cbrt(x) = cbrt;
        cos(x) = cos;
        cosh(x) = cosh;
        exp(x) = exp;
        exp2(x) = exp2;
        hypot(x, y) = hypot;
        log(x) = ln;
        log2(x) = log2;
        log10(x) = log10;
        pow(x, y) = powf;
        sin(x) = sin;
        sinh(x) = sinh;
        sqrt(x) = sqrt;
        tan(x) = tan;
        tanh(x) = tanh;
    }
}
