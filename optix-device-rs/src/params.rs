//! Launch parameters (guide 6.5, 10).

use crate::data::DeviceData;
use crate::intrinsics::ParamsBase;

/// A launch-parameter struct; made by `#[launch_params]`.
///
/// A program reads field by field through the generated view (`rg.params().world()`), which on the device is a load
/// from constant memory at a fixed offset: the form that OptiX can replace by a constant (guide 6.5.1).
///
/// # Safety
/// `SYMBOL` is declared with the struct's size, and `FIELDS` are the struct's.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a launch-parameter struct",
    label = "add `#[launch_params]` to the struct"
)]
pub unsafe trait LaunchParams: DeviceData + ParamsSymbol {
    /// The name, for messages.
    const NAME: &'static str;
    /// The name of the constant-memory variable in the PTX (`pipelineLaunchParamsVariableName`).
    const SYMBOL: &'static str;
    /// The fields, in declaration order.
    const FIELDS: &'static [Field];
    /// What a program gets from `params()`: a method per field.
    type View<'a>: From<ParamsBase<'a, Self>>;
    /// What the application fills in: `Self`, or the host counterpart in which buffers stand in place of views.
    #[cfg(not(target_arch = "nvptx64"))]
    type Host: crate::host::HostData<Device = Self>;
}

/// Loads from the parameter symbol by constant address; one per parameter struct, since PTX names the symbol in the
/// instruction. Made by `#[launch_params]`.
#[doc(hidden)]
pub trait ParamsSymbol {
    /// The eight bytes at `OFFSET + 8 * INDEX`.
    #[cfg(target_arch = "nvptx64")]
    fn long<const OFFSET: usize, const INDEX: usize>() -> u64;
    /// The word at byte `OFFSET + 4 * INDEX`.
    #[cfg(target_arch = "nvptx64")]
    fn word<const OFFSET: usize, const INDEX: usize>() -> u32;
    /// The two bytes at `OFFSET + 2 * INDEX`.
    #[cfg(target_arch = "nvptx64")]
    fn half<const OFFSET: usize, const INDEX: usize>() -> u16;
    /// The byte at `OFFSET + INDEX`.
    #[cfg(target_arch = "nvptx64")]
    fn byte<const OFFSET: usize, const INDEX: usize>() -> u8;
    /// The symbol's generic address.
    #[cfg(target_arch = "nvptx64")]
    fn address() -> *const u8;
}

/// One field of a parameter struct.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// The name.
    pub name: &'static str,
    /// Bytes from the struct's beginning.
    pub offset: usize,
    /// Bytes.
    pub size: usize,
    /// Whether the host may specialise it away (`#[bound]`).
    pub bound: bool,
    /// Whether it is one view of elements, by its name: a `Slice`, `SliceMut` or `SliceMut2d`.
    pub slice: bool,
}

/// A field that the host may bind to a constant when it builds the pipeline; `Frame::MAX_BOUNCES` for a field
/// `#[bound] max_bounces`.
pub struct Bound<P, T> {
    field: Field,
    types: core::marker::PhantomData<fn(P) -> T>,
}

impl<P: LaunchParams, T: DeviceData> Bound<P, T> {
    /// Used by `#[launch_params]`.
    ///
    /// # Safety
    /// The field is one of `P`, of type `T`.
    #[doc(hidden)]
    pub const unsafe fn new(field: Field) -> Self {
        assert!(field.size == size_of::<T>() && field.size > 0, "a bound field has at least one byte");
        Self { field, types: core::marker::PhantomData }
    }

    /// Which field it is.
    pub const fn field(&self) -> Field {
        self.field
    }
}

impl<P, T> Clone for Bound<P, T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<P, T> Copy for Bound<P, T> {}
