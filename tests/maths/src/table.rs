//! What is measured, and the errors that are stated: docs/maths.md has the sources.

use crate::Measure;

/// The largest error that is stated for arguments from `low` to `high`.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    pub measure: Measure,
    pub low: f32,
    pub high: f32,
    /// In ulps, or of the logarithm of base 2.
    pub limit: f64,
}

impl Bound {
    /// The error itself.
    pub fn error(&self) -> f64 {
        if self.measure == Measure::Ulps { self.limit } else { self.limit.exp2() }
    }
}

/// A function, with the names of kernels: `ours_sin`, `fast_sin`, `exact_sin`, `libdevice_sin`, `cuda_sin`, `cuda_fast_sin`.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    pub name: &'static str,
    /// Whether it has two arguments.
    pub pairs: bool,
    /// The standard library's, by which the exact values are checked.
    pub host: fn(f64, f64) -> f64,
    /// Of the precise form.
    pub precise: &'static [Bound],
    /// Of libdevice's and CUDA's precise form.
    pub cuda: &'static [Bound],
    /// Of the fast form.
    pub fast: &'static [Bound],
    /// Of CUDA's fast form.
    pub cuda_fast: &'static [Bound],
}

const fn bound(measure: Measure, low: f32, high: f32, limit: f64) -> Bound {
    Bound { measure, low, high, limit }
}

const fn ulps(limit: f64) -> Bound {
    bound(Measure::Ulps, f32::NEG_INFINITY, f32::INFINITY, limit)
}

/// As CUDA states errors: in ulps from the correctly rounded result, which is half an ulp from the true one.
const fn rounded(ulps_away: u32) -> Bound {
    ulps(ulps_away as f64 + 0.5)
}

type Host = fn(f64, f64) -> f64;

/// A function of one argument.
const fn one(name: &'static str, host: Host, precise: &'static [Bound], cuda: &'static [Bound]) -> Function {
    Function { name, pairs: false, host, precise, cuda, fast: &[], cuda_fast: &[] }
}

const fn two(name: &'static str, host: Host, precise: &'static [Bound], cuda: &'static [Bound]) -> Function {
    Function { pairs: true, ..one(name, host, precise, cuda) }
}

impl Function {
    const fn fast(self, fast: &'static [Bound], cuda_fast: &'static [Bound]) -> Self {
        Self { fast, cuda_fast, ..self }
    }
}

const PI: f32 = core::f32::consts::PI;
const LEAST: f32 = f32::MIN_POSITIVE;
const MAX: f32 = f32::MAX;
const TWO_126: f32 = 8.507_059e37;

pub const TABLE: &[Function] = {
    use Measure::*;
    &[
        one("sin", |x, _| x.sin(), &[ulps(1.6)], &[rounded(2)]).fast(
            &[bound(Absolute, -2.0 * PI, 2.0 * PI, -20.5), bound(Absolute, -100.0 * PI, 100.0 * PI, -14.7)],
            &[bound(Absolute, -PI, PI, -21.41)],
        ),
        one("cos", |x, _| x.cos(), &[ulps(1.6)], &[rounded(2)]).fast(
            &[bound(Absolute, -2.0 * PI, 2.0 * PI, -20.4), bound(Absolute, -100.0 * PI, 100.0 * PI, -14.7)],
            &[bound(Absolute, -PI, PI, -21.19)],
        ),
        one("tan", |x, _| x.tan(), &[ulps(3.1)], &[rounded(4)])
            .fast(&[bound(Absolute, -PI / 4.0, PI / 4.0, -19.0)], &[bound(Absolute, -PI / 4.0, PI / 4.0, -19.0)]),
        one("asin", |x, _| x.asin(), &[ulps(2.0)], &[rounded(2)]),
        one("acos", |x, _| x.acos(), &[ulps(1.5)], &[rounded(2)]),
        one("atan", |x, _| x.atan(), &[ulps(1.5)], &[rounded(2)]),
        one("sinh", |x, _| x.sinh(), &[ulps(1.7)], &[rounded(3)]),
        one("cosh", |x, _| x.cosh(), &[ulps(1.5)], &[rounded(2)]),
        one("tanh", |x, _| x.tanh(), &[ulps(1.5)], &[rounded(2)])
            .fast(&[bound(Absolute, -MAX, MAX, -20.0)], &[bound(Relative, -MAX, MAX, -11.0)]),
        one("asinh", |x, _| x.asinh(), &[ulps(1.8)], &[rounded(3)]),
        one("acosh", |x, _| x.acosh(), &[ulps(2.5)], &[rounded(4)]),
        one("atanh", |x, _| x.atanh(), &[ulps(2.2)], &[rounded(3)]),
        one("exp", |x, _| x.exp(), &[ulps(1.1)], &[rounded(2)]).fast(
            &[bound(Ulps, -1.0, 1.0, 3.5), bound(Ulps, -87.0, 88.0, 105.5)],
            &[bound(Ulps, -1.0, 1.0, 3.5), bound(Ulps, -87.0, 88.0, 105.5)],
        ),
        one("exp2", |x, _| x.exp2(), &[ulps(0.9)], &[rounded(2)]).fast(&[bound(Relative, -126.0, 127.9, -22.0)], &[]),
        one("exp10", |x, _| 10f64.powf(x), &[ulps(1.3)], &[rounded(2)]),
        one("expm1", |x, _| x.exp_m1(), &[ulps(1.5)], &[rounded(1)]),
        one("log", |x, _| x.ln(), &[ulps(1.0)], &[rounded(1)]).fast(
            &[bound(Absolute, 0.5, 2.0, -21.41), bound(Ulps, LEAST, 0.5, 3.5), bound(Ulps, 2.0, MAX, 3.5)],
            &[bound(Absolute, 0.5, 2.0, -21.41), bound(Ulps, LEAST, 0.5, 3.5), bound(Ulps, 2.0, MAX, 3.5)],
        ),
        one("log2", |x, _| x.log2(), &[ulps(1.1)], &[rounded(1)]).fast(
            &[bound(Absolute, 0.5, 2.0, -22.0), bound(Relative, LEAST, 0.5, -22.0), bound(Relative, 2.0, MAX, -22.0)],
            &[bound(Absolute, 0.5, 2.0, -22.0), bound(Ulps, LEAST, 0.5, 2.5), bound(Ulps, 2.0, MAX, 2.5)],
        ),
        one("log10", |x, _| x.log10(), &[ulps(1.3)], &[rounded(2)]).fast(
            // The Programming Guide says 2^-24 of `__log10f`, which an H100 misses: 2^-23.88.
            &[bound(Absolute, 0.5, 2.0, -23.8), bound(Ulps, LEAST, 0.5, 3.5), bound(Ulps, 2.0, MAX, 3.5)],
            &[bound(Absolute, 0.5, 2.0, -23.8), bound(Ulps, LEAST, 0.5, 3.5), bound(Ulps, 2.0, MAX, 3.5)],
        ),
        one("log1p", |x, _| x.ln_1p(), &[ulps(1.5)], &[rounded(1)]),
        one("cbrt", |x, _| x.cbrt(), &[ulps(0.6)], &[rounded(1)]),
        one("sqrt", |x, _| x.sqrt(), &[ulps(0.5)], &[]).fast(&[bound(Relative, LEAST, MAX, -23.0)], &[]),
        one("recip", |x, _| 1.0 / x, &[], &[])
            .fast(&[bound(Ulps, LEAST, TWO_126, 1.0)], &[bound(Ulps, LEAST, TWO_126, 2.5)]),
        one("rsqrt", |x, _| 1.0 / x.sqrt(), &[], &[])
            .fast(&[bound(Relative, LEAST, MAX, -22.9)], &[bound(Ulps, LEAST, MAX, 2.5)]),
        // By 2.4, over the range where the result is neither 0 nor infinite.
        one("pow_2_4", |x, _| x.powf(2.4f32.into()), &[], &[])
            .fast(&[bound(Relative, 1e-15, 1e15, -14.5)], &[bound(Relative, 1e-15, 1e15, -14.5)]),
        two("pow", |x, y| x.powf(y), &[ulps(1.3)], &[rounded(4)]),
        two("atan2", |x, y| x.atan2(y), &[ulps(2.0)], &[rounded(3)]),
        two("hypot", |x, y| x.hypot(y), &[ulps(0.8)], &[rounded(3)]),
        two("fmod", |x, y| x % y, &[ulps(0.0)], &[rounded(0)]),
    ]
};
