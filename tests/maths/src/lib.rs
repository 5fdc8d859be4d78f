//! A device program that measures the error of the device's maths, over every `f32`.
#![no_std]

mod reference;

use optix_device_rs::math::fast;
use optix_device_rs::prelude::*;

/// How an error is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// In units of the last place that an `f32` has at the true value.
    Ulps,
    /// As the distance from the true value.
    Absolute,
    /// As the distance from the true value, divided by it.
    Relative,
}

/// What one launch index found.
#[derive(Clone, Copy, Debug, PartialEq, Element)]
#[repr(C)]
pub struct Worst {
    /// The largest error.
    pub error: f32,
    /// The bits of the argument that it is at.
    pub at: u32,
    /// How many results are the `f32` nearest to the true value.
    pub correct: u32,
    /// How many arguments were tried.
    pub tried: u32,
}

/// The launch parameters.
#[launch_params]
pub struct MathsFrame {
    /// One per launch index.
    pub worst: SliceMut<Worst>,
    /// The index in [`FUNCTIONS`].
    pub function: u32,
    /// A launch index tries this many bit patterns ..
    pub count: u32,
    /// .. from its number times `count` on, this far apart.
    pub stride: u32,
}

/// A function and what is expected of it.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Its name: `sin`, or `fast::sin`.
    pub name: &'static str,
    /// How its error is measured.
    pub measure: Measure,
    /// Arguments of a magnitude outside of this range are passed over.
    pub range: (f32, f32),
    /// The largest error that is stated for it.
    pub bound: f32,
}

/// All arguments.
const ALL: (f32, f32) = (0.0, f32::INFINITY);
const TWO_PI: (f32, f32) = (0.0, core::f32::consts::TAU);
const NORMAL: (f32, f32) = (f32::MIN_POSITIVE, 8.5e37);

macro_rules! functions {
    ($($name:literal $measure:ident $range:expr, $bound:expr, $ours:expr, $exact:expr;)*) => {
        /// What is measured. Functions of two arguments get one from [`partner`].
        pub const FUNCTIONS: &[Function] =
            &[$(Function { name: $name, measure: Measure::$measure, range: $range, bound: $bound }),*];

        /// Measures the function that the launch parameters name.
        #[raygen]
        pub fn sweep(rg: &RayGen<Maths>) {
            let function = rg.params().function();
            let mut index = 0;
            $(
                if function == index {
                    measure(rg, Measure::$measure, $range, $ours, $exact);
                }
                index += 1;
            )*
            let _ = index;
        }
    };
}

functions! {
    "sin" Ulps ALL, 1.6, Math::sin, |x| reference::sin(x as f64);
    "cos" Ulps ALL, 1.6, Math::cos, |x| reference::cos(x as f64);
    "tan" Ulps ALL, 2.6, Math::tan, |x| reference::tan(x as f64);
    "asin" Ulps ALL, 2.0, Math::asin, |x| reference::asin(x as f64);
    "acos" Ulps ALL, 1.5, Math::acos, |x| reference::acos(x as f64);
    "atan" Ulps ALL, 1.5, Math::atan, |x| reference::atan(x as f64);
    "exp" Ulps ALL, 1.0, Math::exp, |x| reference::exp(x as f64);
    "exp2" Ulps ALL, 0.9, Math::exp2, |x| reference::exp2(x as f64);
    "ln" Ulps ALL, 0.9, Math::ln, |x| reference::log(x as f64);
    "log2" Ulps ALL, 0.9, Math::log2, |x| reference::log2(x as f64);
    "log10" Ulps ALL, 0.9, Math::log10, |x| reference::log10(x as f64);
    "sinh" Ulps ALL, 1.7, Math::sinh, |x| reference::sinh(x as f64);
    "cosh" Ulps ALL, 1.5, Math::cosh, |x| reference::cosh(x as f64);
    "tanh" Ulps ALL, 1.5, Math::tanh, |x| reference::tanh(x as f64);
    "cbrt" Ulps ALL, 0.6, Math::cbrt, |x| reference::cbrt(x as f64);
    "sqrt" Ulps ALL, 0.501, Math::sqrt, |x| reference::sqrt(x as f64);
    "powf" Ulps ALL, 1.3, |x| Math::powf(x, partner(x)), |x| reference::pow(x as f64, partner(x) as f64);
    "atan2" Ulps ALL, 2.0, |x| Math::atan2(x, partner(x)), |x| reference::atan2(x as f64, partner(x) as f64);
    "hypot" Ulps ALL, 0.6, |x| Math::hypot(x, partner(x)), |x| reference::hypot(x as f64, partner(x) as f64);
    "fast::sin" Absolute TWO_PI, 6.743_496e-7, fast::sin, |x| reference::sin(x as f64);
    "fast::cos" Absolute TWO_PI, 6.743_496e-7, fast::cos, |x| reference::cos(x as f64);
    "fast::exp2" Relative (0.0, 125.0), 2.384_185_8e-7, fast::exp2, |x| reference::exp2(x as f64);
    "fast::exp" Relative (0.0, 1.0), 4.768_371_6e-7, fast::exp, |x| reference::exp(x as f64);
    "fast::log2" Absolute (0.5, 2.0), 2.384_185_8e-7, |x: f32| fast::log2(x.abs()), |x: f32| reference::log2(x.abs() as f64);
    "fast::tanh" Absolute ALL, 9.536_743e-7, fast::tanh, |x| reference::tanh(x as f64);
    "fast::recip" Ulps NORMAL, 1.0, fast::recip, |x| 1.0 / x as f64;
    "fast::sqrt" Relative NORMAL, 1.192_092_9e-7, |x: f32| fast::sqrt(x.abs()), |x: f32| reference::sqrt(x.abs() as f64);
    "fast::rsqrt" Relative NORMAL, 1.277_660_4e-7, |x: f32| fast::rsqrt(x.abs()), |x: f32| 1.0 / reference::sqrt(x.abs() as f64);
}

/// A second argument for `x`: any bits, or every other time a number between 2^-16 and 2^16.
pub fn partner(x: f32) -> f32 {
    let hash = (x.to_bits() ^ 0x9e37_79b9).wrapping_mul(0x85eb_ca6b);
    let hash = (hash ^ hash >> 15).wrapping_mul(0xc2b2_ae35);
    let bits = hash ^ hash >> 13;
    f32::from_bits(if hash & 0x40 == 0 { bits } else { bits & 0x80ff_ffff | 0x3000_0000 | (bits >> 3 & 0x0f00_0000) })
}

#[inline(always)]
fn measure(
    rg: &RayGen<Maths>,
    measure: Measure,
    range: (f32, f32),
    ours: impl Fn(f32) -> f32,
    exact: impl Fn(f32) -> f64,
) {
    let (index, count, stride) = (rg.launch_index().x, rg.params().count(), rg.params().stride());
    let mut worst = Worst { error: 0.0, at: 0, correct: 0, tried: 0 };
    let mut i = 0;
    while i < count {
        let bits = index.wrapping_mul(count).wrapping_add(i).wrapping_mul(stride);
        let x = f32::from_bits(bits);
        i += 1;
        // A NaN is within `ALL`.
        let outside = x.abs() < range.0 || x.abs() > range.1;
        if outside {
            continue;
        }
        let (value, exact) = (ours(x), exact(x));
        let error = error(measure, value, exact);
        worst.tried += 1;
        worst.correct += u32::from(value == exact as f32 || value.is_nan() && exact.is_nan());
        if error > worst.error {
            (worst.error, worst.at) = (error, bits);
        }
    }
    rg.params().worst().set(index, worst);
}

/// The error of `value`. Infinity stands for 2^128 where a finite number belongs; a NaN in the wrong place is infinitely far.
fn error(measure: Measure, value: f32, exact: f64) -> f32 {
    const LEAST: u64 = (1023 - 126) << 52;
    const INFINITE: f64 = 340_282_366_920_938_463_463_374_607_431_768_211_456.0;
    if exact.is_nan() || value.is_nan() || exact.is_infinite() {
        let same = exact.is_nan() && value.is_nan() || value as f64 == exact;
        return if same { 0.0 } else { f32::INFINITY };
    }
    let value = (value as f64).clamp(-INFINITE, INFINITE);
    let distance = (value - exact.clamp(-INFINITE, INFINITE)).abs();
    let unit = match measure {
        Measure::Ulps => f64::from_bits((exact.to_bits() & 0x7ff0_0000_0000_0000).max(LEAST) - (23 << 52)),
        Measure::Absolute => 1.0,
        Measure::Relative => exact.abs().max(f64::MIN_POSITIVE),
    };
    (distance / unit) as f32
}

pipeline! {
    /// Measures functions.
    pub struct Maths {
        params: MathsFrame,
        raygen: [sweep],
        rays: {},
        hitgroups: {},
    }
}
