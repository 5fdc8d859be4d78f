//! Maths that shaders need and `core` does not have; one meaning on both machines.

use glam::Vec3;

/// Functions of `f32` that the standard library has and `core` has not, under the same names.
pub trait Math {
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// Sine of an angle in radians.
    fn sin(self) -> Self;
    /// Cosine of an angle in radians.
    fn cos(self) -> Self;
    /// `self` to the power `exponent`.
    fn powf(self, exponent: Self) -> Self;
    /// e to the power `self`.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Greatest integer not above.
    fn floor(self) -> Self;
    /// `self * a + b` with one rounding.
    fn mul_add(self, a: Self, b: Self) -> Self;
}

macro_rules! math {
    ($($name:ident($($arg:ident),*) => $device:ident;)*) => {
        impl Math for f32 {$(
            #[inline(always)]
            fn $name(self $(, $arg: f32)*) -> f32 {
                #[cfg(target_arch = "nvptx64")]
                return libm::$device(self $(, $arg)*);
                #[cfg(not(target_arch = "nvptx64"))]
                return f32::$name(self $(, $arg)*);
            }
        )*}
    };
}

math! {
    sqrt() => sqrtf;
    sin() => sinf;
    cos() => cosf;
    powf(exponent) => powf;
    exp() => expf;
    ln() => logf;
    floor() => floorf;
    mul_add(a, b) => fmaf;
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
        let a = -1.0 / (sign + normal.z);
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
