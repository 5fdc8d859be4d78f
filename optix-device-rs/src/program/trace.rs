//! Trace calls: ray generation, closest-hit and miss programs, continuation callables (guide 13.2).

use super::{ClosestHit, ContinuationCallable, Miss, RayGen};
use crate::machine::{Cx, TraceCall};
use crate::payload::{Part, Payload, TracedWithoutClosestHit, Transport};
use crate::pipeline::HasRay;
use crate::ray::{Ray, Traversable};

#[inline(always)]
fn trace<P: HasRay<R>, R: Payload>(
    cx: &Cx,
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
    unsafe { R::Transport::trace(cx, &call, payload) }
}

macro_rules! may_trace {
    ($($name:ident<P $(, $a:ident)?>),*) => {$(
        impl<P $(, $a)?> $name<P $(, $a)?> {
            /// Traces a ray of type `R` against `world`: gives what the caller writes of its payload, returns what the
            /// caller reads.
            ///
            /// SBT offset, stride, miss index and payload type follow from `R` and the pipeline.
            #[inline(always)]
            pub fn trace<R: Payload>(&self, world: Traversable, ray: Ray, payload: R::FromCaller) -> R::AtCaller
            where
                P: HasRay<R>,
            {
                trace::<P, R>(&self.cx, world, ray, true, payload)
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
                trace::<P, R>(&self.cx, world, ray, false, payload)
            }
        }
    )*};
}
may_trace!(RayGen<P>, ClosestHit<P, A>, Miss<P>, ContinuationCallable<P>);
