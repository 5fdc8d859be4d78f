//! The instance of the primitive, the transforms between it and the world, and instances by handle (guide 13.11, 13.12).

use super::Invocation;
use crate::program::{AccelHandle, Transform, TransformHandle};
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;
use glam::Vec3;

device_functions! {
    in primitive else HasPrimitive {
        /// The application's id of the instance; `None` where a GAS is traced without one.
        "optixGetInstanceId"
        fn instance_id(&self) -> Option<u32> {
            let id = body! {
                ptx { get_u32!("_optix_read_instance_id") }
                host { self.frame().hit.instance_id }
            };
            (id != !0).then_some(id)
        }

        /// Index of the instance in its IAS; 0 without an instance.
        "optixGetInstanceIndex"
        fn instance_index(&self) -> u32 {
            ptx { get_u32!("_optix_read_instance_idx") }
            host { self.frame().hit.instance_index }
        }

        /// The GAS that the primitive is in.
        "optixGetGASTraversableHandle"
        fn gas_handle(&self) -> AccelHandle<'_> {
            ptx { AccelHandle::new(get_u64!("_optix_get_gas_traversable_handle")) }
            host { AccelHandle::new(self.frame().executor.gas_traversable_handle()) }
        }

        /// How many instances are on the way from the structure given to `trace` to the primitive (guide 13.11).
        "optixGetTransformListSize"
        fn transform_list_size(&self) -> u32 {
            self.invocation.transform_list_size()
        }

        /// One of these instances, 0 nearest the structure given to `trace`; none where the list has ended.
        "optixGetTransformListHandle"
        fn transform_list_handle(&self, index: u32) -> Option<TransformHandle<'_>> {
            if index >= self.invocation.transform_list_size() {
                return None;
            }
            // SAFETY: inside the list.
            let handle = unsafe { self.invocation.transform_list_handle(index) };
            Some(TransformHandle::new(self.invocation, handle))
        }

        /// From object to world space.
        "optixGetObjectToWorldTransformMatrix"
        fn object_to_world(&self) -> Transform {
            ptx {
                // SAFETY: the product asks for indices inside the list, whose handles are of instances, which are the only
                // transforms of a static scene. Index 0 is nearest the root, so its transform is applied last.
                let matrix = |i| unsafe {
                    self.invocation.instance_transform_from_handle(self.invocation.transform_list_handle(i))
                };
                self.invocation.product(matrix, |product, next| product.after(&next))
            }
            // Composed in `f64` and rounded once.
            host { Transform::from_rows(self.frame().executor.object_to_world()) }
        }

        /// From world to object space.
        "optixGetWorldToObjectTransformMatrix"
        fn world_to_object(&self) -> Transform {
            ptx {
                // SAFETY: as for `object_to_world`. The inverse of index 0 is applied first.
                let matrix = |i| unsafe {
                    self.invocation.instance_inverse_transform_from_handle(self.invocation.transform_list_handle(i))
                };
                self.invocation.product(matrix, |product, next| next.after(&product))
            }
            // As for `object_to_world`.
            host { Transform::from_rows(self.frame().executor.world_to_object()) }
        }

        /// A point of object space in world space.
        "optixTransformPointFromObjectToWorldSpace"
        fn point_to_world(&self, point: Vec3) -> Vec3 {
            self.object_to_world().point(point)
        }

        /// A vector of object space in world space: without translation.
        "optixTransformVectorFromObjectToWorldSpace"
        fn vector_to_world(&self, vector: Vec3) -> Vec3 {
            self.object_to_world().vector(vector)
        }

        /// A normal of object space in world space, by the inverse transpose; its length changes.
        "optixTransformNormalFromObjectToWorldSpace"
        fn normal_to_world(&self, normal: Vec3) -> Vec3 {
            self.world_to_object().normal(normal)
        }

        /// A point of world space in object space.
        "optixTransformPointFromWorldToObjectSpace"
        fn point_to_object(&self, point: Vec3) -> Vec3 {
            self.world_to_object().point(point)
        }

        /// A vector of world space in object space: without translation.
        "optixTransformVectorFromWorldToObjectSpace"
        fn vector_to_object(&self, vector: Vec3) -> Vec3 {
            self.world_to_object().vector(vector)
        }

        /// A normal of world space in object space, by the inverse transpose; its length changes.
        "optixTransformNormalFromWorldToObjectSpace"
        fn normal_to_object(&self, normal: Vec3) -> Vec3 {
            self.object_to_world().normal(normal)
        }
    }
}

/// What handles of instances tell, in any program that has one.
impl Invocation {
    /// How many transforms are on the way to the primitive.
    #[inline(always)]
    pub fn transform_list_size(&self) -> u32 {
        body! {
            ptx { get_u32!("_optix_get_transform_list_size") }
            host { self.frame().executor.transform_list_size() }
        }
    }

    /// One of them.
    ///
    /// # Safety
    /// `index` is less than the list's size.
    #[inline(always)]
    pub unsafe fn transform_list_handle(&self, index: u32) -> u64 {
        body! {
            ptx {
                // SAFETY: the caller's.
                unsafe { get_of!("_optix_get_transform_list_handle", reg32 index, reg64 as u64) }
            }
            host { self.frame().executor.transform_list_handle(index) }
        }
    }

    /// `OptixTransformType`.
    ///
    /// # Safety
    /// `handle` is of the transform list or of an instance.
    #[inline(always)]
    pub unsafe fn transform_type_from_handle(&self, handle: u64) -> u32 {
        body! {
            ptx {
                // SAFETY: the caller's.
                unsafe { get_of!("_optix_get_transform_type_from_handle", reg64 handle, reg32 as u32) }
            }
            host {
                // Instances are the only transforms that the executor has.
                let _ = handle;
                4
            }
        }
    }

    /// The handle of an instance of an IAS.
    ///
    /// # Safety
    /// `ias` was built with random instance access and has an instance `index`.
    #[inline(always)]
    pub unsafe fn instance_traversable_from_ias(&self, ias: u64, index: u32) -> u64 {
        body! {
            ptx {
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
            host {
                // SAFETY: the caller's.
                unsafe { self.frame().executor.instance_traversable_from_ias(ias, index) }
            }
        }
    }

    /// The application's id of an instance.
    ///
    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_id_from_handle(&self, handle: u64) -> u32 {
        body! {
            ptx {
                // SAFETY: the caller's.
                unsafe { get_of!("_optix_get_instance_id_from_handle", reg64 handle, reg32 as u32) }
            }
            host {
                // SAFETY: the caller's.
                unsafe { self.frame().executor.instance(handle) }.id
            }
        }
    }

    /// The structure that an instance places.
    ///
    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_child_from_handle(&self, handle: u64) -> u64 {
        body! {
            ptx {
                // SAFETY: the caller's.
                unsafe { get_of!("_optix_get_instance_child_from_handle", reg64 handle, reg64 as u64) }
            }
            host {
                // SAFETY: the caller's.
                unsafe { self.frame().executor.instance(handle) }.child
            }
        }
    }

    /// The matrix of an instance.
    ///
    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_transform_from_handle(&self, handle: u64) -> [[f32; 4]; 3] {
        body! {
            ptx {
                // SAFETY: the caller's; the query gives the address of the matrix.
                unsafe { rows(get_of!("_optix_get_instance_transform_from_handle", reg64 handle, reg64 as u64)) }
            }
            host {
                // SAFETY: the caller's.
                unsafe { self.frame().executor.instance(handle) }.transform
            }
        }
    }

    /// The inverse of that matrix.
    ///
    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_inverse_transform_from_handle(&self, handle: u64) -> [[f32; 4]; 3] {
        body! {
            ptx {
                // SAFETY: the caller's; the query gives the address of the matrix.
                unsafe {
                    rows(get_of!("_optix_get_instance_inverse_transform_from_handle", reg64 handle, reg64 as u64))
                }
            }
            host {
                // SAFETY: the caller's.
                unsafe { self.frame().executor.instance(handle) }.inverse
            }
        }
    }

    /// The product of the matrices of the transform list.
    #[cfg(target_arch = "nvptx64")]
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
#[cfg(target_arch = "nvptx64")]
#[inline(always)]
unsafe fn rows(address: u64) -> [[f32; 4]; 3] {
    // SAFETY: the caller's.
    unsafe { [row(address), row(address + 16), row(address + 32)] }
}

/// A row of a matrix.
///
/// # Safety
/// `address` is of 16 bytes of global memory, aligned to 16, which do not change during the launch.
#[cfg(target_arch = "nvptx64")]
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
