//! Limits and features (guide 12).

use super::sys::OptixDeviceProperty as P;
use crate::error::DriverError as Error;

/// Limits and features of a context (guide 12). They depend on the GPU and on the ABI version, not on driver updates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limits {
    /// The greatest depth of recursive traces.
    pub max_trace_depth: u32,
    /// The greatest number of traversables on a path from the root to a leaf.
    pub max_graph_depth: u32,
    /// The greatest number of primitives, summed over build inputs and times motion keys.
    pub max_primitives_per_gas: u32,
    /// The greatest number of instances in one instance acceleration structure.
    pub max_instances_per_ias: u32,
    /// The greatest instance id.
    pub max_instance_id: u32,
    /// Bits of a visibility mask.
    pub visibility_mask_bits: u32,
    /// The greatest number of records that one geometry acceleration structure refers to.
    pub max_sbt_records_per_gas: u32,
    /// The greatest record offset of an instance, and of the sum along a path.
    pub max_sbt_offset: u32,
    /// Version of the ray-tracing cores times 10, 0 without any.
    pub rt_core_version: u32,
    /// Whether shader execution reordering reorders. `false` on ABI versions before 87, which cannot tell.
    pub reordering: bool,
    /// Whether cluster acceleration structures can be built. `false` on ABI versions before 105.
    pub clusters: bool,
}

impl Limits {
    /// Asks `get` for each of them. An older ABI refuses properties that it does not know.
    pub(super) fn query(abi: i32, get: impl Fn(P) -> Result<u32, Error>) -> Result<Self, Error> {
        let since = |first: i32, property: P| {
            if abi >= first { get(property).map(|value| value != 0) } else { Ok(false) }
        };
        Ok(Self {
            max_trace_depth: get(P::LIMIT_MAX_TRACE_DEPTH)?,
            max_graph_depth: get(P::LIMIT_MAX_TRAVERSABLE_GRAPH_DEPTH)?,
            max_primitives_per_gas: get(P::LIMIT_MAX_PRIMITIVES_PER_GAS)?,
            max_instances_per_ias: get(P::LIMIT_MAX_INSTANCES_PER_IAS)?,
            max_instance_id: get(P::LIMIT_MAX_INSTANCE_ID)?,
            visibility_mask_bits: get(P::LIMIT_NUM_BITS_INSTANCE_VISIBILITY_MASK)?,
            max_sbt_records_per_gas: get(P::LIMIT_MAX_SBT_RECORDS_PER_GAS)?,
            max_sbt_offset: get(P::LIMIT_MAX_SBT_OFFSET)?,
            rt_core_version: get(P::RTCORE_VERSION)?,
            reordering: since(87, P::SHADER_EXECUTION_REORDERING)?,
            clusters: since(105, P::CLUSTER_ACCEL)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_older_abi_is_not_asked_for_newer_properties() {
        let answer = |newest: u32| {
            move |property: P| {
                if property.0 <= newest { Ok(property.0) } else { Err(Error::invalid("", "", "")) }
            }
        };
        let limits = Limits::query(84, answer(8201)).unwrap();
        assert_eq!((limits.max_trace_depth, limits.max_sbt_offset), (8193, 8201));
        assert!(!limits.reordering && !limits.clusters);
        assert!(Limits::query(93, answer(8202)).unwrap().reordering);
        assert!(Limits::query(105, answer(8224)).unwrap().clusters);
        assert!(Limits::query(105, answer(8202)).is_err());
    }
}
