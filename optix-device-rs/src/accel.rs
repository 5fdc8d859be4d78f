//! Acceleration structures that programs read without a hit: the instances of an IAS and the triangles of a GAS, by number
//! (guide 13.9, 13.12). Any kind of program may.
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
use crate::layout::Layout;
use crate::machine::check;
use crate::program::{Context, Here, InstanceHandle};
use crate::view::{OfLaunch, Slice};
use crate::words::{FromRaw, words_of_raw};
use glam::Vec3;

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

/// The triangles of a GAS.
///
/// On the host it is a [`TriangleTable`](crate::host::TriangleTable).
#[derive(Clone, Copy)]
#[repr(C)]
pub struct TriangleVertices {
    gas: u64,
    /// Per record of the GAS: triangles in its build input.
    counts: Slice<u32>,
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

/// # Safety
/// The handle is of a GAS of triangles, built with random vertex access on the machine that launches, and stays alive while
/// programs may use the view; it has as many records as `counts`, each of a build input with so many triangles.
impl FromRaw for TriangleVertices {
    type Raw = (u64, Slice<u32>);
    #[inline(always)]
    unsafe fn from_raw((gas, counts): (u64, Slice<u32>)) -> Self {
        Self { gas, counts }
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
        let cx = context.machine(Here(()));
        // SAFETY: the structure has such an instance, and was built for this (`from_raw`).
        InstanceHandle::new(*cx, unsafe { cx.instance_traversable_from_ias(self.ias, index) })
    }
}

impl TriangleVertices {
    #[doc(hidden)]
    pub const fn to_raw(self) -> [u64; 3] {
        let [address, len] = self.counts.to_raw();
        [self.gas, address, len]
    }

    /// How many records the GAS has: one for each material of each geometry, in order.
    #[inline(always)]
    pub const fn records(self) -> u32 {
        self.counts.len() as u32
    }

    /// How many triangles the geometry of a record has. A record out of range ends the program.
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub fn triangles(self, sbt_gas_index: u32) -> u32 {
        self.counts.get(sbt_gas_index)
    }

    /// The vertices of a triangle, in object space: triangle `primitive_index` of the geometry that has the record
    /// `sbt_gas_index`; the two as a hit's context gives them. `context` is that of the running program
    /// (`optixGetTriangleVertexDataFromHandle`). For a triangle without area, which no ray meets, NaN or its vertices: the CPU
    /// says NaN, and a driver may. An index out of range ends the program.
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub fn get<C: Context>(self, context: &C, sbt_gas_index: u32, primitive_index: u32) -> [Vec3; 3] {
        let count = self.triangles(sbt_gas_index);
        let message = format_args!("triangle {primitive_index} is out of range: record {sbt_gas_index} has {count}");
        check(primitive_index, count, message);
        // SAFETY: the structure has such a triangle, and was built for this (`from_raw`).
        unsafe { context.machine(Here(())).triangle_vertices_from_handle(self.gas, primitive_index, sbt_gas_index) }
    }
}

words_of_raw! {
    [] Instances: [u64; 2], |raw| Self::from_raw(raw);
    [] TriangleVertices: [u64; 3], |raw| Self::from_raw((raw[0], Slice::from_raw([raw[1], raw[2]])));
}

macro_rules! device_data {
    ($($name:ident)*) => {$(
        // SAFETY: `#[repr(C)]` integers of 64 bits, the same on both machines.
        unsafe impl DeviceData for $name {
            const LAYOUT: Layout = Layout::of(stringify!($name));
            #[inline]
            fn write_to(&self, bytes: &mut [u8]) {
                self.to_raw().write_to(bytes);
            }
            const UNIT: usize = u64::UNIT;
        }
    )*};
}
device_data!(Instances TriangleVertices);

impl core::fmt::Debug for Instances {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Instances({})", self.len)
    }
}

impl core::fmt::Debug for TriangleVertices {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "TriangleVertices({} records)", self.records())
    }
}
