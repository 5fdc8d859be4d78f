//! Ray payloads with typed access per program (guide 14; checklist group H).
//!
//! `#[derive(Payload)]` on a struct `Radiance` makes, for each party that takes part, the struct it receives and the
//! struct it must return: `RadianceFromCaller`, `RadianceAtClosestHit`, `RadianceFromClosestHit`, `RadianceAtMiss`,
//! `RadianceFromMiss`, `RadianceAtAnyHit`, `RadianceFromAnyHit`, `RadianceAtIntersection`, `RadianceFromIntersection` and
//! `RadianceAtCaller`, which `trace` returns. A party with no field has `()` in place of the struct.

use crate::words::WordBuffer;

/// A payload type. Implemented by `#[derive(Payload)]` only.
///
/// # Safety
/// There are at most 32 words, one entry of `SEMANTICS` each, and a part touches only words that its party may.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a payload",
    label = "not a payload type",
    note = "a ray type is named by its payload: a struct with `#[derive(Payload)]`"
)]
pub unsafe trait Payload: Sized + 'static {
    /// The name, for messages.
    const NAME: &'static str;
    /// Words in registers, 0 to 32.
    const WORDS: usize;
    /// One word of `OptixPayloadSemantics` bits per payload word.
    const SEMANTICS: &'static [u32];

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

/// Some of the fields of a payload: those that one party reads or writes.
///
/// # Safety
/// `load` and `store` touch the words of `MASK` and no others.
pub unsafe trait Part: Copy {
    /// Bit `i` is set if the part holds payload word `i`.
    const MASK: u32;
    /// Takes the part's fields out of the payload's words.
    fn load(words: &WordBuffer) -> Self;
    /// Puts the part's fields into the payload's words.
    fn store(self, words: &mut WordBuffer);
}

// SAFETY: no words.
unsafe impl Part for () {
    const MASK: u32 = 0;
    #[inline(always)]
    fn load(_: &WordBuffer) {}
    #[inline(always)]
    fn store(self, _: &mut WordBuffer) {}
}

/// Leads from a part, such as `RadianceAtMiss`, to its payload, `Radiance`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a part of a payload",
    label = "expected a struct such as `RadianceAtClosestHit` or `RadianceFromClosestHit`",
    note = "a program takes and returns the structs that `#[derive(Payload)]` makes, by value, not the payload itself; a record is taken by reference, `&{Self}`"
)]
pub trait PartOf: Part {
    /// The payload the part belongs to.
    type Payload: Payload;
}

/// The mask of `count` words that begin at word `at`. Used by the derive.
#[doc(hidden)]
pub const fn word_mask(at: usize, count: usize) -> u32 {
    // A payload of more than 32 words is an error of its own; the mask must not be a second one.
    if count == 0 || at + count > 32 { 0 } else { (u32::MAX >> (32 - count as u32)) << at as u32 }
}

/// `OptixPayloadSemantics` bits: two per party, read is the low one (guide 14).
pub mod semantics {
    /// The caller of trace receives the value.
    pub const CALLER_READ: u32 = 1;
    /// The caller of trace supplies the value.
    pub const CALLER_WRITE: u32 = 2;
    /// Closest-hit programs may get the value.
    pub const CLOSESTHIT_READ: u32 = 4;
    /// Closest-hit programs set the value.
    pub const CLOSESTHIT_WRITE: u32 = 8;
    /// Miss programs may get the value.
    pub const MISS_READ: u32 = 16;
    /// Miss programs set the value.
    pub const MISS_WRITE: u32 = 32;
    /// Any-hit programs may get the value.
    pub const ANYHIT_READ: u32 = 64;
    /// Any-hit programs set the value.
    pub const ANYHIT_WRITE: u32 = 128;
    /// Intersection programs may get the value.
    pub const INTERSECTION_READ: u32 = 256;
    /// Intersection programs set the value.
    pub const INTERSECTION_WRITE: u32 = 512;
}

/// A party that has nothing to write, so that a hit group or ray type may do without its program.
#[diagnostic::on_unimplemented(
    message = "a program is missing: its payload has fields that only it writes (`{Self}`)",
    label = "no program returns `{Self}`",
    note = "name a program in `pipeline!` for this ray type, or give the fields another writer in `#[payload(write(..))]`"
)]
pub trait NothingToWrite {}
impl NothingToWrite for () {}
