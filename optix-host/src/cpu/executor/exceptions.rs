//! Reports of exceptions (guide 13.14), if the pipeline has no exception program.

use super::Launch;
use glam::UVec3;
use optix_device_rs::exception::TRACE_DEPTH_EXCEEDED;
use optix_device_rs::host::ExceptionState;
use std::sync::{Mutex, PoisonError};

/// OptiX prints as many.
const REPORTED: usize = 5;

/// The first exceptions of a launch, in the order of launch indices, that no program was told of.
#[derive(Default)]
pub(super) struct Unhandled(Mutex<Vec<([u32; 3], String)>>);

impl Unhandled {
    pub fn add(&self, launch: &Launch<'_>, index: UVec3, program: &str, exception: &ExceptionState) {
        let [x, y, z] = index.to_array();
        let mut reports = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let at = reports.partition_point(|(other, _)| *other < [z, y, x]);
        if at == REPORTED {
            return;
        }
        let line = exception.line.as_ref().map_or(String::new(), |line| format!(" ({})", line.to_string_lossy()));
        let text = format!("{} at launch index {:?}, by {program}{line}", describe(launch, exception), [x, y, z]);
        reports.insert(at, ([z, y, x], text));
        reports.truncate(REPORTED);
    }

    pub fn reports(self) -> Vec<String> {
        let reports = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        reports.into_iter().map(|(_, text)| text).collect()
    }
}

fn describe(launch: &Launch<'_>, exception: &ExceptionState) -> String {
    let exceptions = &launch.description.exceptions;
    let Ok(code) = u32::try_from(exception.code) else {
        let what = match exception.code {
            TRACE_DEPTH_EXCEEDED => "trace depth exceeded",
            code if code == ExceptionState::STACK_OVERFLOW.code => "stack overflow",
            _ => "exception of OptiX",
        };
        return format!("{what} (code {})", exception.code);
    };
    let name = exceptions.variants.iter().find(|(known, _)| *known == code).map_or("?", |(_, name)| name);
    format!("{}::{name} (code {code}, details {:x?})", exceptions.throws.unwrap_or("?"), exception.details)
}
