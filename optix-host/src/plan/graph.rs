//! Which traversable graphs a pipeline traces (guide 6.3).

use crate::error::ReferenceError;
use crate::features::Features;

/// Which traversable graphs rays meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Graph {
    SingleGas,
    SingleLevelInstancing,
    Any,
}

impl Graph {
    /// The graphs of a scene, with the reason.
    pub fn of(features: &Features) -> (Self, String) {
        let levels = features.instance_levels;
        match features.roots.least_but(levels) {
            None => (Self::of_levels(levels), format!("{levels} levels of instances in the scene")),
            Some(least) => {
                let reason = format!("rays are traced against structures with {least} to {levels} levels of instances");
                (Self::Any, reason)
            }
        }
    }

    fn of_levels(levels: u32) -> Self {
        match levels {
            0 => Self::SingleGas,
            1 => Self::SingleLevelInstancing,
            _ => Self::Any,
        }
    }

    /// For messages.
    pub fn words(self) -> &'static str {
        match self {
            Self::SingleGas => "a single GAS",
            Self::SingleLevelInstancing => "one level of instances",
            Self::Any => "any graph",
        }
    }

    /// Checks whether rays may be traced against a structure with so many levels of instances. `planned` is the most
    /// that the scene had.
    pub fn allows(self, levels: u32, planned: u32) -> Result<(), ReferenceError> {
        match self {
            _ if levels > planned => Err(ReferenceError::GraphTooDeep { levels, planned, graph: self.words() }),
            Self::SingleLevelInstancing if levels == 0 => Err(ReferenceError::GasAlone),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn graphs_of_scenes() {
        let graph = |instance_levels, roots: &[u32]| {
            let features = Features { instance_levels, ..Features::default() };
            roots.iter().for_each(|&levels| features.roots.add(levels));
            Graph::of(&features).0
        };
        assert_eq!(graph(1, &[1]), Graph::SingleLevelInstancing);
        assert_eq!(graph(1, &[]), Graph::SingleLevelInstancing);
        assert_eq!(graph(1, &[0, 1]), Graph::Any, "the GAS is traced against, too");
        assert_eq!(graph(0, &[0]), Graph::SingleGas);
        for planned in 0..4 {
            for levels in 0..6 {
                let refused = graph(planned, &[]).allows(levels, planned).err();
                assert_eq!(refused.is_some(), levels > planned || planned == 1 && levels == 0, "{levels} in {planned}");
                if let Some(why) = refused {
                    assert_eq!(matches!(why, ReferenceError::GasAlone), levels == 0, "{why}");
                    assert!(why.remedy().contains(if levels == 0 {
                        "put the GAS into one"
                    } else {
                        "after the acceleration structures"
                    }));
                }
            }
        }
    }
}
