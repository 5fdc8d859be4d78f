//! What the macros' output is checked against: traits whose only purpose is the message they fail with.
//!
//! Not for users; the macros refer to these by path.

use crate::payload::{Part, Payload};
use crate::ray::{Ray, Traversable};

// ---- Payload parts -------------------------------------------------------------------------------------------------

macro_rules! received {
    ($($name:ident: $part:ident, $message:literal, $label:literal;)*) => {$(
        /// The part is what a program of one kind receives of payload `R`. Made by `#[derive(Payload)]`.
        #[diagnostic::on_unimplemented(
            message = $message,
            label = $label,
            note = "a program takes its part of the payload by value, and a record by reference: `(context, record: &Record, ray: Part)`"
        )]
        pub trait $name<R: Payload>: Part {
            /// The identity, as far as types can't say so.
            fn take(part: R::$part) -> Self;
        }
    )*};
}
received! {
    ReceivedByClosestHit: AtClosestHit, "a closest-hit program does not receive `{Self}`", "expected `{R}AtClosestHit`";
    ReceivedByMiss: AtMiss, "a miss program does not receive `{Self}`", "expected `{R}AtMiss`";
    ReceivedByAnyHit: AtAnyHit, "an any-hit program does not receive `{Self}`", "expected `{R}AtAnyHit`";
    ReceivedByIntersection: AtIntersection, "an intersection program does not receive `{Self}`", "expected `{R}AtIntersection`";
}

macro_rules! returned {
    ($($name:ident: $part:ident, $message:literal, $label:literal;)*) => {$(
        /// The part is what a program of one kind returns of payload `R`. Made by `#[derive(Payload)]`.
        #[diagnostic::on_unimplemented(message = $message, label = $label)]
        pub trait $name<R: Payload>: Part {
            /// The identity, as far as types can't say so.
            fn give(self) -> R::$part;
        }
    )*};
}
returned! {
    ReturnedByClosestHit: FromClosestHit, "a closest-hit program of payload `{R}` does not return `{Self}`", "expected `{R}FromClosestHit`";
    ReturnedByMiss: FromMiss, "a miss program of payload `{R}` does not return `{Self}`", "expected `{R}FromMiss`";
    ReturnedByAnyHit: FromAnyHit, "an any-hit program of payload `{R}` does not return `{Self}`", "expected `{R}FromAnyHit`";
    ReturnedByIntersection: FromIntersection, "an intersection program of payload `{R}` does not return `{Self}`", "expected `{R}FromIntersection`";
}

/// What a program without a payload in its result leaves behind.
#[diagnostic::on_unimplemented(
    message = "a program does not return `{Self}`, which its payload says it writes",
    label = "this program must return `{Self}`",
    note = "return it: `-> {Self}`, for an any-hit program `-> (Decision, {Self})`; or take the party out of `write(..)` in the payload"
)]
pub trait MayReturnNothing: Part {
    /// The empty part.
    fn nothing() -> Self;
}
impl MayReturnNothing for () {
    #[inline(always)]
    fn nothing() -> Self {}
}

// ---- Programs ------------------------------------------------------------------------------------------------------

/// The context of a program that may trace rays.
#[diagnostic::on_unimplemented(
    message = "rays can't be traced from `{Self}`",
    label = "only ray-generation, closest-hit and miss programs trace rays (guide 13)",
    note = "leave what is needed in the payload, and trace from the closest-hit program"
)]
pub trait MayTrace {}

macro_rules! may_not_trace {
    ($($context:ident)*) => {$(
        impl<P, A> crate::program::$context<P, A> {
            /// Not allowed here; it exists for the message.
            #[doc(hidden)]
            pub fn trace<R: Payload>(&self, _: Traversable, _: Ray, _: R::FromCaller) -> R::AtCaller
            where
                Self: MayTrace,
            {
                unreachable!()
            }
        }
    )*};
}
may_not_trace!(AnyHit Intersection);

// ---- Pipelines -----------------------------------------------------------------------------------------------------

/// All intersection programs of a hit group report the same attributes.
#[diagnostic::on_unimplemented(
    message = "the intersection programs of one hit group report different hits: `{Self}` and `{Other}`",
    label = "its programs report `{Self}` for this ray type and `{Other}` for the first one",
    note = "hits of one geometry carry the same attributes for every ray type: use one intersection program, or one attribute type"
)]
pub trait SameHits<Other> {}
impl<T> SameHits<T> for T {}

/// Two attribute types are one.
pub const fn same_hits<A: SameHits<B>, B>() {}
/// No program is missing that would have to write.
pub const fn nothing_to_write<T: crate::payload::NothingToWrite>() {}

// ---- Layout --------------------------------------------------------------------------------------------------------

// Owners of arrays of views: textures of a material, say.
#[cfg(not(target_arch = "nvptx64"))]
impl<V: crate::host::View, const N: usize> crate::host::View for [V; N]
where
    [V; N]: crate::data::DeviceData,
{
    type Owner = [V::Owner; N];
    fn of(owner: &Self::Owner, keep: &mut crate::host::KeepAlive) -> Self {
        core::array::from_fn(|i| V::of(&owner[i], keep))
    }
}

/// Text that a const panic can show: pieces and numbers.
struct Text {
    bytes: [u8; 512],
    len: usize,
}

impl Text {
    const fn push(mut self, text: &str) -> Self {
        let text = text.as_bytes();
        let mut i = 0;
        while i < text.len() && self.len < self.bytes.len() {
            self.bytes[self.len] = text[i];
            self.len += 1;
            i += 1;
        }
        self
    }

    const fn number(self, number: usize) -> Self {
        let mut digits = [0; 20];
        let (mut at, mut rest) = (digits.len(), number);
        loop {
            at -= 1;
            digits[at] = b'0' + (rest % 10) as u8;
            rest /= 10;
            if rest == 0 {
                break;
            }
        }
        match core::str::from_utf8(digits.split_at(at).1) {
            Ok(digits) => self.push(digits),
            Err(_) => self,
        }
    }

    const fn as_str(&self) -> &str {
        match core::str::from_utf8(self.bytes.split_at(self.len).0) {
            Ok(text) => text,
            Err(_) => "a compile-time check failed",
        }
    }
}

const EMPTY: Text = Text { bytes: [0; 512], len: 0 };

/// A payload has 32 words at most (guide 14).
pub const fn payload_words(name: &str, words: usize) {
    if words > crate::words::MAX_PAYLOAD_WORDS {
        let text = EMPTY
            .push("payload `")
            .push(name)
            .push("` takes ")
            .number(words)
            .push(" words, but a ray has registers for ")
            .number(crate::words::MAX_PAYLOAD_WORDS)
            .push(": take fields out, or keep them in a `SliceMut` of the launch parameters");
        panic!("{}", text.as_str());
    }
}

/// Attributes have 8 words at most (guide 13.4).
pub const fn attribute_words(name: &str, words: usize) {
    if words > crate::words::MAX_ATTRIBUTE_WORDS {
        let text = EMPTY
            .push("attributes `")
            .push(name)
            .push("` take ")
            .number(words)
            .push(" words, but a hit has registers for ")
            .number(crate::words::MAX_ATTRIBUTE_WORDS)
            .push(": report less and compute the rest in the closest-hit program from the record");
        panic!("{}", text.as_str());
    }
}

/// A record's data is aligned to 16 bytes at most (guide 7.2).
pub const fn record_align(name: &str, align: usize) {
    if align > 16 {
        let text = EMPTY
            .push("record `")
            .push(name)
            .push("` is aligned to ")
            .number(align)
            .push(" bytes, but OptiX aligns records to 16: lower its `align(..)`");
        panic!("{}", text.as_str());
    }
}

/// An element has no padding.
pub const fn no_padding(name: &str, size: usize, fields: usize) {
    if size != fields {
        let text = EMPTY
            .push("element `")
            .push(name)
            .push("` has ")
            .number(size - fields)
            .push(" bytes of padding, which a buffer can't hold: order fields by falling alignment, or fill the gap with a field such as `pad: u32`");
        panic!("{}", text.as_str());
    }
}
