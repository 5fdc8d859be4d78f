//! Axis-aligned boxes.

use crate::geometry;
use bytemuck::{Pod, Zeroable};

/// An axis-aligned box, laid out as `OptixAabb` (guide 5.1): six `f32`, 24 bytes, lengths in the units of its space.
///
/// A box with `min > max` on any axis holds nothing; a primitive with such a box is inactive.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Aabb {
    pub min: [f32; 3],
    pub max: [f32; 3],
}

impl Aabb {
    /// The box that holds nothing and is neutral in [`Aabb::union`].
    pub const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    pub fn new(min: [f32; 3], max: [f32; 3]) -> Self {
        Self { min, max }
    }

    /// The smallest box around `points`; exact, since minimum and maximum do not round.
    pub fn around(points: &[[f32; 3]]) -> Self {
        points.iter().fold(Self::EMPTY, |bounds, p| bounds.union(&Self { min: *p, max: *p }))
    }

    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|a| self.min[a].min(other.min[a])),
            max: std::array::from_fn(|a| self.max[a].max(other.max[a])),
        }
    }

    pub fn is_empty(&self) -> bool {
        (0..3).any(|a| self.min[a] > self.max[a])
    }

    pub fn is_finite(&self) -> bool {
        self.min.iter().chain(&self.max).all(|x| x.is_finite())
    }

    /// Half the surface area, in `f64` so that no pair of finite `f32` extents overflows or underflows.
    pub(super) fn half_area(&self) -> f64 {
        let [x, y, z] = std::array::from_fn(|a| f64::from(self.max[a]) - f64::from(self.min[a]));
        x * y + y * z + z * x
    }
}

impl From<&geometry::Aabb> for Aabb {
    fn from(bounds: &geometry::Aabb) -> Self {
        Self { min: bounds.min.to_array(), max: bounds.max.to_array() }
    }
}
