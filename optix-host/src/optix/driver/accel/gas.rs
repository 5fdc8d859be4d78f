//! Geometry acceleration structures (guide 5.1).

use super::super::context::Context;
use super::build::{RawInput, build};
use super::staging::{Staging, Upload};
use super::{Accel, AccelOptions};
use crate::error::DriverError as Error;
use crate::geometry::{BuildInput, BuildInputs, GasLimits, of_any_kind};

/// A kind of primitive that OptiX takes. Each has one conversion.
pub(super) trait ToInput: Sized {
    /// # Safety
    /// The primitives and records must stay as they are until the stream has got past the copies.
    unsafe fn to_input(input: &BuildInput<Self>, upload: &mut impl Upload) -> Result<RawInput, Error>;
}

/// What OptiX takes for these inputs.
///
/// # Safety
/// As [`ToInput::to_input`].
unsafe fn to_inputs(inputs: &BuildInputs, upload: &mut impl Upload) -> Result<Vec<RawInput>, Error> {
    unsafe fn each<A: ToInput>(inputs: &[BuildInput<A>], upload: &mut impl Upload) -> Result<Vec<RawInput>, Error> {
        // SAFETY: the caller's.
        inputs.iter().map(|input| unsafe { A::to_input(input, upload) }).collect()
    }
    // SAFETY: the caller's.
    unsafe { of_any_kind!(inputs, inputs => each(inputs, upload)) }
}

impl Accel {
    /// Builds a geometry acceleration structure, and returns when it is built.
    ///
    /// # Errors
    /// [`Build`](crate::Error::Build) for more primitives or records than one structure has on this GPU,
    /// [`Driver`](crate::Error::Driver) for motion options that don't fit the geometry, and where the driver fails.
    pub fn gas(context: &Context, inputs: &BuildInputs, options: &AccelOptions) -> crate::Result<Self> {
        const WHAT: &str = "a geometry acceleration structure";
        let limits = context.limits();
        inputs.check(GasLimits {
            primitives: limits.max_primitives_per_gas as usize,
            records: limits.max_sbt_records_per_gas as usize,
        })?;
        let keys = options.motion.map_or(1, |motion| motion.keys.into());
        if keys != inputs.motion_keys() {
            let problem = format!("its geometry has {} motion keys, but its options say {keys}", inputs.motion_keys());
            return Err(Error::invalid(WHAT, problem, "give motion options with the keys of the geometry").into());
        }
        let mut staging = Staging::new(context);
        // SAFETY: `staging` is dropped, and so waits for the copies, before this function returns; the data are borrowed for
        // as long.
        let raw = unsafe { to_inputs(inputs, &mut staging)? };
        if raw.is_empty() {
            return Err(Error::invalid(WHAT, "it has no build input", "give at least one, which may be empty").into());
        }
        // SAFETY: the addresses in `raw` belong to `staging`; what is there was checked when the inputs were made.
        Ok(unsafe { build(context, &raw, options, Vec::new(), 1)? })
    }
}

/// A count in OptiX's 32 bits.
pub(super) fn count(count: usize) -> Result<u32, Error> {
    u32::try_from(count).map_err(|_| {
        Error::invalid("a build input", format!("{count} elements, more than 32 bits count"), "split the input")
    })
}
