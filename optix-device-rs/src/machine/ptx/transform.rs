//! The transforms between a primitive and the world, and instances by handle (guide 13.11, 13.12).

use super::Cx;
use crate::program::Transform;
use core::arch::asm;

impl Cx {
    #[inline(always)]
    pub fn transform_list_size(&self) -> u32 {
        get_u32!("_optix_get_transform_list_size")
    }

    /// # Safety
    /// `index` is less than the list's size.
    #[inline(always)]
    pub unsafe fn transform_list_handle(&self, index: u32) -> u64 {
        // SAFETY: the caller's.
        unsafe { get_of!("_optix_get_transform_list_handle", reg32 index, reg64 as u64) }
    }

    /// `OptixTransformType`.
    ///
    /// # Safety
    /// `handle` is of the transform list or of an instance.
    #[inline(always)]
    pub unsafe fn transform_type_from_handle(&self, handle: u64) -> u32 {
        // SAFETY: the caller's.
        unsafe { get_of!("_optix_get_transform_type_from_handle", reg64 handle, reg32 as u32) }
    }

    /// # Safety
    /// `ias` was built with random instance access and has an instance `index`.
    #[inline(always)]
    pub unsafe fn instance_traversable_from_ias(&self, ias: u64, index: u32) -> u64 {
        let handle: u64;
        // SAFETY: the caller's.
        unsafe {
            asm!(
                "call ({h}), _optix_get_instance_traversable_from_ias, ({ias}, {index});",
                h = out(reg64) handle,
                ias = in(reg64) ias,
                index = in(reg32) index,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        handle
    }

    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_id_from_handle(&self, handle: u64) -> u32 {
        // SAFETY: the caller's.
        unsafe { get_of!("_optix_get_instance_id_from_handle", reg64 handle, reg32 as u32) }
    }

    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_child_from_handle(&self, handle: u64) -> u64 {
        // SAFETY: the caller's.
        unsafe { get_of!("_optix_get_instance_child_from_handle", reg64 handle, reg64 as u64) }
    }

    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_transform_from_handle(&self, handle: u64) -> [[f32; 4]; 3] {
        // SAFETY: the caller's; the query gives the address of the matrix.
        unsafe { rows(get_of!("_optix_get_instance_transform_from_handle", reg64 handle, reg64 as u64)) }
    }

    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_inverse_transform_from_handle(&self, handle: u64) -> [[f32; 4]; 3] {
        // SAFETY: the caller's; the query gives the address of the matrix.
        unsafe { rows(get_of!("_optix_get_instance_inverse_transform_from_handle", reg64 handle, reg64 as u64)) }
    }

    /// The object-to-world transform: the product of the transform list. Instances are the only transforms of a static
    /// scene.
    #[inline(always)]
    pub fn object_to_world(&self) -> Transform {
        // SAFETY: the product asks for indices inside the list, whose handles are of instances. Index 0 is nearest the
        // root, so its transform is applied last.
        let matrix = |i| unsafe { self.instance_transform_from_handle(self.transform_list_handle(i)) };
        self.product(matrix, |product, next| product.after(&next))
    }

    /// The world-to-object transform.
    #[inline(always)]
    pub fn world_to_object(&self) -> Transform {
        // SAFETY: as above. The inverse of index 0 is applied first.
        let matrix = |i| unsafe { self.instance_inverse_transform_from_handle(self.transform_list_handle(i)) };
        self.product(matrix, |product, next| next.after(&product))
    }

    #[inline(always)]
    fn product(
        &self,
        matrix: impl Fn(u32) -> [[f32; 4]; 3],
        and: impl Fn(Transform, Transform) -> Transform,
    ) -> Transform {
        let size = self.transform_list_size();
        if size == 0 {
            return Transform::from_rows([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
        }
        // Of most hits the list is one instance, whose matrix is the product.
        let mut product = Transform::from_rows(matrix(0));
        let mut i = 1;
        while i < size {
            product = and(product, Transform::from_rows(matrix(i)));
            i += 1;
        }
        product
    }
}

/// A matrix that a query returned.
///
/// # Safety
/// `address` is of three rows, as for [`row`].
#[inline(always)]
unsafe fn rows(address: u64) -> [[f32; 4]; 3] {
    // SAFETY: the caller's.
    unsafe { [row(address), row(address + 16), row(address + 32)] }
}

/// A row of a matrix.
///
/// # Safety
/// `address` is of 16 bytes of global memory, aligned to 16, which do not change during the launch.
#[inline(always)]
unsafe fn row(address: u64) -> [f32; 4] {
    let (x, y, z, w): (u32, u32, u32, u32);
    // SAFETY: the caller's. Nobody writes the memory, so the load may be moved or left out as a computation may.
    unsafe {
        asm!(
            "{{ .reg .b64 g; cvta.to.global.u64 g, {a}; ld.global.v4.b32 {{{x}, {y}, {z}, {w}}}, [g]; }}",
            x = out(reg32) x,
            y = out(reg32) y,
            z = out(reg32) z,
            w = out(reg32) w,
            a = in(reg64) address,
            options(pure, nomem, nostack, preserves_flags)
        )
    };
    [x, y, z, w].map(f32::from_bits)
}
