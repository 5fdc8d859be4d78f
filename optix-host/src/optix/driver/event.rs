//! Marks on the stream, for waiting and for timing.

use std::time::Duration;

use cudarc::driver::result;
use cudarc::driver::sys as cu;

use super::context::Context;
use crate::error::DriverError as Error;

/// A mark on the context's stream.
#[derive(Debug)]
pub(super) struct Event {
    raw: cu::CUevent,
    context: Context,
}

// SAFETY: CUDA events may be used from any thread and at the same time.
unsafe impl Send for Event {}
// SAFETY: as above.
unsafe impl Sync for Event {}

impl Event {
    pub(super) fn new(context: &Context) -> Result<Self, Error> {
        let _current = context.enter()?;
        let raw = context.cuda("cuEventCreate", result::event::create(cu::CUevent_flags::CU_EVENT_DEFAULT))?;
        Ok(Self { raw, context: context.clone() })
    }

    /// Marks the end of the work asked for so far.
    pub(super) fn record(&self) -> Result<(), Error> {
        let _current = self.context.enter()?;
        // SAFETY: the event and the stream are live and of the same context.
        let result = unsafe { result::event::record(self.raw, self.context.cuda_stream()) };
        self.context.cuda("cuEventRecord", result)
    }

    /// Waits until the stream has passed the mark.
    pub(super) fn wait(&self) -> Result<(), Error> {
        let _current = self.context.enter()?;
        // SAFETY: the event is live.
        self.context.cuda("cuEventSynchronize", unsafe { result::event::synchronize(self.raw) })
    }

    /// Whether the stream has passed the mark.
    pub(super) fn is_done(&self) -> Result<bool, Error> {
        let _current = self.context.enter()?;
        // SAFETY: the event is live.
        match unsafe { result::event::query(self.raw) } {
            Err(error) if error.0 == cu::CUresult::CUDA_ERROR_NOT_READY => Ok(false),
            other => self.context.cuda("cuEventQuery", other).map(|()| true),
        }
    }

    /// Device time from `start` to this mark, both passed. Resolution about half a microsecond.
    pub(super) fn since(&self, start: &Self) -> Result<Duration, Error> {
        let _current = self.context.enter()?;
        // SAFETY: both events are live and were recorded on this context's stream.
        let milliseconds = unsafe { result::event::elapsed(start.raw, self.raw) };
        let milliseconds = self.context.cuda("cuEventElapsedTime", milliseconds)?;
        Ok(Duration::try_from_secs_f64(f64::from(milliseconds) / 1e3).unwrap_or_default())
    }
}

impl Drop for Event {
    fn drop(&mut self) {
        if let Ok(_current) = self.context.enter() {
            // SAFETY: made by `new` and destroyed here only; CUDA allows it before the mark is passed.
            let _ = unsafe { result::event::destroy(self.raw) };
        }
    }
}
