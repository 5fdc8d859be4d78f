//! Trace calls: ray generation, closest-hit and miss programs (guide 13.2).

use super::{ClosestHit, Miss, RayGen};
use crate::machine::{Cx, TraceCall};
use crate::payload::{Part, Payload};
use crate::pipeline::HasRay;
use crate::ray::{Ray, Traversable};
use crate::words::WordBuffer;

#[inline(always)]
fn trace<P: HasRay<R>, R: Payload>(cx: &Cx, world: Traversable, ray: Ray, payload: R::FromCaller) -> R::AtCaller {
    let mut words = WordBuffer::ZERO;
    payload.store(&mut words);
    let call = TraceCall {
        payload_type: P::PAYLOAD_TYPE,
        payload_words: R::WORDS,
        traversable: world.to_raw(),
        ray,
        sbt_offset: <P as HasRay<R>>::INDEX,
        sbt_stride: P::RAY_TYPES,
        miss_index: <P as HasRay<R>>::INDEX,
        caller_writes: <R::FromCaller as Part>::MASK,
        caller_reads: <R::AtCaller as Part>::MASK,
    };
    R::AtCaller::load(&cx.trace(&call, words))
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
                trace::<P, R>(&self.cx, world, ray, payload)
            }
        }
    )*};
}
may_trace!(RayGen<P>, ClosestHit<P, A>, Miss<P>);
