//! `llvm.vector.reduce.*`, which combine all elements of a vector into one value.

use super::builder::Builder;
use super::{floats, integers};
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Type, Typed};
use optix_llvm_ir::opcode::{Binary, IntPredicate};

pub(super) fn lower(builder: &mut Builder<'_>, op: &str, arguments: &[Typed]) -> Result<Typed, Unknown> {
    // Sums and products of floats start with an extra value before the vector, and go from left to right.
    let (first, vector) = match arguments {
        [first, vector] if matches!(op, "fadd" | "fmul") => (Some(first.clone()), vector),
        [vector] => (None, vector),
        _ => return Err(Unknown::new(format!("`vector.reduce.{op}` of {} arguments", arguments.len()))),
    };
    let Type::Vector(count, _) = vector.ty else {
        return Err(Unknown::new("a reduction of what is no vector"));
    };
    let mut all = first;
    for index in 0..count {
        let next = builder.extract(vector, index);
        all = Some(match all {
            None => next,
            Some(so_far) => combine(builder, op, &so_far, &next)?,
        });
    }
    all.ok_or_else(|| Unknown::new("a reduction of nothing"))
}

fn combine(builder: &mut Builder<'_>, op: &str, a: &Typed, b: &Typed) -> Result<Typed, Unknown> {
    let predicate = match op {
        "smax" => IntPredicate::Sgt,
        "smin" => IntPredicate::Slt,
        "umax" => IntPredicate::Ugt,
        "umin" => IntPredicate::Ult,
        "fmax" | "fmin" | "fmaximum" | "fminimum" => {
            let name = match op {
                "fmax" => "maxnum",
                "fmin" => "minnum",
                "fmaximum" => "maximum",
                _ => "minimum",
            };
            let unknown = || Err(Unknown::new(format!("`vector.reduce.{op}`")));
            return floats::function(builder, name, &[a.clone(), b.clone()]).unwrap_or_else(unknown);
        }
        op => {
            return match Binary::of(op) {
                Some(
                    op @ (Binary::Add
                    | Binary::Mul
                    | Binary::And
                    | Binary::Or
                    | Binary::Xor
                    | Binary::FAdd
                    | Binary::FMul),
                ) => Ok(builder.binary(op, a, b)),
                _ => Err(Unknown::new(format!("`vector.reduce.{op}`"))),
            };
        }
    };
    Ok(integers::least(builder, predicate, a, b))
}
