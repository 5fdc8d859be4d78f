//! Rays: the query of a trace call, and what is derived from it once for each space it enters.

use glam::{BVec3A, Vec3A};

use super::bvh::Aabb;

/// The arguments of a trace call (guide 13.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayQuery {
    pub origin: [f32; 3],
    /// Any length but 0; `t` counts in multiples of it. A ray with an element that is not finite, or with no
    /// direction, misses everything; one that becomes so in the space of an instance misses what the instance holds.
    pub direction: [f32; 3],
    /// Closed interval of hits. A negative `tmin` is undefined in OptiX (guide 13.2) and taken as 0 here; NaN misses.
    pub tmin: f32,
    /// May be infinite.
    pub tmax: f32,
    /// Handed on to programs; nothing in this module moves.
    pub time: f32,
    pub mask: u8,
    /// Bits of [`ray_flags`](super::ray_flags).
    pub flags: u32,
    /// Only the lowest 4 bits count (guide 7.3.3).
    pub sbt_offset: u32,
    /// Only the lowest 4 bits count (guide 7.3.4).
    pub sbt_stride: u32,
}

impl RayQuery {
    /// A ray with `[0, inf]`, all visibility groups, no flags, SBT offset 0 and stride 1.
    pub fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        Self {
            origin,
            direction,
            tmin: 0.0,
            tmax: f32::INFINITY,
            time: 0.0,
            mask: 0xff,
            flags: 0,
            sbt_offset: 0,
            sbt_stride: 1,
        }
    }
}

/// Origin and direction in some space; the direction is not normalised, so that `t` means the same in all spaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: [f32; 3],
    pub direction: [f32; 3],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    X,
    Y,
    Z,
}

/// What the triangle test needs of a ray: the shear of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection"
/// (JCGT 2013), which maps the ray to the `z` axis. It is the same for all triangles, so that a vertex goes to the same
/// three floats whichever triangle it is read from.
#[derive(Clone, Copy, Debug)]
pub struct ShearRay {
    /// The origin's elements in the order of `axes`.
    pub origin: [f32; 3],
    /// The axis of the largest direction element last; the first two keep the winding as seen along the ray.
    pub axes: [Axis; 3],
    /// `d[axes[0]] / d[axes[2]]` and `d[axes[1]] / d[axes[2]]`, rounded; magnitude at most 1.
    pub slope: [f32; 2],
    /// `d[axes[2]]`: depth along the major axis is `t` times this.
    pub major: f64,
}

impl ShearRay {
    /// Of the same ray where all lengths are [`SHRINK`] times as large. That is exact, but for denormal numbers: they lose less
    /// than `2^-144` of an original length, which the margin of [`PreparedRay::boxes`] covers. So triangles with coordinates up to
    /// `f32::MAX` are decided as others are, and `t` is the same.
    pub fn shrunk(&self) -> Self {
        Self { origin: self.origin.map(|x| x * SHRINK), major: self.major * f64::from(SHRINK), ..*self }
    }
}

/// What the box test needs of a ray. See [`PreparedRay::boxes`] for why no box is missed.
///
/// Distances here are *depths*: lengths along the major axis, `t * |d[major]|`, in the units of the space.
#[derive(Clone, Copy, Debug)]
pub struct BoxRay {
    /// Origins moved outwards by the margin, for the near and the far plane of each axis.
    pub near_origin: [f32; 3],
    pub far_origin: [f32; 3],
    /// Reciprocal slopes against depth: never 0, infinite or NaN.
    pub inverse: [f32; 3],
    /// Whether the near plane of each axis is the upper one.
    pub backward: [bool; 3],
    pub depth_min: f32,
    /// Whether differences of coordinates may overflow, so that triangles are tested [shrunk](ShearRay::shrunk).
    pub far: bool,
}

/// A ray prepared for one space.
#[derive(Clone, Copy, Debug)]
pub struct PreparedRay {
    pub shear: ShearRay,
    origin: Vec3A,
    /// As in [`BoxRay`].
    inverse: Vec3A,
    backward: BVec3A,
    /// A depth that every hit with `t >= tmin` reaches.
    pub depth_min: f32,
}

/// The axes of a shear, by the major axis and whether the ray runs down it.
const SHEARS: [[[Axis; 3]; 2]; 3] = [
    [[Axis::Y, Axis::Z, Axis::X], [Axis::Z, Axis::Y, Axis::X]],
    [[Axis::Z, Axis::X, Axis::Y], [Axis::X, Axis::Z, Axis::Y]],
    [[Axis::X, Axis::Y, Axis::Z], [Axis::Y, Axis::X, Axis::Z]],
];

/// Of the reach: `16 e`.
const MARGIN: f32 = 1.0 / (1 << 20) as f32;
/// Slopes below this are raised to it: at any depth within `R` that moves the ray by less than `2^-40 R`.
const MIN_SLOPE: f32 = 1.0 / (1u64 << 40) as f32;
/// Beyond this distance differences and sums of coordinates could overflow; see [`PreparedRay::far_boxes`] and [`ShearRay::shrunk`].
const MAX_REACH: f32 = f32::MAX / 8.0;
/// What far structures are scaled by: twice the largest coordinate is then within [`MAX_REACH`].
pub const SHRINK: f32 = 1.0 / 32.0;

impl PreparedRay {
    /// Prepares a ray. `None` for one that misses everything: with an element that is not finite, or without direction.
    #[inline(always)]
    pub fn new(origin: &[f32; 3], direction: &[f32; 3], tmin: f32) -> Option<Self> {
        // Element by element: a wider load would have to wait until the elements, just stored, have left the core.
        let load = |v: &[f32; 3]| Vec3A::new(v[0], v[1], v[2]);
        let (origin, direction) = (load(origin), load(direction));
        let magnitude = direction.abs();
        let length = magnitude.max_element();
        if !(origin.is_finite() && direction.is_finite() && length > 0.0) {
            return None;
        }
        // The first axis of the greatest length, without branches: they would be mispredicted every other time.
        let [x, y, _] = magnitude.to_array();
        let (not_x, not_y) = (usize::from(x != length), usize::from(y != length));
        let axis = not_x + (not_x & not_y);
        let major = direction[axis];

        let slope = direction / length;
        let axes = SHEARS[axis][usize::from(major < 0.0)];
        // Division is symmetric in sign: these are the quotients by the major element.
        let sign = major.to_bits() & (1 << 31);
        let quotient = |a: Axis| f32::from_bits(slope[a as usize].to_bits() ^ sign);
        let shear = ShearRay {
            origin: [origin[axes[0] as usize], origin[axes[1] as usize], origin[axes[2] as usize]],
            axes,
            slope: [quotient(axes[0]), quotient(axes[1])],
            major: f64::from(major),
        };

        // Not from the rounded slope, which would take another division after the first.
        let inverse = (length / magnitude).min(Vec3A::splat(1.0 / MIN_SLOPE)).copysign(direction);
        let t = (f64::from(tmin) - SMALLEST).max(0.0);
        Some(Self {
            shear,
            origin,
            inverse,
            backward: inverse.cmplt(Vec3A::ZERO),
            depth_min: ((t * f64::from(length) * (1.0 - DEPTH_SLACK)) as f32).min(f32::MAX),
        })
    }

    /// The largest distance on any axis between the origin and a corner of `bounds`. Infinite for an empty box, and more than
    /// [`MAX_REACH`] where differences of coordinates may overflow.
    #[inline(always)]
    fn reach(&self, bounds: &Aabb) -> f32 {
        let (low, high) = (Vec3A::from_array(bounds.min), Vec3A::from_array(bounds.max));
        (low - self.origin).abs().max((high - self.origin).abs()).max_element()
    }

    /// Whether triangles within these bounds are tested [shrunk](ShearRay::shrunk). `None` if there are none.
    #[inline(always)]
    pub fn is_far(&self, bounds: &Aabb) -> Option<bool> {
        #[cold]
        fn unless_empty(bounds: &Aabb) -> Option<bool> {
            (!bounds.is_empty()).then_some(true)
        }
        if self.reach(bounds) <= MAX_REACH { Some(false) } else { unless_empty(bounds) }
    }

    /// Prepares the box tests of the structure with these `bounds`. `None` if it is empty.
    ///
    /// # No box is missed
    ///
    /// Let `e = 2^-24`, `R` the largest distance on any axis between the origin `o` and a corner of `bounds`, `s` the
    /// rounded slopes of [`ShearRay`], and take a triangle with corners `o + a_i`, `|a_i| <= R`, that the test in
    /// [`triangle`](super::triangle) hits. That test works with
    ///
    /// ```text
    /// z_i = fl(a_z) = a_z + e R            x_i = fl(fl(a_x) - fl(s_x z_i)) = a_x - s_x a_z + 5 e R
    ///                                      (1 e R for a_x, 1 for z_i, 1 for the product, 2 for the difference)
    /// ```
    ///
    /// (signs of errors left out) and decides exactly on these numbers. So there are exact weights `w_i >= 0`, sum 1,
    /// with `sum w_i x_i = sum w_i y_i = 0`; it reports the depth `h = sum w_i z_i`. The point `p = sum w_i a_i` lies in
    /// every box around the triangle and `|p_x - s_x h| <= 6 e R`, the same for `y`, and `|p_z - h| <= e R`. Hence a
    /// box widened by `6 e R` on all sides holds the ray's point at depth `h`. The slab test uses the slopes `s'` before
    /// rounding, which moves that point by `e R`. It computes `fl(fl(lo - o') * fl(1 / s'))` with three roundings, a
    /// relative error of at most `3.01 e` of a length that is at most `R`: `3.01 e R` more. Raising small slopes adds
    /// `2^-40 R`. So a margin of `11 e R` is enough; `16 e R` is used, and `2^-120` is added so that rounding of denormal
    /// numbers is covered as well. The margin is put into the origin, where it costs nothing per box.
    ///
    /// `slack` multiplies the margin: 1 for a structure of primitives, more where boxes stand for transformed content
    /// (see [`Ias`](super::Ias)).
    #[inline(always)]
    pub fn boxes(&self, bounds: &Aabb, slack: f32) -> Option<BoxRay> {
        let reach = self.reach(bounds);
        if reach > MAX_REACH {
            return self.far_boxes(bounds, slack);
        }
        let margin = (reach * MARGIN * slack).min(2.0 * reach) + 64.0 * f32::MIN_POSITIVE;
        // The second part is twice what rounding the sums below can take away.
        let margin = Vec3A::splat(margin) + self.origin.abs() * f32::EPSILON;
        Some(self.box_ray(self.origin + margin, self.origin - margin, false))
    }

    /// [`PreparedRay::boxes`] where sums and differences may overflow, as they do around planes without end. The margin is the same,
    /// unless it goes beyond the largest number, which is then as far outwards as boxes are. A plane whose distance overflows is
    /// infinitely far, on its side: nothing is 0 times infinity or the difference of infinities, so nothing is NaN.
    #[cold]
    fn far_boxes(&self, bounds: &Aabb, slack: f32) -> Option<BoxRay> {
        if bounds.is_empty() {
            return None;
        }
        let (low, high, origin) =
            (Vec3A::from_array(bounds.min) * 0.5, Vec3A::from_array(bounds.max) * 0.5, self.origin * 0.5);
        let half = (low - origin).abs().max((high - origin).abs()).max_element();
        let margin = Vec3A::splat(half * (2.0 * MARGIN * slack).min(4.0)) + self.origin.abs() * f32::EPSILON;
        let finite = |v: Vec3A| v.clamp(Vec3A::splat(f32::MIN), Vec3A::splat(f32::MAX));
        Some(self.box_ray(finite(self.origin + margin), finite(self.origin - margin), true))
    }

    #[inline(always)]
    fn box_ray(&self, above: Vec3A, below: Vec3A, far: bool) -> BoxRay {
        BoxRay {
            near_origin: Vec3A::select(self.backward, below, above).to_array(),
            far_origin: Vec3A::select(self.backward, above, below).to_array(),
            inverse: self.inverse.to_array(),
            backward: [self.backward.test(0), self.backward.test(1), self.backward.test(2)],
            depth_min: self.depth_min,
            far,
        }
    }

    /// A depth that no hit with `t <= tmax` exceeds: `t` was rounded from its depth, by half an ulp.
    #[inline(always)]
    pub fn depth_max(&self, tmax: f32) -> f32 {
        let t = f64::from(tmax) + SMALLEST;
        (t * self.shear.major.abs() * (1.0 + DEPTH_SLACK)) as f32
    }
}

/// The smallest `f32` above 0: more than a `t` among the denormal numbers is off by.
const SMALLEST: f64 = 1.0 / (1u64 << 63) as f64 / (1u64 << 63) as f64 / (1u64 << 23) as f64;
/// Covers the rounding of `t` (`2^-24`) and of the depth limit itself (`2^-24`).
const DEPTH_SLACK: f64 = 1.0 / (1 << 22) as f64;
