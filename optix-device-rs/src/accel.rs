//! Acceleration structures that programs read without a hit: the instances of an IAS, by number (guide 13.12). Any kind of
//! program may. What a GAS is made of is read likewise: see [`TriangleVertices`](crate::primitive::TriangleVertices).
//!
//! Both are fields of launch parameters and records, and travel in payloads. On the host a structure that is built for it
//! gives their owners: `scene.ias(..).build_with_instances()`, `scene.gas(..).build_with_triangles()`.
//!
//! ```
//! use optix_device_rs::prelude::*;
//!
//! #[launch_params]
//! pub struct Frame {
//!     pub lamps: Instances,    // where each lamp stands
//!     pub bulb: TriangleVertices, // the shape of all of them
//! }
//!
//! /// A corner of a lamp, in the space of the lamps' structure.
//! fn corner(at: &impl Context, lamps: Instances, bulb: TriangleVertices, lamp: u32, triangle: u32) -> Vec3 {
//!     let [corner, ..] = bulb.get(at, 0, triangle);
//!     lamps.get(at, lamp).transform().point(corner)
//! }
//! ```

use crate::data::DeviceData;
use crate::intrinsics::{Private, check};
use crate::layout::Layout;
use crate::program::{Context, InstanceHandle};
use crate::view::OfLaunch;
use crate::words::{FromRaw, words_of_raw};

/// The instances of an IAS, in the order in which the application gave them.
///
/// On the host it is an [`InstanceTable`](crate::host::InstanceTable).
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Instances {
    ias: u64,
    len: u64,
    of: OfLaunch,
}

/// # Safety
/// The handle is of an IAS with so many instances, built with random instance access on the machine that launches, and stays
/// alive while programs may use the view.
impl FromRaw for Instances {
    type Raw = [u64; 2];
    #[inline(always)]
    unsafe fn from_raw([ias, len]: [u64; 2]) -> Self {
        Self { ias, len, of: OfLaunch::NEW }
    }
}

impl Instances {
    #[doc(hidden)]
    pub const fn to_raw(self) -> [u64; 2] {
        [self.ias, self.len]
    }

    /// How many there are: one at the least.
    #[inline(always)]
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub const fn len(self) -> u32 {
        self.len as u32
    }

    /// Instance `index`, as in [`instance_index`](crate::program::ClosestHit::instance_index); `context` is that of the running
    /// program (`optixGetInstanceTraversableFromIAS`). An index out of range ends the program.
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub fn get<C: Context>(self, context: &C, index: u32) -> InstanceHandle<'_> {
        let message = format_args!("instance {index} is out of range: the structure has {}", self.len);
        check(index, self.len(), message);
        let invocation = context.invocation(Private(()));
        // SAFETY: the structure has such an instance, and was built for this (`from_raw`).
        InstanceHandle::new(*invocation, unsafe { invocation.instance_traversable_from_ias(self.ias, index) })
    }
}

words_of_raw! {
    [] Instances: [u64; 2], |raw| Self::from_raw(raw);
}

// SAFETY: `#[repr(C)]` integers of 64 bits, the same on both machines.
unsafe impl DeviceData for Instances {
    const LAYOUT: Layout = Layout::of("Instances");
    #[inline]
    fn write_to(&self, bytes: &mut [u8]) {
        self.to_raw().write_to(bytes);
    }
    const UNIT: usize = u64::UNIT;
}

impl core::fmt::Debug for Instances {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Instances({})", self.len)
    }
}
