//! Shader-binding-table records (guide 7).

use crate::data::DeviceData;

/// The data of a record that a program of the shader binding table reads, after OptiX's 32-byte header.
///
/// `#[derive(SbtRecord)]` on a `#[repr(C)]` struct. A record with views ([`Slice`](crate::view::Slice) and its kin) has a
/// host counterpart, `LambertHost` for `Lambert`, with the owning buffer in each view's place; otherwise the struct is its own
/// host counterpart.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a record of the shader binding table",
    label = "not an SBT record",
    note = "add `#[derive(Clone, Copy, SbtRecord)]` and `#[repr(C)]` to the struct"
)]
pub trait SbtRecord: DeviceData {
    /// The name, for messages.
    const NAME: &'static str;
    /// What the application fills in: `Self`, or the host counterpart in which buffers stand in place of views.
    #[cfg(not(target_arch = "nvptx64"))]
    type Host: crate::host::HostData<Device = Self>;
}

/// No data.
impl SbtRecord for () {
    const NAME: &'static str = "()";
    #[cfg(not(target_arch = "nvptx64"))]
    type Host = ();
}
