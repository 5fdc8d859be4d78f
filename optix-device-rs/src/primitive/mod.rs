//! Kinds of primitive, a file each: what OptiX calls the kind, what its hits carry, and what programs may ask about them
//! (guide 13.4, 13.7, 13.9).
//!
//! To add a kind, write its file and name it below, where [`PrimitiveType`] is declared.

mod custom;
mod triangle;

pub use custom::{Custom, Reported};
pub use triangle::{OnTriangles, TriangleVertices, Triangles};

use crate::layout::Layout;
use crate::sealed::Sealed;
use core::ops::RangeInclusive;

/// A kind of primitive, as `pipeline!` names it after `on`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a kind of primitive",
    label = "expected what the geometry is made of, such as `Triangles`, or `Custom` for primitives with an intersection program"
)]
pub trait Primitive: Sealed + 'static {
    /// Which of the kinds it is.
    const TYPE: PrimitiveType;
    /// The number of the kind (`OptixPrimitiveType`).
    const OPTIX_TYPE: u32;
    /// The hit kinds by which its hits are known (guide 13.7).
    const HIT_KINDS: RangeInclusive<u8>;
    /// Whether a program of the user's says where rays meet these primitives. OptiX intersects the others itself.
    const HAS_INTERSECTION_PROGRAM: bool;
    /// Functions in the PTX that ask about the current hit and are undefined unless it is on such a primitive.
    const QUERIES: &'static [&'static str];
    /// What its hits carry, where intersection programs report `Reported`: built-in primitives have attributes of their own.
    type Hits<Reported: Attributes>: Attributes;
    /// What `pipeline!` checks an intersection program `Program` as. Where there should be none that is
    /// [what fits everywhere](crate::check::FitsEverywhere): that it is there is all there is to say.
    #[doc(hidden)]
    type IntersectionProgram<Program>;
    /// What `pipeline!` checks another program of a hit group without an intersection program as: likewise.
    #[doc(hidden)]
    type ProgramOfBuiltIn<Program>;
}

/// The attributes of a kind of hit: what `report` takes and what closest-hit and any-hit programs of that geometry read.
///
/// A built-in kind of primitive, such as [`Triangles`], has its own; a struct with `#[derive(Attributes)]` is one for custom
/// primitives.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a kind of hit",
    label = "expected `Triangles` or a struct with `#[derive(Attributes)]`"
)]
pub trait Attributes: Copy + 'static {
    /// The name, for messages.
    const NAME: &'static str;
    /// Attribute words, 0 to 8.
    const WORDS: usize;
    /// How they are made up.
    #[doc(hidden)]
    const LAYOUT: Layout = Layout::of("attributes").number(Self::WORDS);
    /// Reads the attributes from their words.
    ///
    /// # Safety
    /// [`Attributes::store`] of the same type wrote the words.
    unsafe fn load(words: &[u32]) -> Self;
    /// Writes the attributes to their words.
    fn store(self, words: &mut [u32]);
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $variant:ident = $module:ident::$kind:ident,)*) => {
        /// The kinds of primitive (`OptixPrimitiveType`).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum PrimitiveType {
            $($(#[$doc])* $variant,)*
        }

        /// The kinds alone: where `pipeline!` looks for what stands after `on`.
        #[doc(hidden)]
        pub mod kinds {
            pub use super::{$($kind),*};
        }

        $(impl Sealed for $kind {})*

        /// The tables of device functions that ask about one kind of primitive.
        #[cfg(not(target_arch = "nvptx64"))]
        pub(crate) const TABLES: &[&[crate::intrinsics::DeviceFunction]] = &[$($module::FUNCTIONS),*];

        impl PrimitiveType {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// The name, as `pipeline!` has it after `on`.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => stringify!($kind),)*
                }
            }

            /// Functions in the PTX that are undefined unless the current hit is on such a primitive: [`Primitive::QUERIES`].
            pub const fn queries(self) -> &'static [&'static str] {
                match self {
                    $(Self::$variant => <$kind as Primitive>::QUERIES,)*
                }
            }

            /// The kind whose number is `optix_type`; a number that is none of these counts as a custom primitive's.
            #[cfg(target_arch = "nvptx64")]
            #[inline(always)]
            pub(crate) const fn from_optix(optix_type: u32) -> Self {
                $(if optix_type == <$kind as Primitive>::OPTIX_TYPE {
                    return Self::$variant;
                })*
                Self::Custom
            }

            /// The kind whose hits have this hit kind, if there is one.
            pub(crate) const fn of_hit_kind(hit_kind: u8) -> Option<Self> {
                $(if contains(&<$kind as Primitive>::HIT_KINDS, hit_kind) {
                    return Some(Self::$variant);
                })*
                None
            }
        }
    };
}

kinds! {
    /// A primitive with an intersection program of the user's.
    Custom = custom::Custom,
    /// A built-in triangle.
    Triangle = triangle::Triangles,
}

/// `RangeInclusive::contains`, in constants.
#[inline(always)]
const fn contains(range: &RangeInclusive<u8>, number: u8) -> bool {
    *range.start() <= number && number <= *range.end()
}
