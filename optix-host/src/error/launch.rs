//! Why a launch can't begin.

use super::ReferenceError;
use super::words::{Words, errors};
use crate::limits::MAX_LAUNCH_SIZE;

/// What is wrong with a launch.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum LaunchError {
    /// A dimension that is 0.
    Empty {
        /// Width, height and depth.
        dimensions: [u32; 3],
    },
    /// More launch indices than OptiX has.
    TooLarge {
        /// Width, height and depth.
        dimensions: [u32; 3],
    },
    /// Parameters that hold what another device made.
    OfAnotherDevice {
        /// What they hold, with an article.
        holds: &'static str,
    },
    /// Parameters that hold a structure or a callable that the pipeline's programs can't use.
    Parameters(ReferenceError),
    /// A parameter that differs from the value that the pipeline was built with.
    BoundValue {
        /// The field of the parameters.
        parameter: &'static str,
        /// Its value in this launch: its bytes as a number.
        given: String,
        /// The bound value.
        bound: String,
    },
}

impl LaunchError {
    fn words(&self) -> Words {
        match self {
            Self::Empty { dimensions: [w, h, d] } => (
                format!("its dimensions {w} x {h} x {d} are empty"),
                "give 1 for a dimension that is not used, and leave out a launch without indices".into(),
            ),
            Self::TooLarge { dimensions: [w, h, d] } => (
                format!("its dimensions {w} x {h} x {d} are more than 2^{} (guide 12)", MAX_LAUNCH_SIZE.ilog2()),
                "split it over several launches, with a parameter that says where each begins".into(),
            ),
            Self::OfAnotherDevice { holds } => {
                (format!("its parameters hold {holds} of another device"), "make it with the pipeline's device".into())
            }
            Self::Parameters(error) => (format!("its parameters hold {}", error.problem()), error.remedy()),
            Self::BoundValue { parameter, given, bound } => (
                format!(
                    "its parameter `{parameter}` differs from the value that the pipeline was built with ({given} against {bound})"
                ),
                "launch with the bound value, or build another pipeline without `.bind(..)` for it".into(),
            ),
        }
    }
}

errors!(LaunchError);
