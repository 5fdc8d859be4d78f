//! Loads of launch parameters and of records.

use std::collections::HashSet;

use optix_ptx::{Function, Instruction, Statement, operands};

/// Load instructions and the bytes that they load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Loads {
    /// Instructions.
    pub count: usize,
    /// Bytes.
    pub bytes: usize,
}

impl Loads {
    /// Loads from constant memory, which holds only launch parameters.
    pub(super) fn of_parameters(function: &Function<'_>) -> Self {
        Self::of(function, |load| load.op.starts_with("ld.const."))
    }

    /// Loads through the record's pointer, and through addresses computed from it.
    pub(super) fn of_record(function: &Function<'_>) -> Self {
        let pointers = record_pointers(function);
        Self::of(function, |load| {
            let address = operands(load.operands).get(1).copied().unwrap_or_default();
            words(address).any(|register| pointers.contains(register))
        })
    }

    fn of(function: &Function<'_>, wanted: impl Fn(&Instruction<'_>) -> bool) -> Self {
        let mut loads = Self::default();
        for instruction in instructions(function) {
            if instruction.op.starts_with("ld") && wanted(instruction) {
                loads.count += 1;
                loads.bytes += bytes(instruction.op);
            }
        }
        loads
    }
}

fn instructions<'b, 'a>(function: &'b Function<'a>) -> impl Iterator<Item = &'b Instruction<'a>> {
    function.statements().iter().filter_map(|statement| match statement {
        Statement::Instruction(instruction) => Some(instruction),
        _ => None,
    })
}

/// The registers that may hold an address in the record: the result of the call that gives it, and what moves,
/// additions and conversions make of that.
fn record_pointers<'a>(function: &Function<'a>) -> HashSet<&'a str> {
    let mut pointers = HashSet::new();
    loop {
        let before = pointers.len();
        for instruction in instructions(function) {
            let operands = operands(instruction.operands);
            let Some((target, sources)) = operands.split_first() else { continue };
            let is_pointer = match instruction.op.split('.').next() {
                Some("call") => sources.first() == Some(&"_optix_get_sbt_data_ptr_64"),
                Some("mov" | "add" | "cvta" | "or" | "selp") => sources.iter().any(|source| pointers.contains(source)),
                _ => false,
            };
            if is_pointer {
                pointers.extend(words(target));
            }
        }
        if pointers.len() == before {
            return pointers;
        }
    }
}

/// The names in an operand: `[%rd1+4]`, `(%rd1)`.
fn words(operand: &str) -> impl Iterator<Item = &str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '$' | '%');
    operand.split(move |c| !is_part(c)).filter(|word| !word.is_empty())
}

/// The bytes of `ld.global.v2.b32`.
fn bytes(op: &str) -> usize {
    let mut parts = op.rsplit('.');
    let bits: usize = parts.next().and_then(|kind| kind.get(1..)?.parse().ok()).unwrap_or(0);
    let count = parts.find_map(|part| part.strip_prefix('v')?.parse::<usize>().ok()).unwrap_or(1);
    bits * count / 8
}
