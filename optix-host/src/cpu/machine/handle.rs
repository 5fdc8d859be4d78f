//! Traversable handles: addresses of structures and instances, which the owner of a launch's structures keeps in place.

use crate::cpu::kernel::{Accel, Placed};

/// The handle of a structure or of an instance.
pub(super) fn of<T>(target: &T) -> u64 {
    core::ptr::from_ref(target).expose_provenance() as u64
}

/// The structure; none for handle 0.
///
/// # Safety
/// The handle is 0 or of a structure that outlives `'a`.
pub(super) unsafe fn structure<'a>(handle: u64) -> Option<&'a Accel> {
    // SAFETY: the caller's.
    unsafe { core::ptr::with_exposed_provenance::<Accel>(handle as usize).as_ref() }
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
