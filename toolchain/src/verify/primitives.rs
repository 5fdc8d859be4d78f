//! Checks that only programs for triangles ask about triangles (guide 13.9).

use optix_ptx::Function;

use super::facts::Program;
use super::finding::{Finding, Rule};
use super::place;

/// Device functions that are undefined if the current hit is not on a triangle.
const OF_TRIANGLES: [&str; 2] = ["_optix_get_triangle_barycentrics", "_optix_get_triangle_vertex_data_current_hit"];

pub(super) fn check(function: &Function<'_>, program: &Program, item: &str, findings: &mut Vec<Finding>) {
    for call in function.calls().iter().filter(|call| program.custom && OF_TRIANGLES.contains(&call.function)) {
        let message = format!("calls `{}`, and its hits are of custom primitives", call.function);
        findings.push(Finding::error(Rule::Primitive, place(function, item), message));
    }
}
