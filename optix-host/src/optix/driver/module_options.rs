//! How a module is compiled (guide 6.3, 6.5.1).

use std::ffi::CString;

use super::options::PipelineOptions;
use super::payload::PayloadType;
use super::sys;
use crate::error::DriverError as Error;
use crate::limits::MAX_PAYLOAD_TYPES;

/// How one module is compiled. Modules of one pipeline may differ in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ModuleOptions {
    /// The registers that a thread may use; 0 leaves the limit to the driver.
    pub max_registers: u32,
    /// How hard the compiler optimises.
    pub optimization: OptimizationLevel,
    /// How much debug information is kept.
    pub debug: DebugLevel,
    /// Parts of the launch parameters that the compiler may replace by constants.
    pub bound_values: Vec<BoundValue>,
    /// Up to 8 payload types; a type's id is `1 << index`. Needs
    /// [`PipelineOptions::payload_values`] of 0.
    pub payload_types: Vec<PayloadType>,
}

/// How hard the compiler optimises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OptimizationLevel {
    /// The driver chooses.
    #[default]
    Default,
    /// None.
    Level0,
    /// Little.
    Level1,
    /// More.
    Level2,
    /// All.
    Level3,
}

/// How much debug information is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DebugLevel {
    /// The driver chooses.
    #[default]
    Default,
    /// None.
    None,
    /// Only what costs no speed.
    Minimal,
    /// What profilers need; costs some speed.
    Moderate,
    /// Everything.
    Full,
}

/// Bytes of the launch parameters that are promised to have this value in every launch (guide 6.5.1). A launch with
/// another value is undefined behaviour, which validation mode finds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoundValue {
    /// The offset in the launch parameters, in bytes.
    pub offset: usize,
    /// The value.
    pub bytes: Vec<u8>,
    /// The name in the compiler's feedback for each load that is replaced.
    pub annotation: String,
}

impl ModuleOptions {
    /// Checks the rules of guide 6.5.1 and 14 for which no driver is needed.
    pub(super) fn check(&self, pipeline: &PipelineOptions) -> Result<(), Error> {
        const WHAT: &str = "module options";
        if i32::try_from(self.max_registers).is_err() {
            let problem = format!("max_registers is {}", self.max_registers);
            return Err(Error::invalid(WHAT, problem, "a thread has at most 255 registers; 0 sets no limit"));
        }
        self.check_payload_types(pipeline)?;
        if !self.bound_values.is_empty() && pipeline.launch_params.is_none() {
            let problem = "values are bound, but the pipeline has no launch parameters";
            return Err(Error::invalid(WHAT, problem, "name the launch-parameter variable in the pipeline options"));
        }
        let mut ranges = Vec::with_capacity(self.bound_values.len());
        for value in &self.bound_values {
            let name = &value.annotation;
            match value.offset.checked_add(value.bytes.len()) {
                Some(end) if end > value.offset => ranges.push((value.offset, end, name)),
                _ => {
                    let problem = format!("bound value {name:?}: {} bytes at {}", value.bytes.len(), value.offset);
                    return Err(Error::invalid(WHAT, problem, "bind at least one byte, inside the launch parameters"));
                }
            }
        }
        ranges.sort_unstable();
        for pair in ranges.windows(2) {
            if pair[1].0 < pair[0].1 {
                let problem = format!("bound values {:?} and {:?} overlap", pair[0].2, pair[1].2);
                return Err(Error::invalid(
                    WHAT,
                    problem,
                    "bind each byte of the launch parameters once (guide 6.5.1)",
                ));
            }
        }
        Ok(())
    }

    fn check_payload_types(&self, pipeline: &PipelineOptions) -> Result<(), Error> {
        const WHAT: &str = "payload types";
        let max = MAX_PAYLOAD_TYPES;
        if self.payload_types.len() > max {
            let problem = format!("{} types in one module, more than {max}", self.payload_types.len());
            return Err(Error::invalid(WHAT, problem, "spread the ray types over several modules (guide 14)"));
        }
        if !self.payload_types.is_empty() && pipeline.payload_values != 0 {
            let problem = format!("the pipeline has {} untyped payload words as well", pipeline.payload_values);
            return Err(Error::invalid(
                WHAT,
                problem,
                "set `payload_values` to 0 where payload types are used (guide 14)",
            ));
        }
        self.payload_types.iter().try_for_each(PayloadType::check)
    }
}

/// The C structures of [`ModuleOptions`], which point into it and into each other.
pub(super) struct RawModuleOptions<'a> {
    options: &'a ModuleOptions,
    payload_types: Vec<sys::OptixPayloadType>,
    bound_values: Vec<sys::OptixModuleCompileBoundValueEntry>,
    _annotations: Vec<CString>,
}

impl<'a> RawModuleOptions<'a> {
    pub(super) fn new(options: &'a ModuleOptions) -> Result<Self, Error> {
        let annotations = options
            .bound_values
            .iter()
            .map(|value| {
                CString::new(value.annotation.as_str()).map_err(|_| {
                    let problem = format!("{:?} has a NUL in it", value.annotation);
                    Error::invalid("the annotation of a bound value", problem, "use the field's name")
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let entry = |(value, annotation): (&BoundValue, &CString)| sys::OptixModuleCompileBoundValueEntry {
            pipeline_param_offset_in_bytes: value.offset,
            size_in_bytes: value.bytes.len(),
            bound_value_ptr: value.bytes.as_ptr().cast(),
            annotation: annotation.as_ptr(),
        };
        Ok(Self {
            payload_types: options.payload_types.iter().map(PayloadType::raw).collect(),
            bound_values: options.bound_values.iter().zip(&annotations).map(entry).collect(),
            _annotations: annotations,
            options,
        })
    }

    /// Points into `self`.
    pub(super) fn options(&self) -> sys::OptixModuleCompileOptions {
        use sys::{OptixCompileDebugLevel as Debug, OptixCompileOptimizationLevel as Level};
        sys::OptixModuleCompileOptions {
            max_register_count: self.options.max_registers as i32,
            opt_level: match self.options.optimization {
                OptimizationLevel::Default => Level::DEFAULT,
                OptimizationLevel::Level0 => Level::LEVEL_0,
                OptimizationLevel::Level1 => Level::LEVEL_1,
                OptimizationLevel::Level2 => Level::LEVEL_2,
                OptimizationLevel::Level3 => Level::LEVEL_3,
            },
            debug_level: match self.options.debug {
                DebugLevel::Default => Debug::DEFAULT,
                DebugLevel::None => Debug::NONE,
                DebugLevel::Minimal => Debug::MINIMAL,
                DebugLevel::Moderate => Debug::MODERATE,
                DebugLevel::Full => Debug::FULL,
            },
            bound_values: or_null(&self.bound_values),
            num_bound_values: self.bound_values.len() as u32,
            num_payload_types: self.payload_types.len() as u32,
            payload_types: or_null(&self.payload_types),
        }
    }
}

/// The address of the first element, null without one.
pub(super) fn or_null<T>(slice: &[T]) -> *const T {
    if slice.is_empty() { std::ptr::null() } else { slice.as_ptr() }
}

#[cfg(test)]
mod tests {
    use super::super::payload::PayloadSemantics;
    use super::*;

    fn bound(offset: usize, len: usize) -> BoundValue {
        BoundValue { offset, bytes: vec![0; len], annotation: format!("at {offset}") }
    }

    fn check(bound_values: Vec<BoundValue>) -> Result<(), Error> {
        let pipeline = PipelineOptions { launch_params: Some("params".into()), ..Default::default() };
        ModuleOptions { bound_values, ..Default::default() }.check(&pipeline)
    }

    #[test]
    fn bound_values_may_touch_but_not_overlap() {
        assert!(check(vec![bound(4, 4), bound(0, 4), bound(8, 1)]).is_ok());
        assert!(check(vec![bound(4, 4), bound(0, 5)]).unwrap_err().to_string().contains("overlap"));
        assert!(check(vec![bound(0, 8), bound(0, 8)]).is_err());
        assert!(check(vec![bound(0, 0)]).is_err());
        assert!(check(vec![bound(usize::MAX, 2)]).is_err());
        let options = ModuleOptions { bound_values: vec![bound(0, 4)], ..Default::default() };
        assert!(options.check(&PipelineOptions::default()).is_err());
    }

    #[test]
    fn payload_types_keep_their_limits() {
        let words = |words| PayloadType { semantics: vec![PayloadSemantics::CALLER_READ; words] };
        let check = |types: Vec<PayloadType>, payload_values| {
            let pipeline = PipelineOptions { payload_values, ..Default::default() };
            ModuleOptions { payload_types: types, ..Default::default() }.check(&pipeline)
        };
        assert!(check(vec![words(32); 8], 0).is_ok());
        assert!(check(vec![words(33)], 0).is_err());
        assert!(check(vec![words(1); 9], 0).is_err());
        assert!(check(vec![words(1)], 1).is_err());
    }

    #[test]
    fn raw_options_point_at_the_values() {
        let options = ModuleOptions {
            bound_values: vec![bound(8, 4)],
            payload_types: vec![PayloadType { semantics: vec![PayloadSemantics::CALLER_WRITE; 3] }],
            ..Default::default()
        };
        let raw = RawModuleOptions::new(&options).unwrap();
        let c = raw.options();
        assert_eq!((c.num_bound_values, c.num_payload_types), (1, 1));
        // SAFETY: the pointers lead to `raw` and `options`, which are alive.
        let (entry, payload) = unsafe { (&*c.bound_values, &*c.payload_types) };
        assert_eq!((entry.pipeline_param_offset_in_bytes, entry.size_in_bytes), (8, 4));
        // SAFETY: as above; the payload has three words.
        let words = unsafe { std::slice::from_raw_parts(payload.payload_semantics, 3) };
        assert_eq!(words, [2, 2, 2]);
        let empty = ModuleOptions::default();
        let raw = RawModuleOptions::new(&empty).unwrap();
        assert!(raw.options().bound_values.is_null() && raw.options().payload_types.is_null());
    }
}
