//! Device functions on the host: each reads the frame that the executor made for the program call.

use super::TraceCall;
use crate::callable::Signature;
use crate::exception::MAX_DETAILS;
use crate::host::end;
use crate::host::{CallableCall, ExceptionState, Frame, Rule, name_of};
use crate::limits::MAX_PAYLOAD_WORDS;
use crate::params::LaunchParams;
use crate::primitive::PrimitiveType;
use crate::program::Transform;
use crate::words::{WordBuffer, Words, part, part_mut};
use core::any::TypeId;
use core::cell::Cell;
use core::ffi::CStr;
use core::marker::PhantomData;
use core::mem::MaybeUninit;
use core::panic::Location;
use core::ptr::NonNull;
use glam::{UVec3, Vec2, Vec3};
use std::ffi::CString;
use std::format;

/// The running program's frame.
#[derive(Clone, Copy)]
pub struct Cx(NonNull<Frame<'static>>);

/// The launch's parameters, for as long as the program's context is borrowed.
pub struct ParamsBase<'a, P>(NonNull<u8>, PhantomData<&'a P>);

impl<P> Clone for ParamsBase<'_, P> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<P> Copy for ParamsBase<'_, P> {}

/// The parameter field at byte `OFFSET`.
///
/// # Safety
/// `P` has a field of type `T` at `OFFSET`.
#[inline(always)]
pub unsafe fn load_param<P: LaunchParams, T: Copy, const OFFSET: usize>(base: ParamsBase<'_, P>) -> T {
    // SAFETY: the executor's parameters are a valid `P` (`Cx::new`), and the caller vouches for the field.
    unsafe { base.0.add(OFFSET).cast::<T>().read() }
}

/// What a payload word that nobody has written yet holds: a NaN, and as an index out of range of everything, so that a program
/// that were to read it would show.
pub const UNWRITTEN: u32 = 0xffcd_cdcd;

/// Memory that nobody has written yet: words of [`UNWRITTEN`].
///
/// # Safety
/// A `T` is an array of words, which may be any.
#[inline(always)]
pub unsafe fn unwritten<T>(memory: &mut MaybeUninit<T>) -> &mut T {
    let words = memory.as_mut_ptr().cast::<u32>();
    // SAFETY: the words are `memory`'s, and the caller says that any are a `T`.
    unsafe {
        for i in 0..size_of::<T>() / 4 {
            words.add(i).write(UNWRITTEN);
        }
        memory.assume_init_mut()
    }
}

/// The payload's words, each a cell of its own.
#[inline(always)]
fn each_word(payload: &Cell<WordBuffer>) -> &[Cell<u32>; MAX_PAYLOAD_WORDS] {
    // SAFETY: `WordBuffer` is transparent over `[u32; MAX_PAYLOAD_WORDS]` and `Cell<T>` over `T`, and a cell of an array may
    // be taken for an array of cells, as `Cell::as_slice_of_cells` does.
    unsafe { &*core::ptr::from_ref(payload).cast() }
}

/// Ends the program with this message and the place that asks unless `index < len`.
#[inline(always)]
#[track_caller]
pub fn check(index: u32, len: u32, message: core::fmt::Arguments<'_>) {
    #[cold]
    #[inline(never)]
    fn out_of_range(message: core::fmt::Arguments<'_>, at: &Location<'_>) -> ! {
        end::fail(Rule::Index, format!("{message}, at {at}"))
    }
    if index >= len {
        out_of_range(message, Location::caller());
    }
}

/// The place `offset` bytes into the memory of a view, if each index is below its length; otherwise ends the program with this
/// message.
#[inline(always)]
#[track_caller]
pub fn place_if<const N: usize>(
    in_range: [(u32, u32); N],
    view: u64,
    offset: u64,
    message: core::fmt::Arguments<'_>,
) -> *mut u8 {
    #[cold]
    #[inline(never)]
    fn out_of_range(view: u64, message: core::fmt::Arguments<'_>, at: &Location<'_>) -> ! {
        end::fail(Rule::Index, format!("{message}, at {at}{}", name_of(view)))
    }
    if in_range.iter().any(|(index, len)| index >= len) {
        out_of_range(view, message, Location::caller());
    }
    place(view).wrapping_add(offset as usize)
}

/// Where the memory of a view begins; ends the program if it is no view of the running launch.
#[inline(always)]
pub fn place(view: u64) -> *mut u8 {
    crate::host::memory(view).as_ptr()
}

/// The 64-bit value of two words.
#[inline(always)]
pub fn wide(low: u32, high: u32) -> u64 {
    u64::from(low) | u64::from(high) << 32
}

/// The kind of primitive that a hit kind is of.
#[inline(always)]
pub fn primitive_type_of(kind: u8) -> PrimitiveType {
    PrimitiveType::of_hit_kind(kind).unwrap_or(PrimitiveType::Custom)
}

/// Whether a hit kind says that the back of a built-in primitive was hit.
#[inline(always)]
pub fn is_back_face(kind: u8) -> bool {
    kind == 255
}

impl Cx {
    /// The context of a program call.
    ///
    /// # Safety
    /// `frame` outlives every use of the context (the program call), its parameters are a valid `P::Params` of the
    /// pipeline whose program is called, and its record is of the program's record type.
    pub unsafe fn new(frame: &Frame<'_>) -> Self {
        Self(NonNull::from(frame).cast())
    }

    #[inline(always)]
    fn frame(&self) -> &Frame<'static> {
        #[cold]
        #[inline(never)]
        fn waits() -> ! {
            let what = "a context is used while another program runs than the one that it was given to";
            end::fail(Rule::Context, what.into())
        }
        // SAFETY: the promise of `new`; the reference does not leave the methods below.
        let frame = unsafe { self.0.as_ref() };
        if frame.turn.waits() {
            waits();
        }
        frame
    }

    #[inline(always)]
    pub fn params<P>(&self) -> ParamsBase<'_, P> {
        ParamsBase(self.frame().params, PhantomData)
    }
    #[inline(always)]
    pub fn record(&self) -> *const u8 {
        self.frame().record.as_ptr()
    }
    #[inline(always)]
    pub fn launch_index(&self) -> UVec3 {
        self.frame().launch_index
    }
    #[inline(always)]
    pub fn launch_dimensions(&self) -> UVec3 {
        self.frame().launch_dimensions
    }
    #[inline(always)]
    pub fn trace(&self, call: &TraceCall, mut payload: WordBuffer) -> WordBuffer {
        // What comes back where no program ran is a value of every type.
        if end::goes_on() {
            self.frame().executor.trace(call, &mut payload);
            payload
        } else {
            WordBuffer::ZERO
        }
    }
    #[inline(always)]
    pub fn set_payload_type(&self, _: u32) {}
    #[inline(always)]
    pub fn takes(&self, fields: &'static [usize]) {
        if let Some(watch) = self.frame().watch {
            watch.takes(fields);
        }
    }
    #[inline(always)]
    pub fn gives(&self, fields: &'static [usize]) {
        if let Some(watch) = self.frame().watch {
            watch.gives(fields);
        }
    }
    #[inline(always)]
    pub fn payload(&self, _mask: u32) -> WordBuffer {
        // The caller inlines this and uses the words of `mask` only, so no more are copied.
        self.frame().payload.get()
    }
    #[inline(always)]
    pub fn set_payload(&self, mask: u32, words: &WordBuffer) {
        // Word by word: the mask is a constant, and most payloads are much smaller than the buffer.
        let payload = each_word(self.frame().payload);
        for (i, (to, from)) in payload.iter().zip(&words.0).enumerate() {
            if mask & 1 << i != 0 {
                to.set(*from);
            }
        }
    }
    #[inline(always)]
    pub fn world_ray_origin(&self) -> Vec3 {
        self.frame().ray.origin
    }
    #[inline(always)]
    pub fn world_ray_direction(&self) -> Vec3 {
        self.frame().ray.direction
    }
    #[inline(always)]
    pub fn object_ray_origin(&self) -> Vec3 {
        self.frame().object_ray.0
    }
    #[inline(always)]
    pub fn object_ray_direction(&self) -> Vec3 {
        self.frame().object_ray.1
    }
    #[inline(always)]
    pub fn ray_tmin(&self) -> f32 {
        self.frame().ray.tmin
    }
    #[inline(always)]
    pub fn ray_tmax(&self) -> f32 {
        self.frame().ray.tmax
    }
    #[inline(always)]
    pub fn interval_end(&self) -> f32 {
        self.frame().executor.interval_end()
    }
    #[inline(always)]
    pub fn ray_time(&self) -> f32 {
        self.frame().ray.time
    }
    #[inline(always)]
    pub fn ray_flags(&self) -> u32 {
        self.frame().ray.flags.bits()
    }
    #[inline(always)]
    pub fn ray_mask(&self) -> u32 {
        self.frame().ray.mask as u32
    }
    #[inline(always)]
    pub fn primitive_index(&self) -> u32 {
        self.frame().hit.primitive_index
    }
    #[inline(always)]
    pub fn sbt_gas_index(&self) -> u32 {
        self.frame().hit.sbt_gas_index
    }
    #[inline(always)]
    pub fn instance_id(&self) -> u32 {
        self.frame().hit.instance_id
    }
    #[inline(always)]
    pub fn instance_index(&self) -> u32 {
        self.frame().hit.instance_index
    }
    #[inline(always)]
    pub fn hit_kind(&self) -> u32 {
        self.frame().hit.kind as u32
    }
    #[inline(always)]
    pub fn barycentrics(&self) -> Vec2 {
        let [u, v, ..] = self.frame().hit.attributes;
        Vec2::new(f32::from_bits(u), f32::from_bits(v))
    }
    #[inline(always)]
    pub fn attributes(&self, _count: usize) -> WordBuffer {
        let mut words = WordBuffer::ZERO;
        words.0[..8].copy_from_slice(&self.frame().hit.attributes);
        words
    }
    #[inline(always)]
    pub fn gas_traversable_handle(&self) -> u64 {
        self.frame().executor.gas_traversable_handle()
    }
    #[inline(always)]
    pub fn transform_list_size(&self) -> u32 {
        self.frame().executor.transform_list_size()
    }
    /// # Safety
    /// `index` is less than the list's size.
    #[inline(always)]
    pub unsafe fn transform_list_handle(&self, index: u32) -> u64 {
        self.frame().executor.transform_list_handle(index)
    }
    /// `OptixTransformType`.
    ///
    /// # Safety
    /// `handle` is of the transform list or of an instance.
    #[inline(always)]
    pub unsafe fn transform_type_from_handle(&self, _handle: u64) -> u32 {
        // Instances are the only transforms that the executor has.
        4
    }
    /// # Safety
    /// `ias` was built with random instance access and has an instance `index`.
    #[inline(always)]
    pub unsafe fn instance_traversable_from_ias(&self, ias: u64, index: u32) -> u64 {
        // SAFETY: the caller's.
        unsafe { self.frame().executor.instance_traversable_from_ias(ias, index) }
    }
    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_id_from_handle(&self, handle: u64) -> u32 {
        // SAFETY: the caller's.
        unsafe { self.frame().executor.instance(handle) }.id
    }
    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_child_from_handle(&self, handle: u64) -> u64 {
        // SAFETY: the caller's.
        unsafe { self.frame().executor.instance(handle) }.child
    }
    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_transform_from_handle(&self, handle: u64) -> [[f32; 4]; 3] {
        // SAFETY: the caller's.
        unsafe { self.frame().executor.instance(handle) }.transform
    }
    /// # Safety
    /// `handle` is of an instance.
    #[inline(always)]
    pub unsafe fn instance_inverse_transform_from_handle(&self, handle: u64) -> [[f32; 4]; 3] {
        // SAFETY: the caller's.
        unsafe { self.frame().executor.instance(handle) }.inverse
    }
    /// # Safety
    /// `gas` is of triangles and was built with random vertex access; `sbt_gas_index` is a record of one of its build
    /// inputs, which has a triangle `primitive`.
    #[inline(always)]
    pub unsafe fn triangle_vertices_from_handle(&self, gas: u64, primitive: u32, sbt_gas_index: u32) -> [Vec3; 3] {
        // SAFETY: the caller's.
        unsafe { self.frame().executor.triangle_vertices_from_handle(gas, primitive, sbt_gas_index) }
    }
    #[inline(always)]
    pub fn triangle_vertices(&self) -> [Vec3; 3] {
        self.frame().executor.triangle_vertices()
    }
    /// The object-to-world transform, composed in `f64` and rounded once.
    #[inline(always)]
    pub fn object_to_world(&self) -> Transform {
        Transform::from_rows(self.frame().executor.object_to_world())
    }
    /// The world-to-object transform, composed in `f64` and rounded once.
    #[inline(always)]
    pub fn world_to_object(&self) -> Transform {
        Transform::from_rows(self.frame().executor.world_to_object())
    }
    #[inline(always)]
    pub fn report(&self, t: f32, kind: u32, count: usize, attributes: &WordBuffer) -> bool {
        end::goes_on() && self.frame().executor.report(t, kind as u8, count, attributes)
    }

    fn call<F: Signature>(&self, continuation: bool, number: u32, arguments: F::Arguments) -> F::Result {
        let mut words = WordBuffer::ZERO;
        arguments.store(part_mut(&mut words.0, 0, F::Arguments::COUNT));
        let call = CallableCall { number, continuation, signature: TypeId::of::<F>() };
        if end::goes_on() {
            self.frame().executor.call(&call, &mut words);
        } else {
            words = WordBuffer::ZERO;
        }
        // SAFETY: the executor compares the signatures, and the callable's entry stored what it returned (`entry::result`);
        // where none ran, they are zeros.
        unsafe { F::Result::load(part(&words.0, 0, F::Result::COUNT)) }
    }
    /// # Safety
    /// None on the host; on the device the record has to be there, of a direct callable with signature `F`.
    #[inline(always)]
    pub unsafe fn call_direct<F: Signature>(&self, index: u32, arguments: F::Arguments) -> F::Result {
        self.call::<F>(false, index, arguments)
    }
    /// # Safety
    /// As for `call_direct`.
    #[inline(always)]
    pub unsafe fn call_continuation<F: Signature>(&self, index: u32, arguments: F::Arguments) -> F::Result {
        self.call::<F>(true, index, arguments)
    }
    #[track_caller]
    pub fn throw<const CODE: u32>(&self, _count: usize, details: &[u32; MAX_DETAILS]) -> ! {
        // It is the running program's, whose pipeline is told.
        let _ = self.frame();
        let at = Location::caller();
        let line = CString::new(std::format!("{}:{}", at.file(), at.line())).ok();
        // SAFETY: `Throw`, which the context makes, is told code and details by an exception of the pipeline's type.
        unsafe { end::throw(ExceptionState { code: CODE.cast_signed(), details: *details, line }) }
    }
    #[inline(always)]
    pub fn exception_code(&self) -> i32 {
        self.frame().exception.code
    }
    #[inline(always)]
    pub fn exception_details(&self, _count: usize) -> WordBuffer {
        let mut words = WordBuffer::ZERO;
        words.0[..MAX_DETAILS].copy_from_slice(&self.frame().exception.details);
        words
    }
    #[inline(always)]
    pub fn exception_line(&self) -> Option<&CStr> {
        self.frame().exception.line.as_deref()
    }
}
