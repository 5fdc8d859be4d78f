//! Collecting what the driver logs (guide 4.1).

use std::collections::VecDeque;
use std::ffi::{CStr, c_char, c_void};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::error::LogMessage;

/// Messages kept; older ones are dropped, since level 4 can be chatty.
const CAPACITY: usize = 4096;

/// How much the driver logs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum LogLevel {
    /// Nothing.
    Off = 0,
    /// The context, or OptiX, may be unusable.
    Fatal = 1,
    /// An error that the caller can recover from.
    Error = 2,
    /// Unexpected or slow behaviour.
    Warning = 3,
    /// Status, progress and compile feedback.
    #[default]
    Print = 4,
}

/// Receives the driver's messages; shared with the driver by address, so it lives in an `Arc` that outlives the context.
#[derive(Debug, Default)]
pub(super) struct LogSink {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    messages: VecDeque<LogMessage>,
    /// Errors that have not been given to a [`super::Error`] yet.
    unreported: Vec<LogMessage>,
}

impl LogSink {
    fn state(&self) -> MutexGuard<'_, State> {
        // If a thread panicked while it held the lock, it left plain lists, which are still good.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn push(&self, message: LogMessage) {
        let mut state = self.state();
        if message.level <= 2 && state.unreported.len() < CAPACITY {
            state.unreported.push(message.clone());
        }
        if state.messages.len() == CAPACITY {
            state.messages.pop_front();
        }
        state.messages.push_back(message);
    }

    pub(super) fn messages(&self) -> Vec<LogMessage> {
        self.state().messages.iter().cloned().collect()
    }

    pub(super) fn take_messages(&self) -> Vec<LogMessage> {
        self.state().messages.drain(..).collect()
    }

    pub(super) fn take_unreported(&self) -> Vec<LogMessage> {
        std::mem::take(&mut self.state().unreported)
    }
}

/// The callback given to the driver; `data` is the address of a [`LogSink`].
///
/// # Safety
/// `tag` and `text` are null or NUL-terminated, `data` is the address of a live [`LogSink`].
pub(super) unsafe extern "C" fn receive(level: u32, tag: *const c_char, text: *const c_char, data: *mut c_void) {
    // SAFETY: the context that registered this callback keeps the sink alive until it is destroyed.
    let sink = unsafe { &*data.cast::<LogSink>() };
    // SAFETY: the driver passes NUL-terminated strings.
    let (tag, text) = unsafe { (lossy(tag), lossy(text)) };
    sink.push(LogMessage { level, tag, text: text.trim_end().to_owned() });
}

/// # Safety
/// `text` is null or NUL-terminated.
unsafe fn lossy(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: not null, and NUL-terminated as the caller promises.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_handed_out_once_and_messages_stay() {
        let sink = LogSink::default();
        let data = (&raw const sink).cast_mut().cast();
        for level in [4, 2] {
            // SAFETY: the strings end in NUL and the sink lives on this stack.
            unsafe { receive(level, c"TAG".as_ptr(), c"text\n".as_ptr(), data) };
        }
        // SAFETY: null strings are allowed.
        unsafe { receive(3, std::ptr::null(), std::ptr::null(), data) };
        let unreported = sink.take_unreported();
        assert_eq!(unreported, [LogMessage { level: 2, tag: "TAG".into(), text: "text".into() }]);
        assert!(sink.take_unreported().is_empty());
        assert_eq!(sink.messages().len(), 3);
        assert_eq!(sink.take_messages().iter().filter(|m| m.is_warning_or_worse()).count(), 2);
        assert!(sink.messages().is_empty());
    }

    #[test]
    fn the_newest_messages_are_kept() {
        let sink = LogSink::default();
        for i in 0..CAPACITY + 10 {
            sink.push(LogMessage { level: 4, tag: String::new(), text: i.to_string() });
        }
        let messages = sink.messages();
        assert_eq!((messages.len(), messages[0].text.as_str()), (CAPACITY, "10"));
    }
}
