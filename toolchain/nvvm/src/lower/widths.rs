//! Widths of integers that functions take and return. libNVVM passes integers of 8, 16, 32, 64 and 128 bits only, while
//! rustc passes, for example, a struct of six bytes as `i48`.

use super::builder::FRESH;
use optix_llvm_ir::model::{Callee, Function, Instruction, Op, Type, Typed, Value};
use optix_llvm_ir::opcode::Cast;

/// The type that replaces one that can't be passed.
fn passed(ty: &Type) -> Option<Type> {
    let Type::Int(bits @ 2..=127) = ty else { return None };
    let wide = bits.next_power_of_two().max(8);
    (wide != *bits).then_some(Type::Int(wide))
}

/// Changes the function, and the calls in it, so that they pass only what can be passed.
pub(super) fn widen(function: &mut Function) {
    let mut fresh = (0..).map(|number| format!("{FRESH}w{number}"));
    let mut narrowed = Vec::new();
    for parameter in &mut function.parameters {
        let Some(wide) = passed(&parameter.value.ty) else { continue };
        let narrow = std::mem::replace(&mut parameter.value.ty, wide.clone());
        if let Value::Local(name) = &mut parameter.value.value {
            let name = std::mem::replace(name, fresh.next().unwrap_or_default());
            let value = Typed::new(wide, parameter.value.value.clone());
            narrowed.push(cast(Cast::Trunc, value, narrow, name, function.line, &[]));
        }
    }
    let result = passed(&function.result);
    if let Some(wide) = &result {
        function.result = wide.clone();
    }
    for (at, block) in function.blocks.iter_mut().enumerate() {
        let first = if at == 0 { std::mem::take(&mut narrowed) } else { Vec::new() };
        let old = std::mem::replace(&mut block.instructions, first);
        let out = &mut block.instructions;
        for mut instruction in old {
            let (line, metadata) = (instruction.line, instruction.metadata.clone());
            let mut extend = |value: &mut Typed, wide: Type, out: &mut Vec<Instruction>| {
                let name = fresh.next().unwrap_or_default();
                let narrow = std::mem::replace(value, Typed::new(wide.clone(), Value::Local(name.clone())));
                out.push(cast(Cast::ZExt, narrow, wide, name, line, &metadata));
            };
            let mut after = None;
            match &mut instruction.op {
                Op::Return(Some(value)) => {
                    if let Some(wide) = &result {
                        extend(value, wide.clone(), out);
                    }
                }
                Op::Call(call) if is_function(&call.callee) => {
                    for argument in &mut call.arguments {
                        if let Some(wide) = passed(&argument.value.ty) {
                            extend(&mut argument.value, wide, out);
                        }
                    }
                    if let Some(wide) = passed(&call.result) {
                        let narrow = std::mem::replace(&mut call.result, wide.clone());
                        if let Some(name) = instruction.result.take() {
                            let raw = fresh.next().unwrap_or_default();
                            instruction.result = Some(raw.clone());
                            let value = Typed::new(wide, Value::Local(raw));
                            after = Some(cast(Cast::Trunc, value, narrow, name, line, &metadata));
                        }
                    }
                }
                _ => {}
            }
            out.push(instruction);
            out.extend(after);
        }
    }
}

/// Whether the called function is or may be defined elsewhere. Intrinsics are not.
fn is_function(callee: &Callee) -> bool {
    match callee {
        Callee::Function(Value::Global(name)) => !name.starts_with("llvm."),
        Callee::Function(_) => true,
        Callee::Asm { .. } => false,
    }
}

fn cast(op: Cast, value: Typed, to: Type, name: String, line: usize, of: &[(String, String)]) -> Instruction {
    let metadata = of.iter().filter(|(name, _)| name == "dbg").cloned().collect();
    Instruction { result: Some(name), op: Op::Cast { op, value, to }, metadata, line }
}
