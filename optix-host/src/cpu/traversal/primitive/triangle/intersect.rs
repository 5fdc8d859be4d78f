//! The watertight triangle test.
//!
//! After the shear of [`ShearRay`] the ray is the `z` axis and a triangle is hit if it contains the 2D origin. That is
//! decided by the signs of three edge functions `U, V, W` of the sheared, rounded corners. Two triangles that share an
//! edge with bitwise equal corners evaluate the same number for it, up to its sign, so nothing can slip between them
//! **if the signs are exact**, which they are here:
//!
//! * A product of two `f32` has 48 significant bits and an exponent within `f64`'s range: exact in `f64`. The
//!   difference of two of them, rounded once, has the exact sign and is 0 only if they are equal.
//! * The vector test works in `f32`: `P = fl(c_x b_y)`, `Q = fl(c_y b_x)`, `U = fl(P - Q)`. With `e = 2^-24` the
//!   products are off by at most `e(|P| + |Q|)(1 + 2 e) + 2^-149`, the last part for denormal numbers; the difference
//!   has the sign of `P - Q`, off by a factor `1 + e`. So the sign is right if
//!   `|U| > 2^-23 (|P| + |Q|) + 2^-125` (twice what is needed). Otherwise, for infinities and NaN too, the sign
//!   counts as unknown.
//!
//! A lane is dropped if one of its edges is surely positive and another surely negative, and if its corners all lie on
//! one side of the depths that count; the remaining ones, which are few, are decided in `f64` by [`hit`]. An origin on an edge belongs to the triangles on both sides. A triangle whose
//! projection has no area (`U = V = W = 0`) is not hit, and no hole comes of it: in a closed surface the ray then meets
//! a neighbour with area, because all rays close to it do.
//!
//! # Error
//!
//! From the signs on everything is in `f64`, so `t`, `u` and `v` are those of the triangle with sheared corners
//! `(x_i, y_i, z_i)`, rounded once to `f32` (relative error `2^-24 (1 + 2^-25)`). The sheared corners differ from the
//! exact ones by at most `6 e r` in `x` and `y` and `e r` in `z`, where `r` is the largest distance on any axis of
//! a corner from the ray's origin (derivation in [`PreparedRay::boxes`](crate::cpu::traversal::ray::PreparedRay::boxes); one `e r` more for the
//! rounding of the slope). For a triangle that is the plane `z = z_0 + g_x x + g_y y` in exact sheared coordinates, the
//! depth is thus off by about `e r (1 + 6 |g_x| + 6 |g_y|)`, and never leaves the depths of its corners.

use crate::cpu::traversal::bvh::{Lanes, WIDTH};
use crate::cpu::traversal::ray::{SHRINK, ShearRay};

/// Eight triangles as structure of arrays, `corners[corner][axis][lane]`, in five cache lines: a ray that comes here
/// mostly finds the block in none of the near caches, and then waits for its lines, not for arithmetic.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Block {
    pub corners: [[Lanes; 3]; 3],
    /// Counted over all inputs of the structure.
    pub primitives: [u32; WIDTH],
}

impl Block {
    /// Up to eight of the `triangles`; unused lanes repeat the first.
    pub fn new(primitives: &[u32], triangles: &[[[f32; 3]; 3]]) -> Self {
        let primitives: [u32; WIDTH] =
            std::array::from_fn(|lane| primitives.get(lane).copied().unwrap_or(primitives[0]));
        let corners = std::array::from_fn(|corner| {
            std::array::from_fn(|axis| Lanes(primitives.map(|p| triangles[p as usize][corner][axis])))
        });
        Self { corners, primitives }
    }

    /// All coordinates times [`SHRINK`].
    pub fn shrunk(&self) -> Self {
        Self {
            corners: self.corners.map(|corner| corner.map(|axis| Lanes(axis.0.map(|x| x * SHRINK)))),
            primitives: self.primitives,
        }
    }

    #[inline(always)]
    pub fn triangle(&self, lane: usize) -> [[f32; 3]; 3] {
        std::array::from_fn(|corner| std::array::from_fn(|axis| self.corners[corner][axis].0[lane & (WIDTH - 1)]))
    }
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Finite and not negative; not compared with the ray's interval.
    pub t: f32,
    /// Weights of the second and third corner, in `[0, 1]`.
    pub u: f32,
    pub v: f32,
    /// Whether the corners go counter-clockwise as seen from the ray's origin.
    pub front: bool,
}

/// Relative and absolute threshold below which the sign of an edge function in `f32` counts as unknown.
pub const EDGE_RELATIVE: f32 = 1.0 / (1 << 23) as f32;
pub const EDGE_ABSOLUTE: f32 = f32::MIN_POSITIVE * 2.0;

/// The triangles of a block in the ray's sheared space, `[corner][axis][lane]`.
pub type Sheared = [[Lanes; 3]; 3];

/// A triangle of a sheared block.
#[inline(always)]
pub fn lane_of(sheared: &Sheared, lane: usize) -> [[f32; 3]; 3] {
    sheared.map(|corner| corner.map(|axis| axis.0[lane & (WIDTH - 1)]))
}

/// The edge function of two sheared corners: exact sign, relative error `2^-53`.
#[inline(always)]
pub fn edge(from: [f32; 3], to: [f32; 3]) -> f64 {
    f64::from(from[0]) * f64::from(to[1]) - f64::from(from[1]) * f64::from(to[0])
}

/// The exact test of one triangle, given by its sheared corners. `None` for a miss, for a hit behind the origin, for a
/// triangle without area as seen along the ray, and where coordinate differences overflow. Never gives NaN.
#[inline(always)]
pub fn hit(ray: &ShearRay, [a, b, c]: [[f32; 3]; 3]) -> Option<TriangleHit> {
    let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
    // Without short circuits, which are branches that nothing predicts.
    if ((u < 0.0) | (v < 0.0) | (w < 0.0)) & ((u > 0.0) | (v > 0.0) | (w > 0.0)) {
        return None;
    }
    // No cancellation: all three have the same sign.
    let determinant = u + v + w;
    if determinant == 0.0 || !determinant.is_finite() {
        return None;
    }
    let t = (u * f64::from(a[2]) + v * f64::from(b[2]) + w * f64::from(c[2])) / (determinant * ray.major);
    // Before rounding, which could make 0 of a hit behind the origin. `+ 0.0` turns -0 into 0.
    let (behind, t) = (t < 0.0, t as f32 + 0.0);
    (!behind && t.is_finite()).then_some(TriangleHit {
        t,
        u: (v / determinant) as f32,
        v: (w / determinant) as f32,
        front: determinant > 0.0,
    })
}
