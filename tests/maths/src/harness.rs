//! Arguments, exact values, and the comparison.

use crate::device::{kernels, share};
use crate::{Measure, Worst, pair};

/// Fills in the arguments of the numbers from `first` on: bit patterns, or pairs.
///
/// # Safety
/// `arguments` has room for `count`.
#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn arguments(arguments: *mut [f32; 2], count: u32, first: u64, pairs: u32) {
    share(count, |i| {
        let number = first + i as u64;
        let value = if pairs == 0 { [f32::from_bits(number as u32), 0.0] } else { pair(number) };
        // SAFETY: the caller's.
        unsafe { *arguments.add(i) = value };
    });
}

/// Adds the errors of `count` values to what each thread has found; of those alone whose first argument is from `low` to
/// `high`, or a NaN.
///
/// # Safety
/// There are `count` arguments, values and exact values, and one `Worst` for each thread; `measure` is a [`Measure`].
#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn compare(
    arguments: *const [f32; 2],
    values: *const f32,
    exact: *const f64,
    count: u32,
    measure: u32,
    low: f32,
    high: f32,
    worst: *mut Worst,
) {
    let measure = match measure {
        0 => Measure::Ulps,
        1 => Measure::Absolute,
        _ => Measure::Relative,
    };
    let mut found = Worst::default();
    let thread = share(count, |i| {
        // SAFETY: the caller's.
        let (arguments, value, exact) = unsafe { (*arguments.add(i), *values.add(i), *exact.add(i)) };
        let outside = arguments[0] < low || arguments[0] > high;
        if !outside {
            found.add(measure, arguments, value, exact);
        }
    });
    // SAFETY: the caller's.
    unsafe { (*worst.add(thread)).merge(found) };
}

// The `libm` crate's functions of `f64` are within an ulp or two, which is a hundred-millionth of an ulp of `f32`.
kernels! {
    f64:
    "exact_sin" |x, _| libm::sin(x as f64);
    "exact_cos" |x, _| libm::cos(x as f64);
    "exact_tan" |x, _| libm::tan(x as f64);
    "exact_asin" |x, _| libm::asin(x as f64);
    "exact_acos" |x, _| libm::acos(x as f64);
    "exact_atan" |x, _| libm::atan(x as f64);
    "exact_sinh" |x, _| libm::sinh(x as f64);
    "exact_cosh" |x, _| libm::cosh(x as f64);
    "exact_tanh" |x, _| libm::tanh(x as f64);
    "exact_asinh" |x, _| libm::asinh(x as f64);
    "exact_acosh" |x, _| libm::acosh(x as f64);
    "exact_atanh" |x, _| libm::atanh(x as f64);
    "exact_exp" |x, _| libm::exp(x as f64);
    "exact_exp2" |x, _| libm::exp2(x as f64);
    "exact_exp10" |x, _| libm::exp10(x as f64);
    "exact_expm1" |x, _| libm::expm1(x as f64);
    "exact_log" |x, _| libm::log(x as f64);
    "exact_log2" |x, _| libm::log2(x as f64);
    "exact_log10" |x, _| libm::log10(x as f64);
    "exact_log1p" |x, _| libm::log1p(x as f64);
    "exact_cbrt" |x, _| libm::cbrt(x as f64);
    "exact_sqrt" |x, _| libm::sqrt(x as f64);
    "exact_pow" |x, y| libm::pow(x as f64, y as f64);
    "exact_atan2" |y, x| libm::atan2(y as f64, x as f64);
    "exact_hypot" |x, y| libm::hypot(x as f64, y as f64);
    "exact_fmod" |x, y| libm::fmod(x as f64, y as f64);
    "exact_recip" |x, _| 1.0 / x as f64;
    "exact_rsqrt" |x, _| 1.0 / libm::sqrt(x as f64);
    "exact_pow_2_4" |x, _| libm::pow(x as f64, 2.4f32 as f64);
}
