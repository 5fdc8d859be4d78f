//! What a machine is given to build acceleration structures, and what it gives back.

use super::InstanceInput;
use crate::geometry::BuildInputs;
use std::any::Any;
use std::sync::Arc;

/// What a GAS is built of.
pub(crate) struct GasInput {
    pub inputs: BuildInputs,
    pub compact: bool,
    /// Whether programs read its vertices by handle.
    pub random_vertex_access: bool,
}

/// What an IAS is built of.
pub(crate) struct IasInput {
    pub instances: Vec<InstanceInput<BuiltAccel>>,
    /// Whether programs read its instances by handle.
    pub random_instance_access: bool,
}

/// An acceleration structure: `owner` keeps `handle` alive.
#[derive(Clone)]
pub(crate) struct BuiltAccel {
    pub handle: u64,
    pub owner: Arc<dyn Any + Send + Sync>,
    /// Bytes of the finished structure.
    pub bytes: usize,
}
