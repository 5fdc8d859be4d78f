//! The instances between the root of a trace and a primitive.

use super::ias::{Accel, BuiltInstance};
use crate::affine::Affine;
use crate::limits::MAX_GRAPH_DEPTH;

/// Which instances lead from the structure given to the trace down to a primitive. Copied by value; no heap.
#[derive(Clone, Copy, Debug)]
pub struct InstancePath<'a> {
    root: &'a Accel,
    len: u32,
    indices: [u32; MAX_GRAPH_DEPTH - 1],
}

impl<'a> InstancePath<'a> {
    pub(super) fn new(root: &'a Accel) -> Self {
        Self { root, len: 0, indices: [0; MAX_GRAPH_DEPTH - 1] }
    }

    #[inline]
    pub(super) fn push(&mut self, instance: u32) {
        self.indices[self.len as usize] = instance;
        self.len += 1;
    }

    #[inline]
    pub(super) fn pop(&mut self) {
        self.len -= 1;
    }

    /// Becomes `other`, of the same root; copies no more than its length.
    #[inline]
    pub(super) fn set(&mut self, other: &Self) {
        self.len = other.len;
        for (to, from) in self.indices.iter_mut().zip(other.indices()) {
            *to = *from;
        }
    }

    /// The structure given to the trace.
    pub fn root(&self) -> &'a Accel {
        self.root
    }

    /// Zero-based instance indices, each in its IAS, nearest the root first. Their order is the order of ties.
    pub fn indices(&self) -> &[u32] {
        &self.indices[..self.len as usize]
    }

    /// The transform list (guide 13.11): nearest the root first.
    pub fn instances(&self) -> impl Iterator<Item = &'a BuiltInstance> {
        self.indices().iter().scan(self.root, |at, &index| {
            let Accel::Ias(ias) = *at else { return None };
            let built = &ias.built[index as usize];
            *at = &built.instance.child;
            Some(built)
        })
    }

    /// The instance, where there is just one.
    #[inline]
    fn only(&self) -> Option<&'a BuiltInstance> {
        match (self.root, self.indices()) {
            (Accel::Ias(ias), &[index]) => Some(&ias.built[index as usize]),
            _ => None,
        }
    }

    /// The innermost instance; `None` where the root is a GAS.
    #[inline]
    pub fn innermost(&self) -> Option<&'a BuiltInstance> {
        if let Some(built) = self.only() {
            return Some(built);
        }
        self.instances().last()
    }

    /// The structure that holds the primitives.
    pub fn leaf(&self) -> &'a Accel {
        self.innermost().map_or(self.root, |built| &built.instance.child)
    }

    /// `optixGetInstanceId`: the innermost instance's ID, `!0` without one (guide 13.7).
    pub fn instance_id(&self) -> u32 {
        self.innermost().map_or(!0, |built| built.instance.id)
    }

    /// `optixGetInstanceIndex`: the innermost instance's index in its IAS, 0 without one (guide 13.7).
    pub fn instance_index(&self) -> u32 {
        self.indices().last().copied().unwrap_or(0)
    }

    /// Object to world, row-major 3x4: the product of all transforms, formed in `f64` and rounded once.
    #[inline]
    pub fn object_to_world(&self) -> [f32; 12] {
        if let Some(built) = self.only() {
            return built.to_world;
        }
        self.instances()
            .fold(Affine::IDENTITY, |all, built| all.after(&Affine::from_f32(&built.instance.transform)))
            .to_f32()
    }

    /// World to object, as [`InstancePath::object_to_world`].
    #[inline]
    pub fn world_to_object(&self) -> [f32; 12] {
        if let Some(built) = self.only() {
            return built.to_object;
        }
        self.instances().fold(Affine::IDENTITY, |all, built| built.inverse.after(&all)).to_f32()
    }
}
