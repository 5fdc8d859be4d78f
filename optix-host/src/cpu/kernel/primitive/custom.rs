//! Custom primitives: boxes, and a program that says what is in them.

use super::Leaves;
use crate::cpu::kernel::aabb::Aabb;
use crate::cpu::kernel::bvh::Bvh;
use crate::cpu::kernel::candidate::Sink;
use crate::cpu::kernel::collapse::SINGLE_LEAF;
use crate::cpu::kernel::flags::Verdict;
use crate::cpu::kernel::program::Reporter;
use crate::cpu::kernel::simd::Simd;
use crate::cpu::kernel::trace::AtGas;
use crate::geometry::{BuildInput, CustomPrimitiveArray};

/// The boxes of a structure. A leaf's payload is the primitive, counted over all inputs.
#[derive(Debug)]
pub struct Custom {
    inputs: Vec<BuildInput<CustomPrimitiveArray>>,
}

impl Custom {
    /// A hierarchy over the boxes, each in a leaf of its own. Inverted ones are left out.
    pub fn build(inputs: Vec<BuildInput<CustomPrimitiveArray>>) -> (Bvh, Self) {
        let boxes: Vec<Aabb> =
            inputs.iter().flat_map(|input| input.primitives().bounds().iter().map(Aabb::from)).collect();
        (Bvh::build(&boxes, SINGLE_LEAF, |primitives| primitives[0]), Self { inputs })
    }

    /// A box of an input.
    pub fn get(&self, input: usize, local: usize) -> Option<Aabb> {
        self.inputs[input].primitives().bounds().get(local).map(Aabb::from)
    }

    /// Heap bytes.
    pub fn memory_bytes(&self) -> usize {
        self.inputs.iter().map(|input| size_of_val(input.primitives().bounds())).sum()
    }
}

impl Leaves for Custom {
    /// Has the intersection program look at a primitive.
    #[inline(always)]
    fn visit<S: Simd>(&self, _: S, ray: &mut AtGas<'_, '_>, primitive: u32, limit: f32) -> f32 {
        let Sink { gas, place, path, ref mut state } = ray.sink;
        let record = gas.record_of(primitive);
        let sink = Sink { gas, place, path, state };
        let verdict = sink.verdict(record);
        if verdict == Verdict::Cull {
            return limit;
        }
        let before = sink.state.tmax;
        let site = place.site(gas, path, primitive, record);
        ray.programs.intersect(&site, &mut Reporter { sink, primitive, record, verdict });
        ray.sink.state.limit(before, limit, &place.space.frame)
    }

    /// Only a structure without boxes has no nodes.
    fn visit_all<S: Simd>(&self, _: S, _: &mut AtGas<'_, '_>, _: f32) {}
}
