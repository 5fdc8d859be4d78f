//! A launch: its indices on all threads, and the calls of programs through the shader binding table.
//!
//! | module | what |
//! | --- | --- |
//! | `call` | program calls and trace calls |
//! | `traversal` | the programs that run during traversal, and what programs at a primitive may ask |
//! | `exceptions` | what is thrown, and what becomes of it |
//! | `handle` | traversable handles |
//! | `stack` | how much of its stack a thread has left |
//! | `checks` | how the checked mode finds out |

mod call;
mod checks;
mod exceptions;
mod handle;
#[cfg(test)]
mod rules;
mod stack;
#[cfg(test)]
mod tests;
mod traversal;

use crate::cpu::traversal::Accel;
use crate::plan::{Depths, Exceptions, Plan};
use crate::sbt::{CallableProgram, Section, ShaderBindingTable};
use crate::{Error, Result};
use call::Call;
use core::cell::Cell;
use exceptions::Unhandled;
use glam::UVec3;
use optix_device_rs::host::end::{self, End, fail};
use optix_device_rs::host::{ByHandle, HitPrograms, PipelineDescription, RayDescription, Reach, Rule};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex};

/// The number of launch indices that a thread takes at a time. It is small, because one index may be all paths of a
/// pixel, and the other threads wait for the last chunk of a launch. It is large enough that taking a chunk costs
/// nothing beside a ray for each index.
const CHUNK: u64 = 16;

/// What the programs of a launch may use, by the numbers in their views.
#[derive(Default)]
pub(super) struct Reached<'a> {
    pub memory: Reach,
    /// Structures that rays are traced against. They belong to the table's scene.
    pub traced: ByHandle<&'a Accel>,
    /// Structures that programs read by number.
    pub read: ByHandle<&'a Accel>,
    pub callables: Callables,
}

/// Records of callables by the number that programs know them by.
#[derive(Clone, Debug, Default)]
pub(super) struct Callables(Arc<[(u32, usize)]>);

impl Callables {
    pub fn of(section: &Section<CallableProgram>) -> Self {
        let mut records: Vec<_> = section.programs().iter().map(|callable| callable.number).zip(0..).collect();
        records.sort_unstable();
        Self(records.into())
    }

    /// The index of the record with this number.
    fn get(&self, number: u32) -> Option<usize> {
        let at = self.0.binary_search_by_key(&number, |&(number, _)| number).ok()?;
        Some(self.0[at].1)
    }
}

/// A launch, while its programs run.
pub(super) struct Launch<'a> {
    description: &'a PipelineDescription,
    depths: Depths,
    exceptions: Exceptions,
    sbt: &'a ShaderBindingTable,
    /// A copy of the parameters at an address that is a multiple of 16.
    params: Vec<u128>,
    reached: Reached<'a>,
    raygen: usize,
    dimensions: UVec3,
    /// Whether programs are checked for what the guide leaves undefined; see [`checks`].
    checked: bool,
    /// The exceptions, if the pipeline has no exception program.
    unhandled: Unhandled,
}

impl<'a> Launch<'a> {
    pub fn new(
        plan: &'a Plan,
        sbt: &'a ShaderBindingTable,
        params: &[u8],
        reached: Reached<'a>,
        raygen: usize,
        dimensions: [u32; 3],
        checked: bool,
    ) -> Self {
        let mut copy = vec![0u128; params.len().div_ceil(16).max(1)];
        bytemuck::cast_slice_mut(&mut copy)[..params.len()].copy_from_slice(params);
        let Plan { description, depths, exceptions, .. } = plan;
        let (depths, exceptions, unhandled) = (*depths, *exceptions, Unhandled::default());
        let dimensions = dimensions.into();
        Self { description, depths, exceptions, sbt, params: copy, reached, raygen, dimensions, checked, unhandled }
    }

    /// The ray type that a miss record belongs to.
    #[inline]
    fn ray(&self, miss_index: u32) -> &RayDescription {
        match self.description.rays.get(miss_index as usize) {
            Some(ray) => ray,
            None => fail(
                Rule::MissRecord,
                format!("there is no miss record {miss_index}: the pipeline has {}", self.description.rays.len()),
            ),
        }
    }

    /// The ray type and the programs of a hit record. If there is no such record, the program that caused the hit ends
    /// the launch.
    #[inline]
    fn hit_programs(&self, sbt_index: u32) -> (usize, &'a HitPrograms) {
        match self.sbt.hit.programs().get(sbt_index as usize) {
            Some(slot) => (slot.ray, &self.description.hitgroups[slot.group].rays[slot.ray]),
            None => fail(
                Rule::HitRecord,
                format!(
                    "a hit asks for record {sbt_index} of the hit-group table, which has {}",
                    self.sbt.hit.programs().len()
                ),
            ),
        }
    }
}

/// Runs the launch on all threads of the current pool. Returns the exceptions that no program was told of.
pub(super) fn run(launch: Launch<'_>) -> Result<Vec<String>> {
    run_all(&launch)?;
    Ok(launch.unhandled.reports())
}

fn run_all(launch: &Launch<'_>) -> Result<()> {
    let size = launch.dimensions.as_u64vec3();
    let total = size.x * size.y * size.z;
    let failed = AtomicBool::new(false);
    let first: Mutex<Option<(u64, Error)>> = Mutex::new(None);
    (0..total.div_ceil(CHUNK)).into_par_iter().for_each(|chunk| {
        for linear in chunk * CHUNK..((chunk + 1) * CHUNK).min(total) {
            if failed.load(Relaxed) {
                return;
            }
            let index = UVec3::new(
                (linear % size.x) as u32,
                (linear / size.x % size.y) as u32,
                (linear / (size.x * size.y)) as u32,
            );
            // SAFETY: `run_index` calls the programs, and the launch outlives it.
            if let Err(error) = unsafe { launch.reached.memory.enter(|| run_index(launch, index)) } {
                failed.store(true, Relaxed);
                let mut first = first.lock().unwrap_or_else(|e| e.into_inner());
                if first.as_ref().is_none_or(|(at, _)| linear < *at) {
                    *first = Some((linear, error));
                }
            }
        }
    });
    match first.into_inner().unwrap_or_else(|e| e.into_inner()) {
        Some((_, error)) => Err(error),
        None => Ok(()),
    }
}

fn run_index(launch: &Launch<'_>, index: UVec3) -> Result<()> {
    let running = Cell::new(launch.description.raygen[launch.raygen].entry.name);
    // SAFETY: this is the executor; nothing of the index runs after an end but its exception program, which is told of it.
    let ended = unsafe { end::catch(|| Call::raygen(launch, index, &running)) };
    let ended = match ended {
        Err(End::Thrown(exception)) => {
            let thrower = running.get();
            // SAFETY: as above, and nothing at all runs after this.
            match unsafe { end::catch(|| Call::exception(launch, index, &running, &exception)) } {
                Ok(true) => Ok(()),
                Ok(false) => {
                    launch.unhandled.add(launch, index, thrower, &exception);
                    Ok(())
                }
                Err(end) => Err(end),
            }
        }
        ended => ended,
    };
    match ended {
        Ok(()) => Ok(()),
        Err(End::Failed { rule, what }) => {
            Err(Error::Program { program: running.get().into(), index: index.to_array(), rule, what })
        }
        // An exception program can't throw, so this does not happen.
        Err(End::Thrown(exception)) => {
            launch.unhandled.add(launch, index, running.get(), &exception);
            Ok(())
        }
    }
}
