//! Adds records of callables to a scene (guide 15).

use super::Scene;
use crate::Result;
use crate::scene::{CallableState, SceneError, numbered};
use optix_device_rs::host::{CallableRecord, CallableTable};
use optix_device_rs::pipeline::{HasCallable, Pipeline};
use optix_device_rs::record::SbtRecord;
use std::any::Any;
use std::sync::Arc;

impl<P: Pipeline> Scene<P> {
    /// Adds a record of callable `Prog`: `scene.callable::<wood>(Wood { .. })`. The result is a reference, for a field
    /// of records and launch parameters.
    ///
    /// # Errors
    /// [`SceneError`] for a record that holds what another device or scene made.
    pub fn callable<Prog>(
        &mut self,
        record: <P::Record as SbtRecord>::Host,
    ) -> Result<CallableRecord<P::Signature, P::Kind>>
    where
        P: HasCallable<Prog>,
    {
        let record = self.state.lower(&record)?;
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
    /// [`SceneError`] for a callable of another scene.
    pub fn callables<F, K>(&mut self, callables: &[CallableRecord<F, K>]) -> Result<CallableTable<F, K>> {
        let states = callables
            .iter()
            .enumerate()
            .map(|(i, callable)| {
                self.state.callable(callable).cloned().ok_or(SceneError::ForeignCallable { callable: i })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let len = numbered(states.len(), "callables")?;
        let (first, shared) = self.push(states)?;
        // SAFETY: copies of records of programs with this signature and kind; otherwise as above.
        Ok(unsafe { CallableTable::new(first, len, self.device.backend.id(), shared) })
    }

    /// Adds records and numbers them one after the other. Returns the first number, and what tells launches whose they
    /// are.
    fn push(&mut self, states: Vec<CallableState>) -> Result<(u32, Arc<dyn Any + Send + Sync>)> {
        let indices = self.state.next_callables(states.len())?;
        let first = self.device.backend.number_callables(indices.start, indices.len() as u32)?;
        Ok((first, Arc::new(self.state.add_callables(first, states))))
    }
}
