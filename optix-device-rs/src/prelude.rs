//! What a shader crate uses: `use optix_device_rs::prelude::*;`.

pub use crate::accel::Instances;
pub use crate::callable::{Callable, Callables, Continuation, Direct};
pub use crate::data::DeviceData;
pub use crate::exception::{Raised, UserException};
#[cfg(target_arch = "nvptx64")]
pub use crate::math::{HostOnly, HostOnlyDouble};
pub use crate::math::{Math, Onb};
pub use crate::params::LaunchParams;
pub use crate::payload::Payload;
pub use crate::pipeline::{HasHitGroup, HasRay, Pipeline, Throws};
pub use crate::primitive::{Attributes, Custom, OnTriangles, PrimitiveType, TriangleVertices, Triangles};
pub use crate::program::{
    AnyHit, CallsContinuation, CallsDirect, ClosestHit, Context, ContinuationCallable, DirectCallable, Exception, Face,
    HitKind, InstanceHandle, Intersection, Miss, RayGen, Transform, TransformHandle,
};
pub use crate::ray::{AnyHitMode, CullFaces, Decision, Ray, RayFlags, Traversable};
pub use crate::record::SbtRecord;
pub use crate::rng::Pcg32;
pub use crate::surface::SurfacePoint;
pub use crate::texture::{Texture1d, Texture2d, Texture2dArray, Texture3d, TextureCube};
pub use crate::view::{Element, Slice, SliceMut, SliceMut2d};
pub use crate::words::Words;
pub use glam::{
    Affine3A, BVec2, BVec3, BVec4, Mat3, Mat4, Quat, UVec2, UVec3, UVec4, Vec2, Vec3, Vec3Swizzles, Vec4, Vec4Swizzles,
};
pub use optix_macros::{
    Attributes, DeviceData, Element, Payload, SbtRecord, UserException, Words, anyhit, closesthit,
    continuation_callable, direct_callable, exception, intersection, launch_params, miss, pipeline, raygen,
};
