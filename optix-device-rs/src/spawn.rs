//! Hit points with an error bound, so that rays that start there don't hit the surface they left.

use crate::program::Transform;
use crate::ray::Ray;
use glam::Vec3;

/// Unit roundoff of `f32`.
const U: f32 = 1.0 / 16_777_216.0;

/// `n * u / (1 - n * u)`: the relative error of `n` roundings (Higham 2002, section 3.1), rounded up.
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f64 / 16_777_216.0;
    (nu / (1.0 - nu)) as f32 * (1.0 + 2.0 * U)
}

/// A point on a surface in world space, with its geometric normal and a bound of its error along that normal.
///
/// # The bound
///
/// Let a triangle in object space have vertices `p0, p1, p2`, a hit barycentrics `u, v`, an instance object-to-world matrix
/// `M` and world-to-object matrix `W` as the machine stores them. A ray that starts at the world point `x` is tested by the
/// machine at `W x` in object space, so what counts is the distance of *that* point, as computed, from the triangle's plane.
/// [`SurfacePoint::of_triangle`] bounds it by the sum of, all along the object-space normal `n` with |n| = 1:
///
/// 1. *interpolation*: `(1 - u - v) p0 + u p1 + v p2` is computed with at most 5 roundings on a term and 2 in `1 - u - v`,
///    which is a combination of the vertices with weights that sum to 1 but for those 2: at most
///    `gamma(5) (|b0 p0| + |b1 p1| + |b2 p2|) + 2 u |p0|`. The hit's own `u` and `v` may be off by any amount: they still
///    name a point of the plane;
/// 2. *residual*: how far `W (M p)`, both as computed here, is from `p`. It is evaluated, not bounded, so it covers whatever
///    the machine did to invert the matrix: `|n . (W M p - p)|`;
/// 3. *the machine's own rounding* when it maps the origin, which may differ from ours in order and contraction, twice for
///    the evaluation in 2: `2 gamma(4) (|W| |x| + |w|)`, and the rounding of `x` itself when the offset is added:
///    `2 u |W| |x|`;
/// 4. *the intersection*: a test that translates vertices to the ray's origin and evaluates the plane from the differences
///    (Woop, Benthin and Wald 2013) errs by roundings on lengths up to the longest edge: `gamma(16) (|e1| + |e2|)`.
///
/// A plane distance `d` in object space is `d / |W^T n|` in world space, exactly, so the sum divided by that length is
/// [`SurfacePoint::error`]. A ray whose origin is moved by it to the side it leaves to starts on that side as the machine
/// sees it. The constants of OptiX's own triangle test are not published; that its hits respect the same bound is measured,
/// not proven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, in world space.
    pub position: Vec3,
    /// Unit normal of the surface itself (not interpolated): counter-clockwise vertices are seen from its side.
    pub normal: Vec3,
    /// Bound of the distance from the surface along the normal, in world units.
    pub error: f32,
}

impl SurfacePoint {
    /// A point whose error the caller knows: for custom primitives.
    #[inline(always)]
    pub fn new(position: Vec3, normal: Vec3, error: f32) -> Self {
        Self { position, normal, error }
    }

    /// The point at `barycentrics` of a triangle given in object space; see the type for the bound.
    #[inline(always)]
    pub fn of_triangle(
        [p0, p1, p2]: [Vec3; 3],
        barycentrics: glam::Vec2,
        object_to_world: &Transform,
        world_to_object: &Transform,
    ) -> Self {
        let (b1, b2) = (barycentrics.x, barycentrics.y);
        let b0 = 1.0 - b1 - b2;
        let (e1, e2) = (p1 - p0, p2 - p0);
        let (t0, t1, t2) = (p0 * b0, p1 * b1, p2 * b2);
        let object = t0 + t1 + t2;
        let n = unit(e1.cross(e2));

        let interpolation = (t0.abs() + t1.abs() + t2.abs()) * gamma(5) + p0.abs() * (2.0 * U);
        let intersection = (e1.abs() + e2.abs()) * gamma(16);
        Self::of_object(object, n, interpolation + intersection, object_to_world, world_to_object)
    }

    /// A point given in object space with unit normal `normal`: for custom primitives in instances.
    ///
    /// `error` bounds, per object-space axis, how far `point` is off the surface as the intersection program sees it (terms
    /// 1 and 4 of the bound); the terms of the transforms are added here.
    #[inline(always)]
    pub fn of_object(
        point: Vec3,
        normal: Vec3,
        error: Vec3,
        object_to_world: &Transform,
        world_to_object: &Transform,
    ) -> Self {
        let position = object_to_world.point(point);
        let residual = normal.dot(world_to_object.point(position) - point).abs();
        let mapping = absolute(world_to_object, position.abs()) * (2.0 * gamma(4) + 2.0 * U);
        let object_error = (error + mapping).dot(normal.abs()) + residual;

        let world_normal = world_to_object.normal(normal);
        let per_length = world_normal.length().recip();
        Self {
            position,
            normal: world_normal * per_length,
            // The sums above are of positive terms, each with a few roundings itself.
            error: object_error * per_length * (1.0 + gamma(16)),
        }
    }

    /// Where a ray in `direction` starts: the point moved off the surface, to the side that `direction` leads to.
    #[inline(always)]
    pub fn origin(&self, direction: Vec3) -> Vec3 {
        let side = self.error.copysign(self.normal.dot(direction));
        self.position + self.normal * side
    }

    /// A ray from here in `direction`.
    #[inline(always)]
    pub fn ray(&self, direction: Vec3) -> Ray {
        Ray::new(self.origin(direction), direction)
    }

    /// A ray from here to another surface's point, which ends (`t` = 1) just before that surface: for shadow rays.
    #[inline(always)]
    pub fn ray_to(&self, target: &SurfacePoint) -> Ray {
        let direction = target.position - self.position;
        let origin = self.origin(direction);
        Ray::new(origin, target.origin(-direction) - origin).range(0.0, 1.0)
    }
}

/// `v` with length 1, also where its square would underflow or overflow.
#[inline(always)]
fn unit(v: Vec3) -> Vec3 {
    // By a power of two, which is exact, from the exponent alone: 2^-e for a largest element from 2^e to 2^(e+1).
    let exponent = v.abs().max_element().to_bits() & 0x7f80_0000;
    let scale = f32::from_bits(0x7f00_0000u32.saturating_sub(exponent).max(0x0080_0000));
    (v * scale).normalize()
}

/// `|A| p + |a|` for the affine map `A, a`.
#[inline(always)]
fn absolute(map: &Transform, p: Vec3) -> Vec3 {
    let row = |[x, y, z, w]: [f32; 4]| x.abs() * p.x + y.abs() * p.y + z.abs() * p.z + w.abs();
    let [x, y, z] = map.rows();
    Vec3::new(row(x), row(y), row(z))
}
