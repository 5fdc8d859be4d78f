//! Hit points with an error bound, so that rays that start there don't hit the surface they left. What a kind of primitive brings to
//! the bound is in its file, in [`primitive`](crate::primitive).

use crate::program::Transform;
use crate::ray::Ray;
use glam::Vec3;

/// Unit roundoff of `f32`.
pub(crate) const U: f32 = 1.0 / 16_777_216.0;

/// `n * u / (1 - n * u)`: the relative error of `n` roundings (Higham 2002, section 3.1), rounded up. From `2^24` roundings on
/// nothing is known, and it is infinite.
pub const fn gamma(n: u32) -> f32 {
    if n >= 1 << 24 {
        return f32::INFINITY;
    }
    let nu = n as f64 / 16_777_216.0;
    (nu / (1.0 - nu)) as f32 * (1.0 + 2.0 * U)
}

/// Absolute error per object-space axis that denormal numbers can add: far above the few units of `2^-149` that it takes, far
/// below what scenes are made of.
pub(crate) const TINY: f32 = f32::MIN_POSITIVE * 16.0;

/// A point on a surface in world space, with its geometric normal and a bound of its error along that normal.
///
/// # What is promised
///
/// A ray that starts at [`SurfacePoint::origin`] of its own direction does not meet the triangle that the point is on, with
/// any `tmin >= 0`, whatever its direction: [`ray`](Self::ray). A surface that is farther away than the `error`s of both is
/// met. A segment between two points meets neither surface, if each point is farther from the other one's plane than both
/// errors: [`ray_to`](Self::ray_to).
///
/// Nothing is promised of a ray that starts in the plane of a triangle, such as at [`SurfacePoint::position`]. The interval of a
/// ray is closed, so where rounding happens to give `t = tmin`, the triangle is hit.
///
/// # The bound
///
/// All lengths are in object space, `u = 2^-24` and `gamma(n)` the relative error of `n` roundings. A triangle has vertices `p_i`,
/// edges `e1, e2`, the extent `l` (on each axis, the largest distance of two vertices), its largest element `L`, and the
/// *computed* unit normal `n`. An instance has the matrices `M` (object to world) and `W` (world to object) as the program sees
/// them; `x` is the point in world space; `|.|` goes by element. We ask for a *height* `h` above the point, along `n`, such that
/// a ray which starts there and leaves to that side is not seen to meet the triangle. It is enough, as a sum. Terms 1 and 2 are what the surface itself brings: how far a
/// point is off, and how far its intersection test is. [`SurfacePoint::of_triangle`] has those of a triangle; those of a custom
/// primitive its program knows ([`SurfacePoint::of_object`]). The others are:
///
/// 3. *direction*, `gamma(10) |n|.|W| |M| l`. The side is chosen by the computed world normal and direction: 7 roundings
///    on a term of `n.W d`; the machine's direction in object space has up to 3. So a grazing ray may dip, by that much of
///    `|n|.|W| |d|` for each unit of `t`. While it is over the triangle it covers `l` at most, in world space `|M| l`.
/// 4. *the way to the world*: the residual `|n.(W x - p)|` with `x = M p`, both as computed here, whatever the machine did
///    to invert the matrix. It is evaluated, not bounded. The evaluation rounds 3 times on a term of `W x`, and as a whole,
///    by `u |p|`, when the translation `w` is added, which nearly cancels.
/// 5. *the way back*, `gamma(3) |n|.(|W| |x| + |w|)`, the machine's own rounding when it maps the origin; and `u |n|.|W| |x|`
///    for the rounding of `x` when the offset is added: far from 0 the offset is not lost, but as large as it takes.
///
/// Where OptiX walks several instances it applies one after the other, and so are the program's matrices composed, in `f32`.
/// Elements of `|W|`, `|M|` and `|w|` are then sums of magnitudes, times the number of levels. The CPU does both in `f64`.
///
/// A height `h` is a distance `h / |W^T n|` in world space, where `W^T n` is good to `gamma(4) |n|.|W|`. The ratio
/// `|n|.|W| / |W^T n|` is 1 to 3 for rotation and scale, and large only where shear makes the normal a small difference.
///
/// Of 21 roundings on `l` 22 are taken, of 3 on `L` 4; that and factors of `1 + gamma(16)` cover products of errors and the
/// evaluation of the bound itself. All is proven for the CPU where nothing over- or underflows: lengths and coordinates from
/// `2^-60` to `2^60` in either space, and an absolute term for denormal numbers. The arithmetic of OptiX is not published. That
/// 2, 3 and 5 hold for it too is measured, by a search for the worst case (docs/measurements.md), for triangles of `2^-28` to
/// `2^38`: beyond, products of three coordinates leave the range of `f32`.
///
/// The terms are those of Pharr, Jakob and Humphreys ("Physically Based Rendering", 6.8), with the rounding of the test and the
/// transforms added. NVIDIA's Self Intersection Avoidance (OptiX Toolkit) has 1, 2 and 5 with smaller constants, and the same
/// `4 u L`. An offset that depends on the position alone (Wächter and Binder 2019, Ray Tracing Gems, chapter 6) can't cover 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, in world space.
    pub position: Vec3,
    /// Unit normal of the surface itself (not interpolated): counter-clockwise vertices are seen from its side.
    pub normal: Vec3,
    /// Bound of the distance from the surface along the normal, in world units.
    pub error: f32,
    /// What is added to `error` for a ray that comes from elsewhere, for each unit that it is long on its longest axis.
    pub error_per_length: f32,
}

impl SurfacePoint {
    /// A point whose error the caller knows. Seen from afar it counts as one whose transform rotates and scales.
    #[inline(always)]
    pub fn new(position: Vec3, normal: Vec3, error: f32) -> Self {
        Self { position, normal, error, error_per_length: 3.0 * gamma(20) }
    }

    /// A point given in object space with unit normal `normal`: for custom primitives in instances.
    ///
    /// `error` bounds, on each object-space axis, what the intersection program sees of the surface near `point`: how far
    /// its own arithmetic puts it off for rays that start there, of any direction, and how far `point` itself is off (terms
    /// 1 and 2 of the bound). Of a surface with flat parts it is at least `gamma(10)` times their extent, which covers the
    /// rounding of directions (term 3); of one that curves away there is no such term. What transforms add is added here.
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

        // |n|.|W| and |n|.|w|. The error goes to the world and back by magnitudes: that is term 3, and at least |n|.error.
        let (across, translation) = world_to_object.magnitudes_along(normal.abs());
        let world = object_to_world.magnitudes(error) + position.abs() * gamma(7);
        let height = across.dot(world) + translation * gamma(3) + residual;

        let world_normal = world_to_object.normal(normal);
        let per_length = world_normal.length().recip();
        let error_per_length = (across.x + across.y + across.z) * per_length * gamma(20);
        Self {
            position,
            normal: world_normal * per_length,
            // The sums above are of positive terms, each with a few roundings itself; the normal has those of its own.
            error: height * per_length * (1.0 + gamma(16) + error_per_length),
            error_per_length,
        }
    }

    /// Where a ray in `direction` starts: the point moved off the surface, to the side that `direction` leads to.
    #[inline(always)]
    pub fn origin(&self, direction: Vec3) -> Vec3 {
        self.moved(direction, self.error)
    }

    /// A ray from here in `direction`.
    #[inline(always)]
    pub fn ray(&self, direction: Vec3) -> Ray {
        Ray::new(self.origin(direction), direction)
    }

    /// A ray from here to another surface's point, which ends (`t` = 1) just before that surface: for shadow rays.
    ///
    /// The other surface sees the ray's origin from afar. Its test, and the transform to its space, then round by the
    /// ray's length `d` and not by the surface's extent: on a term of `|n|.|W| |d|` 5 times in the test, 4 and 4 where origin and
    /// direction are mapped, and 3 in the direction itself, in `t` and in the end. So the end is `gamma(16)` of that farther off.
    #[inline(always)]
    pub fn ray_to(&self, target: &SurfacePoint) -> Ray {
        let way = target.position - self.position;
        let length = way.abs().max_element();
        let end = target.moved(-way, target.error + target.error_per_length * length);
        let origin = self.origin(end - self.position);
        Ray::new(origin, end - origin).range(0.0, 1.0)
    }

    /// The point moved off the surface by `distance`, to the side that `direction` leads to.
    #[inline(always)]
    fn moved(&self, direction: Vec3, distance: f32) -> Vec3 {
        self.position + self.normal * distance.copysign(self.normal.dot(direction))
    }
}
