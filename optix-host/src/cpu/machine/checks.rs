//! What the checked mode traps: what the OptiX guide calls undefined or leaves to the application.
//!
//! Each message names the rule and its item in the guide's checklist, such as `G010`.

use super::{Job, trap};
use core::cell::Cell;
use optix_device_rs::host::{PayloadWatch, TraceCall};

/// Checks the arguments of a trace call; gives what is known of its payload.
pub(super) fn trace(job: &Job<'_>, trace: &TraceCall) -> Watch {
    let ray = &trace.ray;
    for (what, vector) in [("origin", ray.origin), ("direction", ray.direction)] {
        if !vector.is_finite() {
            trap(format!("the ray's {what} {vector} is not finite (guide 13.2, G008)"));
        }
    }
    if ray.direction == glam::Vec3::ZERO {
        trap("the ray has no direction: all its elements are 0 (guide 13.2, G008)".into());
    }
    // An infinite tmax is an interval without end.
    if ray.tmin.is_nan() || ray.tmin.is_infinite() {
        trap(format!("tmin is {} (guide 13.2, G010)", ray.tmin));
    }
    if ray.tmax.is_nan() || ray.tmax == f32::NEG_INFINITY {
        trap(format!("tmax is {} (guide 13.2, G010)", ray.tmax));
    }
    if ray.tmin < 0.0 {
        trap(format!("tmin is negative: {} (guide 13.2, G010)", ray.tmin));
    }
    // Exclusive among themselves: four about any-hit, two about culling by face.
    for (group, rule) in [(1 | 2 | 64 | 128, "G016 to G019"), (16 | 32, "G023")] {
        if (ray.flags.bits() & group).count_ones() > 1 {
            trap(format!(
                "the ray flags {:#x} have two that exclude each other (guide 13.2, {rule})",
                ray.flags.bits()
            ));
        }
    }
    Watch { payload: job.ray(trace.miss_index).payload.name, written: Cell::new(trace.caller_writes) }
}

/// Checks a report.
pub(super) fn report(t: f32, kind: u8) {
    if kind > 127 {
        trap(format!("hit kind {kind} is reported: 128 to 255 are of built-in primitives (guide 13.4, G030)"));
    }
    if t.is_nan() {
        trap("a hit is reported at t = NaN (guide 13.4, G034)".into());
    }
}

/// What is known of a trace call's payload.
pub(super) struct Watch {
    payload: &'static str,
    /// Bit `i`: the caller or a program has written word `i`.
    written: Cell<u32>,
}

impl Watch {
    /// The trace call returns, and its caller takes these words.
    pub fn returns(&self, caller_reads: u32) {
        if let Some(word) = self.missing(caller_reads) {
            trap(format!(
                "payload word {word} of `{}` comes back to the caller, which reads it, but neither the caller nor any \
                 program of this trace wrote it (guide 14, H024)",
                self.payload
            ));
        }
    }

    /// The first of these words that nobody has written.
    fn missing(&self, mask: u32) -> Option<u32> {
        let missing = mask & !self.written.get();
        (missing != 0).then(|| missing.trailing_zeros())
    }
}

impl PayloadWatch for Watch {
    fn takes(&self, mask: u32) {
        if let Some(word) = self.missing(mask) {
            trap(format!(
                "payload word {word} of `{}` is read, but neither the caller nor any program wrote it (guide 14, H024)",
                self.payload
            ));
        }
    }

    fn gives(&self, mask: u32) {
        self.written.set(self.written.get() | mask);
    }
}
