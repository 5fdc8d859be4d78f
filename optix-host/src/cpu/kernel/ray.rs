//! Rays: the query of a trace call, and what is derived from it once for each space it enters.

use super::aabb::Aabb;

/// The arguments of a trace call (guide §13.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayQuery {
    pub origin: [f32; 3],
    /// Any length but 0; `t` counts in multiples of it. A ray with an element that is not finite, or with no
    /// direction, misses everything.
    pub direction: [f32; 3],
    /// Closed interval of hits. A negative `tmin` is undefined in OptiX (§13.2) and taken as 0 here; NaN misses.
    pub tmin: f32,
    /// May be infinite.
    pub tmax: f32,
    /// Handed on to programs; nothing in this module moves.
    pub time: f32,
    pub mask: u8,
    /// Bits of [`ray_flags`](super::ray_flags).
    pub flags: u32,
    /// Only the lowest 4 bits count (§7.3.3).
    pub sbt_offset: u32,
    /// Only the lowest 4 bits count (§7.3.4).
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

/// What the triangle test needs of a ray: the shear of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection"
/// (JCGT 2013), which maps the ray to the `z` axis. It is the same for all triangles, so that a vertex goes to the same
/// three floats whichever triangle it is read from.
#[derive(Clone, Copy, Debug)]
pub struct ShearRay {
    pub origin: [f32; 3],
    /// The axis of the largest direction element last; the first two keep the winding as seen along the ray.
    pub axes: [usize; 3],
    /// `d[axes[0]] / d[axes[2]]` and `d[axes[1]] / d[axes[2]]`, rounded; magnitude at most 1.
    pub slope: [f32; 2],
    /// `d[axes[2]]`: depth along the major axis is `t` times this.
    pub major: f64,
}

/// What the box test needs of a ray. See [`Frame::new`] for why no box is missed.
///
/// Distances here are *depths*: lengths along the major axis, `t * |d[major]|`, in the units of the space.
#[derive(Clone, Copy, Debug)]
pub struct BoxRay {
    /// Origins moved outwards by the margin, for the near and the far plane of each axis.
    pub near_origin: [f32; 3],
    pub far_origin: [f32; 3],
    /// Reciprocal slopes against depth: never 0, infinite or NaN.
    pub inverse: [f32; 3],
    /// Index in [`Node::planes`](super::bvh::Node) of the near plane of each axis; the far plane's is this `^ 1`.
    pub near_plane: [usize; 3],
    pub depth_min: f32,
}

/// A ray prepared for one space and one structure in it.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub shear: ShearRay,
    pub boxes: BoxRay,
}

/// Slopes below this are raised to it: at any depth within `R` that moves the ray by less than `2^-40 R`.
const MIN_SLOPE: f32 = 1.0 / (1u64 << 40) as f32;
/// Beyond this distance differences of coordinates could overflow; the structure is then missed.
const MAX_REACH: f32 = f32::MAX / 8.0;

impl Frame {
    /// Prepares `ray` for the structure with these `bounds`. `None` if it misses for sure.
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
    /// box widened by `6 e R` on all sides holds the ray's point at depth `h`. The slab test computes
    /// `fl(fl(lo - o') * fl(1 / s))` with three roundings, a relative error of at most `3.01 e` of a length that is at
    /// most `R`: `3.01 e R` more. Raising small slopes adds `2^-40 R`. So a margin of `10 e R` is enough; `16 e R` is
    /// used, and `2^-120` is added so that rounding of denormal numbers is covered as well. The margin is put into the
    /// origin, rounded outwards, where it costs nothing per box.
    ///
    /// `slack` multiplies the margin: 1 for a structure of primitives, more where boxes stand for transformed content
    /// (see [`Ias`](super::Ias)).
    pub fn new(ray: &Ray, tmin: f32, bounds: &Aabb, slack: f32) -> Option<Self> {
        let Ray { origin, direction } = *ray;
        let magnitude = direction.map(f32::abs);
        let finite = origin.iter().chain(&direction).all(|x| x.is_finite());
        let z = match magnitude {
            [x, y, z] if x >= y && x >= z => 0,
            [_, y, z] if y >= z => 1,
            _ => 2,
        };
        let major = direction[z];
        let reach = (0..3).fold(0.0f32, |reach, a| {
            reach.max((bounds.min[a] - origin[a]).abs()).max((bounds.max[a] - origin[a]).abs())
        });
        if !finite || major == 0.0 || bounds.is_empty() || !(reach <= MAX_REACH) {
            return None;
        }

        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if major < 0.0 {
            (x, y) = (y, x);
        }
        let shear = ShearRay {
            origin,
            axes: [x, y, z],
            slope: [direction[x] / major, direction[y] / major],
            major: f64::from(major),
        };

        let margin = (reach * (1.0 / (1 << 20) as f32) * slack).min(2.0 * reach) + f32::MIN_POSITIVE * 64.0;
        let mut boxes = BoxRay {
            near_origin: origin,
            far_origin: origin,
            inverse: [0.0; 3],
            near_plane: [0; 3],
            depth_min: 0.0,
        };
        for a in 0..3 {
            // Division is symmetric in sign, so this is the shear's slope up to the sign of the major element.
            let slope = direction[a] / major.abs();
            let slope = if slope.abs() < MIN_SLOPE { MIN_SLOPE.copysign(slope) } else { slope };
            boxes.inverse[a] = 1.0 / slope;
            let (above, below) = ((origin[a] + margin).next_up(), (origin[a] - margin).next_down());
            if slope > 0.0 {
                (boxes.near_origin[a], boxes.far_origin[a], boxes.near_plane[a]) = (above, below, 2 * a);
            } else {
                (boxes.near_origin[a], boxes.far_origin[a], boxes.near_plane[a]) = (below, above, 2 * a + 1);
            }
        }
        let frame = Self { shear, boxes };
        let t = (f64::from(tmin) - f64::from(f32::from_bits(1))).max(0.0);
        let depth_min = (t * frame.shear.major.abs() * (1.0 - DEPTH_SLACK)) as f32;
        Some(Self { boxes: BoxRay { depth_min, ..frame.boxes }, ..frame })
    }

    /// A depth that no hit with `t <= tmax` exceeds: `t` was rounded from its depth, by half an ulp.
    pub fn depth_max(&self, tmax: f32) -> f32 {
        let t = f64::from(tmax) + f64::from(f32::from_bits(1));
        (t * self.shear.major.abs() * (1.0 + DEPTH_SLACK)) as f32
    }
}

/// Covers the rounding of `t` (`2^-24`) and of the depth limit itself (`2^-24`).
const DEPTH_SLACK: f64 = 1.0 / (1 << 22) as f64;
