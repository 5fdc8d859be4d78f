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
    /// By which programs know it.
    pub number: u32,
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
        let program = <P as HasCallable<Prog>>::INDEX as usize;
        let (number, shared) = self.push(vec![CallableState { program, number: 0, record }])?;
        // SAFETY: the record is of a program with this signature and kind (`HasCallable`), and records are never taken
        // away; launches compare the scene.
        Ok(unsafe { CallableRecord::new(number, self.device.backend.id(), shared) })
    }

    /// Makes a table of callables, which programs choose from by number. A callable may be in any number of tables, and
    /// several times in one.
    ///
    /// # Errors
    /// [`Error::Scene`] for a callable of another scene.
    pub fn callables<F, K>(&mut self, callables: &[CallableRecord<F, K>]) -> Result<CallableTable<F, K>> {
        let state = |callable: &CallableRecord<F, K>| {
            let shared = callable.owner::<CallableShared>().filter(|shared| shared.scene == self.state.id)?;
            Some(self.state.callables[shared.end as usize - 1].clone())
        };
        let states = callables.iter().map(state).collect::<Option<Vec<_>>>().ok_or_else(|| {
            Error::Scene("a table of callables holds one of another scene; make it with this scene".into())
        })?;
        let len = numbered(states.len(), "callables")?;
        let (first, shared) = self.push(states)?;
        // SAFETY: copies of records of programs with this signature and kind; otherwise as above.
        Ok(unsafe { CallableTable::new(first, len, self.device.backend.id(), shared) })
    }

    /// Adds records, and numbers them one after the other: the first number, and what tells launches whose they are.
    fn push(&mut self, states: Vec<CallableState>) -> Result<(u32, Arc<dyn Any + Send + Sync>)> {
        let index = numbered(self.state.callables.len(), "callables")?;
        let end = numbered(self.state.callables.len().saturating_add(states.len()), "callables")?;
        let first = self.device.backend.number_callables(index, end - index)?;
        self.state.callables.extend((first..).zip(states).map(|(number, state)| CallableState { number, ..state }));
        Ok((first, Arc::new(CallableShared { scene: self.state.id, end })))
    }
}
