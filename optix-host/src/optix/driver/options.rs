//! Options that all modules of a pipeline share (guide 6.3).

use optix_device_rs::primitive::PrimitiveType;
use std::ffi::CString;

use super::context::Context;
use super::sys;
use crate::error::DriverError as Error;
use crate::limits::{MAX_ATTRIBUTE_WORDS, MAX_PAYLOAD_WORDS};

/// The `ROCAPS` curves, which exist from ABI 105 on.
const ROCAPS: u32 = 0xf00;

/// Options that must be the same for every module whose programs are linked into one pipeline.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PipelineOptions {
    /// Whether a traversable has motion keys.
    pub motion_blur: bool,
    /// Which traversable graphs are traced.
    pub graph: TraversableGraph,
    /// 32-bit payload words, up to 32. 0 where the modules declare payload types instead.
    pub payload_values: u32,
    /// 32-bit attribute words that intersection programs report, up to 8. Triangles use 2 of them.
    pub attribute_values: u32,
    /// Which exceptions are raised.
    pub exceptions: Exceptions,
    /// The name of the launch-parameter variable in the modules; `None` without launch parameters.
    pub launch_params: Option<String>,
    /// The primitive kinds that are met.
    pub primitives: PrimitiveKinds,
    /// Whether acceleration structures have opacity micromaps. Tracing one without this is undefined behaviour.
    pub opacity_micromaps: bool,
}

/// Which traversable graphs a pipeline traces. A narrower choice is faster, but tracing any other graph is undefined
/// behaviour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TraversableGraph {
    /// Any graph.
    #[default]
    Any,
    /// One geometry acceleration structure.
    SingleGas,
    /// One instance acceleration structure over geometry acceleration structures.
    SingleLevelInstancing,
    /// Either of the two.
    SingleGasOrSingleLevelInstancing,
}

impl TraversableGraph {
    fn flags(self) -> u32 {
        use sys::OptixTraversableGraphFlags as Flags;
        match self {
            Self::Any => Flags::ALLOW_ANY.0,
            Self::SingleGas => Flags::ALLOW_SINGLE_GAS.0,
            Self::SingleLevelInstancing => Flags::ALLOW_SINGLE_LEVEL_INSTANCING.0,
            Self::SingleGasOrSingleLevelInstancing => {
                Flags::ALLOW_SINGLE_GAS.0 | Flags::ALLOW_SINGLE_LEVEL_INSTANCING.0
            }
        }
    }

    /// The depth of the deepest such graph, if there is one.
    pub fn max_depth(self) -> Option<u32> {
        match self {
            Self::Any => None,
            Self::SingleGas => Some(1),
            Self::SingleLevelInstancing | Self::SingleGasOrSingleLevelInstancing => Some(2),
        }
    }
}

/// Which exceptions are raised (guide 13.14).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exceptions {
    /// The continuation stack is too small.
    pub stack_overflow: bool,
    /// A program traces at the deepest level that is allowed.
    pub trace_depth: bool,
    /// The exceptions that programs throw.
    pub user: bool,
}

impl Exceptions {
    fn flags(self) -> u32 {
        use sys::OptixExceptionFlags as Flags;
        [(self.stack_overflow, Flags::STACK_OVERFLOW), (self.trace_depth, Flags::TRACE_DEPTH), (self.user, Flags::USER)]
            .into_iter()
            .filter(|(on, _)| *on)
            .fold(0, |bits, (_, flag)| bits | flag.0)
    }
}

/// A set of primitive kinds. Empty means triangles and custom primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PrimitiveKinds(u32);

impl PrimitiveKinds {
    /// Triangles.
    pub const TRIANGLE: Self = Self(sys::OptixPrimitiveTypeFlags::TRIANGLE.0);
    /// Primitives with an intersection program of the application.
    pub const CUSTOM: Self = Self(sys::OptixPrimitiveTypeFlags::CUSTOM.0);
    /// Spheres.
    pub const SPHERE: Self = Self(sys::OptixPrimitiveTypeFlags::SPHERE.0);

    /// The kinds of these bits, as in [`sys::OptixPrimitiveTypeFlags`].
    pub fn from_flags(flags: sys::OptixPrimitiveTypeFlags) -> Self {
        Self(flags.0)
    }

    /// The union of both sets.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl From<PrimitiveType> for PrimitiveKinds {
    fn from(kind: PrimitiveType) -> Self {
        match kind {
            PrimitiveType::Triangle => Self::TRIANGLE,
            PrimitiveType::Custom => Self::CUSTOM,
        }
    }
}

/// The C structure, and the string it points to.
pub(super) struct RawOptions {
    pub options: sys::OptixPipelineCompileOptions,
    // A CString's characters stay where they are when it is moved.
    _symbol: Option<CString>,
}

impl PipelineOptions {
    pub(super) fn raw(&self, context: &Context) -> Result<RawOptions, Error> {
        const WHAT: &str = "pipeline options";
        let max_payload = MAX_PAYLOAD_WORDS as u32;
        if self.payload_values > max_payload {
            let problem = format!("{} payload words, more than {max_payload}", self.payload_values);
            return Err(Error::invalid(WHAT, problem, "move state behind a pointer that two payload words carry"));
        }
        if self.attribute_values > MAX_ATTRIBUTE_WORDS as u32 {
            let problem = format!("{} attribute words, more than {MAX_ATTRIBUTE_WORDS}", self.attribute_values);
            return Err(Error::invalid(WHAT, problem, "compute the rest of the attributes in the hit programs"));
        }
        if self.primitives.0 & ROCAPS != 0 && context.abi_version() < 105 {
            let problem = format!("ROCAPS curves need OptiX 9.0, the driver serves {}", context.optix_release());
            return Err(Error::invalid(WHAT, problem, "install driver 570 or newer, or use the curves without ROCAPS"));
        }
        let symbol = self.launch_params.as_deref().map(|name| c_name(WHAT, name)).transpose()?;
        let options = sys::OptixPipelineCompileOptions {
            uses_motion_blur: self.motion_blur.into(),
            traversable_graph_flags: self.graph.flags(),
            num_payload_values: self.payload_values as i32,
            num_attribute_values: self.attribute_values as i32,
            exception_flags: self.exceptions.flags(),
            pipeline_launch_params_variable_name: symbol.as_ref().map_or(std::ptr::null(), |name| name.as_ptr()),
            uses_primitive_type_flags: self.primitives.0,
            allow_opacity_micromaps: self.opacity_micromaps.into(),
            allow_clustered_geometry: 0,
        };
        Ok(RawOptions { options, _symbol: symbol })
    }
}

/// A name as a C string.
pub(super) fn c_name(what: &'static str, name: &str) -> Result<CString, Error> {
    if name.is_empty() {
        return Err(Error::invalid(what, "a name is empty", "give the name that the PTX has"));
    }
    CString::new(name).map_err(|error| {
        let problem = format!("the name {name:?} has a NUL at byte {}", error.nul_position());
        Error::invalid(what, problem, "give the name that the PTX has")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_become_bits() {
        assert_eq!(PrimitiveKinds::TRIANGLE.with(PrimitiveKinds::CUSTOM).0, 0x8000_0001);
        assert_eq!(Exceptions { stack_overflow: true, trace_depth: false, user: true }.flags(), 5);
        assert_eq!(TraversableGraph::SingleGasOrSingleLevelInstancing.flags(), 3);
        assert_eq!(TraversableGraph::default().flags(), 0);
    }

    #[test]
    fn names_are_checked() {
        assert!(c_name("a test", "params").is_ok());
        assert!(c_name("a test", "").is_err());
        assert!(c_name("a test", "a\0b").unwrap_err().to_string().contains("byte 1"));
    }
}
