//! Rays and what they are traced against (guide 13.2).

use crate::layout::Layout;
use crate::view::OfLaunch;
use crate::words::{FromRaw, Words};
use glam::Vec3;

/// A traversable: what a ray is traced against (an acceleration structure of the scene).
///
/// It has no public constructor but [`Traversable::NULL`]: the host fills it in from a scene it keeps alive. As a
/// [view](crate::view), it is for the programs of launches that keep the structure.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(transparent)]
pub struct Traversable(u64, OfLaunch);

impl Traversable {
    /// Nothing: a ray traced against it runs only its miss program (guide 13.2).
    pub const NULL: Self = Self(0, OfLaunch::NEW);

    #[doc(hidden)]
    pub const fn to_raw(self) -> u64 {
        self.0
    }
}

/// # Safety
/// The handle is alive, on the machine that launches, for as long as programs may trace against it.
impl FromRaw for Traversable {
    type Raw = u64;
    #[inline(always)]
    unsafe fn from_raw(handle: u64) -> Self {
        Self(handle, OfLaunch::NEW)
    }
}

impl core::fmt::Debug for Traversable {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(if self.0 == 0 { "Traversable::NULL" } else { "Traversable" })
    }
}

impl Words for Traversable {
    const COUNT: usize = 2;
    const LAYOUT: Layout = Layout::of("Traversable");
    #[inline(always)]
    fn store(self, words: &mut [u32]) {
        self.0.store(words);
    }
    #[inline(always)]
    unsafe fn load(words: &[u32]) -> Self {
        // SAFETY: the words are of a traversable that was stored.
        unsafe { Self::from_raw(u64::load(words)) }
    }
}

/// A ray: origin and direction in world space, and the interval of `t` in which hits count, `origin + t * direction`.
///
/// Both have to be finite, and the direction longer than 0, in the object space of each instance that the ray comes to as well
/// (guide 13.2): an instance of scale `1e-38` puts an origin 4 units away beyond what 32 bits can have. On the CPU such a ray
/// misses what the instance holds, and meets everything else; in checked mode it ends the launch.
///
/// ```
/// use optix_device_rs::prelude::*;
/// let shadow = Ray::new(Vec3::ZERO, Vec3::Y)
///     .range(0.0, 0.999)
///     .flags(RayFlags::NONE.terminate_on_first_hit());
/// assert_eq!(shadow.tmax, 0.999);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin in world space.
    pub origin: Vec3,
    /// Direction in world space; need not have length 1, `t` is in units of its length.
    pub direction: Vec3,
    /// Least `t` of a hit, at least 0.
    pub tmin: f32,
    /// Greatest `t` of a hit.
    pub tmax: f32,
    /// Time, for motion; ignored where the pipeline has none.
    pub time: f32,
    /// Instances with `(mask & instance mask) == 0` are skipped.
    pub mask: u8,
    /// What to leave out for this ray.
    pub flags: RayFlags,
}

impl Ray {
    /// A ray with `t` from 0 to `f32::MAX`, at time 0, seeing all instances, with no flags.
    #[inline(always)]
    pub const fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, tmin: 0.0, tmax: f32::MAX, time: 0.0, mask: 0xff, flags: RayFlags::NONE }
    }

    /// Hits count for `tmin <= t <= tmax`; `tmin` is at least 0.
    #[inline(always)]
    pub const fn range(mut self, tmin: f32, tmax: f32) -> Self {
        self.tmin = tmin;
        self.tmax = tmax;
        self
    }

    /// Only instances that share a bit with `mask` are seen.
    #[inline(always)]
    pub const fn mask(mut self, mask: u8) -> Self {
        self.mask = mask;
        self
    }

    /// At this time.
    #[inline(always)]
    pub const fn time(mut self, time: f32) -> Self {
        self.time = time;
        self
    }

    /// With these flags.
    #[inline(always)]
    pub const fn flags(mut self, flags: RayFlags) -> Self {
        self.flags = flags;
        self
    }
}

/// `OptixRayFlags` (guide 13.2). Each setter replaces its group, so that exclusive flags can't meet.
///
/// There is no setter for `OPTIX_RAY_FLAG_DISABLE_CLOSESTHIT`: it is what
/// [`trace_without_closesthit`](crate::program::RayGen::trace_without_closesthit) is for, which is there for payloads that
/// get along without a closest-hit program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct RayFlags(u32);

/// Which any-hit programs run for a ray; overrides geometry and instances (guide 13.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum AnyHitMode {
    /// As geometry and instances say.
    Default = 0,
    /// None.
    Disable = 1,
    /// All, also where geometry or instance disables them.
    Enforce = 2,
    /// Geometry whose any-hit is disabled is not seen at all.
    CullDisabled = 64,
    /// Geometry whose any-hit is enabled is not seen at all.
    CullEnforced = 128,
}

/// Which side of triangles a ray does not see (guide 13.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum CullFaces {
    /// Both sides are seen.
    None = 0,
    /// Back faces are not seen.
    Back = 16,
    /// Front faces are not seen.
    Front = 32,
}

impl RayFlags {
    /// No flag.
    pub const NONE: Self = Self(0);
    const TERMINATE_ON_FIRST_HIT: u32 = 4;
    const DISABLE_CLOSESTHIT: u32 = 8;

    /// The first accepted hit ends traversal.
    #[inline(always)]
    pub const fn terminate_on_first_hit(self) -> Self {
        Self(self.0 | Self::TERMINATE_ON_FIRST_HIT)
    }

    /// With or without `OPTIX_RAY_FLAG_DISABLE_CLOSESTHIT`. Which of the two is said by which trace function is called, and
    /// not by the ray: what the caller may read depends on it.
    #[inline(always)]
    pub(crate) const fn with_closesthit(self, runs: bool) -> Self {
        let others = self.0 & !Self::DISABLE_CLOSESTHIT;
        Self(if runs { others } else { others | Self::DISABLE_CLOSESTHIT })
    }

    /// Which any-hit programs run.
    #[inline(always)]
    pub const fn any_hit(self, mode: AnyHitMode) -> Self {
        Self(self.0 & !(1 | 2 | 64 | 128) | mode as u32)
    }

    /// Which faces of triangles are not seen.
    #[inline(always)]
    pub const fn cull(self, faces: CullFaces) -> Self {
        Self(self.0 & !(16 | 32) | faces as u32)
    }

    /// The bits of `OptixRayFlags`.
    #[inline(always)]
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// Whether closest-hit programs are off for the ray: it is one of `trace_without_closesthit`.
    #[inline(always)]
    pub const fn closesthit_disabled(self) -> bool {
        self.0 & Self::DISABLE_CLOSESTHIT != 0
    }

    /// From the bits of `OptixRayFlags`; for backends.
    ///
    /// # Safety
    /// No two are set that exclude each other, for which OptiX has no meaning (guide 13.2).
    #[doc(hidden)]
    #[inline(always)]
    pub const unsafe fn from_bits(bits: u32) -> Self {
        Self(bits)
    }
}

/// What an any-hit program decides about a candidate hit (guide 13.13).
///
/// A return value, not a call that never returns, so that payload writes always count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Decision {
    /// The hit counts; traversal goes on for nearer ones.
    Accept,
    /// As if there were no hit (`optixIgnoreIntersection`).
    Ignore,
    /// The hit counts and traversal ends (`optixTerminateRay`).
    Terminate,
}
