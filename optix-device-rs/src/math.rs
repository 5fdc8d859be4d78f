//! Maths that shaders need and `core` does not have; one meaning on both machines.

pub mod fast;
#[cfg(target_arch = "nvptx64")]
mod host_only;

#[cfg(target_arch = "nvptx64")]
pub use host_only::{HostOnly, HostOnlyDouble};

use glam::Vec3;

/// Functions of `f32` that the standard library has and `core` has not, under the same names. Those that are not here, such as
/// `powi`, are found by a check for the host, which knows the standard library; the compiler for the device says what to use.
///
/// On the host they are the standard library's, on the device the toolchain's, in `f32` arithmetic. Both are within the ulps
/// (units of the last place) of the true value that docs/maths.md states; [`fast`] has less precise ones.
///
/// ```
/// use optix_device_rs::prelude::*;
/// assert!((Math::exp(2.0f32.ln()) - 2.0).abs() < 1e-6);
/// ```
pub trait Math {
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// Cube root.
    fn cbrt(self) -> Self;
    /// The length of the vector `(self, other)`, without overflow on the way.
    fn hypot(self, other: Self) -> Self;
    /// Sine of an angle in radians.
    fn sin(self) -> Self;
    /// Cosine of an angle in radians.
    fn cos(self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self)
    where
        Self: Sized;
    /// Tangent of an angle in radians.
    fn tan(self) -> Self;
    /// Arcsine, in radians; a NaN beyond -1 and 1.
    fn asin(self) -> Self;
    /// Arccosine, in radians; a NaN beyond -1 and 1.
    fn acos(self) -> Self;
    /// Arctangent, in radians.
    fn atan(self) -> Self;
    /// The angle of the vector `(x, self)` from the x axis, in radians from -pi to pi.
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// `self` to the power `exponent`.
    fn powf(self, exponent: Self) -> Self;
    /// e to the power `self`.
    fn exp(self) -> Self;
    /// 2 to the power `self`.
    fn exp2(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Logarithm of base 2.
    fn log2(self) -> Self;
    /// Logarithm of base 10.
    fn log10(self) -> Self;
    /// Greatest integer not above.
    fn floor(self) -> Self;
    /// Least integer not below.
    fn ceil(self) -> Self;
    /// The integer part.
    fn trunc(self) -> Self;
    /// Nearest integer, halves away from zero.
    fn round(self) -> Self;
    /// Nearest integer, halves to the even one: one instruction, where [`round`](Math::round) is some.
    fn round_ties_even(self) -> Self;
    /// `self * a + b` with one rounding.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// What [`trunc`](Math::trunc) leaves, with the sign of `self`.
    fn fract(self) -> Self;
    /// The quotient whose remainder is [`rem_euclid`](Math::rem_euclid).
    fn div_euclid(self, divisor: Self) -> Self;
    /// The remainder that is not negative: from 0 up to the divisor's absolute value, which only rounding reaches. It takes the
    /// longer, the larger the quotient; within a period `x - x.floor()` is a few instructions.
    fn rem_euclid(self, divisor: Self) -> Self;
}

#[cfg(target_arch = "nvptx64")]
mod device {
    pub use libm::*;

    // What follows is computed as in the standard library.

    #[inline(always)]
    pub fn fractf(x: f32) -> f32 {
        x - truncf(x)
    }

    pub fn div_euclidf(x: f32, y: f32) -> f32 {
        let quotient = truncf(x / y);
        match fmodf(x, y) < 0.0 {
            true if y > 0.0 => quotient - 1.0,
            true => quotient + 1.0,
            false => quotient,
        }
    }

    pub fn rem_euclidf(x: f32, y: f32) -> f32 {
        let remainder = fmodf(x, y);
        if remainder < 0.0 { remainder + y.abs() } else { remainder }
    }
}

macro_rules! math {
    ($($name:ident($($arg:ident),*) -> $result:ty = $device:ident;)*) => {
        impl Math for f32 {$(
            #[inline(always)]
            fn $name(self $(, $arg: f32)*) -> $result {
                #[cfg(target_arch = "nvptx64")]
                return device::$device(self $(, $arg)*);
                #[cfg(not(target_arch = "nvptx64"))]
                return f32::$name(self $(, $arg)*);
            }
        )*}
    };
}

math! {
    sqrt() -> f32 = sqrtf;
    cbrt() -> f32 = cbrtf;
    hypot(other) -> f32 = hypotf;
    sin() -> f32 = sinf;
    cos() -> f32 = cosf;
    sin_cos() -> (f32, f32) = sincosf;
    tan() -> f32 = tanf;
    asin() -> f32 = asinf;
    acos() -> f32 = acosf;
    atan() -> f32 = atanf;
    atan2(x) -> f32 = atan2f;
    sinh() -> f32 = sinhf;
    cosh() -> f32 = coshf;
    tanh() -> f32 = tanhf;
    powf(exponent) -> f32 = powf;
    exp() -> f32 = expf;
    exp2() -> f32 = exp2f;
    ln() -> f32 = logf;
    log2() -> f32 = log2f;
    log10() -> f32 = log10f;
    floor() -> f32 = floorf;
    ceil() -> f32 = ceilf;
    trunc() -> f32 = truncf;
    round() -> f32 = roundf;
    round_ties_even() -> f32 = rintf;
    mul_add(a, b) -> f32 = fmaf;
    fract() -> f32 = fractf;
    div_euclid(divisor) -> f32 = div_euclidf;
    rem_euclid(divisor) -> f32 = rem_euclidf;
}

/// Sine and cosine of `turns` full turns, for |turns| up to 2^20: within 1.5e-7 of the true value, on both machines.
///
/// Sampling wants fractions of a turn, whose reduction to a quarter turn is exact in `f32`; so no call for large angles is in
/// the code, as there is for [`Math::sin`]. The polynomials are least-squares fits at Chebyshev nodes.
///
/// ```
/// let (sin, cos) = optix_device_rs::math::sin_cos_turns(0.125);
/// assert!((sin - 0.5f32.sqrt()).abs() < 1e-7 && (cos - sin).abs() < 1e-7);
/// ```
#[inline(always)]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    // Adding 1.5 * 2^23 rounds to an integer and leaves it in the low bits.
    const ROUND: f32 = 12_582_912.0;
    let shifted = turns * 4.0 + ROUND;
    let r = turns * 4.0 - (shifted - ROUND); // -0.5 to 0.5, exact
    let quarters = shifted.to_bits();
    let z = r * r;
    let sin =
        r * (1.570_796_4 + z * (-0.645_964_1 + z * (0.079_692_58 + z * (-0.004_681_266_4 + z * 0.000_158_206_53))));
    let cos = 1.0 + z * (-1.233_700_5 + z * (0.253_669_23 + z * (-0.020_860_264 + z * 0.000_903_975_45)));
    // By selects: a branch would part the threads of a warp.
    let (sin, cos) = if quarters & 1 == 0 { (sin, cos) } else { (cos, sin) };
    let sign = |bit: u32| (bit & 2) << 30;
    (f32::from_bits(sin.to_bits() ^ sign(quarters)), f32::from_bits(cos.to_bits() ^ sign(quarters + 1)))
}

/// An orthonormal basis around a unit vector (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onb {
    /// First tangent.
    pub tangent: Vec3,
    /// Second tangent.
    pub bitangent: Vec3,
    /// The vector it was made around.
    pub normal: Vec3,
}

impl Onb {
    /// The basis around `normal`, which has length 1.
    #[inline(always)]
    pub fn around(normal: Vec3) -> Self {
        let sign = 1.0f32.copysign(normal.z);
        let a = (-sign - normal.z).recip();
        let b = normal.x * normal.y * a;
        Self {
            tangent: Vec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            bitangent: Vec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            normal,
        }
    }

    /// `local` in world space.
    #[inline(always)]
    pub fn to_world(&self, local: Vec3) -> Vec3 {
        self.tangent * local.x + self.bitangent * local.y + self.normal * local.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_within_their_bound() {
        let mut worst = 0.0f64;
        for i in 0..4_000_000 {
            let turns = (i - 1_000_000) as f32 / 1_048_576.0;
            let (sin, cos) = sin_cos_turns(turns);
            let (s, c) = (f64::from(turns) * core::f64::consts::TAU).sin_cos();
            worst = worst.max((f64::from(sin) - s).abs()).max((f64::from(cos) - c).abs());
        }
        assert!(worst < 1.5e-7, "{worst}");
    }

    #[test]
    fn bases_are_orthonormal_also_near_the_poles() {
        for n in [Vec3::Z, Vec3::NEG_Z, Vec3::new(1e-4, 0.0, -1.0).normalize(), Vec3::new(0.6, -0.48, 0.64)] {
            let Onb { tangent, bitangent, normal } = Onb::around(n);
            for dot in [tangent.dot(bitangent), tangent.dot(normal), bitangent.dot(normal)] {
                assert!(dot.abs() < 1e-6, "{n}");
            }
            assert!((tangent.length() - 1.0).abs() < 1e-6 && (bitangent.length() - 1.0).abs() < 1e-6);
            assert!((tangent.cross(bitangent) - normal).length() < 1e-6);
        }
    }
}
