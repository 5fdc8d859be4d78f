//! Trace calls: ray generation, closest-hit and miss programs, continuation callables (guide 13.2).

use super::Invocation;
use crate::check::{IsContinuationCallable, MayTrace};
#[cfg(not(target_arch = "nvptx64"))]
use crate::host::end;
use crate::payload::{Part, Payload, TracedWithoutClosestHit, Transport};
use crate::pipeline::HasRay;
use crate::ray::{Ray, Traversable};
use crate::words::WordBuffer;
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;

/// The arguments of a trace call but for the payload, all derived from the ray and the ray type.
#[derive(Clone, Copy, Debug)]
pub struct TraceCall {
    pub payload_type: u32,
    /// Registers.
    pub payload_words: usize,
    pub traversable: u64,
    pub ray: Ray,
    pub sbt_offset: u32,
    pub sbt_stride: u32,
    pub miss_index: u32,
    /// Fields of the payload that the caller gives, and those that it takes back. For the executor's checks; the device has
    /// them in the payload type.
    pub caller_writes: &'static [usize],
    pub caller_reads: &'static [usize],
}

#[inline(always)]
fn trace<P: HasRay<R>, R: Payload>(
    invocation: &Invocation,
    world: Traversable,
    ray: Ray,
    closesthit: bool,
    payload: R::FromCaller,
) -> R::AtCaller {
    let call = TraceCall {
        payload_type: P::PAYLOAD_TYPE,
        payload_words: R::SEMANTICS.len(),
        traversable: world.to_raw(),
        ray: Ray { flags: ray.flags.with_closesthit(closesthit), ..ray },
        sbt_offset: <P as HasRay<R>>::INDEX,
        sbt_stride: P::RAY_TYPES,
        miss_index: <P as HasRay<R>>::INDEX,
        caller_writes: <R::FromCaller as Part>::FIELDS,
        caller_reads: <R::AtCaller as Part>::FIELDS,
    };
    // SAFETY: the parts are the payload's, and the context is of a program that may trace.
    unsafe { R::Transport::trace(invocation, &call, payload) }
}

methods! {
    in tracing {
        /// Traces a ray of type `R` against `world`: gives what the caller writes of its payload, returns what the
        /// caller reads.
        ///
        /// SBT offset, stride, miss index and payload type follow from `R` and the pipeline.
        #[inline(always)]
        pub fn trace<R: Payload>(&self, world: Traversable, ray: Ray, payload: R::FromCaller) -> R::AtCaller
        where
            P: HasRay<R>,
        {
            trace::<P, R>(&self.invocation, world, ray, true, payload)
        }

        /// Traces a ray that runs no closest-hit program (`OPTIX_RAY_FLAG_DISABLE_CLOSESTHIT`, guide 13.2): for shadows
        /// and other questions that traversal answers. The miss program runs.
        ///
        /// Only for payloads whose caller gives every field that it reads; what is still there after a hit says so.
        ///
        /// ```
        /// use optix_device_rs::prelude::*;
        ///
        /// #[derive(Payload)]
        /// pub struct Shadow {
        ///     #[payload(write(caller, miss), read(caller))]
        ///     pub visible: bool,
        /// }
        ///
        /// fn visible<P: HasRay<Shadow>>(rg: &RayGen<P>, world: Traversable, ray: Ray) -> bool {
        ///     let ray = ray.flags(RayFlags::NONE.terminate_on_first_hit());
        ///     rg.trace_without_closesthit::<Shadow>(world, ray, ShadowFromCaller { visible: false }).visible
        /// }
        /// ```
        #[inline(always)]
        pub fn trace_without_closesthit<R: TracedWithoutClosestHit>(
            &self,
            world: Traversable,
            ray: Ray,
            payload: R::FromCaller,
        ) -> R::AtCaller
        where
            P: HasRay<R>,
        {
            trace::<P, R>(&self.invocation, world, ray, false, payload)
        }
    }
    others {}
}

macro_rules! may_not_trace {
    ($bound:ident: $($context:ident<P $(, $a:ident)?>),*) => {$(
        impl<P $(, $a)?> crate::program::$context<P $(, $a)?> {
            #[doc(hidden)]
            pub fn trace<R: Payload>(&self, _: Traversable, _: Ray, _: R::FromCaller) -> R::AtCaller
            where
                Self: $bound,
            {
                unreachable!()
            }
            #[doc(hidden)]
            pub fn trace_without_closesthit<R: Payload>(
                &self,
                _: Traversable,
                _: Ray,
                _: R::FromCaller,
            ) -> R::AtCaller
            where
                Self: $bound,
            {
                unreachable!()
            }
        }
    )*};
}
may_not_trace!(MayTrace: AnyHit<P, A>, Intersection<P, A>, Exception<P>);
may_not_trace!(IsContinuationCallable: DirectCallable<P>);

impl Invocation {
    /// Traces a ray. The number of payload words is a constant at every call.
    #[inline(always)]
    pub fn trace(&self, call: &TraceCall, payload: WordBuffer) -> WordBuffer {
        body! {
            ptx {
                let [
                    mut p0,
                    mut p1,
                    mut p2,
                    mut p3,
                    mut p4,
                    mut p5,
                    mut p6,
                    mut p7,
                    mut p8,
                    mut p9,
                    mut p10,
                    mut p11,
                    mut p12,
                    mut p13,
                    mut p14,
                    mut p15,
                    mut p16,
                    mut p17,
                    mut p18,
                    mut p19,
                    mut p20,
                    mut p21,
                    mut p22,
                    mut p23,
                    mut p24,
                    mut p25,
                    mut p26,
                    mut p27,
                    mut p28,
                    mut p29,
                    mut p30,
                    mut p31,
                ] = payload.0;
                let ray = &call.ray;
                // Registers of words the payload does not have are declared in the block and never read. No brace stands alone on
                // a line: to who reads the PTX, that is the end of an entry.
                macro_rules! arm {
                    ($count:expr, [$($used:ident)*] [$($unused:ident)*]) => {
                        if $count == count!($($used)*) {
                            // SAFETY: the caller's context may trace; the ray type gives matching type, offset, stride and index.
                            unsafe {
                                asm!(
                                    "{{",
                                    ".reg .f32 f<9>; .reg .b32 none;",
                                    "mov.b32 f0, {ox}; mov.b32 f1, {oy}; mov.b32 f2, {oz};",
                                    "mov.b32 f3, {dx}; mov.b32 f4, {dy}; mov.b32 f5, {dz};",
                                    "mov.b32 f6, {tmin}; mov.b32 f7, {tmax}; mov.b32 f8, {time};",
                                    "mov.b32 none, 0;",
                                    concat!(
                                        "call (",
                                        arm!(@list [$($used)*] [$($unused)*]),
                                        "), _optix_trace_typed_32, ({ty}, {handle}, f0, f1, f2, f3, f4, f5, f6, f7, f8, ",
                                        "{mask}, {flags}, {offset}, {stride}, {miss}, {words}, ",
                                        arm!(@list [$($used)*] [$($unused)*]),
                                        "); }}"
                                    ),
                                    ty = in(reg32) call.payload_type,
                                    handle = in(reg64) call.traversable,
                                    ox = in(reg32) ray.origin.x,
                                    oy = in(reg32) ray.origin.y,
                                    oz = in(reg32) ray.origin.z,
                                    dx = in(reg32) ray.direction.x,
                                    dy = in(reg32) ray.direction.y,
                                    dz = in(reg32) ray.direction.z,
                                    tmin = in(reg32) ray.tmin,
                                    tmax = in(reg32) ray.tmax,
                                    time = in(reg32) ray.time,
                                    mask = in(reg32) ray.mask as u32,
                                    flags = in(reg32) ray.flags.bits(),
                                    offset = in(reg32) call.sbt_offset,
                                    stride = in(reg32) call.sbt_stride,
                                    miss = in(reg32) call.miss_index,
                                    words = in(reg32) $count as u32,
                                    $($used = inlateout(reg32) $used,)*
                                    options(nostack, preserves_flags)
                                )
                            };
                        }
                    };
                    (@list [] [$first:ident $($unused:ident)*]) => {
                        concat!("none" $(, arm!(@none $unused))*)
                    };
                    (@list [$first:ident $($used:ident)*] [$($unused:ident)*]) => {
                        concat!("{", stringify!($first), "}" $(, ", {", stringify!($used), "}")* $(, arm!(@none $unused))*)
                    };
                    (@none $unused:ident) => { ", none" };
                }
                by_count!(arm, call.payload_words, [] [
                    p0 p1 p2 p3 p4 p5 p6 p7 p8 p9 p10 p11 p12 p13 p14 p15
                    p16 p17 p18 p19 p20 p21 p22 p23 p24 p25 p26 p27 p28 p29 p30 p31
                ]);
                WordBuffer([
                    p0, p1, p2, p3, p4, p5, p6, p7, p8, p9, p10, p11, p12, p13, p14, p15, p16, p17, p18, p19, p20, p21, p22,
                    p23, p24, p25, p26, p27, p28, p29, p30, p31,
                ])
            }
            host {
                let mut payload = payload;
                // What comes back where no program ran is a value of every type.
                if end::goes_on() {
                    self.frame().executor.trace(call, &mut payload);
                    payload
                } else {
                    WordBuffer::ZERO
                }
            }
        }
    }
}
