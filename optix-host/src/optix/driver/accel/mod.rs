//! Acceleration structures (guide 5).

mod build;
mod custom;
mod gas;
mod instances;
mod options;
mod records;
mod staging;
mod triangles;

use std::sync::Arc;

use super::buffer::DeviceBuffer;
use super::context::Context;
use super::transform::Transform;

pub use instances::Instance;
pub use options::{AccelOptions, Motion, Preference};

/// A geometry or instance acceleration structure. Cheap to clone; keeps its memory and its children alive.
#[derive(Clone, Debug)]
pub struct Accel(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    handle: u64,
    depth: u32,
    built_size: usize,
    buffer: DeviceBuffer,
    _children: Vec<Traversable>,
}

impl Accel {
    /// The traversable handle, for launch parameters and instances. Valid as long as the structure, or anything that
    /// keeps it, lives.
    pub fn handle(&self) -> u64 {
        self.0.handle
    }

    /// Bytes of device memory it takes.
    pub fn size(&self) -> usize {
        self.0.buffer.len()
    }

    /// Bytes it took before compaction.
    pub fn built_size(&self) -> usize {
        self.0.built_size
    }

    /// Traversables on the longest path from here to a leaf: 1 for geometry.
    pub fn depth(&self) -> u32 {
        self.0.depth
    }

    /// The context it belongs to.
    pub fn context(&self) -> &Context {
        self.0.buffer.context()
    }
}

/// Anything that can be traced or be the child of an instance or a transform.
#[derive(Clone, Debug)]
pub enum Traversable {
    /// An acceleration structure.
    Accel(Accel),
    /// A transform above another traversable.
    Transform(Transform),
}

impl Traversable {
    /// The traversable handle.
    pub fn handle(&self) -> u64 {
        match self {
            Self::Accel(accel) => accel.handle(),
            Self::Transform(transform) => transform.handle(),
        }
    }

    /// Traversables on the longest path from here to a leaf, for
    /// [`LinkOptions::max_graph_depth`](super::LinkOptions::max_graph_depth).
    pub fn depth(&self) -> u32 {
        match self {
            Self::Accel(accel) => accel.depth(),
            Self::Transform(transform) => transform.depth(),
        }
    }

    /// The context it belongs to.
    pub fn context(&self) -> &Context {
        match self {
            Self::Accel(accel) => accel.context(),
            Self::Transform(transform) => transform.context(),
        }
    }
}

impl From<&Accel> for Traversable {
    fn from(accel: &Accel) -> Self {
        Self::Accel(accel.clone())
    }
}

impl From<&Transform> for Traversable {
    fn from(transform: &Transform) -> Self {
        Self::Transform(transform.clone())
    }
}
