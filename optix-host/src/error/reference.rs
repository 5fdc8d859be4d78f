//! Why a pipeline's programs can't use a structure or a callable that a record or launch parameters hold.

use super::words::{Words, errors, number};

/// What is wrong with a structure or a callable that a record or launch parameters hold.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum ReferenceError {
    /// No scene made it.
    NoScene {
        /// What is held, with an article.
        held: &'static str,
    },
    /// Another scene made it than the pipeline's.
    AnotherScene {
        /// What is held, with an article.
        held: &'static str,
    },
    /// The scene made it after the pipeline, whose table does not have its records.
    MadeLater {
        /// What is held, with an article.
        held: &'static str,
    },
    /// A graph that is deeper than those that the pipeline traces.
    GraphTooDeep {
        /// Its levels of instances.
        levels: u32,
        /// Those of the deepest graph that the scene had when the pipeline was built.
        planned: u32,
        /// What the pipeline is specialised to.
        graph: &'static str,
    },
    /// A GAS, where the pipeline traces one level of instances.
    GasAlone,
}

impl ReferenceError {
    fn words(&self) -> Words {
        let (problem, remedy): (String, &str) = match *self {
            Self::NoScene { held } => (format!("{held} that no scene made"), "make it with the pipeline's scene"),
            Self::AnotherScene { held } => {
                (format!("{held} of another scene than the pipeline's"), "make it with the pipeline's scene")
            }
            Self::MadeLater { held } => (
                format!("{held} whose records the scene got after the pipeline was built"),
                "build the pipeline again",
            ),
            Self::GraphTooDeep { levels, planned, graph } => (
                format!(
                    "a graph with {} of instances, but the pipeline was specialised to {graph}, the deepest that \
                     the scene had then ({planned})",
                    number(levels as usize, "level")
                ),
                "build the pipeline after the acceleration structures",
            ),
            Self::GasAlone => (
                "a GAS, but the scene has an IAS, so the pipeline is specialised to rays that are traced against an IAS".into(),
                "put the GAS into one (`scene.ias([gas.at(Affine3A::IDENTITY)])`) and trace against that, or take the GAS's \
                 `world()` before the pipeline is built, which then allows any graph",
            ),
        };
        (problem, remedy.into())
    }
}

errors!(ReferenceError);
