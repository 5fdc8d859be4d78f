//! As much of Embree 3's C interface as the comparison needs, loaded at run time.

use std::ffi::{c_char, c_void};
use std::mem::ManuallyDrop;
use std::ptr;

use libloading::Library;

use crate::scene::Mesh;
use optix_host::cpu::traversal::RayQuery;

type Handle = *mut c_void;

/// `RTCRayHit`: ray in the first 12 words, hit in the others.
#[repr(C, align(16))]
struct RayHit {
    origin: [f32; 3],
    tnear: f32,
    direction: [f32; 3],
    time: f32,
    tfar: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    uv: [f32; 2],
    primitive: u32,
    geometry: u32,
    instance: u32,
}

/// `RTCIntersectContext` for one instance level, with room to spare.
#[repr(C)]
struct Context {
    flags: u32,
    filter: *const c_void,
    instance: [u32; 8],
}

const FLAG_ROBUST: u32 = 4;
const TYPE_TRIANGLE: u32 = 0;
const BUFFER_INDEX: u32 = 0;
const BUFFER_VERTEX: u32 = 1;
const FORMAT_UINT3: u32 = 0x5003;
const FORMAT_FLOAT3: u32 = 0x9003;
const NOTHING: u32 = !0;

/// The entry points, copied out of the library.
pub struct Embree {
    new_geometry: unsafe extern "C" fn(Handle, u32) -> Handle,
    new_buffer: unsafe extern "C" fn(Handle, u32, u32, u32, usize, usize) -> *mut c_void,
    commit_geometry: unsafe extern "C" fn(Handle),
    attach: unsafe extern "C" fn(Handle, Handle) -> u32,
    new_scene: unsafe extern "C" fn(Handle) -> Handle,
    set_flags: unsafe extern "C" fn(Handle, u32),
    commit_scene: unsafe extern "C" fn(Handle),
    intersect: unsafe extern "C" fn(Handle, *mut Context, *mut RayHit),
    occluded: unsafe extern "C" fn(Handle, *mut Context, *mut RayHit),
    device: Handle,
    /// Stays loaded to the end of the process: Embree's threads outlive `main`, and would run unmapped code.
    _library: ManuallyDrop<Library>,
}

/// A committed scene; never released, since the process ends soon.
pub struct Scene<'e> {
    embree: &'e Embree,
    handle: Handle,
}

// SAFETY: Embree's committed scenes may be traced from several threads at once.
unsafe impl Sync for Scene<'_> {}

impl Embree {
    pub fn load() -> Result<Self, libloading::Error> {
        // SAFETY: the library's initialisers have no preconditions.
        let library = unsafe { Library::new("libembree3.so.3") }?;
        macro_rules! symbol {
            ($name:literal) => {
                // SAFETY: the field's type is the function's in Embree 3's header.
                *unsafe { library.get($name.as_bytes()) }?
            };
        }
        let new_device: unsafe extern "C" fn(*const c_char) -> Handle = symbol!("rtcNewDevice");
        Ok(Self {
            new_geometry: symbol!("rtcNewGeometry"),
            new_buffer: symbol!("rtcSetNewGeometryBuffer"),
            commit_geometry: symbol!("rtcCommitGeometry"),
            attach: symbol!("rtcAttachGeometry"),
            new_scene: symbol!("rtcNewScene"),
            set_flags: symbol!("rtcSetSceneFlags"),
            commit_scene: symbol!("rtcCommitScene"),
            intersect: symbol!("rtcIntersect1"),
            occluded: symbol!("rtcOccluded1"),
            // SAFETY: a null configuration is the default one.
            device: unsafe { new_device(ptr::null()) },
            _library: ManuallyDrop::new(library),
        })
    }

    pub fn scene(&self, mesh: &Mesh) -> Scene<'_> {
        // SAFETY: handles come from this device; each buffer has the size it was asked for, and Embree pads it.
        unsafe {
            let handle = (self.new_scene)(self.device);
            (self.set_flags)(handle, FLAG_ROBUST);
            let geometry = (self.new_geometry)(self.device, TYPE_TRIANGLE);
            let vertices = (self.new_buffer)(geometry, BUFFER_VERTEX, 0, FORMAT_FLOAT3, 12, mesh.vertices.len());
            ptr::copy_nonoverlapping(mesh.vertices.as_ptr(), vertices.cast(), mesh.vertices.len());
            let indices = (self.new_buffer)(geometry, BUFFER_INDEX, 0, FORMAT_UINT3, 12, mesh.indices.len());
            ptr::copy_nonoverlapping(mesh.indices.as_ptr(), indices.cast(), mesh.indices.len());
            (self.commit_geometry)(geometry);
            (self.attach)(handle, geometry);
            (self.commit_scene)(handle);
            Scene { embree: self, handle }
        }
    }
}

impl Scene<'_> {
    pub fn intersect(&self, ray: &RayQuery) -> Option<f32> {
        let (mut context, mut ray) = prepare(ray);
        // SAFETY: the scene is committed, and both structures have the layout and alignment of the header.
        unsafe { (self.embree.intersect)(self.handle, &mut context, &mut ray) };
        (ray.geometry != NOTHING).then_some(ray.tfar)
    }

    pub fn occluded(&self, ray: &RayQuery) -> bool {
        let (mut context, mut ray) = prepare(ray);
        // SAFETY: as above; only the ray part is touched.
        unsafe { (self.embree.occluded)(self.handle, &mut context, &mut ray) };
        ray.tfar < 0.0
    }
}

fn prepare(ray: &RayQuery) -> (Context, RayHit) {
    let context = Context { flags: 0, filter: ptr::null(), instance: [NOTHING, 0, 0, 0, 0, 0, 0, 0] };
    let ray = RayHit {
        origin: ray.origin,
        tnear: ray.tmin,
        direction: ray.direction,
        time: 0.0,
        tfar: ray.tmax,
        mask: NOTHING,
        id: 0,
        flags: 0,
        normal: [0.0; 3],
        uv: [0.0; 2],
        primitive: NOTHING,
        geometry: NOTHING,
        instance: NOTHING,
    };
    (context, ray)
}
