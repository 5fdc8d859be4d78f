//! Launches (guide 10).

use std::fmt;
use std::sync::PoisonError;
use std::time::Duration;

use super::KeepAlive;
use super::buffer::{DeviceBuffer, PinnedBuffer};
use super::context::Context;
use super::event::Event;
use super::pipeline::Pipeline;
use super::sbt::ShaderBindingTable;
use crate::error::DriverError as Error;
use crate::limits::launch_size;

/// What a launch is given.
pub struct LaunchArgs<'a> {
    /// The records.
    pub sbt: &'a ShaderBindingTable,
    /// Which ray-generation record runs, counted from 0.
    pub raygen: u32,
    /// The launch parameters, byte for byte as the device programs see them. Copied before the call returns.
    pub params: &'a [u8],
    /// Width, height, depth: each at least 1, at most 2^30 together.
    pub dims: [u32; 3],
    /// Held until the launch is done: whatever the parameters point to.
    pub keep: KeepAlive,
}

/// A launch under way. It holds the pipeline, the records and what it was told to keep; dropping it waits.
#[must_use = "dropping a launch waits for it; errors of the launch are reported by `wait` only"]
pub struct Launch {
    pipeline: Pipeline,
    slot: Option<Slot>,
    _sbt: ShaderBindingTable,
    _keep: KeepAlive,
}

impl fmt::Debug for Launch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Launch").field("pipeline", &self.pipeline).finish_non_exhaustive()
    }
}

impl Pipeline {
    /// Starts a launch on the context's stream, after everything asked for before. With validation mode on it waits and
    /// reports what the driver found.
    ///
    /// # Errors
    /// [`Error::Invalid`] for dimensions of 0 or beyond 2^30, a ray-generation record that is not there and a table of
    /// another context; [`Error::Optix`] otherwise, as for parameters larger than the variable.
    ///
    /// # Safety
    /// - Every device address and traversable handle in the parameters and in the records is valid for what the programs
    ///   do with it, until the launch is done; `keep` and the table's own list are there to see to it.
    /// - The parameters are laid out as the programs' launch-parameter variable, with the bound values of the modules.
    /// - The records have the layout that their programs expect, and headers of groups of this pipeline; every record
    ///   index that a trace or call can reach is there.
    /// - The traversables fit the pipeline's options: graph, depth, primitive kinds, motion, opacity micromaps.
    pub unsafe fn launch(&self, args: LaunchArgs<'_>) -> Result<Launch, Error> {
        let [width, height, depth] = args.dims;
        check_dims(args.dims)?;
        let context = self.context();
        context.owns("a launch", args.sbt.context())?;
        let sbt = args.sbt.raw(args.raygen)?;
        let mut slot = self.slot(args.params.len())?;
        let _current = context.enter()?;
        slot.upload(args.params)?;
        // From here on dropping `launch` waits for the stream, so that `slot` is free of copies.
        let launch = Launch { pipeline: self.clone(), slot: Some(slot), _sbt: args.sbt.clone(), _keep: args.keep };
        let Some(slot) = &launch.slot else {
            return Ok(launch);
        };
        slot.start.record()?;
        // SAFETY: the pipeline, the stream and the tables are live and of one context, which is current; the caller
        // promises the rest.
        let result = unsafe {
            let (address, stream) = (slot.device.address(), context.cuda_stream());
            let (table, size) = (context.table(), args.params.len());
            table.launch(self.raw(), stream, address, size, &sbt, width, height, depth)
        };
        context.check("optixLaunch", result)?;
        slot.end.record()?;
        Ok(launch)
    }

    /// Parameter memory of a finished launch with the same size, or new memory.
    fn slot(&self, len: usize) -> Result<Slot, Error> {
        let mut free = self.slots().lock().unwrap_or_else(PoisonError::into_inner);
        match free.iter().position(|slot| slot.device.len() == len) {
            Some(at) => Ok(free.swap_remove(at)),
            None => Slot::new(self.context(), len),
        }
    }
}

impl Launch {
    /// Waits for the launch, and returns the device time it took.
    ///
    /// # Errors
    /// A fault of the launch, or of earlier work, with what the driver logged.
    pub fn wait(mut self) -> Result<Duration, Error> {
        self.finish()
    }

    /// Whether the launch is done.
    ///
    /// # Errors
    /// As [`Self::wait`].
    pub fn is_done(&self) -> Result<bool, Error> {
        self.slot.as_ref().map_or(Ok(true), |slot| slot.end.is_done())
    }

    fn finish(&mut self) -> Result<Duration, Error> {
        let Some(slot) = &self.slot else {
            return Ok(Duration::ZERO);
        };
        slot.end.wait()?;
        let time = slot.end.since(&slot.start)?;
        if let Some(slot) = self.slot.take() {
            self.pipeline.slots().lock().unwrap_or_else(PoisonError::into_inner).push(slot);
        }
        Ok(time)
    }
}

impl Drop for Launch {
    fn drop(&mut self) {
        if self.slot.is_some() {
            // The whole stream, because a launch that failed half-way has not recorded its end. An error has nowhere to
            // go: the next checked call reports it, since it sticks to the CUDA context.
            let _ = self.pipeline.context().synchronize();
        }
    }
}

/// Memory for the parameters of one launch at a time.
#[derive(Debug)]
pub(super) struct Slot {
    device: DeviceBuffer,
    /// `None` without parameters.
    host: Option<PinnedBuffer>,
    start: Event,
    end: Event,
}

impl Slot {
    fn new(context: &Context, len: usize) -> Result<Self, Error> {
        Ok(Self {
            device: DeviceBuffer::new(context, len)?,
            host: if len == 0 { None } else { Some(PinnedBuffer::new(context, len)?) },
            start: Event::new(context)?,
            end: Event::new(context)?,
        })
    }

    /// Copies the parameters, without waiting for the device.
    fn upload(&mut self, params: &[u8]) -> Result<(), Error> {
        let Some(host) = &mut self.host else {
            return Ok(());
        };
        host.bytes_mut().copy_from_slice(params);
        // SAFETY: the slot is not used for another launch, and not freed, before the stream has passed this one: both
        // `Launch::finish` and `Launch::drop` wait, and a device buffer, the first field, waits when it is dropped.
        unsafe { self.device.upload_async(0, host.bytes()) }
    }
}

fn check_dims(dims: [u32; 3]) -> Result<(), Error> {
    match launch_size(dims) {
        Some(_) => Ok(()),
        None => {
            let problem = format!("the dimensions are {} x {} x {}", dims[0], dims[1], dims[2]);
            let remedy = "each must be at least 1 and their product at most 2^30: launch larger images in tiles";
            Err(Error::invalid("a launch", problem, remedy))
        }
    }
}
