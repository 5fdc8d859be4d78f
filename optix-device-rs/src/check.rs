//! What the macros' output is checked against: traits whose only purpose is the message they fail with.
//!
//! Not for users; the macros refer to these by path.

use crate::payload::{Part, Payload};
use crate::primitive::{Attributes, Primitive, Reported};
use crate::program::{AccelHandle, InstanceHandle};
use crate::ray::{RayFlags, Traversable};
use core::fmt::Debug;
use core::marker::PhantomData;
use glam::Vec3;

// ---- Views ---------------------------------------------------------------------------------------------------------

#[cfg(target_arch = "nvptx64")]
pub use crate::data::DeviceData as View;
#[cfg(not(target_arch = "nvptx64"))]
pub use crate::host::View;

/// A field that is taken for a view is one.
pub const fn view<V: View>() {}

/// A struct that crosses is copied.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is copied when it travels, so it must be `Copy`",
    label = "not `Copy`",
    note = "write `#[derive(Clone, Copy)]` above the struct"
)]
pub trait Copied {}
impl<T: Copy> Copied for T {}

/// Asserts it.
pub const fn copied<T: Copied>() {}

/// What a program names as its record is one.
pub const fn record<T: crate::record::SbtRecord>() {}

// ---- Payload parts -------------------------------------------------------------------------------------------------

macro_rules! received {
    ($($name:ident: $part:ident, $message:literal, $label:literal, $note:literal;)*) => {$(
        /// The part is what a program of one kind receives of payload `R`. Made by `#[derive(Payload)]`.
        #[diagnostic::on_unimplemented(message = $message, label = $label, note = $note)]
        pub trait $name<R: Payload> {
            /// The identity, as far as types can't say so.
            fn take(part: R::$part) -> Self;
        }
    )*};
}
received! {
    ReceivedByClosestHit: AtClosestHit,
        "a closest-hit program reads nothing of this payload, so there is no `{Self}` to receive",
        "no field of the payload is read by `closesthit`",
        "add `closesthit` to `read(..)` of the fields that the program reads, `#[payload(write(caller, ..), read(closesthit, ..))]`; or take this argument out";
    ReceivedByMiss: AtMiss,
        "a miss program reads nothing of this payload, so there is no `{Self}` to receive",
        "no field of the payload is read by `miss`",
        "add `miss` to `read(..)` of the fields that the program reads, `#[payload(write(caller, ..), read(miss, ..))]`; or take this argument out";
    ReceivedByAnyHit: AtAnyHit,
        "an any-hit program reads nothing of this payload, so there is no `{Self}` to receive",
        "no field of the payload is read by `anyhit`",
        "add `anyhit` to `read(..)` of the fields that the program reads, `#[payload(write(caller, ..), read(anyhit, ..))]`; or take this argument out";
    ReceivedByIntersection: AtIntersection,
        "an intersection program reads nothing of this payload, so there is no `{Self}` to receive",
        "no field of the payload is read by `intersection`",
        "add `intersection` to `read(..)` of the fields that the program reads, `#[payload(write(caller, ..), read(intersection, ..))]`; or take this argument out";
}

macro_rules! returned {
    ($($name:ident: $part:ident, $message:literal, $label:literal, $note:literal;)*) => {$(
        /// The part is what a program of one kind returns of payload `R`. Made by `#[derive(Payload)]`.
        #[diagnostic::on_unimplemented(message = $message, label = $label, note = $note)]
        pub trait $name<R: Payload> {
            /// The identity, as far as types can't say so.
            fn give(self) -> R::$part;
        }
    )*};
}
returned! {
    ReturnedByClosestHit: FromClosestHit,
        "a closest-hit program of payload `{R}` does not return `{Self}`",
        "not what a closest-hit program writes of `{R}`",
        "it returns a `{R}FromClosestHit` if fields of `{R}` say `#[payload(write(closesthit, ..))]`, and nothing if none does";
    ReturnedByMiss: FromMiss,
        "a miss program of payload `{R}` does not return `{Self}`",
        "not what a miss program writes of `{R}`",
        "it returns a `{R}FromMiss` if fields of `{R}` say `#[payload(write(miss, ..))]`, and nothing if none does";
    ReturnedByAnyHit: FromAnyHit,
        "an any-hit program of payload `{R}` does not return `{Self}`",
        "not what an any-hit program writes of `{R}`",
        "it returns a `(Decision, {R}FromAnyHit)` if fields of `{R}` say `#[payload(write(anyhit, ..))]`, and the `Decision` alone if none does";
    ReturnedByIntersection: FromIntersection,
        "an intersection program of payload `{R}` does not return `{Self}`",
        "not what an intersection program writes of `{R}`",
        "it returns a `{R}FromIntersection` if fields of `{R}` say `#[payload(write(intersection, ..))]`, and nothing if none does";
}

/// A place is of this type, and not only of one that leads to it by `Deref`: what a user's type is called may mean another type
/// where a macro writes it again.
#[inline(always)]
pub const fn same<T>(_: *const T, _: PhantomData<T>) {}

/// The codes of an exception are different.
#[track_caller]
pub const fn codes(codes: &[i128]) {
    let mut i = 0;
    while i < codes.len() {
        let mut k = 0;
        while k < i {
            assert!(codes[i] != codes[k], "two variants of an exception have one code: say other numbers");
            k += 1;
        }
        i += 1;
    }
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

/// A field as `Debug` shows it: fields of a payload need not have `Debug`. Method lookup prefers [`ShowValue`], which
/// takes one `&` less, where there is one.
pub struct Show<'a, T>(pub &'a T);

/// With `Debug`.
pub trait ShowValue {
    /// The value.
    fn shown(&self) -> &dyn Debug;
}
impl<T: Debug> ShowValue for &Show<'_, T> {
    fn shown(&self) -> &dyn Debug {
        self.0
    }
}

/// Without.
pub trait ShowName {
    /// In the value's place.
    fn shown(&self) -> &dyn Debug;
}
impl<T> ShowName for Show<'_, T> {
    fn shown(&self) -> &dyn Debug {
        struct NotShown;
        impl Debug for NotShown {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str("..")
            }
        }
        &NotShown
    }
}

// ---- Device functions ----------------------------------------------------------------------------------------------

// What the methods of the contexts ask for that are no device functions of theirs: each trait exists for the message, which says
// where the function belongs. Which contexts these are: `intrinsics/table.rs`.

/// The context of a program that may trace rays.
#[diagnostic::on_unimplemented(
    message = "rays can't be traced from `{Self}`",
    label = "only ray-generation, closest-hit and miss programs and continuation callables trace rays (guide 13)",
    note = "leave what is needed in the payload, and trace from the closest-hit program"
)]
pub trait MayTrace {}

/// The context of a callable that may trace rays.
#[diagnostic::on_unimplemented(
    message = "a direct callable traces no rays, so there is no `trace` in `{Self}`",
    label = "neither a direct callable nor what it calls may trace (guide 15.1)",
    note = "make it a continuation callable: `#[continuation_callable]`, with `&ContinuationCallable<..>` as context and `Callable<F, Continuation>` as reference"
)]
pub trait IsContinuationCallable {}

/// The context of a program that may throw.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't throw: it runs because something was thrown",
    label = "every kind of program but exception programs may throw (guide 13.14)",
    note = "the launch index has ended already: write what is to be known to a `SliceMut` of the launch parameters"
)]
pub trait MayThrow {}
/// The context of a program that is told of an exception.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not told of exceptions",
    label = "only the pipeline's exception program is told what was raised, and where (guide 13.14)",
    note = "write a program with `#[exception]`, and name it in `pipeline!`: `exception: report`"
)]
pub trait HasException {}

/// The context of a program that runs for a ray.
#[diagnostic::on_unimplemented(
    message = "no ray is on its way in `{Self}`",
    label = "only intersection, any-hit, closest-hit and miss programs ask about their ray (guide 13.5)",
    note = "a ray-generation program makes its rays itself: use the `Ray` that it passes to `trace`",
    note = "a callable knows of a ray, a primitive or a hit only what its caller passes: give it an argument more"
)]
pub trait HasRay {}

/// The context of a program that runs for a primitive.
#[diagnostic::on_unimplemented(
    message = "there is no primitive in `{Self}`",
    label = "only intersection, any-hit and closest-hit programs ask about a primitive and its instance (guide 13.7, 13.11)",
    note = "what the caller of `trace` needs to know about a hit, the closest-hit program returns in the payload"
)]
pub trait HasPrimitive {}

/// The context of a program that has its ray in object space.
#[diagnostic::on_unimplemented(
    message = "the ray is not known in object space in `{Self}`",
    label = "only intersection and any-hit programs have the ray in object space (guide 13.5)",
    note = "in a closest-hit program map it: `hit.world_to_object().point(hit.world_ray_origin())`, `.vector(..)` for the direction"
)]
pub trait HasObjectRay {}

/// The context of a program that runs for a hit.
#[diagnostic::on_unimplemented(
    message = "there is no hit in `{Self}`",
    label = "only any-hit and closest-hit programs ask about a hit, its kind and its attributes (guide 13.4, 13.7, 13.9)",
    note = "an intersection program says what a hit carries: `isect.report(t, kind, attributes)`; the caller of `trace` learns of a hit through the payload"
)]
pub trait HasHit {}

/// The context of a program that may report hits.
#[diagnostic::on_unimplemented(
    message = "hits can't be reported from `{Self}`",
    label = "only intersection programs report hits (guide 13.4)",
    note = "write an `#[intersection]` program for the material, and put the material on `Custom` geometry"
)]
pub trait MayReport {}

/// The context of a program that ends by a call, of which there is none.
#[diagnostic::on_unimplemented(
    message = "what happens to a hit is not decided by a call",
    label = "an any-hit program returns its decision: `Decision::Ignore`, `Decision::Terminate` or `Decision::Accept`",
    note = "so what it writes to the payload counts, whatever it decides (guide 13.13)"
)]
pub trait DecidesByCall {}

/// A ray that says itself whether its closest-hit program runs, of which there is none.
#[diagnostic::on_unimplemented(
    message = "whether closest-hit programs run is not a flag of a ray",
    label = "what the caller may read of the payload depends on it, so it is said by the call",
    note = "trace the ray with `trace_without_closesthit`, for payloads whose caller reads only what it writes itself"
)]
pub trait ClosestHitByFlag {}
impl RayFlags {
    #[doc(hidden)]
    pub fn disable_closesthit(self) -> Self
    where
        for<'never> Self: ClosestHitByFlag, // with a lifetime, since rustc rejects a plain bound that never holds
    {
        unreachable!()
    }
}

/// A handle through which programs read what is in a structure, of which there is none.
#[diagnostic::on_unimplemented(
    message = "what is in a structure is not read through `{Self}`",
    label = "it tells which structure it is, and not what is in it",
    note = "read an `Instances` or a `TriangleVertices` of the launch parameters or of a record: on the host `build_with_instances()` and `build_with_triangles()` give what to put there (guide 13.9, 13.12)"
)]
pub trait Readable {}
impl Traversable {
    #[doc(hidden)]
    pub fn get<C>(self, _: &C, _: u32) -> InstanceHandle<'static>
    where
        for<'never> Self: Readable, // as above
    {
        unreachable!()
    }
}
impl AccelHandle<'_> {
    #[doc(hidden)]
    pub fn get<C>(self, _: &C, _: u32, _: u32) -> [Vec3; 3]
    where
        Self: Readable,
    {
        unreachable!()
    }
}

/// A view that programs write through.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is read-only",
    label = "programs only read this view",
    note = "declare the field as `SliceMut<..>`; its host counterpart is the same"
)]
pub trait Writable {}
impl<T> crate::view::Slice<T> {
    #[doc(hidden)]
    pub fn set(self, _: u32, _: T)
    where
        Self: Writable,
    {
        unreachable!()
    }
}

/// A view whose elements brackets name, of which there is none: a place in it would be a reference to memory that other launch
/// indices write.
#[diagnostic::on_unimplemented(
    message = "elements of `{Self}` are not named by brackets",
    label = "write `.get(i)` to read an element, and `.set(i, value)` to write one where the view is a `SliceMut` or `SliceMut2d`",
    note = "the index of a `Slice` or `SliceMut` is a `u32`, that of a `SliceMut2d` a `UVec2`"
)]
pub trait NamedByBrackets {}

macro_rules! not_named_by_brackets {
    ($($view:ident),*) => {$(
        #[doc(hidden)]
        impl<T, I> core::ops::Index<I> for crate::view::$view<T>
        where
            Self: NamedByBrackets,
        {
            type Output = T;
            fn index(&self, _: I) -> &T {
                unreachable!()
            }
        }
        #[doc(hidden)]
        impl<T, I> core::ops::IndexMut<I> for crate::view::$view<T>
        where
            Self: NamedByBrackets,
        {
            fn index_mut(&mut self, _: I) -> &mut T {
                unreachable!()
            }
        }
    )*};
}
not_named_by_brackets!(Slice, SliceMut, SliceMut2d);

/// What a program with a mistake in it reports, and what a hit group without an intersection program does.
#[derive(Clone, Copy)]
pub enum NoHits {}
impl Attributes for NoHits {
    const NAME: &'static str = "NoHits";
    const WORDS: usize = 0;
    unsafe fn load(_: &[u32]) -> Self {
        unreachable!("nobody reports it")
    }
    fn store(self, _: &mut [u32]) {
        match self {}
    }
}
// SAFETY: there is none of them.
unsafe impl Reported for NoHits {}

// ---- Pipelines -----------------------------------------------------------------------------------------------------

/// All intersection programs of a hit group report the same attributes.
///
/// # Safety
/// Both types are one: the words of one are read as the other.
#[diagnostic::on_unimplemented(
    message = "the intersection programs of one hit group report different hits: `{Self}` and `{Other}`",
    label = "its programs report `{Self}` for this ray type and `{Other}` for the first one",
    note = "hits of one geometry carry the same attributes for every ray type: use one intersection program, or one attribute type"
)]
pub unsafe trait SameHits<Other> {}
// SAFETY: one type.
unsafe impl<T> SameHits<T> for T {}

/// A program of a hit group says where rays meet its primitives if they are custom ones, and none does if they are built-in:
/// whether there is one for a ray type is `given`. The names are as `pipeline!` has them.
#[track_caller]
pub const fn intersection_program<G: Primitive>(given: bool, record: &str, geometry: &str, ray: &str) {
    if given == G::HAS_INTERSECTION_PROGRAM {
        return;
    }
    let text = EMPTY;
    let text = if given {
        text.push("`")
            .push(record)
            .push(" on ")
            .push(geometry)
            .push("` can't have an intersection program: OptiX itself finds where rays meet these primitives; remove it, or write `")
            .push(record)
            .push(" on Custom`")
    } else {
        text.push("hit group `")
            .push(record)
            .push(" on ")
            .push(geometry)
            .push("` has no intersection program for ray type `")
            .push(ray)
            .push("`, so `")
            .push(ray)
            .push("` rays could not see it: add `intersection: ..`")
    };
    panic!("{}", text.as_str());
}

/// A program that fits every place of a pipeline: what stands for one with a mistake that has its own message.
pub type FitsEverywhere = [(); 0];

/// Two attribute types are one.
pub const fn same_hits<A: SameHits<B>, B>() {}
/// No program is missing that would have to write.
pub const fn nothing_to_write<T: crate::payload::NothingToWrite>() {}

// ---- Layout --------------------------------------------------------------------------------------------------------

// Owners of arrays of views: textures of a material, say.
#[cfg(not(target_arch = "nvptx64"))]
// SAFETY: each element keeps its own.
unsafe impl<V: crate::host::View, const N: usize> crate::host::View for [V; N]
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
#[track_caller]
pub const fn payload_words(name: &str, words: usize) {
    if words > crate::limits::MAX_PAYLOAD_WORDS {
        let text = EMPTY
            .push("payload `")
            .push(name)
            .push("` takes ")
            .number(words)
            .push(" words, but a ray has registers for ")
            .number(crate::limits::MAX_PAYLOAD_WORDS)
            .push(": put `#[payload(transport = pointer)]` on the struct, to keep them in the caller's memory; or take fields out");
        panic!("{}", text.as_str());
    }
}

/// Attributes have 8 words at most (guide 13.4).
#[track_caller]
pub const fn attribute_words(name: &str, words: usize) {
    if words > crate::limits::MAX_ATTRIBUTE_WORDS {
        let text = EMPTY
            .push("attributes `")
            .push(name)
            .push("` take ")
            .number(words)
            .push(" words, but a hit has registers for ")
            .number(crate::limits::MAX_ATTRIBUTE_WORDS)
            .push(": report less and compute the rest in the closest-hit program from the record");
        panic!("{}", text.as_str());
    }
}

/// The type by which `pipeline!` knows a program: whether it was made by an attribute. rustc prefers what stands for functions
/// without one, which has the constant itself.
pub struct Program<T>(PhantomData<T>);
impl<const N: usize> Program<[(); N]> {
    /// It was not.
    pub const HAS_ATTRIBUTE: bool = false;
}
/// All others.
pub trait HasAttribute {
    /// It was.
    const HAS_ATTRIBUTE: bool = true;
}
impl<T> HasAttribute for Program<T> {}

/// What `pipeline!` names is a function with an attribute, which made the type of its name.
#[track_caller]
pub const fn is_program(has_attribute: bool, is_function: bool, name: &str, attribute: &str) {
    if has_attribute {
        return;
    }
    let text = if is_function {
        EMPTY
            .push("`")
            .push(name)
            .push("` is a function without an attribute, so it is not a program: put `#[")
            .push(attribute)
            .push("]` above it")
    } else {
        EMPTY
            .push("there is no function `")
            .push(name)
            .push("` here: name a function with `#[")
            .push(attribute)
            .push("]`, one of another module by its path, such as `crate::shaders::")
            .push(name)
            .push("`, or after `use`")
    };
    panic!("{}", text.as_str());
}

/// A call passes and returns 32 words at most.
#[track_caller]
pub const fn callable<F: crate::callable::Signature>(name: &str) {
    let arguments = <F::Arguments as crate::words::Words>::COUNT;
    let result = <F::Result as crate::words::Words>::COUNT;
    let most = crate::limits::MAX_PAYLOAD_WORDS;
    if arguments > most || result > most {
        let (what, words) = if arguments > most { ("arguments", arguments) } else { ("result", result) };
        let text = EMPTY
            .push("the ")
            .push(what)
            .push(" of callable `")
            .push(name)
            .push("` take ")
            .number(words)
            .push(" words, but a call has registers for ")
            .number(most)
            .push(": keep what does not change in its record, or the rest in a `SliceMut` of the launch parameters");
        panic!("{}", text.as_str());
    }
}

/// A user exception has a code of 30 bits (guide 13.14) and [`MAX_DETAILS`](crate::exception::MAX_DETAILS) words of details at most.
#[track_caller]
pub const fn exception(name: &str, variant: &str, code: i128, words: usize) {
    let text = EMPTY.push("exception `").push(name).push("::").push(variant);
    if code < 0 || code >= crate::exception::MAX_CODE as i128 {
        let text = text.push(
            "` has a code that is not within 0 to 2^30 - 1: the others are OptiX's own; give it another discriminant",
        );
        panic!("{}", text.as_str());
    }
    if words > crate::exception::MAX_DETAILS {
        let text = text
            .push("` has ")
            .number(words)
            .push(" words of details, but an exception carries ")
            .number(crate::exception::MAX_DETAILS)
            .push(": keep the rest in a `SliceMut` of the launch parameters");
        panic!("{}", text.as_str());
    }
}

/// The larger of two.
pub const fn larger(a: usize, b: usize) -> usize {
    if a > b { a } else { b }
}

/// What crosses between host and device is aligned to 16 bytes at most.
#[track_caller]
pub const fn alignment(what: &str, name: &str, align: usize) {
    if align > 16 {
        let text = EMPTY
            .push(what)
            .push(" `")
            .push(name)
            .push("` is aligned to ")
            .number(align)
            .push(" bytes, but what crosses between host and device to 16 at most, as OptiX aligns records (guide 7.2): lower its `align(..)`");
        panic!("{}", text.as_str());
    }
}

/// A bound value has at least one byte (guide 6.5.1).
#[track_caller]
pub const fn bound_field(name: &str, field: &str, size: usize) {
    if size == 0 {
        let text = EMPTY
            .push("launch parameter `")
            .push(field)
            .push("` of `")
            .push(name)
            .push("` has no bytes to bind: take its `#[bound]` away");
        panic!("{}", text.as_str());
    }
}

/// An element has no padding: `fields` are each one's name, offset and size, in order.
#[track_caller]
pub const fn no_padding(name: &str, size: usize, fields: &[(&str, usize, usize)]) {
    let (mut i, mut end) = (0, 0);
    while i <= fields.len() {
        let next = if i < fields.len() { fields[i].1 } else { size };
        if next > end {
            let gap = next - end;
            let text = EMPTY.push("element `").push(name).push("` has a gap of ").number(gap);
            let text = text.push(if gap == 1 { " byte " } else { " bytes " });
            let text = if i == 0 {
                text.push("and no field") // a struct without fields, but with an alignment
            } else if i < fields.len() {
                text.push("between `").push(fields[i - 1].0).push("` and `").push(fields[i].0).push("`")
            } else {
                text.push("after `").push(fields[i - 1].0).push("`, its last field")
            };
            let text = text
                .push(", which a buffer can't hold: put a field there, such as `pad: [u8; ")
                .number(gap)
                .push(if i < fields.len() { "]`, or order the fields by falling alignment" } else { "]`" });
            panic!("{}", text.as_str());
        }
        if i < fields.len() {
            end = fields[i].1 + fields[i].2;
        }
        i += 1;
    }
}
