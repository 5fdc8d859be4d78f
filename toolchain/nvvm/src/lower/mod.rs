//! Lowers modern LLVM IR to the instructions of LLVM 7.
//!
//! An instruction that LLVM 7 does not know becomes several that it knows, in the same block. Pointers stay without a
//! pointee, since only the printer has to name pointees. What is not known here is refused.

mod atomics;
mod builder;
mod endless;
mod floats;
mod freeze;
mod integers;
mod intrinsics;
mod libdevice;
mod reduce;
mod stores;
mod widths;

use std::collections::{BTreeMap, HashSet};

use super::refusal::Refusal;
use builder::Builder;
pub(super) use builder::FRESH;
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Argument, Function, Instruction, Module, Op, Type, Typed, Value};
use optix_llvm_ir::opcode::Binary;

/// The functions that lowered code calls: name, result and parameters.
type Called = BTreeMap<String, (Type, Vec<Type>)>;

/// The value that replaces a lowered instruction's result. `None` if it has no result.
type Lowered = Result<Option<Typed>, Unknown>;

/// Lowers every function. `text` is the text that the module was read from. Returns whether the module needs libdevice.
pub(super) fn module(module: &mut Module, text: &str) -> Result<bool, Refusal> {
    let mut called = Called::new();
    let is_own = |function: &&Function| !function.blocks.is_empty();
    let own: HashSet<String> = module.functions.iter().filter(is_own).map(|function| function.name.clone()).collect();
    for function in &mut module.functions {
        self::function(function, &mut called, &own, text)?;
    }
    // Declarations of intrinsics of the newer LLVM go: their calls have been replaced, or use declarations that were
    // added.
    module.functions.retain(|function| {
        let replaced = function.name.starts_with("llvm.") || libdevice::of_symbol(&function.name).is_some();
        !function.blocks.is_empty() || !replaced
    });
    module.functions.iter_mut().for_each(widths::widen);
    module.functions.iter_mut().for_each(stores::join);
    let needs_libdevice = called.keys().any(|name| name.starts_with(libdevice::PREFIX));
    module
        .functions
        .extend(called.into_iter().map(|(name, (result, parameters))| declaration(name, result, parameters)));
    Ok(needs_libdevice)
}

fn declaration(name: String, result: Type, parameters: Vec<Type>) -> Function {
    let parameter =
        |ty| Argument { value: Typed::new(ty, Value::Undef), attributes: Vec::new(), by_value: None, align: None };
    Function {
        name,
        linkage: None,
        kernel: false,
        result,
        parameters: parameters.into_iter().map(parameter).collect(),
        variadic: false,
        attributes: vec!["nounwind".into()],
        debug: None,
        blocks: Vec::new(),
        line: 0,
    }
}

fn function(function: &mut Function, called: &mut Called, own: &HashSet<String>, text: &str) -> Result<(), Refusal> {
    let defined = freeze::defined(function);
    let mut builder = Builder::new(called, own, defined);
    for block in &mut function.blocks {
        for instruction in std::mem::take(&mut block.instructions) {
            builder.at(&instruction);
            lower(&mut builder, instruction)
                .map_err(|unknown| Refusal::of(unknown, text, builder.line, &function.name))?;
        }
        block.instructions = builder.take();
    }
    let renamed = builder.into_renamed();
    for instruction in function.blocks.iter_mut().flat_map(|block| &mut block.instructions) {
        let mut circle = false;
        instruction.op.values_mut(&mut |value| {
            // The replacement of a value may itself have been replaced. A value that is replaced by itself, over any
            // number of steps, comes from no real program.
            let mut steps = 0;
            while let Value::Local(name) = value
                && let Some(other) = renamed.get(name)
                && !circle
            {
                *value = other.clone();
                steps += 1;
                circle = steps > renamed.len();
            }
        });
        if circle {
            let unknown = Unknown::new("a value that is made of itself");
            return Err(Refusal::of(unknown, text, instruction.line, &function.name));
        }
    }
    endless::mark(function);
    Ok(())
}

/// Appends the instructions that this one becomes.
fn lower(builder: &mut Builder<'_>, mut instruction: Instruction) -> Result<(), Unknown> {
    floats::avoid_halves(builder, &mut instruction.op);
    let value = match &instruction.op {
        Op::Freeze { value } => freeze::lower(builder, value).map(Some),
        Op::Negate { value } => floats::negate(builder, value).map(Some),
        Op::Binary { op: Binary::FRem, a, b, .. } => {
            floats::remainder(builder, a, &Typed::new(a.ty.clone(), b.clone())).map(Some)
        }
        Op::Load { ty, pointer, ordering: Some(ordering), .. } => {
            atomics::load(builder, ty, pointer, ordering).map(Some)
        }
        Op::Store { value, pointer, ordering: Some(ordering), .. } => {
            atomics::store(builder, value, pointer, ordering).map(|()| None)
        }
        Op::ReadModifyWrite { op, pointer, value, ordering } => {
            atomics::read_modify_write(builder, *op, pointer, value, ordering).map(Some)
        }
        Op::CompareExchange { pointer, expected, new, ordering } => {
            atomics::compare_exchange(builder, pointer, expected, new, ordering).map(Some)
        }
        Op::Fence(ordering) => atomics::fence(builder, ordering).map(|()| None),
        Op::Call(call) => match call.name() {
            Some(name) if name.starts_with("llvm.") => intrinsics::lower(builder, call, name),
            Some(name) if libdevice::of_symbol(name).is_some() && !builder.is_own(name) => {
                libdevice::call_of_symbol(builder, call, name)
            }
            _ => {
                builder.keep(instruction);
                return Ok(());
            }
        },
        _ => {
            builder.keep(instruction);
            return Ok(());
        }
    }?;
    if let (Some(result), Some(value)) = (instruction.result, value) {
        builder.rename(result, value.value);
    }
    Ok(())
}
