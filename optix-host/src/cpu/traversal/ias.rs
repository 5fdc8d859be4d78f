//! Instance acceleration structures, and the graph of structures.

use std::sync::Arc;

use super::bvh::{Aabb, Bvh, SINGLE_LEAF};
use super::gas::Gas;
use crate::affine::Affine;
use crate::error::{BuildError, InstanceError};
use crate::limits::{MAX_GRAPH_DEPTH, MAX_INSTANCE_NUMBER, MAX_INSTANCES};
use crate::scene::{InstanceInput, InstanceLimits};

/// A structure that rays are traced against.
#[derive(Debug)]
pub enum Accel {
    Gas(Gas),
    Ias(Ias),
}

impl Accel {
    /// The smallest box around all primitives of a GAS; for an IAS a box around all that its instances hold.
    pub fn bounds(&self) -> Aabb {
        match self {
            Self::Gas(gas) => gas.bounds(),
            Self::Ias(ias) => ias.bounds(),
        }
    }

    /// Structures on the longest way down, counting this one; a GAS has 1.
    pub fn depth(&self) -> usize {
        match self {
            Self::Gas(_) => 1,
            Self::Ias(ias) => ias.depth,
        }
    }

    /// Heap bytes of this structure alone.
    pub fn memory_bytes(&self) -> usize {
        match self {
            Self::Gas(gas) => gas.memory_bytes(),
            Self::Ias(ias) => ias.memory_bytes(),
        }
    }

    fn max_sbt_offset(&self) -> u32 {
        match self {
            Self::Gas(_) => 0,
            Self::Ias(ias) => ias.max_sbt_offset,
        }
    }

    /// See [`Ias::slack`].
    fn slack(&self) -> f64 {
        match self {
            Self::Gas(_) => 1.0,
            Self::Ias(ias) => f64::from(ias.slack),
        }
    }
}

impl From<Gas> for Accel {
    fn from(gas: Gas) -> Self {
        Self::Gas(gas)
    }
}

impl From<Ias> for Accel {
    fn from(ias: Ias) -> Self {
        Self::Ias(ias)
    }
}

/// An instance of a structure.
pub type Instance = InstanceInput<Arc<Accel>>;

const LIMITS: InstanceLimits =
    InstanceLimits { id: MAX_INSTANCE_NUMBER, sbt_offset: MAX_INSTANCE_NUMBER, depth: MAX_GRAPH_DEPTH };

/// An instance in a built structure.
#[derive(Debug)]
pub struct BuiltInstance {
    pub instance: Instance,
    pub(super) inverse: Affine,
    /// Its space is its parent's.
    pub(super) identity: bool,
    /// Object to world and back for an instance in the root of a trace, as [`InstancePath`](super::InstancePath) gives them.
    pub(super) to_world: [f32; 12],
    pub(super) to_object: [f32; 12],
}

impl BuiltInstance {
    /// World (the space of the instance's parent) to object, row-major 3x4: formed in `f64`, rounded once.
    pub fn inverse_transform(&self) -> [f32; 12] {
        self.inverse.to_f32()
    }
}

/// An instance acceleration structure.
#[derive(Debug)]
pub struct Ias {
    pub(super) bvh: Bvh,
    pub(super) built: Vec<BuiltInstance>,
    /// Multiplies the margin of the box test. A child's margin `m R'` in its own space is up to `norm(T) m R'` here,
    /// with `R' <= norm(T^-1) R`; rounding the ray into the child's space adds as much as the child's own margin.
    pub(super) slack: f32,
    max_sbt_offset: u32,
    depth: usize,
}

impl Ias {
    /// Builds over instances. None at all is legal; rays then miss.
    pub fn new(instances: Vec<Instance>) -> Result<Self, BuildError> {
        if instances.len() > MAX_INSTANCES {
            return Err(BuildError::TooMany { what: "instances", count: instances.len(), limit: MAX_INSTANCES });
        }
        let (mut built, mut boxes) = (Vec::with_capacity(instances.len()), Vec::with_capacity(instances.len()));
        let (mut slack, mut max_sbt_offset, mut depth) = (1.0f64, 0, 1);
        for (i, instance) in instances.into_iter().enumerate() {
            let inverse = check(&instance).map_err(|error| BuildError::Instance { instance: i, error })?;
            let transform = Affine::from_f32(&instance.transform);
            boxes.push(outline(&transform, &instance.child.bounds()));
            slack = slack.max(transform.norm() * inverse.norm() * (instance.child.slack() + 1.0));
            max_sbt_offset = max_sbt_offset.max(instance.sbt_offset + instance.child.max_sbt_offset());
            depth = depth.max(1 + instance.child.depth());
            built.push(BuiltInstance {
                identity: transform == Affine::IDENTITY,
                to_world: Affine::IDENTITY.after(&transform).to_f32(),
                to_object: inverse.after(&Affine::IDENTITY).to_f32(),
                instance,
                inverse,
            });
        }
        let bvh = Bvh::build(&boxes, SINGLE_LEAF, |instances| instances[0]);
        Ok(Self { bvh, built, slack: slack as f32, max_sbt_offset, depth })
    }

    /// A box around all that the instances hold, a few ulps larger than need be.
    pub fn bounds(&self) -> Aabb {
        self.bvh.bounds
    }

    /// The instances in the order given.
    pub fn instances(&self) -> &[BuiltInstance] {
        &self.built
    }

    /// Heap bytes, those of the children left out.
    pub fn memory_bytes(&self) -> usize {
        self.bvh.memory_bytes() + size_of_val(&self.built[..])
    }
}

/// Finds what is wrong with an instance, or gives the inverse of its transform.
fn check(instance: &Instance) -> Result<Affine, InstanceError> {
    let inverse = instance.check(instance.child.depth(), LIMITS)?;
    let (offset, sum) = (instance.sbt_offset, instance.sbt_offset + instance.child.max_sbt_offset());
    if sum > LIMITS.sbt_offset { Err(InstanceError::RecordOffsetSum { offset, sum }) } else { Ok(inverse) }
}

/// A box around the transformed `bounds`. They are widened first by the rounding of an origin in the child's space,
/// `2^-24` of the largest coordinate, and a little more; the result is clamped to finite numbers.
fn outline(transform: &Affine, bounds: &Aabb) -> Aabb {
    if bounds.is_empty() {
        return Aabb::EMPTY;
    }
    let m = &transform.0;
    let [min, max] = [bounds.min, bounds.max].map(|corner| corner.map(f64::from));
    let margin = min.iter().chain(&max).fold(0.0f64, |r, x| r.max(x.abs())) * 2f64.powi(-22);
    let mut outline = Aabb::EMPTY;
    for r in 0..3 {
        let (mut low, mut high, mut size) = (m[4 * r + 3], m[4 * r + 3], m[4 * r + 3].abs());
        for c in 0..3 {
            let (x, y) = (m[4 * r + c] * (min[c] - margin), m[4 * r + c] * (max[c] + margin));
            low += x.min(y);
            high += x.max(y);
            size += x.abs().max(y.abs());
        }
        // Rounding of the sums above.
        let error = size * 2f64.powi(-50);
        outline.min[r] = ((low - error) as f32).next_down().clamp(f32::MIN, f32::MAX);
        outline.max[r] = ((high + error) as f32).next_up().clamp(f32::MIN, f32::MAX);
    }
    outline
}
