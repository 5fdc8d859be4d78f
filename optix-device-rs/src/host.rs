//! What the host side of a shader crate shares with `optix-host`: the description of a pipeline, the frame of a program
//! call, and the owning twins of device views.

use crate::attributes::GeometryKind;
use crate::data::DeviceData;
use crate::machine::TraceCall;
use crate::params::Field;
use crate::ray::{Decision, Ray, Traversable};
use crate::view::{Element, Slice, SliceMut, SliceMut2d};
use crate::words::WordBuffer;
use core::cell::Cell;
use core::marker::PhantomData;
use core::ptr::NonNull;
use glam::{UVec3, Vec3};
use std::any::Any;
use std::string::String;
use std::sync::Arc;
use std::vec::Vec;

// ---- Description --------------------------------------------------------------------------------------------------

/// A device program: its entry in the PTX and its host function.
#[derive(Clone, Copy)]
pub struct Entry {
    /// The name in the PTX, with its OptiX prefix (`__closesthit__..`).
    pub name: &'static str,
    /// The Rust function's path as written in `pipeline!`, for messages.
    pub function: &'static str,
    /// Runs the program on a frame. Programs other than any-hit return [`Decision::Accept`].
    ///
    /// The caller promises what [`Cx::new`](crate::machine::Cx::new) asks for.
    pub run: unsafe fn(&Frame<'_>) -> Decision,
}

impl core::fmt::Debug for Entry {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name)
    }
}

/// Size and alignment of a record's data, and which type it is.
#[derive(Clone, Copy, Debug)]
pub struct RecordLayout {
    /// The type's name.
    pub name: &'static str,
    /// Bytes, without the header.
    pub size: usize,
    /// Bytes; at most 16 (guide 7.2).
    pub align: usize,
}

impl RecordLayout {
    /// Of a record type.
    pub const fn of<R: crate::record::SbtRecord>() -> Self {
        assert!(align_of::<R>() <= 16, "an SBT record's data is aligned to 16 bytes at most (guide 7.2)");
        Self { name: R::NAME, size: size_of::<R>(), align: align_of::<R>() }
    }
}

/// A payload's words and their semantics.
#[derive(Clone, Copy, Debug)]
pub struct PayloadDescription {
    /// The type's name.
    pub name: &'static str,
    /// `OptixPayloadSemantics` bits per word; its length is the word count.
    pub semantics: &'static [u32],
}

impl PayloadDescription {
    /// Of a payload type.
    pub const fn of<R: crate::payload::Payload>() -> Self {
        assert!(R::WORDS == R::SEMANTICS.len());
        Self { name: R::NAME, semantics: R::SEMANTICS }
    }
}

/// A program with a record of its own: ray generation or miss.
#[derive(Clone, Copy, Debug)]
pub struct ProgramDescription {
    /// The program.
    pub entry: Entry,
    /// Its record.
    pub record: RecordLayout,
}

/// A ray type.
#[derive(Clone, Copy, Debug)]
pub struct RayDescription {
    /// The payload.
    pub payload: PayloadDescription,
    /// The miss program; none where the payload needs none.
    pub miss: Option<ProgramDescription>,
}

/// The programs of a hit group for one ray type.
#[derive(Clone, Copy, Debug)]
pub struct HitPrograms {
    /// Closest hit.
    pub closesthit: Option<Entry>,
    /// Any hit.
    pub anyhit: Option<Entry>,
    /// Intersection; there for custom primitives.
    pub intersection: Option<Entry>,
}

/// A material on a geometry kind: one hit group per ray type.
#[derive(Clone, Copy, Debug)]
pub struct HitGroupDescription {
    /// The material's record.
    pub record: RecordLayout,
    /// The kind of geometry.
    pub geometry: GeometryKind,
    /// Attribute words of its hits.
    pub attribute_words: usize,
    /// Per ray type, in the order of [`PipelineDescription::rays`].
    pub rays: &'static [HitPrograms],
}

/// The launch parameters.
#[derive(Clone, Copy, Debug)]
pub struct ParamsDescription {
    /// The type's name.
    pub name: &'static str,
    /// The constant-memory variable in the PTX.
    pub symbol: &'static str,
    /// Bytes.
    pub size: usize,
    /// Bytes.
    pub align: usize,
    /// The fields.
    pub fields: &'static [Field],
}

impl ParamsDescription {
    /// Of a parameter type.
    pub const fn of<P: crate::params::LaunchParams>() -> Self {
        Self { name: P::NAME, symbol: P::SYMBOL, size: size_of::<P>(), align: align_of::<P>(), fields: P::FIELDS }
    }
}

/// All of a pipeline.
#[derive(Clone, Copy, Debug)]
pub struct PipelineDescription {
    /// The type's name.
    pub name: &'static str,
    /// The launch parameters.
    pub params: ParamsDescription,
    /// The ray-generation programs.
    pub raygen: &'static [ProgramDescription],
    /// The ray types; the index is SBT offset, miss index and payload type.
    pub rays: &'static [RayDescription],
    /// The hit groups.
    pub hitgroups: &'static [HitGroupDescription],
    /// The greatest depth of nested trace calls, where `pipeline!` states one (`trace_depth: 4`); otherwise it follows
    /// from which programs trace which rays.
    pub trace_depth: Option<u32>,
}

// ---- A program call on the host -----------------------------------------------------------------------------------

/// What a hit, or a candidate, tells its program.
#[derive(Clone, Copy, Debug)]
pub struct HitState {
    /// Index in its build input, plus that input's offset.
    pub primitive_index: u32,
    /// Index of its record in its GAS.
    pub sbt_gas_index: u32,
    /// `!0` without an instance.
    pub instance_id: u32,
    /// 0 without an instance.
    pub instance_index: u32,
    /// 254 and 255: front and back of a triangle; 0 to 127: the program's own.
    pub kind: u8,
    /// Attribute words.
    pub attributes: WordBuffer,
}

impl HitState {
    /// For programs without a hit.
    pub const NONE: Self = Self {
        primitive_index: 0,
        sbt_gas_index: 0,
        instance_id: !0,
        instance_index: 0,
        kind: 0,
        attributes: WordBuffer::ZERO,
    };
}

/// Everything a program call on the host can see.
pub struct Frame<'a> {
    /// Who runs it.
    pub executor: &'a dyn Executor,
    /// The launch index.
    pub launch_index: UVec3,
    /// The launch dimensions.
    pub launch_dimensions: UVec3,
    /// The launch parameters, a valid value of the pipeline's parameter type.
    pub params: NonNull<u8>,
    /// The data of the program's record, a valid value of its record type.
    pub record: NonNull<u8>,
    /// The payload.
    pub payload: Cell<WordBuffer>,
    /// The ray, in world space, as passed to trace; for hits `tmax` is as [`Executor::ray_tmax`] says.
    pub ray: Ray,
    /// Origin and direction in object space; intersection and any-hit programs only.
    pub object_ray: (Vec3, Vec3),
    /// The hit.
    pub hit: HitState,
}

/// What a program asks of the executor that runs it.
pub trait Executor {
    /// Traces a ray; `payload` goes in and comes back.
    fn trace(&self, call: &TraceCall, payload: &mut WordBuffer);
    /// Reports a hit from an intersection program; true if it was accepted.
    fn report(&self, t: f32, kind: u8, count: usize, attributes: &WordBuffer) -> bool;
    /// The current end of the ray's interval (guide 13.5): changes while an intersection program reports.
    fn ray_tmax(&self, frame: &Frame<'_>) -> f32;
    /// The vertices of the triangle hit, in object space.
    fn triangle_vertices(&self) -> [Vec3; 3];
    /// Three rows.
    fn object_to_world(&self) -> [[f32; 4]; 3];
    /// Three rows.
    fn world_to_object(&self) -> [[f32; 4]; 3];
}

// ---- Owners of what views point to --------------------------------------------------------------------------------

/// Which device memory or an acceleration structure belongs to; unique in the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DeviceId(pub u64);

/// An error of device memory, from the driver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MemoryError(pub String);

impl core::fmt::Display for MemoryError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(&self.0)
    }
}
impl std::error::Error for MemoryError {}

/// An allocation on a device; copies are ordered with the device's launches.
pub trait Memory: Any + Send + Sync {
    /// Whose it is.
    fn device(&self) -> DeviceId;
    /// The address that programs on that device use.
    fn address(&self) -> u64;
    /// Bytes.
    fn byte_len(&self) -> usize;
    /// Copies `bytes.len()` bytes from `offset` once earlier launches are done.
    fn read(&self, offset: usize, bytes: &mut [u8]) -> Result<(), MemoryError>;
    /// Copies `bytes` to `offset` once earlier launches are done.
    fn write(&self, offset: usize, bytes: &[u8]) -> Result<(), MemoryError>;
}

/// A buffer of `T` on a device: the host twin of [`Slice`] and [`SliceMut`]. A clone is the same buffer.
pub struct Buffer<T> {
    memory: Arc<dyn Memory>,
    len: usize,
    elements: PhantomData<fn(T) -> T>,
}

impl<T> Clone for Buffer<T> {
    fn clone(&self) -> Self {
        Self { memory: self.memory.clone(), len: self.len, elements: PhantomData }
    }
}

impl<T> core::fmt::Debug for Buffer<T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Buffer({} elements)", self.len)
    }
}

impl<T: Element> Buffer<T> {
    /// From an allocation of at least `len` elements, aligned for `T`; for backends.
    ///
    /// # Panics
    /// If the allocation is too small or misaligned.
    #[doc(hidden)]
    pub fn from_memory(memory: Arc<dyn Memory>, len: usize) -> Self {
        assert!(memory.byte_len() >= len * size_of::<T>(), "allocation too small");
        assert!(len == 0 || memory.address().is_multiple_of(align_of::<T>() as u64), "allocation misaligned");
        Self { memory, len, elements: PhantomData }
    }

    /// How many elements it has.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Copies all elements to the host, after the launches that were begun before.
    pub fn read(&self) -> Result<Vec<T>, MemoryError> {
        let mut elements: Vec<T> = Vec::with_capacity(self.len);
        let bytes = self.len * size_of::<T>();
        // SAFETY: the vector's memory, zeroed so that the slice is of initialised bytes.
        let target = unsafe {
            core::ptr::write_bytes(elements.as_mut_ptr(), 0, self.len);
            core::slice::from_raw_parts_mut(elements.as_mut_ptr().cast::<u8>(), bytes)
        };
        self.memory.read(0, target)?;
        // SAFETY: `len` elements were written, and any bytes are a `T` (`Element`).
        unsafe { elements.set_len(self.len) };
        Ok(elements)
    }

    /// Overwrites the buffer; `elements` is as long as the buffer.
    pub fn write(&self, elements: &[T]) -> Result<(), MemoryError> {
        if elements.len() != self.len {
            return Err(MemoryError(std::format!(
                "{} elements were given for a buffer of {}",
                elements.len(),
                self.len
            )));
        }
        // SAFETY: an `Element` has no padding, so all its bytes are initialised.
        let bytes = unsafe {
            core::slice::from_raw_parts(elements.as_ptr().cast::<u8>(), size_of_val(elements))
        };
        self.memory.write(0, bytes)
    }
}

/// A two-dimensional buffer: the host twin of [`SliceMut2d`]. A clone is the same buffer.
pub struct Buffer2d<T> {
    buffer: Buffer<T>,
    size: [u32; 2],
}

impl<T> Clone for Buffer2d<T> {
    fn clone(&self) -> Self {
        Self { buffer: self.buffer.clone(), size: self.size }
    }
}

impl<T> core::fmt::Debug for Buffer2d<T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Buffer2d({} x {})", self.size[0], self.size[1])
    }
}

impl<T: Element> Buffer2d<T> {
    /// Rows of `size[0]` elements; for backends.
    ///
    /// # Panics
    /// If the buffer is not `size[0] * size[1]` long.
    #[doc(hidden)]
    pub fn from_buffer(buffer: Buffer<T>, size: [u32; 2]) -> Self {
        assert!(buffer.len() == size[0] as usize * size[1] as usize);
        Self { buffer, size }
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Copies all elements to the host, row by row, after the launches that were begun before.
    pub fn read(&self) -> Result<Vec<T>, MemoryError> {
        self.buffer.read()
    }

    /// Overwrites the buffer, row by row.
    pub fn write(&self, elements: &[T]) -> Result<(), MemoryError> {
        self.buffer.write(elements)
    }
}

/// An acceleration structure of a scene: the host twin of [`Traversable`]. A clone is the same structure.
#[derive(Clone)]
pub struct World {
    handle: u64,
    device: DeviceId,
    scene: u64,
    owner: Arc<dyn Any + Send + Sync>,
}

impl core::fmt::Debug for World {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("World")
    }
}

impl World {
    /// For backends: `owner` keeps `handle` alive on `device`; `scene` tells whose records it refers to.
    #[doc(hidden)]
    pub fn new(handle: u64, device: DeviceId, scene: u64, owner: Arc<dyn Any + Send + Sync>) -> Self {
        Self { handle, device, scene, owner }
    }
}

// ---- Twins --------------------------------------------------------------------------------------------------------

/// What a launch or a shader binding table keeps alive, gathered while twins are lowered to device data.
#[derive(Default)]
pub struct KeepAlive {
    owners: Vec<Arc<dyn Any + Send + Sync>>,
    devices: Vec<(DeviceId, &'static str)>,
    scenes: Vec<u64>,
}

impl KeepAlive {
    fn memory(&mut self, memory: &Arc<dyn Memory>) {
        self.devices.push((memory.device(), "buffer"));
        let owner: Arc<dyn Any + Send + Sync> = memory.clone();
        self.owners.push(owner);
    }

    /// What is to be kept.
    pub fn into_owners(self) -> Vec<Arc<dyn Any + Send + Sync>> {
        self.owners
    }

    /// The first thing that is not `device`'s, by kind.
    pub fn foreign(&self, device: DeviceId) -> Option<&'static str> {
        self.devices.iter().find(|(id, _)| *id != device).map(|(_, what)| *what)
    }

    /// Whether all acceleration structures are of this scene.
    pub fn only_scene(&self, scene: u64) -> bool {
        self.scenes.iter().all(|s| *s == scene)
    }
}

/// Host data that becomes device data: a struct without views is its own twin, a buffer is the twin of a view.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be handed to a device",
    label = "is not the host twin of any device type"
)]
pub trait Twin {
    /// What programs see.
    type Device: DeviceData;
    /// The device data; owners of what it points to go to `keep`.
    fn lower(&self, keep: &mut KeepAlive) -> Self::Device;
}

impl Twin for () {
    type Device = ();
    fn lower(&self, _: &mut KeepAlive) {}
}

/// Which host type stands in for a view in a host twin. Used by the derives.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a view of device memory",
    label = "only `Slice`, `SliceMut`, `SliceMut2d` and `Traversable` have an owner on the host"
)]
pub trait View: DeviceData {
    /// The owner.
    type Owner: Clone;
    /// The view of what the owner owns.
    fn of(owner: &Self::Owner, keep: &mut KeepAlive) -> Self;
}

impl<T: Element> View for Slice<T> {
    type Owner = Buffer<T>;
    fn of(owner: &Buffer<T>, keep: &mut KeepAlive) -> Self {
        keep.memory(&owner.memory);
        // SAFETY: the buffer has `len` aligned elements (`from_memory`), and `keep` holds it.
        unsafe { Self::from_raw(owner.memory.address(), owner.len as u64) }
    }
}

impl<T: Element> View for SliceMut<T> {
    type Owner = Buffer<T>;
    fn of(owner: &Buffer<T>, keep: &mut KeepAlive) -> Self {
        keep.memory(&owner.memory);
        // SAFETY: as for `Slice`.
        unsafe { Self::from_raw(owner.memory.address(), owner.len as u64) }
    }
}

impl<T: Element> View for SliceMut2d<T> {
    type Owner = Buffer2d<T>;
    fn of(owner: &Buffer2d<T>, keep: &mut KeepAlive) -> Self {
        keep.memory(&owner.buffer.memory);
        let [width, height] = owner.size;
        // SAFETY: the buffer has `width * height` aligned elements (`from_buffer`), and `keep` holds it.
        unsafe { Self::from_raw(owner.buffer.memory.address(), width, height) }
    }
}

impl View for Traversable {
    type Owner = World;
    fn of(owner: &World, keep: &mut KeepAlive) -> Self {
        keep.devices.push((owner.device, "acceleration structure"));
        keep.scenes.push(owner.scene);
        keep.owners.push(owner.owner.clone());
        // SAFETY: the owner keeps the handle alive (`World::new`), and `keep` holds it.
        unsafe { Self::from_raw(owner.handle) }
    }
}
