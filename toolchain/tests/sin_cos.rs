//! The error of the device's sine and cosine, which is plain Rust and runs here too.

#[path = "../templates/libm/sin_cos.rs"]
mod sin_cos;

/// What the generated `libm` crate has beside the module.
fn fmaf(x: f32, y: f32, z: f32) -> f32 {
    x.mul_add(y, z)
}

use sin_cos::{cosf, sincosf, sinf};

/// The distance in units of the last place of the `f32` nearest to `exact`.
fn ulps(value: f32, exact: f64) -> f64 {
    let nearest = exact.abs() as f32;
    let ulp = f64::from(nearest.next_up()) - f64::from(nearest);
    (f64::from(value) - exact).abs() / ulp
}

#[test]
fn the_error_is_as_stated() {
    let infinity = f32::INFINITY.to_bits();
    // Every 311th number, a prime, meets every pattern of low bits; 1 takes 10 minutes and was tried.
    let stride = 311;
    let mut worst = (0.0_f64, 0.0_f64);
    for bits in (0..infinity).step_by(stride) {
        let x = f32::from_bits(bits);
        let ((sin, cos), (exact_sin, exact_cos)) = (sincosf(x), f64::from(x).sin_cos());
        worst = (worst.0.max(ulps(sin, exact_sin)), worst.1.max(ulps(cos, exact_cos)));
        assert_eq!(sinf(-x).to_bits(), (-sin).to_bits(), "sine is odd, {x}");
        assert_eq!(cosf(-x).to_bits(), cos.to_bits(), "cosine is even, {x}");
    }
    assert!(worst.0 < 1.6 && worst.1 < 1.6, "{worst:?}");
}

#[test]
fn the_extremes_are_right() {
    assert_eq!(sinf(-0.0).to_bits(), (-0.0_f32).to_bits());
    assert_eq!(cosf(0.0), 1.0);
    assert!(sinf(f32::NAN).is_nan() && cosf(f32::INFINITY).is_nan());
    assert_eq!(sinf(1e30), f64::from(1e30_f32).sin() as f32);
}
