//! Handles of instances: their addresses, which the owner of a launch's structures keeps in place.

use crate::cpu::kernel::Placed;

/// The handle of an instance; for the structure that it places, a key that is compared only.
pub(super) fn of<T>(target: &T) -> u64 {
    core::ptr::from_ref(target).expose_provenance() as u64
}

/// The instance; none for handle 0.
///
/// # Safety
/// The handle is 0 or of an instance that outlives `'a`.
pub(super) unsafe fn instance<'a>(handle: u64) -> Option<&'a Placed> {
    // SAFETY: the caller's.
    unsafe { core::ptr::with_exposed_provenance::<Placed>(handle as usize).as_ref() }
}

/// A matrix as programs read it.
pub(super) fn rows(matrix: [f32; 12]) -> [[f32; 4]; 3] {
    bytemuck::cast(matrix)
}
