//! Joins stores to neighbouring places, such as those of a `Vec4`, to one store of a vector. LLVM's own code generator
//! does that, libNVVM does not.

use std::collections::HashMap;

use super::builder::FRESH;
use optix_llvm_ir::model::{Block, Function, Instruction, Op, Type, Typed, Value};

/// The most bytes that the machine stores at once.
const MOST_BYTES: u64 = 16;

/// The place of a store: a base address, and the distance from it in bytes.
type Place = (Value, i128);

/// Joins stores in each block, as long as no instruction between them prevents that.
pub(super) fn join(function: &mut Function) {
    let places = places(function);
    let mut fresh = (0..).map(|number| format!("{FRESH}v{number}"));
    for block in &mut function.blocks {
        let runs = runs(block, &places);
        for run in runs.into_iter().rev() {
            replace(block, &run, &mut fresh);
        }
    }
}

/// The values that are another value plus a constant number of bytes.
fn places(function: &Function) -> HashMap<String, Place> {
    let instructions = function.blocks.iter().flat_map(|block| &block.instructions);
    let place = |instruction: &Instruction| match &instruction.op {
        Op::Address { of: Type::Int(8), base, indices, .. } => match &indices[..] {
            [index] => Some((instruction.result.clone()?, (base.value.clone(), index.value.as_int()?))),
            _ => None,
        },
        _ => None,
    };
    instructions.filter_map(place).collect()
}

/// Groups of stores that can become one, by their indices in the block. The first store of each group has the lowest
/// address.
fn runs(block: &Block, places: &HashMap<String, Place>) -> Vec<Vec<usize>> {
    let mut runs = Vec::new();
    let mut run: Vec<usize> = Vec::new();
    let mut last: Option<(Place, &Type)> = None;
    for (at, instruction) in block.instructions.iter().enumerate() {
        match &instruction.op {
            Op::Store { value, pointer, volatile: false, ordering: None, .. } => {
                let place = match &pointer.value {
                    Value::Local(name) => places.get(name).cloned().unwrap_or((pointer.value.clone(), 0)),
                    value => (value.clone(), 0),
                };
                let follows = last.is_some_and(|((base, offset), ty)| {
                    base == place.0 && *ty == value.ty && offset + i128::from(bytes(ty)) == place.1
                });
                if !follows {
                    split(block, std::mem::take(&mut run), &mut runs);
                }
                run.push(at);
                last = Some((place, &value.ty));
            }
            op if is_apart(op) => {}
            _ => {
                split(block, std::mem::take(&mut run), &mut runs);
                last = None;
            }
        }
    }
    split(block, run, &mut runs);
    runs
}

/// Divides stores of neighbours into vectors that the machine can store, as far as the alignment is known to allow.
fn split(block: &Block, mut run: Vec<usize>, runs: &mut Vec<Vec<usize>>) {
    while let Some(first) = run.first() {
        let Op::Store { value, align, .. } = &block.instructions[*first].op else { return };
        let bytes = bytes(&value.ty);
        let fits = |count: &usize| {
            let all = *count as u64 * bytes;
            bytes > 0 && all <= MOST_BYTES && align.is_some_and(|align| align >= all) && *count <= run.len()
        };
        let count = [4, 2].into_iter().find(fits).unwrap_or(1);
        let rest = run.split_off(count);
        if count > 1 {
            runs.push(run);
        }
        run = rest;
    }
}

/// Puts the store of a vector in the place of the group's last store.
fn replace(block: &mut Block, run: &[usize], fresh: &mut impl Iterator<Item = String>) {
    let (Some(&first), Some(&last)) = (run.first(), run.last()) else { return };
    let Op::Store { value, pointer, align, .. } = block.instructions[first].op.clone() else { return };
    let ty = Type::Vector(run.len() as u64, Box::new(value.ty));
    let (metadata, line) = (block.instructions[last].metadata.clone(), block.instructions[last].line);
    let dbg: Vec<_> = metadata.iter().filter(|(name, _)| name == "dbg").cloned().collect();
    let mut vector = Typed::new(ty.clone(), Value::Undef);
    let mut made = Vec::new();
    for (index, at) in run.iter().enumerate() {
        let Op::Store { value, .. } = &block.instructions[*at].op else { return };
        let name = fresh.next().unwrap_or_default();
        let op = Op::InsertElement { vector, value: value.clone(), index: Typed::int(32, index as i128) };
        made.push(Instruction { result: Some(name.clone()), op, metadata: dbg.clone(), line });
        vector = Typed::new(ty.clone(), Value::Local(name));
    }
    let op = Op::Store { value: vector, pointer, align, volatile: false, ordering: None };
    made.push(Instruction { result: None, op, metadata: dbg, line });
    block.instructions.splice(last..=last, made);
    for at in run[..run.len() - 1].iter().rev() {
        block.instructions.remove(*at);
    }
}

/// The size of a type that vectors are made of here; 0 for other types.
fn bytes(ty: &Type) -> u64 {
    match ty {
        Type::Int(32) | Type::Float => 4,
        Type::Int(64) | Type::Double => 8,
        _ => 0,
    }
}

/// Whether a store may be moved across this instruction.
fn is_apart(op: &Op) -> bool {
    matches!(
        op,
        Op::Binary { .. }
            | Op::Negate { .. }
            | Op::Freeze { .. }
            | Op::Cast { .. }
            | Op::Compare { .. }
            | Op::Select { .. }
            | Op::Phi { .. }
            | Op::Address { .. }
            | Op::ExtractValue { .. }
            | Op::InsertValue { .. }
            | Op::ExtractElement { .. }
            | Op::InsertElement { .. }
            | Op::Shuffle { .. }
    )
}
