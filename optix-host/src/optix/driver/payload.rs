//! Payload types and the semantics of their words (guide 14).

use super::sys;
use crate::error::DriverError as Error;
use crate::limits::MAX_PAYLOAD_WORDS;

/// A payload: for each 32-bit word, up to 32, who reads and writes it (guide 14).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PayloadType {
    /// An entry for each word.
    pub semantics: Vec<PayloadSemantics>,
}

/// Who reads and writes a payload word: two bits for each party, joined with [`Self::with`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(transparent)]
pub struct PayloadSemantics(u32);

impl PayloadSemantics {
    /// The caller of the trace receives the value.
    pub const CALLER_READ: Self = Self(1 << 0);
    /// The caller of the trace supplies the value.
    pub const CALLER_WRITE: Self = Self(1 << 1);
    /// Closest-hit programs may get it.
    pub const CLOSESTHIT_READ: Self = Self(1 << 2);
    /// Closest-hit programs may set it.
    pub const CLOSESTHIT_WRITE: Self = Self(1 << 3);
    /// Miss programs may get it.
    pub const MISS_READ: Self = Self(1 << 4);
    /// Miss programs may set it.
    pub const MISS_WRITE: Self = Self(1 << 5);
    /// Any-hit programs may get it.
    pub const ANYHIT_READ: Self = Self(1 << 6);
    /// Any-hit programs may set it.
    pub const ANYHIT_WRITE: Self = Self(1 << 7);
    /// Intersection programs may get it.
    pub const INTERSECTION_READ: Self = Self(1 << 8);
    /// Intersection programs may set it.
    pub const INTERSECTION_WRITE: Self = Self(1 << 9);

    /// The semantics of these bits; `None` when a bit above bit 9 is set.
    pub fn from_bits(bits: u32) -> Option<Self> {
        (bits < 1 << 10).then_some(Self(bits))
    }

    /// The bits.
    pub fn bits(self) -> u32 {
        self.0
    }

    /// The union of both.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl PayloadType {
    pub(super) fn check(&self) -> Result<(), Error> {
        let (words, max) = (self.semantics.len(), MAX_PAYLOAD_WORDS);
        if words <= max {
            return Ok(());
        }
        let remedy = "move state behind a pointer that two payload words carry";
        Err(Error::invalid("a payload type", format!("{words} words, more than {max}"), remedy))
    }

    /// Points into `self`.
    pub(super) fn raw(&self) -> sys::OptixPayloadType {
        sys::OptixPayloadType {
            num_payload_values: self.semantics.len() as u32,
            // `PayloadSemantics` is transparent over `u32`.
            payload_semantics: self.semantics.as_ptr().cast(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn semantics_have_ten_bits() {
        let both = PayloadSemantics::CALLER_READ.with(PayloadSemantics::MISS_WRITE);
        assert_eq!(PayloadSemantics::from_bits(both.bits()), Some(both));
        assert_eq!(PayloadSemantics::from_bits(1 << 10), None);
    }
}
