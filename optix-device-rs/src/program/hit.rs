//! What programs may ask about the primitive, the hit and the transforms (guide 13.4, 13.7, 13.9, 13.11).

use super::{AccelHandle, AnyHit, ClosestHit, HitKind, Intersection, Transform, TransformHandle};
use crate::primitive::{Attributes, PrimitiveType};
use crate::words::part;
use glam::Vec3;

macro_rules! primitive_queries {
    ($($name:ident),*) => {$(
        impl<P, A> $name<P, A> {
            /// Index of the primitive in its build input, plus that input's offset.
            #[inline(always)]
            pub fn primitive_index(&self) -> u32 {
                self.cx.primitive_index()
            }
            /// Index of the primitive's record in its GAS.
            #[inline(always)]
            pub fn sbt_gas_index(&self) -> u32 {
                self.cx.sbt_gas_index()
            }
            /// The application's id of the instance; `None` where a GAS is traced without one.
            #[inline(always)]
            pub fn instance_id(&self) -> Option<u32> {
                let id = self.cx.instance_id();
                (id != !0).then_some(id)
            }
            /// Index of the instance in its IAS; 0 without an instance.
            #[inline(always)]
            pub fn instance_index(&self) -> u32 {
                self.cx.instance_index()
            }
            /// The GAS that the primitive is in (`optixGetGASTraversableHandle`).
            #[inline(always)]
            pub fn gas_handle(&self) -> AccelHandle<'_> {
                AccelHandle::new(self.cx.gas_traversable_handle())
            }
            /// How many instances are on the way from the structure given to `trace` to the primitive (guide 13.11).
            #[inline(always)]
            pub fn transform_list_size(&self) -> u32 {
                self.cx.transform_list_size()
            }
            /// One of these instances, 0 nearest the structure given to `trace`; none where the list has ended.
            #[inline(always)]
            pub fn transform_list_handle(&self, index: u32) -> Option<TransformHandle<'_>> {
                if index >= self.cx.transform_list_size() {
                    return None;
                }
                // SAFETY: inside the list.
                let handle = unsafe { self.cx.transform_list_handle(index) };
                Some(TransformHandle::new(self.cx, handle))
            }
            /// From object to world space.
            #[inline(always)]
            pub fn object_to_world(&self) -> Transform {
                self.cx.object_to_world()
            }
            /// From world to object space.
            #[inline(always)]
            pub fn world_to_object(&self) -> Transform {
                self.cx.world_to_object()
            }
            /// A point of object space in world space.
            #[inline(always)]
            pub fn point_to_world(&self, point: Vec3) -> Vec3 {
                self.object_to_world().point(point)
            }
            /// A vector of object space in world space: without translation.
            #[inline(always)]
            pub fn vector_to_world(&self, vector: Vec3) -> Vec3 {
                self.object_to_world().vector(vector)
            }
            /// A normal of object space in world space, by the inverse transpose; its length changes.
            #[inline(always)]
            pub fn normal_to_world(&self, normal: Vec3) -> Vec3 {
                self.world_to_object().normal(normal)
            }
            /// A point of world space in object space.
            #[inline(always)]
            pub fn point_to_object(&self, point: Vec3) -> Vec3 {
                self.world_to_object().point(point)
            }
            /// A vector of world space in object space: without translation.
            #[inline(always)]
            pub fn vector_to_object(&self, vector: Vec3) -> Vec3 {
                self.world_to_object().vector(vector)
            }
            /// A normal of world space in object space, by the inverse transpose; its length changes.
            #[inline(always)]
            pub fn normal_to_object(&self, normal: Vec3) -> Vec3 {
                self.object_to_world().normal(normal)
            }
        }
    )*};
}
primitive_queries!(Intersection, AnyHit, ClosestHit);

macro_rules! object_ray {
    ($($name:ident),*) => {$(
        impl<P, A> $name<P, A> {
            /// Ray origin in object space (guide 13.5).
            #[inline(always)]
            pub fn object_ray_origin(&self) -> Vec3 {
                self.cx.object_ray_origin()
            }
            /// Ray direction in object space, scaled as the transform does: `t` means the same in both spaces.
            #[inline(always)]
            pub fn object_ray_direction(&self) -> Vec3 {
                self.cx.object_ray_direction()
            }
        }
    )*};
}
object_ray!(Intersection, AnyHit);

macro_rules! hit_queries {
    ($($name:ident),*) => {$(
        impl<P, A: Attributes> $name<P, A> {
            /// What the intersection reported.
            #[inline(always)]
            pub fn attributes(&self) -> A {
                // SAFETY: `pipeline!` made sure that the intersection programs of this hit group report an `A`.
                unsafe { A::load(part(&self.cx.attributes(A::WORDS).0, 0, A::WORDS)) }
            }
        }

        impl<P, A> $name<P, A> {
            /// The kind that the intersection program reported, or that of a built-in primitive (guide 13.7).
            #[inline(always)]
            pub fn hit_kind(&self) -> HitKind {
                HitKind::from_bits(self.cx.hit_kind())
            }
            /// The kind of primitive that was hit (`optixGetPrimitiveType`); of a stored kind: [`HitKind::primitive_type`].
            #[inline(always)]
            pub fn primitive_type(&self) -> PrimitiveType {
                self.hit_kind().primitive_type()
            }
        }
    )*};
}
hit_queries!(AnyHit, ClosestHit);
