//! Custom primitives: boxes, and a program that says what is in them.

use super::{LeafRay, Leaves, Primitives};
use crate::cpu::traversal::bvh::{Aabb, Bvh, SINGLE_LEAF};
use crate::cpu::traversal::candidate::HitSink;
use crate::cpu::traversal::flags::Verdict;
use crate::cpu::traversal::gas::Gas;
use crate::cpu::traversal::program::Reporter;
use crate::cpu::traversal::simd::Simd;
use crate::geometry::{BuildInput, CustomPrimitiveArray};

/// The boxes of a structure. A leaf's payload is the primitive, counted over all inputs.
#[derive(Debug)]
pub struct Custom {
    inputs: Vec<BuildInput<CustomPrimitiveArray>>,
}

impl Gas {
    /// The box, in object space, of the custom primitive with this reported index; see [`Gas::triangle_vertices`].
    pub fn custom_box(&self, sbt_gas_index: u32, primitive_index: u32) -> Option<Aabb> {
        let Primitives::Custom(custom) = &self.primitives else { return None };
        let (input, local) = self.locate(sbt_gas_index, primitive_index)?;
        custom.inputs[input].primitives().bounds().get(local).map(Aabb::from)
    }
}

impl Leaves for Custom {
    type Array = CustomPrimitiveArray;

    /// Each box is in a leaf of its own. Inverted ones are left out.
    fn build(inputs: Vec<BuildInput<CustomPrimitiveArray>>) -> (Bvh, Self) {
        let boxes: Vec<Aabb> =
            inputs.iter().flat_map(|input| input.primitives().bounds().iter().map(Aabb::from)).collect();
        (Bvh::build(&boxes, SINGLE_LEAF, |primitives| primitives[0]), Self { inputs })
    }

    fn memory_bytes(&self) -> usize {
        self.inputs.iter().map(|input| size_of_val(input.primitives().bounds())).sum()
    }

    /// Has the intersection program look at a primitive.
    #[inline(always)]
    fn visit<S: Simd>(&self, _: S, ray: &mut LeafRay<'_, '_>, primitive: u32, limit: f32) -> f32 {
        let HitSink { gas, context, path, ref mut state } = ray.sink;
        let record = gas.record_of(primitive);
        let sink = HitSink { gas, context, path, state };
        let verdict = sink.verdict(record);
        if verdict == Verdict::Cull {
            return limit;
        }
        let before = sink.state.tmax;
        let of_primitive = context.of_primitive(gas, path, primitive, record);
        ray.programs.intersect(&of_primitive, &mut Reporter { sink, primitive, record, verdict });
        ray.sink.state.limit(before, limit, &context.space.prepared)
    }

    /// Only a structure without boxes has no nodes.
    fn visit_all<S: Simd>(&self, _: S, _: &mut LeafRay<'_, '_>, _: f32) {}
}
