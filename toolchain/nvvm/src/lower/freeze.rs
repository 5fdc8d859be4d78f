//! `freeze`: replaces an undefined value by any value, which is the same wherever it is used.
//!
//! LLVM 7 has nothing like it. A value that is known to be defined stays as it is. Any other passes through a `mov` in
//! inline assembly, which LLVM can't see through and the assembler removes.

use std::collections::HashSet;

use super::builder::Builder;
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Callee, Function, Instruction, Op, Type, Typed, Value};
use optix_llvm_ir::opcode::{Binary, Cast};

pub(super) fn lower(builder: &mut Builder<'_>, value: &Typed) -> Result<Typed, Unknown> {
    if is_defined(&value.value, &builder.defined) {
        return Ok(value.clone());
    }
    if let Type::Vector(count, _) = &value.ty {
        let mut frozen = Typed::new(value.ty.clone(), Value::Undef);
        for index in 0..*count {
            let element = builder.extract(value, index);
            let element = scalar(builder, &element)?;
            frozen = builder.insert(&frozen, element, index);
        }
        return Ok(frozen);
    }
    scalar(builder, value)
}

fn scalar(builder: &mut Builder<'_>, value: &Typed) -> Result<Typed, Unknown> {
    let moved = |builder: &mut Builder<'_>, value: &Typed| match value.ty.bits() {
        Some(32) => Ok(builder.asm("mov.b32 $0, $1;", "=r,r", &value.ty, &[value])),
        Some(64) => Ok(builder.asm("mov.b64 $0, $1;", "=l,l", &value.ty, &[value])),
        _ => Err(Unknown::new(format!("`freeze` of {:?}", value.ty))),
    };
    match value.ty {
        Type::Int(bits) if bits < 32 => {
            let wide = builder.cast(Cast::ZExt, value, &Type::Int(32));
            let wide = moved(builder, &wide)?;
            Ok(builder.cast(Cast::Trunc, &wide, &value.ty))
        }
        Type::Int(bits @ 33..64) => {
            let wide = builder.cast(Cast::ZExt, value, &Type::Int(64));
            let wide = moved(builder, &wide)?;
            Ok(builder.cast(Cast::Trunc, &wide, &Type::Int(bits)))
        }
        Type::Int(128) => {
            let half = Type::Int(64);
            let low = builder.cast(Cast::Trunc, value, &half);
            let low = moved(builder, &low)?;
            let high = builder.with(Binary::LShr, value, 64);
            let high = builder.cast(Cast::Trunc, &high, &half);
            let high = moved(builder, &high)?;
            let low = builder.cast(Cast::ZExt, &low, &value.ty);
            let high = builder.cast(Cast::ZExt, &high, &value.ty);
            let high = builder.with(Binary::Shl, &high, 64);
            Ok(builder.binary(Binary::Or, &high, &low))
        }
        Type::Half => {
            let bits = builder.cast(Cast::Bitcast, value, &Type::Int(16));
            let bits = scalar(builder, &bits)?;
            Ok(builder.cast(Cast::Bitcast, &bits, &Type::Half))
        }
        Type::Float | Type::Double => {
            let bits = Type::Int(value.ty.bits().unwrap_or(64));
            let frozen = builder.cast(Cast::Bitcast, value, &bits);
            let frozen = moved(builder, &frozen)?;
            Ok(builder.cast(Cast::Bitcast, &frozen, &value.ty))
        }
        _ => moved(builder, value),
    }
}

/// The local names whose values can't be undefined, as far as one pass over the function finds them.
pub(super) fn defined(function: &Function) -> HashSet<String> {
    let mut defined = HashSet::new();
    for parameter in &function.parameters {
        if let Value::Local(name) = &parameter.value.value
            && parameter.attributes.iter().any(|attribute| attribute == "noundef")
        {
            defined.insert(name.clone());
        }
    }
    for instruction in function.blocks.iter().flat_map(|block| &block.instructions) {
        if let Some(name) = &instruction.result
            && gives_defined(instruction, &defined)
        {
            defined.insert(name.clone());
        }
    }
    defined
}

fn is_defined(value: &Value, defined: &HashSet<String>) -> bool {
    match value {
        Value::Local(name) => defined.contains(name),
        Value::Number(_) | Value::Null | Value::Zero | Value::Global(_) => true,
        Value::Aggregate(elements) => elements.iter().all(|element| is_defined(&element.value, defined)),
        _ => false,
    }
}

fn gives_defined(instruction: &Instruction, defined: &HashSet<String>) -> bool {
    let is = |value: &Value| is_defined(value, defined);
    match &instruction.op {
        Op::Freeze { .. } => true,
        // The result of inline assembly is whatever a register holds, which is a value.
        Op::Call(call) => matches!(call.callee, Callee::Asm { .. }),
        Op::Load { .. } => instruction.metadata.iter().any(|(name, _)| name == "noundef"),
        Op::Binary { op, flags, a, b } if flags.is_empty() => {
            let operands = is(&a.value) && is(b);
            match op {
                Binary::Shl | Binary::LShr | Binary::AShr => {
                    let bits = a.ty.bits().unwrap_or(0);
                    operands && b.as_int().is_some_and(|amount| (0..i128::from(bits)).contains(&amount))
                }
                Binary::UDiv | Binary::SDiv | Binary::URem | Binary::SRem | Binary::FDiv | Binary::FRem => false,
                Binary::Add
                | Binary::Sub
                | Binary::Mul
                | Binary::And
                | Binary::Or
                | Binary::Xor
                | Binary::FAdd
                | Binary::FSub
                | Binary::FMul => operands,
            }
        }
        Op::Compare { flags, a, b, .. } if flags.is_empty() => is(&a.value) && is(b),
        Op::Negate { value } => is(&value.value),
        // If a float does not fit the integer, the result is undefined.
        Op::Cast { op, value, .. } => !matches!(op, Cast::FPToUI | Cast::FPToSI) && is(&value.value),
        Op::Select { condition, yes, no } => [condition, yes, no].iter().all(|operand| is(&operand.value)),
        Op::Phi { incoming, .. } => incoming.iter().all(|(value, _)| is(value)),
        Op::ExtractValue { aggregate, .. } => is(&aggregate.value),
        _ => false,
    }
}
