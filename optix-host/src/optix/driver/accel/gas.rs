//! Geometry acceleration structures of any kind of primitive (guide 5, 5.1).

use super::super::context::Context;
use super::build::{RawInput, build};
use super::records::Records;
use super::source::{Source, Staging};
use super::{Accel, AccelOptions};
use crate::error::DriverError as Error;

/// A geometry build input. Inputs of one build have one type, and so do the elements of a slice.
pub(super) trait Input {
    fn primitives(&self) -> Result<u32, Error>;
    fn records(&self) -> &Records<'_>;
    fn check(&self, keys: usize) -> Result<(), Error>;
    /// # Safety
    /// Host data must stay as they are until the stream has got past their copies.
    unsafe fn place(&self, staging: &mut Staging<'_>) -> Result<RawInput, Error>;
}

pub(super) fn gas<I: Input>(context: &Context, inputs: &[I], options: &AccelOptions) -> Result<Accel, Error> {
    check_gas(context, inputs, options)?;
    let mut staging = Staging::new(context);
    // SAFETY: `staging` is dropped, and so waits for the copies, before this function returns; the data are borrowed by
    // the inputs for as long.
    let raw = inputs.iter().map(|input| unsafe { input.place(&mut staging) }).collect::<Result<Vec<_>, _>>()?;
    // SAFETY: the addresses in `raw` belong to `staging` and to buffers that the inputs borrow; the contents were
    // checked, or promised by whoever made the source.
    unsafe { build(context, &raw, options, Vec::new(), 1) }
}

fn check_gas<I: Input>(context: &Context, inputs: &[I], options: &AccelOptions) -> Result<(), Error> {
    const WHAT: &str = "a geometry acceleration structure";
    if inputs.is_empty() {
        return Err(Error::invalid(WHAT, "it has no build input", "give at least one, which may be empty"));
    }
    let (mut primitives, mut records) = (0u64, 0u64);
    for input in inputs {
        input.check(options.keys())?;
        input.records().check(input.primitives()?)?;
        primitives += u64::from(input.primitives()?);
        records += input.records().flags.len() as u64;
    }
    let (limits, keyed) = (context.limits(), primitives.saturating_mul(options.keys() as u64));
    if keyed > limits.max_primitives_per_gas.into() {
        let problem = format!("{primitives} primitives times {} motion keys", options.keys());
        return Err(Error::invalid(
            WHAT,
            problem,
            "split the geometry over several structures, and put those into an instance structure (guide 12)",
        ));
    }
    if records > limits.max_sbt_records_per_gas.into() {
        let problem = format!("{records} records, more than {}", limits.max_sbt_records_per_gas);
        return Err(Error::invalid(
            WHAT,
            problem,
            "split the geometry over several structures, and put those into an instance structure (guide 12)",
        ));
    }
    Ok(())
}

/// One list a key, all of one length.
pub(super) fn check_keys<T: bytemuck::NoUninit>(
    what: &'static str,
    lists: &[Source<'_, T>],
    keys: usize,
) -> Result<(), Error> {
    if lists.len() != keys {
        let problem = format!("{} lists for {keys} motion keys", lists.len());
        return Err(Error::invalid(
            what,
            problem,
            "give a list of vertices or boxes for each motion key; without motion there is one key",
        ));
    }
    if lists.windows(2).any(|pair| pair[0].len() != pair[1].len()) {
        return Err(Error::invalid(what, "the motion keys differ in length", "give every key the same elements"));
    }
    Ok(())
}

/// # Safety
/// As [`Staging::place`].
pub(super) unsafe fn place_keys<T: bytemuck::NoUninit>(
    staging: &mut Staging<'_>,
    lists: &[Source<'_, T>],
) -> Result<Box<[u64]>, Error> {
    // SAFETY: the caller promises the host data.
    lists.iter().map(|list| unsafe { staging.place(list) }).collect()
}

pub(super) fn to_u32(count: usize) -> Result<u32, Error> {
    u32::try_from(count).map_err(|_| {
        Error::invalid("a build input", format!("{count} elements, more than 32 bits count"), "split the input")
    })
}
