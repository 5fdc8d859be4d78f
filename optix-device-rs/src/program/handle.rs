//! Handles of acceleration structures and instances: where a primitive is, and what any program may ask about an instance
//! (guide 13.11, 13.12).

use super::Transform;
use crate::intrinsics::Invocation;
use core::marker::PhantomData;

/// An acceleration structure that a program has come across.
///
/// Its use is to be compared. Rays are not traced against it: the records of its hits are where its instance says, so a
/// trace needs the structure that has the instance, a [`Traversable`](crate::ray::Traversable) from the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccelHandle<'a> {
    handle: u64,
    call: PhantomData<&'a Invocation>,
}

impl AccelHandle<'_> {
    pub(crate) fn new(handle: u64) -> Self {
        Self { handle, call: PhantomData }
    }

    /// A number that tells it from all others that are alive: a key, to be stored. There is no way back.
    #[inline(always)]
    pub const fn key(self) -> u64 {
        self.handle
    }
}

/// What a transform is (`OptixTransformType`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TransformType {
    /// An instance in an IAS.
    Instance,
}

/// A transform between the structure given to `trace` and a primitive.
#[derive(Clone, Copy)]
pub struct TransformHandle<'a> {
    invocation: Invocation,
    handle: u64,
    call: PhantomData<&'a Invocation>,
}

impl<'a> TransformHandle<'a> {
    pub(crate) fn new(invocation: Invocation, handle: u64) -> Self {
        Self { invocation, handle, call: PhantomData }
    }

    /// What it is (`optixGetTransformTypeFromHandle`); none if it is of a kind that this library can't make.
    #[inline(always)]
    pub fn transform_type(self) -> Option<TransformType> {
        // SAFETY: the handle is of a transform list (`new`).
        match unsafe { self.invocation.transform_type_from_handle(self.handle) } {
            // OPTIX_TRANSFORM_TYPE_INSTANCE
            4 => Some(TransformType::Instance),
            _ => None,
        }
    }

    /// The instance, if it is one.
    #[inline(always)]
    pub fn instance(self) -> Option<InstanceHandle<'a>> {
        (self.transform_type()? == TransformType::Instance).then(|| InstanceHandle::new(self.invocation, self.handle))
    }
}

/// An instance in an IAS, for as long as the program's context is borrowed.
#[derive(Clone, Copy)]
pub struct InstanceHandle<'a> {
    invocation: Invocation,
    handle: u64,
    call: PhantomData<&'a Invocation>,
}

impl<'a> InstanceHandle<'a> {
    pub(crate) fn new(invocation: Invocation, handle: u64) -> Self {
        Self { invocation, handle, call: PhantomData }
    }

    /// The application's id (`optixGetInstanceIdFromHandle`).
    #[inline(always)]
    pub fn id(self) -> u32 {
        // SAFETY: the handle is of an instance (`new`).
        unsafe { self.invocation.instance_id_from_handle(self.handle) }
    }

    /// The structure that it places (`optixGetInstanceChildFromHandle`).
    #[inline(always)]
    pub fn child(self) -> AccelHandle<'a> {
        // SAFETY: as above.
        AccelHandle::new(unsafe { self.invocation.instance_child_from_handle(self.handle) })
    }

    /// From the space of the structure that it places to the space of its IAS (`optixGetInstanceTransformFromHandle`).
    #[inline(always)]
    pub fn transform(self) -> Transform {
        // SAFETY: as above.
        Transform::from_rows(unsafe { self.invocation.instance_transform_from_handle(self.handle) })
    }

    /// From the space of its IAS to that of the structure (`optixGetInstanceInverseTransformFromHandle`).
    #[inline(always)]
    pub fn inverse_transform(self) -> Transform {
        // SAFETY: as above.
        Transform::from_rows(unsafe { self.invocation.instance_inverse_transform_from_handle(self.handle) })
    }
}
