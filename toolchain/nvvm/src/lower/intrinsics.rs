//! Calls of `llvm.*`, which are kept, replaced, left out or refused.
//!
//! libNVVM takes an unknown intrinsic for a function that is defined elsewhere. So an intrinsic that is not known here
//! is refused.

use super::builder::{Builder, argument};
use super::{Lowered, floats, integers, libdevice, reduce};
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Argument, Call, Type, Typed, Value};
use optix_llvm_ir::opcode::{Binary, Cast, IntPredicate};

/// Intrinsics without a result that only tell the optimiser or a debugger something.
const LEFT_OUT: [&str; 7] = [
    "lifetime.start",
    "lifetime.end",
    "experimental.noalias.scope.decl",
    "donothing",
    "dbg.value",
    "dbg.declare",
    "prefetch",
];

/// Intrinsics that return their first argument, and only tell something about it.
const SAME: [&str; 5] =
    ["expect", "expect.with.probability", "ssa.copy", "launder.invariant.group", "strip.invariant.group"];

pub(super) fn lower(builder: &mut Builder<'_>, call: &Call, name: &str) -> Lowered {
    let arguments: Vec<Typed> = call.arguments.iter().map(|argument| argument.value.clone()).collect();
    let base = base(name);
    let arguments = &arguments[..];
    match (base, arguments) {
        (base, _) if LEFT_OUT.contains(&base) => Ok(None),
        (base, [first, ..]) if SAME.contains(&base) => Ok(Some(first.clone())),
        ("assume", [condition]) => {
            if condition.value.as_int() != Some(1) {
                builder.effect("llvm.assume", vec![argument(condition.clone())], vec!["nounwind".into()])?;
            }
            Ok(None)
        }
        ("trap" | "debugtrap" | "ubsantrap", _) => {
            let attributes = ["noreturn", "nounwind"].map(String::from).to_vec();
            builder.effect("llvm.trap", Vec::new(), attributes)?;
            Ok(None)
        }
        ("memcpy" | "memcpy.inline" | "memmove" | "memset" | "memset.inline", [_, _, _, _]) => {
            memory(builder, base.trim_end_matches(".inline"), &call.arguments)?;
            Ok(None)
        }
        ("ptrmask", [pointer, mask]) => {
            let address = builder.cast(Cast::PtrToInt, pointer, &mask.ty);
            let address = builder.binary(Binary::And, &address, mask);
            Ok(Some(builder.cast(Cast::IntToPtr, &address, &pointer.ty)))
        }
        (base, arguments) => {
            if let Some(op) = base.strip_prefix("vector.reduce.") {
                return reduce::lower(builder, op, arguments).map(Some);
            }
            if base.starts_with("nvvm.") {
                return builder.call(name, call);
            }
            elementwise(builder, base, arguments, &call.result).map(Some)
        }
    }
}

/// The operation in an intrinsic's name, such as `umax` in `llvm.umax.v4i32`, without the prefix and the types.
fn base(name: &str) -> &str {
    let mut base = name.strip_prefix("llvm.").unwrap_or(name);
    if base.starts_with("nvvm.") {
        return base;
    }
    while let Some((before, last)) = base.rsplit_once('.')
        && is_type(last)
    {
        base = before;
    }
    base
}

/// `i32`, `f32`, `p0` or `v4i32`
fn is_type(word: &str) -> bool {
    let word = match word.strip_prefix('v') {
        Some(vector) => vector.trim_start_matches(|c: char| c.is_ascii_digit()),
        None => word,
    };
    let digits = word.strip_prefix(['i', 'f', 'p']).unwrap_or_default();
    !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit())
}

/// Copies and fills.
fn memory(builder: &mut Builder<'_>, op: &str, arguments: &[Argument]) -> Result<(), Unknown> {
    let mut name = format!("llvm.{op}");
    for argument in &arguments[..3] {
        match argument.value.ty {
            Type::Pointer(space) => name.push_str(&format!(".p{space}")),
            Type::Int(bits @ (32 | 64)) => name.push_str(&format!(".i{bits}")),
            // The byte that a fill writes.
            Type::Int(8) => {}
            _ => return Err(Unknown::new(format!("`{op}` of {:?}", argument.value.ty))),
        }
    }
    let mut arguments = arguments.to_vec();
    arguments.iter_mut().for_each(|argument| argument.attributes.clear());
    builder.effect(&name, arguments, vec!["nounwind".into()])
}

/// An operation that is done to each element if the result is a vector.
fn elementwise(builder: &mut Builder<'_>, base: &str, arguments: &[Typed], result: &Type) -> Result<Typed, Unknown> {
    let Type::Vector(count, element) = result else {
        return scalar(builder, base, arguments, result);
    };
    let mut all = Typed::new(result.clone(), Value::Undef);
    for index in 0..*count {
        let of = |builder: &mut Builder<'_>, argument: &Typed| match argument.ty {
            Type::Vector(..) => builder.extract(argument, index),
            _ => argument.clone(),
        };
        let arguments: Vec<Typed> = arguments.iter().map(|argument| of(builder, argument)).collect();
        let one = scalar(builder, base, &arguments, element)?;
        all = builder.insert(&all, one, index);
    }
    Ok(all)
}

fn scalar(builder: &mut Builder<'_>, base: &str, arguments: &[Typed], result: &Type) -> Result<Typed, Unknown> {
    let unknown = || Err(Unknown::new(format!("the intrinsic `llvm.{base}`")));
    match (base, arguments) {
        ("smax", [a, b]) => Ok(integers::least(builder, IntPredicate::Sgt, a, b)),
        ("smin", [a, b]) => Ok(integers::least(builder, IntPredicate::Slt, a, b)),
        ("umax", [a, b]) => Ok(integers::least(builder, IntPredicate::Ugt, a, b)),
        ("umin", [a, b]) => Ok(integers::least(builder, IntPredicate::Ult, a, b)),
        ("abs", [a, _]) => Ok(integers::abs(builder, a)),
        ("scmp" | "ucmp", [a, b]) => Ok(integers::three_way(builder, base == "scmp", a, b, result)),
        ("fshl" | "fshr", [high, low, amount]) => integers::funnel(builder, base == "fshl", high, low, amount),
        ("ctpop" | "bswap" | "bitreverse", [a]) | ("ctlz" | "cttz", [a, _]) => {
            integers::bit_operation(builder, base, a)
        }
        ("fptosi.sat", [a]) => floats::to_integer(builder, true, a, result),
        ("fptoui.sat", [a]) => floats::to_integer(builder, false, a, result),
        ("is.fpclass", [a, mask]) => match mask.value.as_int().and_then(|mask| u32::try_from(mask).ok()) {
            Some(mask) => floats::is_class(builder, a, mask),
            None => unknown(),
        },
        ("powi" | "ldexp", [a, exponent]) if exponent.ty == Type::Int(32) => {
            let suffix = match a.ty {
                Type::Float => "f",
                Type::Double => "",
                _ => return unknown(),
            };
            builder.pure(&format!("{}{base}{suffix}", libdevice::PREFIX), result, &[a, exponent])
        }
        ("sincos", [a]) if matches!(a.ty, Type::Float | Type::Double) => {
            let sine = libdevice::call(builder, "sin", &[a])?;
            let cosine = libdevice::call(builder, "cos", &[a])?;
            Ok(builder.pair(&sine, &cosine))
        }
        (_, [a, b]) if base.ends_with(".with.overflow") || base.ends_with(".sat") => {
            let (what, kind) = base.split_once('.').unwrap_or((base, ""));
            let (signed, op) = match (what.strip_prefix('s'), what.strip_prefix('u')) {
                (Some(op), _) => (true, op),
                (_, Some(op)) => (false, op),
                _ => return unknown(),
            };
            match (kind, Binary::of(op)) {
                ("sat", Some(op @ (Binary::Add | Binary::Sub | Binary::Shl))) => {
                    integers::saturating(builder, signed, op, a, b)
                }
                ("with.overflow", Some(op @ (Binary::Add | Binary::Sub | Binary::Mul))) => {
                    integers::with_overflow(builder, signed, op, a, b)
                }
                _ => unknown(),
            }
        }
        (_, [_, ..]) => floats::function(builder, base, arguments).unwrap_or_else(unknown),
        _ => unknown(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lose_their_types() {
        assert_eq!(base("llvm.umax.v4i32"), "umax");
        assert_eq!(base("llvm.fptosi.sat.i32.f32"), "fptosi.sat");
        assert_eq!(base("llvm.memcpy.p0.p0.i64"), "memcpy");
        assert_eq!(base("llvm.vector.reduce.add.v4i32"), "vector.reduce.add");
        assert_eq!(base("llvm.experimental.noalias.scope.decl"), "experimental.noalias.scope.decl");
        assert_eq!(base("llvm.nvvm.f2i.rz"), "nvvm.f2i.rz");
    }
}
