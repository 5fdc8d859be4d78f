//! Handles of instances. A handle is the instance's address, which stays the same because the launch keeps the owner of
//! its structures.

use crate::cpu::traversal::BuiltInstance;

/// The handle of an instance. For the structure that an instance places, the handle is only compared.
pub(super) fn of<T>(target: &T) -> u64 {
    core::ptr::from_ref(target).expose_provenance() as u64
}

/// The instance with this handle. `None` for handle 0.
///
/// # Safety
/// The handle is 0 or of an instance that outlives `'a`.
pub(super) unsafe fn instance<'a>(handle: u64) -> Option<&'a BuiltInstance> {
    // SAFETY: the caller's.
    unsafe { core::ptr::with_exposed_provenance::<BuiltInstance>(handle as usize).as_ref() }
}

/// A matrix as programs read it.
pub(super) fn rows(matrix: [f32; 12]) -> [[f32; 4]; 3] {
    bytemuck::cast(matrix)
}
