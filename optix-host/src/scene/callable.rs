//! Callables with the data of their records (guide 15).

use super::{RecordData, Scene, numbered};
use crate::{Error, Result};
use optix_device_rs::host::{CallableRecord, CallableTable};
use optix_device_rs::pipeline::{HasCallable, Pipeline};
use optix_device_rs::record::SbtRecord;
use std::any::Any;
use std::sync::Arc;

/// A record of a callable as the scene keeps it.
#[derive(Clone)]
pub(crate) struct CallableState {
    /// Index in the pipeline's description.
    pub program: usize,
    pub record: RecordData,
}

/// Tells a launch whose the records are, and up to which one they go.
pub(crate) struct CallableShared {
    pub scene: u64,
    pub end: u32,
}

impl<P: Pipeline> Scene<P> {
    /// Adds a record of callable `Prog`: `scene.callable::<wood>(Wood { .. })`. What comes back is a field of records and
    /// launch parameters.
    ///
    /// # Errors
    /// [`Error::Scene`] for a record that holds what another device or scene made.
    pub fn callable<Prog>(
        &mut self,
        record: <P::Record as SbtRecord>::Host,
    ) -> Result<CallableRecord<P::Signature, P::Kind>>
    where
        P: HasCallable<Prog>,
    {
        let record = self.lower(&record)?;
        let index = self.push(CallableState { program: <P as HasCallable<Prog>>::INDEX as usize, record })?;
        let shared = self.callables_up_to(index + 1);
        // SAFETY: the record is of a program with this signature and kind (`HasCallable`), and records are never taken
        // away; launches compare the scene.
        Ok(unsafe { CallableRecord::new(index, self.device.backend.id(), shared) })
    }

    /// Makes a table of callables, which programs choose from by number. A callable may be in any number of tables, and
    /// several times in one.
    ///
    /// # Errors
    /// [`Error::Scene`] for a callable of another scene.
    pub fn callables<F, K>(&mut self, callables: &[CallableRecord<F, K>]) -> Result<CallableTable<F, K>> {
        if callables.iter().any(|c| c.owner::<CallableShared>().is_none_or(|shared| shared.scene != self.state.id)) {
            return Err(Error::Scene(
                "a table of callables holds one of another scene; make it with this scene".into(),
            ));
        }
        let first = numbered(self.state.callables.len(), "callables")?;
        let end = numbered(self.state.callables.len().saturating_add(callables.len()), "callables")?;
        let states: Vec<_> = callables.iter().map(|c| self.state.callables[c.index() as usize].clone()).collect();
        for state in states {
            self.push(state)?;
        }
        let len = end - first;
        let shared = self.callables_up_to(end);
        // SAFETY: copies of records of programs with this signature and kind; otherwise as above.
        Ok(unsafe { CallableTable::new(first, len, self.device.backend.id(), shared) })
    }

    fn push(&mut self, state: CallableState) -> Result<u32> {
        let index = numbered(self.state.callables.len(), "callables")?;
        self.state.callables.push(state);
        Ok(index)
    }

    fn callables_up_to(&self, end: u32) -> Arc<dyn Any + Send + Sync> {
        Arc::new(CallableShared { scene: self.state.id, end })
    }
}
