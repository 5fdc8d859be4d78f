//! Custom primitives, given by their bounding boxes.

use super::{BuildInput, BuildInputs, GasPrimitive, GeometryError, IntoGeometry, PrimitiveArray};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use optix_device_rs::primitive::Custom;

/// An axis-aligned box in object space, laid out as `OptixAabb`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Aabb {
    /// Least corner.
    pub min: Vec3,
    /// Greatest corner.
    pub max: Vec3,
}

impl Aabb {
    fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// Whether it holds nothing, since `min > max` on an axis.
    fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }
}

/// Custom primitives to be: a bounding box for each, in which an intersection program says where a ray hits it.
#[derive(Clone, Copy, Debug)]
pub struct CustomPrimitives<'a> {
    bounds: &'a [Aabb],
}

impl<'a> CustomPrimitives<'a> {
    /// One primitive in each box: finite, `min <= max`. One without end reaches from `f32::MIN` to `f32::MAX`.
    pub fn new(bounds: &'a [Aabb]) -> Self {
        Self { bounds }
    }
}

impl IntoGeometry for CustomPrimitives<'_> {
    type Kind = Custom;

    /// Inverted boxes are refused, too: nobody who has a primitive gives it such a box on purpose.
    fn check(self) -> Result<CustomPrimitiveArray, GeometryError> {
        match self.bounds.iter().position(|bounds| !bounds.is_finite() || bounds.is_empty()) {
            Some(index) => Err(bad_box(self.bounds, index)),
            None => CustomPrimitiveArray::new(self.bounds.to_vec()),
        }
    }
}

fn bad_box(bounds: &[Aabb], index: usize) -> GeometryError {
    let Aabb { min, max } = bounds[index];
    GeometryError::BadBox { index, min, max }
}

/// Checked boxes of custom primitives: coordinates are finite. One with `min > max` on an axis makes its primitive inactive.
#[derive(Clone, Debug, PartialEq)]
pub struct CustomPrimitiveArray {
    bounds: Vec<Aabb>,
}

impl CustomPrimitiveArray {
    /// Checks boxes. No boxes at all are legal.
    pub fn new(bounds: Vec<Aabb>) -> Result<Self, GeometryError> {
        match bounds.iter().position(|bounds| !bounds.is_finite()) {
            Some(index) => Err(bad_box(&bounds, index)),
            None => Ok(Self { bounds }),
        }
    }

    /// The boxes.
    pub fn bounds(&self) -> &[Aabb] {
        &self.bounds
    }
}

impl GasPrimitive for Custom {
    type Array = CustomPrimitiveArray;
}

impl PrimitiveArray for CustomPrimitiveArray {
    type Primitive = Custom;
    const NAME: &'static str = "custom geometry";

    fn inputs(inputs: Vec<BuildInput<Self>>) -> BuildInputs {
        BuildInputs::Custom(inputs)
    }

    fn len(&self) -> usize {
        self.bounds.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_boxes_are_named() {
        let unit = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        let inverted = Aabb { min: Vec3::ONE, max: Vec3::ZERO };
        let endless = Aabb { min: Vec3::splat(f32::MIN), max: Vec3::splat(f32::MAX) };
        assert!(CustomPrimitives::new(&[unit, endless]).check().is_ok());
        assert_eq!(CustomPrimitiveArray::new(vec![unit, inverted]).unwrap().len(), 2);
        assert!(CustomPrimitiveArray::new(vec![]).unwrap().is_empty());
        let error = |index: usize, Aabb { min, max }: Aabb| GeometryError::BadBox { index, min, max };
        assert_eq!(CustomPrimitives::new(&[unit, inverted]).check().unwrap_err(), error(1, inverted));
        let open = Aabb { max: Vec3::INFINITY, ..unit };
        assert_eq!(CustomPrimitives::new(&[open]).check().unwrap_err(), error(0, open));
        assert_eq!(CustomPrimitiveArray::new(vec![unit, open]).unwrap_err(), error(1, open));
        let nan = Aabb { min: Vec3::NAN, ..unit };
        assert!(CustomPrimitives::new(&[nan]).check().is_err() && CustomPrimitiveArray::new(vec![nan]).is_err());
    }
}
