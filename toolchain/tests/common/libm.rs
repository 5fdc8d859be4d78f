//! The device's `f32` functions, which are plain Rust and run here too, and their error.
#![allow(dead_code, reason = "each user takes a part")]

#[path = "../../templates/libm/exp.rs"]
mod exp;
#[path = "../../templates/libm/hyperbolic.rs"]
mod hyperbolic;
#[path = "../../templates/libm/inverse.rs"]
mod inverse;
#[path = "../../templates/libm/log.rs"]
mod log;
#[path = "../../templates/libm/root.rs"]
mod root;
#[path = "../../templates/libm/sin_cos.rs"]
mod sin_cos;

pub use exp::{exp2f, exp10f, expf};
pub use hyperbolic::{acosh, acoshf, coshf, sinhf, tanhf};
pub use inverse::{acosf, asinf, atan2f, atanf};
pub use log::{log2f, log10f, logf, powf};
pub use root::{cbrtf, hypotf, sqrt_rn as sqrtf};
pub use sin_cos::{cosf, sincosf, sinf, tanf};
pub use software::{asinhf, atanhf, expm1f, log1pf};

/// What the generated `libm` crate has beside the modules.
fn fmaf(x: f32, y: f32, z: f32) -> f32 {
    x.mul_add(y, z)
}

/// A function of one argument, what it computes, and the ulps by which it may miss that.
pub struct Function {
    pub name: &'static str,
    pub ours: fn(f32) -> f32,
    pub exact: fn(f64) -> f64,
    pub bound: f64,
}

/// A function of two.
pub struct Function2 {
    pub name: &'static str,
    pub ours: fn(f32, f32) -> f32,
    pub exact: fn(f64, f64) -> f64,
    pub bound: f64,
}

macro_rules! function {
    ($kind:ident $name:ident, $exact:expr, $bound:literal) => {
        $kind { name: stringify!($name), ours: $name, exact: $exact, bound: $bound }
    };
}

/// The functions of one argument. The standard library's `f64` is off by less than 1e-8 of our ulps.
pub const FUNCTIONS: [Function; 22] = [
    function!(Function sinf, f64::sin, 1.6),
    function!(Function cosf, f64::cos, 1.6),
    function!(Function tanf, f64::tan, 3.1),
    function!(Function asinf, f64::asin, 2.0),
    function!(Function acosf, f64::acos, 1.5),
    function!(Function atanf, f64::atan, 1.5),
    function!(Function expf, f64::exp, 1.1),
    function!(Function exp2f, f64::exp2, 0.9),
    function!(Function exp10f, |x| 10f64.powf(x), 1.3),
    function!(Function logf, f64::ln, 1.0),
    function!(Function log2f, f64::log2, 1.1),
    function!(Function log10f, f64::log10, 1.3),
    function!(Function sinhf, f64::sinh, 1.7),
    function!(Function coshf, f64::cosh, 1.5),
    function!(Function tanhf, f64::tanh, 1.5),
    function!(Function asinhf, f64::asinh, 1.8),
    function!(Function acoshf, f64::acosh, 2.1),
    function!(Function atanhf, f64::atanh, 1.8),
    function!(Function expm1f, f64::exp_m1, 1.0),
    function!(Function log1pf, f64::ln_1p, 1.0),
    function!(Function cbrtf, f64::cbrt, 0.6),
    function!(Function sqrtf, f64::sqrt, 0.500_001),
];

/// The functions of two arguments.
pub const FUNCTIONS_2: [Function2; 3] = [
    function!(Function2 powf, f64::powf, 1.3),
    function!(Function2 atan2f, f64::atan2, 2.0),
    function!(Function2 hypotf, f64::hypot, 0.8),
];

/// The largest error of a function, where it is, and how many of its results are the nearest `f32`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    pub ulps: f64,
    pub at: (f32, f32),
    pub correct: u64,
    pub count: u64,
}

impl Errors {
    pub fn add(&mut self, at: (f32, f32), value: f32, exact: f64) {
        let ulps = ulps(value, exact);
        if ulps > self.ulps {
            (self.ulps, self.at) = (ulps, at);
        }
        self.correct += u64::from(value == exact as f32 || value.is_nan() && exact.is_nan());
        self.count += 1;
    }

    pub fn merge(self, other: Self) -> Self {
        let (ulps, at) = if other.ulps > self.ulps { (other.ulps, other.at) } else { (self.ulps, self.at) };
        Self { ulps, at, correct: self.correct + other.correct, count: self.count + other.count }
    }
}

/// The distance in units of the last place that an `f32` has at `exact`. Infinity stands for 2^128 where a finite number
/// belongs; a NaN in the wrong place is infinitely far.
pub fn ulps(value: f32, exact: f64) -> f64 {
    const LEAST: u64 = (1023 - 126) << 52;
    const GREATEST: u64 = (1023 + 127) << 52;
    if exact.is_nan() || value.is_nan() || exact.is_infinite() {
        let same = exact.is_nan() && value.is_nan() || f64::from(value) == exact;
        return if same { 0.0 } else { f64::INFINITY };
    }
    let exponent = (exact.to_bits() & 0x7ff0_0000_0000_0000).clamp(LEAST, GREATEST);
    let ulp = f64::from_bits(exponent - (23 << 52));
    let two_to_128 = 2f64.powi(128);
    let value = if value.is_infinite() { two_to_128.copysign(f64::from(value)) } else { f64::from(value) };
    (value - exact.clamp(-two_to_128, two_to_128)).abs() / ulp
}

impl Function {
    /// Its errors at every `stride`th bit pattern from `first` on.
    pub fn errors(&self, first: u32, stride: u32) -> Errors {
        let mut errors = Errors::default();
        for bits in (u64::from(first)..1 << 32).step_by(stride as usize) {
            let x = f32::from_bits(bits as u32);
            errors.add((x, 0.0), (self.ours)(x), (self.exact)(f64::from(x)));
        }
        errors
    }
}

/// Numbers where functions are special.
const SPECIAL: [f32; 22] = [
    0.0,
    1e-45,
    1.17e-38,
    1e-20,
    0.1,
    0.333_333_34,
    0.5,
    0.999_999_94,
    1.0,
    1.000_000_1,
    1.5,
    2.0,
    3.0,
    127.0,
    128.0,
    149.0,
    16_777_215.0,
    16_777_216.0,
    1e20,
    f32::MAX,
    f32::INFINITY,
    f32::NAN,
];

impl Function2 {
    /// Its errors at `count` pairs from `seed`: any bits, and numbers between 2^-16 and 2^16, where results are neither 0 nor
    /// infinite; and at all pairs of special numbers.
    pub fn errors(&self, seed: u64, count: u64) -> Errors {
        let mut errors = Errors::default();
        let mut add = |x: f32, y: f32| {
            // The reference is not told what kind of NaN it gets.
            errors.add((x, y), (self.ours)(x, y), (self.exact)(f64::from(x), f64::from(y)));
        };
        for x in SPECIAL.iter().flat_map(|x| [*x, -x]) {
            SPECIAL.iter().flat_map(|y| [*y, -y]).for_each(|y| add(x, y));
        }
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        for i in 0..count {
            // xorshift64*
            state ^= state >> 12;
            state ^= state << 25;
            state ^= state >> 27;
            let bits = state.wrapping_mul(0x2545_f491_4f6c_dd1d);
            let number = |bits: u32| match i % 2 {
                0 => f32::from_bits(bits),
                // 2^-16 to 2^16, of either sign
                _ => f32::from_bits(bits & 0x80ff_ffff | 0x3000_0000 | (bits >> 3 & 0x0f00_0000)),
            };
            add(number(bits as u32), number((bits >> 32) as u32));
        }
        errors
    }
}
