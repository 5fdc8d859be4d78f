//! Callables with the data of their records (guide 15).

use super::{RecordData, SceneState, numbered};
use crate::Result;
use optix_device_rs::host::CallableRecord;
use std::ops::Range;

/// A record of a callable as the scene keeps it.
#[derive(Clone)]
pub(crate) struct CallableState {
    /// The index of its program in the pipeline's description.
    pub program: usize,
    /// The number by which programs know it.
    pub number: u32,
    pub record: RecordData,
}

/// Tells a launch which scene the records belong to, and the number after the last of them.
pub(crate) struct CallableShared {
    pub scene: u64,
    pub end: u32,
}

impl SceneState {
    /// The record of this callable. `None` if it belongs to another scene.
    pub(crate) fn callable<F, K>(&self, callable: &CallableRecord<F, K>) -> Option<&CallableState> {
        let shared = callable.owner::<CallableShared>().filter(|shared| shared.scene == self.id)?;
        self.callables.get(shared.end as usize - 1)
    }

    /// The indices that `count` new records of callables will have.
    pub(crate) fn next_callables(&self, count: usize) -> Result<Range<u32>> {
        let first = numbered(self.callables.len(), "callables")?;
        Ok(first..numbered(self.callables.len().saturating_add(count), "callables")?)
    }

    /// Adds records and numbers them from `first` on. Returns what tells launches whose they are.
    pub(crate) fn add_callables(&mut self, first: u32, states: Vec<CallableState>) -> CallableShared {
        self.features.callables.extend(states.iter().map(|state| state.program));
        self.callables.extend((first..).zip(states).map(|(number, state)| CallableState { number, ..state }));
        CallableShared { scene: self.id, end: self.callables.len() as u32 }
    }
}
