//! What a scene uses of what OptiX can do. The scene adds to it with each structure, material and callable that it gets, and
//! pipelines are specialised to it.

use crate::geometry::BuildInputs;
use optix_device_rs::host::PrimitiveType;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// What a scene uses.
#[derive(Clone, Debug, Default)]
pub(crate) struct Features {
    /// Kinds of primitives, in order of first use.
    pub primitives: Vec<PrimitiveType>,
    /// Whether any geometry has more than one motion key.
    pub motion: bool,
    /// The most levels of instances over a GAS, of all structures that were built.
    pub instance_levels: u32,
    /// Which structures rays are traced against.
    pub roots: Roots,
    /// Hit groups with a record, by their index in the pipeline's description.
    pub hit_groups: BTreeSet<usize>,
    /// Callables with a record, by their index in the pipeline's description.
    pub callables: BTreeSet<usize>,
}

impl Features {
    /// What a GAS of these adds.
    pub fn add_gas(&mut self, inputs: &BuildInputs) {
        let kind = inputs.kind();
        if !self.primitives.contains(&kind) {
            self.primitives.push(kind);
        }
        self.motion |= inputs.motion_keys() > 1;
    }

    /// What a structure with so many levels of instances adds.
    pub fn add_structure(&mut self, instance_levels: u32) {
        self.instance_levels = self.instance_levels.max(instance_levels);
    }
}

/// Which structures rays are traced against, by their levels of instances. A clone is the same, since a structure is told to be
/// a root when nobody has the scene at hand.
#[derive(Clone, Debug, Default)]
pub(crate) struct Roots(Arc<AtomicU32>);

impl Roots {
    /// Rays are traced against a structure with so many levels of instances.
    pub fn add(&self, instance_levels: u32) {
        self.0.fetch_or(1 << instance_levels, Relaxed);
    }

    /// The least levels of a root, apart from those with `instance_levels`.
    pub fn least_but(&self, instance_levels: u32) -> Option<u32> {
        let others = self.0.load(Relaxed) & !(1 << instance_levels);
        (others != 0).then(|| others.trailing_zeros())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{BuildInput, CustomPrimitiveArray, TriangleArray};

    #[test]
    fn structures_add_what_they_use() {
        let triangles: BuildInputs = Vec::<BuildInput<TriangleArray>>::new().into();
        let custom: BuildInputs = Vec::<BuildInput<CustomPrimitiveArray>>::new().into();
        let mut features = Features::default();
        for inputs in [&custom, &triangles, &custom] {
            features.add_gas(inputs);
        }
        assert_eq!(features.primitives, [custom.kind(), triangles.kind()]);
        assert!(!features.motion);
        for levels in [1, 2, 0] {
            features.add_structure(levels);
        }
        assert_eq!(features.instance_levels, 2);
        features.clone().roots.add(2);
        assert_eq!(features.roots.least_but(2), None);
        features.roots.add(1);
        assert_eq!((features.roots.least_but(2), features.roots.least_but(1)), (Some(1), Some(2)));
    }
}
