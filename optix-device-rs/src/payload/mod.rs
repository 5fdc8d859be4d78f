//! Ray payloads with typed access per program (guide 14).
//!
//! `#[derive(Payload)]` on a struct `Radiance` makes, for each party that takes part, the struct it receives and the
//! struct it must return: `RadianceFromCaller`, `RadianceAtClosestHit`, `RadianceFromClosestHit`, `RadianceAtMiss`,
//! `RadianceFromMiss`, `RadianceAtAnyHit`, `RadianceFromAnyHit`, `RadianceAtIntersection`, `RadianceFromIntersection` and
//! `RadianceAtCaller`, which `trace` returns. A party with no field has `()` in place of the struct.
//!
//! A payload travels in [`Registers`], or with `#[payload(transport = pointer)]` in memory of the caller, by [`Pointer`].

pub mod semantics;
mod transport;

use crate::layout::{Crossing, Layout};
pub use transport::{Pointer, Registers, Transport};

/// A payload type. Implemented by `#[derive(Payload)]` only.
///
/// # Safety
/// The fields' words follow each other and there are `WORDS` of them, 32 at most in registers. The semantics let each party
/// do what its parts do. On every path of a ray a part's fields were stored before they are loaded, if every party stores the
/// part that it returns.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a payload",
    label = "not a payload type",
    note = "a ray type is named by its payload: a struct with `#[derive(Payload)]`"
)]
pub unsafe trait Payload: Sized + 'static {
    /// The name, for messages.
    const NAME: &'static str;
    /// Words of all fields: at most 32 in [`Registers`], any number by [`Pointer`].
    const WORDS: usize;
    /// The fields, in the order of their words.
    const FIELDS: &'static [Field];
    /// How the fields are made up.
    #[doc(hidden)]
    const LAYOUT: Layout;
    /// One word of `OptixPayloadSemantics` bits per register.
    const SEMANTICS: &'static [u32];
    /// The same at a call that only traverses; see [`semantics::at_traverse`].
    const SEMANTICS_AT_TRAVERSE: &'static [u32];
    /// The same at a call that runs the program of a traversed ray; see [`semantics::at_invoke`].
    const SEMANTICS_AT_INVOKE: &'static [u32];
    /// How it gets from party to party.
    type Transport: Transport;

    /// What a host and a device have to agree on.
    #[doc(hidden)]
    const CROSSING: Crossing = Crossing::payload::<Self>();
    /// All of this as a value, for the host.
    #[cfg(not(target_arch = "nvptx64"))]
    const DESCRIPTION: crate::host::PayloadDescription = crate::host::PayloadDescription::of::<Self>();

    /// What the caller must give to `trace`.
    type FromCaller: Part;
    /// What `trace` returns.
    type AtCaller: Part;
    /// What an intersection program receives.
    type AtIntersection: Part;
    /// What an intersection program must return.
    type FromIntersection: Part;
    /// What an any-hit program receives.
    type AtAnyHit: Part;
    /// What an any-hit program must return.
    type FromAnyHit: Part;
    /// What a closest-hit program receives.
    type AtClosestHit: Part;
    /// What a closest-hit program must return.
    type FromClosestHit: Part;
    /// What a miss program receives.
    type AtMiss: Part;
    /// What a miss program must return.
    type FromMiss: Part;
}

/// A field of a payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// The name.
    pub name: &'static str,
    /// Its first word.
    pub at: usize,
    /// Words.
    pub count: usize,
}

/// Some of the fields of a payload: those that one party reads or writes.
///
/// # Safety
/// `load` and `store` touch the words of `FIELDS` and no others, and of those the first 32 are in `MASK`.
pub unsafe trait Part: Copy {
    /// How its payload travels.
    type Transport: Transport;
    /// The part's fields: indices into [`Payload::FIELDS`].
    const FIELDS: &'static [usize];
    /// Bit `i` is set if the part holds payload word `i`.
    const MASK: u32;
    /// Takes the part's fields out of the payload's words.
    ///
    /// # Safety
    /// Each field of the part was stored in these words.
    unsafe fn load(words: &[u32]) -> Self;
    /// Puts the part's fields into the payload's words.
    fn store(self, words: &mut [u32]);
}

// SAFETY: no words.
unsafe impl Part for () {
    type Transport = Registers;
    const FIELDS: &'static [usize] = &[];
    const MASK: u32 = 0;
    #[inline(always)]
    unsafe fn load(_: &[u32]) {}
    #[inline(always)]
    fn store(self, _: &mut [u32]) {}
}

/// Leads from a part, such as `RadianceAtMiss`, to its payload, `Radiance`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a part of a payload",
    label = "expected a struct such as `RadianceAtClosestHit` or `RadianceFromClosestHit`",
    note = "a program takes and returns the structs that `#[derive(Payload)]` makes, by value, not the payload itself; a record is taken by reference, `&{Self}`"
)]
pub trait PartOf {
    /// The payload the part belongs to.
    type Payload: Payload;
}

/// The mask of `count` words that begin at word `at`. Used by the derive.
#[doc(hidden)]
pub const fn word_mask(at: usize, count: usize) -> u32 {
    // A payload of more than 32 words is an error of its own, or in memory, where it needs no mask.
    if count == 0 || at + count > 32 { 0 } else { (u32::MAX >> (32 - count as u32)) << at as u32 }
}

/// A party that has nothing to write, so that a hit group or ray type may do without its program.
///
/// # Safety
/// As the name says: otherwise words that nobody wrote are read.
#[diagnostic::on_unimplemented(
    message = "a program is missing: its payload has fields that only it writes (`{Self}`)",
    label = "no program returns `{Self}`",
    note = "name a program in `pipeline!` for this ray type, or give the fields another writer in `#[payload(write(..))]`"
)]
pub unsafe trait NothingToWrite {}
// SAFETY: the part without fields.
unsafe impl NothingToWrite for () {}

/// The caller reads only what it writes itself, so that the closest-hit program may be left out for a ray.
///
/// # Safety
/// As the name says: otherwise words that nobody wrote are read.
#[diagnostic::on_unimplemented(
    message = "rays of payload `{Self}` need their closest-hit program",
    label = "on a hit, the caller would read fields of `{Self}` that nobody wrote",
    note = "let the caller give those fields a value, `write(caller, ..)`; or call `trace`, which runs the closest-hit program"
)]
pub unsafe trait TracedWithoutClosestHit: Payload {}
