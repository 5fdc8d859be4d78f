//! A pipeline as a type: what `pipeline!` declares, and what host and device read from it.

use crate::callable::{CallableKind, Signature};
use crate::exception::UserException;
use crate::layout::Crossing;
use crate::params::LaunchParams;
use crate::payload::Payload;
use crate::primitive::Primitive;
use crate::record::SbtRecord;

/// A pipeline: launch parameters, ray types, hit groups and programs under one name. Made by `pipeline!`.
///
/// # Safety
/// The description's entries run as what it lists them for, with the records and payloads it names; a host launches
/// whatever it says.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a pipeline",
    label = "expected a type that `pipeline!` declares"
)]
pub unsafe trait Pipeline: Sized + 'static {
    /// The launch parameters.
    type Params: LaunchParams;
    /// What its programs may throw; [`NoException`](crate::exception::NoException) if nothing.
    type Exception: UserException;
    /// How many ray types there are: the SBT stride of every trace call.
    const RAY_TYPES: u32;
    /// Of the launch parameters.
    #[doc(hidden)]
    const PARAMS_CROSSING: Crossing = Crossing::params::<Self::Params>();
    /// The types that cross between host and device in it.
    #[doc(hidden)]
    const CROSSINGS: &'static [Crossing];
    /// The launch parameters as a value, for the host.
    #[doc(hidden)]
    #[cfg(not(target_arch = "nvptx64"))]
    const PARAMS_DESCRIPTION: crate::host::ParamsDescription = crate::host::ParamsDescription::of::<Self::Params>();
    /// All of it as a value, for the host.
    #[cfg(not(target_arch = "nvptx64"))]
    const DESCRIPTION: crate::host::PipelineDescription;
}

/// The pipeline traces rays of type `R`; a ray type is named by its payload.
///
/// # Safety
/// The number is that of the ray type in the pipeline's description: a trace call with another reads foreign records.
#[diagnostic::on_unimplemented(
    message = "pipeline `{Self}` has no ray type `{R}`",
    label = "`{R}` is not among the `rays` of `{Self}`",
    note = "add `{R} {{ miss: .. }}` to `rays` in `pipeline!`, or bound a generic program by `P: HasRay<{R}>`"
)]
pub unsafe trait HasRay<R: Payload>: Pipeline {
    /// The ray type's number: SBT offset of its hit-group records and index of its miss record.
    const INDEX: u32;
    /// `OptixPayloadTypeID` of its payload in the pipeline's modules.
    const PAYLOAD_TYPE: u32 = 1 << Self::INDEX;
    /// The record of its miss program.
    type MissRecord: SbtRecord;
}

/// The pipeline has a hit group for material `Rec` on geometry `G`; a material is named by its record.
///
/// # Safety
/// The number is that of the hit group in the pipeline's description, whose record is `Rec`.
#[diagnostic::on_unimplemented(
    message = "pipeline `{Self}` has no hit group for material `{Rec}` on `{G}`",
    label = "`{Rec} on {G}` is not among the `hitgroups` of `{Self}`"
)]
pub unsafe trait HasHitGroup<Rec: SbtRecord, G: Primitive>: Pipeline {
    /// The hit group's number in the pipeline's description.
    const INDEX: u32;
}

/// The pipeline has the ray-generation program that type `Prog` stands for.
///
/// # Safety
/// The number is that of the program in the pipeline's description, whose record is `Record`.
#[diagnostic::on_unimplemented(
    message = "`{Prog}` is not a ray-generation program of pipeline `{Self}`",
    label = "not among the `raygen` programs of `{Self}`"
)]
pub unsafe trait HasRayGen<Prog>: Pipeline {
    /// The program's number in the pipeline's description.
    const INDEX: u32;
    /// Its record.
    type Record: SbtRecord;
}

/// The pipeline has the callable that type `Prog` stands for.
///
/// # Safety
/// The number is that of the program in the pipeline's description, with this record, signature and kind.
#[diagnostic::on_unimplemented(
    message = "`{Prog}` is not a callable of pipeline `{Self}`",
    label = "not among the `direct_callables` and `continuation_callables` of `{Self}`"
)]
pub unsafe trait HasCallable<Prog>: Pipeline {
    /// The program's number in the pipeline's description.
    const INDEX: u32;
    /// Its record.
    type Record: SbtRecord;
    /// What it takes and returns.
    type Signature: Signature;
    /// Direct or continuation.
    type Kind: CallableKind;
}

/// The pipeline has an exception program.
///
/// # Safety
/// The description's exception program has this record.
#[diagnostic::on_unimplemented(
    message = "pipeline `{Self}` has no exception program",
    label = "it has no record to fill in",
    note = "add `exception: program` in `pipeline!`"
)]
pub unsafe trait HasException: Pipeline {
    /// Its record.
    type Record: SbtRecord;
}

/// Programs of the pipeline may throw `E`.
///
/// # Safety
/// The description says so, and [`Pipeline::Exception`] is `E`.
#[diagnostic::on_unimplemented(
    message = "programs of pipeline `{Self}` can't throw `{E}`",
    label = "`{Self}` does not say that its programs throw `{E}`",
    note = "add `throws: {E}` in `pipeline!`, or bound a generic program by `P: Throws<{E}>`; without it OptiX would not see the exception (guide 13.14)"
)]
pub unsafe trait Throws<E: UserException>: Pipeline<Exception = E> {}
