//! What can be wrong with a scene.

use super::words::{Words, errors};

/// What does not fit together in a scene. Geometries and instances are counted from 0, in the order given.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum SceneError {
    /// A GAS without geometry.
    EmptyGas,
    /// An IAS without instances.
    EmptyIas,
    /// A material that another scene made.
    ForeignMaterial {
        /// The geometry that has it.
        geometry: usize,
    },
    /// A record that holds what another device made.
    RecordOfAnotherDevice {
        /// What it holds, with an article.
        holds: &'static str,
    },
    /// A record that holds what another scene made.
    RecordOfAnotherScene {
        /// What it holds, with an article.
        holds: &'static str,
    },
    /// A table of callables that holds one of another scene.
    ForeignCallable {
        /// Which of the callables that were given.
        callable: usize,
    },
    /// More than can be numbered.
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many there are.
        count: usize,
    },
    /// More callables than this process can tell apart, over all scenes that it has had.
    TooManyCallables,
    /// An instance of a structure that another scene made.
    ForeignInstance {
        /// Which instance.
        instance: usize,
    },
    /// An instance of a structure that another device built.
    InstanceOfAnotherDevice {
        /// Which instance.
        instance: usize,
    },
    /// A GAS that only rays through an instance find the records of.
    NotFirstGas,
}

impl SceneError {
    fn words(&self) -> Words {
        let (problem, remedy): (String, &str) = match *self {
            Self::EmptyGas => (
                "a GAS needs at least one geometry, and was given none".into(),
                "give it one, or leave out the structure",
            ),
            Self::EmptyIas => (
                "an IAS needs at least one instance, and was given none".into(),
                "give it one; an instance with visibility mask 0 is seen by no ray",
            ),
            Self::ForeignMaterial { geometry } => (
                format!("geometry {geometry} of the GAS has a material of another scene"),
                "make the material with this scene (`scene.material(..)`)",
            ),
            Self::RecordOfAnotherDevice { holds } => {
                (format!("a record holds {holds} of another device"), "make it with this scene's device")
            }
            Self::RecordOfAnotherScene { holds } => (
                format!("a record holds {holds} of another scene, whose records are in another table"),
                "make it with this scene",
            ),
            Self::ForeignCallable { callable } => (
                format!("callable {callable} of the table is a callable of another scene"),
                "make it with this scene (`scene.callable::<program>(..)`)",
            ),
            Self::TooMany { what, count } => {
                (format!("the scene has {count} {what}, more than 32 bits can number"), "split the scene over several")
            }
            Self::TooManyCallables => (
                "the scenes of this process have had more callables than 32 bits can number".into(),
                "make callables once and keep their references, or start the process again",
            ),
            Self::ForeignInstance { instance } => (
                format!("instance {instance} is of an acceleration structure of another scene"),
                "build the structure with this scene",
            ),
            Self::InstanceOfAnotherDevice { instance } => (
                format!("instance {instance} is of an acceleration structure of another device"),
                "build the structure on this device",
            ),
            Self::NotFirstGas => (
                "this GAS is not the scene's first, so its records are reached through an instance only".into(),
                "trace against an IAS that has it (`scene.ias([gas.at(Affine3A::IDENTITY)])`)",
            ),
        };
        (problem, remedy.into())
    }
}

errors!(SceneError);
