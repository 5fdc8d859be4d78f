//! The error of the device's maths in a sample; `cargo bench --bench maths` tries everything.

#[path = "common/libm.rs"]
mod libm;

use libm::{FUNCTIONS, FUNCTIONS_2, acosf, acosh, atan2f, cosf, expf, log2f, logf, powf, sincosf, sinf, tanf};

#[test]
fn errors_are_below_their_bounds() {
    // A prime meets every pattern of low bits.
    let measured = FUNCTIONS.map(|function| (function.name, function.errors(0, 2003), function.bound));
    let missed: Vec<_> = measured.iter().filter(|(_, errors, bound)| errors.ulps >= *bound).collect();
    assert!(missed.is_empty(), "{missed:#?}");
}

#[test]
fn errors_of_two_arguments_are_below_their_bounds() {
    let measured = FUNCTIONS_2.map(|function| (function.name, function.errors(1, 1_000_000), function.bound));
    let missed: Vec<_> = measured.iter().filter(|(_, errors, bound)| errors.ulps >= *bound).collect();
    assert!(missed.is_empty(), "{missed:#?}");
}

#[test]
fn signs_and_symmetries_are_kept() {
    for function in FUNCTIONS {
        let zero = (function.ours)(0.0);
        if zero == 0.0 {
            assert_eq!(zero.to_bits(), 0, "{}", function.name);
            if !function.name.starts_with("log") && function.name != "acosf" {
                assert_eq!((function.ours)(-0.0).to_bits(), (-0.0f32).to_bits(), "{} is odd", function.name);
            }
        }
    }
    for x in [0.3f32, 2.0, 1e5, 1e30] {
        assert_eq!(sinf(-x), -sinf(x));
        assert_eq!(cosf(-x), cosf(x));
        assert_eq!(tanf(-x), -tanf(x));
        assert_eq!(sincosf(x), (sinf(x), cosf(x)));
    }
}

#[test]
fn there_are_no_values_outside_of_domains() {
    const INFINITY: f32 = f32::INFINITY;
    let domains = [
        ("asinf", -1.0f32, 1.0f32),
        ("acosf", -1.0, 1.0),
        ("acoshf", 1.0, INFINITY),
        ("atanhf", -1.0, 1.0),
        ("logf", 0.0, INFINITY),
        ("log2f", 0.0, INFINITY),
        ("log10f", 0.0, INFINITY),
        ("log1pf", -1.0, INFINITY),
    ];
    let sample = || (0..=u32::MAX).step_by(65_521).map(f32::from_bits);
    for (name, low, high) in domains {
        let function = FUNCTIONS.into_iter().find(|function| function.name == name).expect("it is measured");
        let ends = [-INFINITY, low.next_down(), high.next_up(), INFINITY, f32::NAN];
        for x in sample().chain(ends).filter(|x| !(low..=high).contains(x)) {
            assert!((function.ours)(x).is_nan(), "{name} of {x:e}");
        }
    }
    assert!(sample().filter(|x| *x < 1.0).all(|x| acosh(x.into()).is_nan()));
    for x in sample().filter(|x| *x < 0.0 && x.is_finite()) {
        for y in [0.5, -0.5, 1.0f32.next_up(), -2.4, 1e-45, 8_388_607.5] {
            assert!(powf(x, y).is_nan(), "powf of {x:e} and {y:e}");
        }
    }
}

#[test]
fn the_extremes_are_right() {
    assert!(cosf(f32::INFINITY).is_nan() && acosf(1.1).is_nan() && logf(-1.0).is_nan());
    assert_eq!(sinf(1e30), f64::from(1e30_f32).sin() as f32);
    assert_eq!((expf(f32::NEG_INFINITY), expf(200.0), expf(0.0)), (0.0, f32::INFINITY, 1.0));
    assert_eq!((log2f(8.0), log2f(1e-45), logf(0.0)), (3.0, -149.0, f32::NEG_INFINITY));
    assert_eq!((powf(-2.0, 3.0), powf(-0.0, -3.0), powf(0.0, 0.0)), (-8.0, f32::NEG_INFINITY, 1.0));
    assert_eq!((powf(f32::NAN, 0.0), powf(1.0, f32::NAN), powf(-1.0, f32::INFINITY)), (1.0, 1.0, 1.0));
    let pi = core::f32::consts::PI;
    assert_eq!((atan2f(0.0, -0.0), atan2f(-0.0, -0.0), atan2f(-0.0, 0.0).to_bits()), (pi, -pi, (-0.0f32).to_bits()));
}
