//! Loops without an end.
//!
//! LLVM 7 assumes that every loop without effects ends, but a Rust program may wait forever in `loop {}`. An empty
//! piece of inline assembly counts as an effect.

use std::collections::{HashMap, HashSet};

use super::builder::asm_call;
use optix_llvm_ir::model::{Function, Instruction, Op, Type};

/// Puts such an effect into each block from which the function's end can't be reached.
pub(super) fn mark(function: &mut Function) {
    let mut before: HashMap<&str, Vec<&str>> = HashMap::new();
    let mut waiting: Vec<&str> = Vec::new();
    for block in &function.blocks {
        let next = block.instructions.last().map(|last| last.op.successors()).unwrap_or_default();
        if next.is_empty() {
            waiting.push(&block.name);
        }
        for to in next {
            before.entry(to).or_default().push(&block.name);
        }
    }
    let mut ends: HashSet<String> = waiting.iter().map(|name| name.to_string()).collect();
    while let Some(name) = waiting.pop() {
        for from in before.get(name).into_iter().flatten() {
            if ends.insert(from.to_string()) {
                waiting.push(from);
            }
        }
    }
    for block in function.blocks.iter_mut().filter(|block| !ends.contains(&block.name)) {
        let at = block.instructions.len().saturating_sub(1);
        let op = Op::Call(asm_call("", "", &Type::Void, &[], true));
        block.instructions.insert(at, Instruction { result: None, op, metadata: Vec::new(), line: function.line });
    }
}
