//! Instances as machines take them, and the only checks of each one alone (guide 5.4). Sums over a way down a graph are the
//! machines' to check.

use super::InstanceFlags;
use crate::affine::Affine;
use crate::error::InstanceError;

/// How an IAS places a structure `child` (`OptixInstance`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstanceInput<C> {
    /// Object to world, row-major 3x4. Has an inverse.
    pub transform: [f32; 12],
    /// What programs read as the instance id: 28 bits.
    pub id: u32,
    /// Added to the index of the hit-group record: 28 bits, and so is the sum along any way down the graph.
    pub sbt_offset: u32,
    /// Rays whose mask shares no bit with this one don't see the instance.
    pub visibility_mask: u8,
    /// What holds for all primitives below.
    pub flags: InstanceFlags,
    /// What is placed.
    pub child: C,
}

/// The greatest numbers that an instance may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InstanceLimits {
    /// Of its id.
    pub id: u32,
    /// Of its record offset.
    pub sbt_offset: u32,
    /// The most structures on a path from the one with the instance down to the primitives.
    pub depth: usize,
}

impl<C> InstanceInput<C> {
    /// An instance of `child` in its place, with id and record offset 0 and no flags, that all rays see.
    pub fn new(child: C) -> Self {
        Self {
            transform: Affine::IDENTITY.to_f32(),
            id: 0,
            sbt_offset: 0,
            visibility_mask: 0xff,
            flags: InstanceFlags::NONE,
            child,
        }
    }

    /// The same instance of another child.
    pub(crate) fn with_child<D>(&self, child: D) -> InstanceInput<D> {
        let Self { transform, id, sbt_offset, visibility_mask, flags, .. } = *self;
        InstanceInput { transform, id, sbt_offset, visibility_mask, flags, child }
    }

    /// Finds what is wrong with it, where its child is `depth` structures deep, or gives the inverse of its transform.
    pub(crate) fn check(&self, depth: usize, limits: InstanceLimits) -> Result<Affine, InstanceError> {
        let Self { transform, id, sbt_offset, .. } = *self;
        if id > limits.id {
            return Err(InstanceError::Id { id });
        }
        if sbt_offset > limits.sbt_offset {
            return Err(InstanceError::RecordOffset { offset: sbt_offset });
        }
        if let Some(flags) = self.flags.conflict() {
            return Err(InstanceError::Flags { flags });
        }
        if depth >= limits.depth {
            return Err(InstanceError::TooDeep { depth: depth + 1, limit: limits.depth });
        }
        if !transform.iter().all(|x| x.is_finite()) {
            return Err(InstanceError::NonFiniteTransform { transform });
        }
        Affine::from_f32(&transform).inverse().ok_or(InstanceError::SingularTransform { transform })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: InstanceLimits = InstanceLimits { id: (1 << 28) - 1, sbt_offset: (1 << 28) - 1, depth: 31 };

    #[test]
    fn wrong_instances_are_named() {
        let good = InstanceInput::new(());
        assert_eq!(good.check(30, LIMITS), Ok(Affine::IDENTITY));
        let flat = [1., 2., 3., 0., 4., 5., 6., 0., 7., 8., 9., 0.];
        let both = InstanceFlags::DISABLE_ANYHIT | InstanceFlags::ENFORCE_ANYHIT;
        let cases = [
            (InstanceInput { id: 1 << 28, ..good }, InstanceError::Id { id: 1 << 28 }),
            (InstanceInput { sbt_offset: 1 << 28, ..good }, InstanceError::RecordOffset { offset: 1 << 28 }),
            (
                InstanceInput { flags: both, ..good },
                InstanceError::Flags { flags: ["DISABLE_ANYHIT", "ENFORCE_ANYHIT"] },
            ),
            (InstanceInput { transform: flat, ..good }, InstanceError::SingularTransform { transform: flat }),
            (InstanceInput { transform: [0.0; 12], ..good }, InstanceError::SingularTransform { transform: [0.0; 12] }),
        ];
        for (instance, error) in cases {
            assert_eq!(instance.check(1, LIMITS), Err(error));
        }
        let mut transform = flat;
        transform[3] = f32::NAN;
        let error = InstanceInput { transform, ..good }.check(1, LIMITS).unwrap_err();
        assert!(matches!(error, InstanceError::NonFiniteTransform { .. }));
        assert_eq!(good.check(31, LIMITS), Err(InstanceError::TooDeep { depth: 32, limit: 31 }));
    }
}
