//! Flags of instances.

/// Flags that hold for all primitives below an instance (`OptixInstanceFlags`, guide 5.4). A set, joined with `|`. If
/// instances are nested, the flags of the innermost one count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct InstanceFlags(u32);

impl InstanceFlags {
    /// No flag.
    pub const NONE: Self = Self(0);
    /// Rays don't cull faces of this instance's triangles.
    pub const DISABLE_TRIANGLE_FACE_CULLING: Self = Self(1);
    /// Front and back are exchanged.
    pub const FLIP_TRIANGLE_FACING: Self = Self(2);
    /// Any-hit programs are not called, unless a ray enforces them.
    pub const DISABLE_ANYHIT: Self = Self(4);
    /// Any-hit programs are called even for geometry that disables them, unless a ray disables them.
    pub const ENFORCE_ANYHIT: Self = Self(8);

    /// Bits of `OptixInstanceFlags`.
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// Two of these flags that exclude each other (guide 5.4), if there are. OptiX does not report them.
    pub(crate) fn conflict(self) -> Option<[&'static str; 2]> {
        self.contains(Self::DISABLE_ANYHIT | Self::ENFORCE_ANYHIT).then_some(["DISABLE_ANYHIT", "ENFORCE_ANYHIT"])
    }

    /// Whether all flags of the other are among these.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

impl core::ops::BitOr for InstanceFlags {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}
