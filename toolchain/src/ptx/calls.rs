//! The calls in a PTX function, with the arguments that are constants.
//!
//! Inline assembly takes its constants in registers, and LLVM uses one register for one value in several places, among
//! them as the first value of a loop variable. So "set once" is not the question; what a register holds at a call is, and
//! constant propagation over the control flow answers it.

use std::collections::{BTreeMap, HashMap};

use super::body::{Body, Instruction, Statement, operands};

/// A call and what is known of its arguments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Call<'a> {
    pub function: &'a str,
    pub results: Vec<&'a str>,
    pub arguments: Vec<&'a str>,
    /// The value of each argument that is a constant.
    pub values: Vec<Option<u32>>,
}

/// What registers hold: a constant, or `None` for more than one value. A register that is not here holds nothing yet.
type State<'a> = HashMap<&'a str, Option<u32>>;

/// The calls of a function in the order of the text.
pub(crate) fn calls<'a>(body: &Body<'a>) -> Vec<Call<'a>> {
    let blocks = blocks(&body.statements);
    let mut states: Vec<Option<State<'a>>> = vec![None; blocks.len()];
    let mut waiting = Vec::new();
    if let Some(first) = states.first_mut() {
        *first = Some(State::new());
        waiting.push(0);
    }
    // Values only ever go from nothing to a constant to `None`, so this ends.
    while let Some(block) = waiting.pop() {
        let mut state = states[block].clone().unwrap_or_default();
        for statement in blocks[block].statements {
            execute(statement, &mut state);
        }
        for &next in &blocks[block].next {
            if merge(&mut states[next], &state) {
                waiting.push(next);
            }
        }
    }
    let mut calls = Vec::new();
    for (block, state) in blocks.iter().zip(states) {
        // A block that nothing leads to is looked at as well: no constants are known there.
        let mut state = state.unwrap_or_default();
        for statement in block.statements {
            if let Statement::Instruction(instruction) = statement {
                calls.extend(call(instruction, &state));
            }
            execute(statement, &mut state);
        }
    }
    calls
}

/// Statements that are executed one after the other.
struct Block<'s, 'a> {
    statements: &'s [Statement<'a>],
    next: Vec<usize>,
}

fn blocks<'s, 'a>(statements: &'s [Statement<'a>]) -> Vec<Block<'s, 'a>> {
    let mut begins = vec![0];
    for (i, statement) in statements.iter().enumerate() {
        match statement {
            Statement::Label(_) => begins.push(i),
            Statement::Instruction(instruction) if is_jump(instruction) => begins.push(i + 1),
            _ => {}
        }
    }
    begins.push(statements.len());
    begins.sort_unstable();
    begins.dedup();
    let ranges: Vec<_> = begins.windows(2).map(|range| &statements[range[0]..range[1]]).collect();

    let mut labels = BTreeMap::new();
    let mut tables = BTreeMap::new();
    for (number, range) in ranges.iter().enumerate() {
        if let Some(Statement::Label(label)) = range.first() {
            labels.insert(*label, number);
            if let Some(Statement::Directive(directive)) = range.get(1)
                && let Some(targets) = directive.strip_prefix(".branchtargets")
            {
                tables.insert(*label, operands(targets));
            }
        }
    }
    let next = |number: usize, range: &[Statement<'a>]| {
        let mut next = Vec::new();
        let mut falls_through = true;
        if let Some(Statement::Instruction(jump)) = range.last()
            && is_jump(jump)
        {
            let operands = operands(jump.operands);
            match jump.op.split('.').next() {
                Some("bra") => next.extend(operands.first().and_then(|label| labels.get(label))),
                Some("brx") => {
                    let targets = operands.get(1).and_then(|table| tables.get(table));
                    next.extend(targets.into_iter().flatten().filter_map(|label| labels.get(label)));
                }
                _ => {}
            }
            falls_through = !jump.guard.is_empty();
        }
        next.extend((falls_through && number + 1 < ranges.len()).then_some(number + 1));
        next
    };
    ranges.iter().enumerate().map(|(number, range)| Block { statements: range, next: next(number, range) }).collect()
}

fn is_jump(instruction: &Instruction<'_>) -> bool {
    matches!(instruction.op.split('.').next(), Some("bra" | "brx" | "ret" | "exit"))
}

fn execute<'a>(statement: &Statement<'a>, state: &mut State<'a>) {
    let Statement::Instruction(instruction) = statement else {
        return;
    };
    let operands = operands(instruction.operands);
    let is_call = instruction.op.starts_with("call");
    let Some(target) = operands.first().filter(|first| !is_jump(instruction) && (!is_call || first.starts_with('(')))
    else {
        return;
    };
    let is_move = instruction.op.starts_with("mov.") && instruction.guard.is_empty();
    let value = if is_move { operands.get(1).and_then(|source| value_of(source, state)) } else { None };
    // `%p1|%p2`, `{%r1, %r2}` and `(%r1, %r2)` are several.
    for register in target.split(['|', ',', '(', ')', '{', '}']).map(str::trim).filter(|register| !register.is_empty())
    {
        state.insert(register, value);
    }
}

fn value_of(operand: &str, state: &State<'_>) -> Option<u32> {
    if let Some(bits) = operand.strip_prefix("0f").or_else(|| operand.strip_prefix("0x")) {
        return u32::from_str_radix(bits, 16).ok();
    }
    match operand.parse::<i64>() {
        // A register of 32 bits has no sign.
        Ok(number) => u32::try_from(number).ok().or_else(|| i32::try_from(number).ok().map(i32::cast_unsigned)),
        Err(_) => state.get(operand).copied().flatten(),
    }
}

/// Adds what another way to the block brings; returns whether that changes anything.
fn merge<'a>(into: &mut Option<State<'a>>, from: &State<'a>) -> bool {
    let Some(into) = into else {
        *into = Some(from.clone());
        return true;
    };
    let mut changed = false;
    for (register, value) in from {
        match into.get_mut(register) {
            Some(old) if old == value || old.is_none() => {}
            Some(old) => {
                *old = None;
                changed = true;
            }
            None => {
                into.insert(register, *value);
                changed = true;
            }
        }
    }
    changed
}

fn call<'a>(instruction: &Instruction<'a>, state: &State<'a>) -> Option<Call<'a>> {
    let Parts { function, results, arguments } = parts(instruction)?;
    let values = arguments.iter().map(|argument| value_of(argument, state)).collect();
    Some(Call { function, results, arguments, values })
}

/// What is written in a call.
pub(crate) struct Parts<'a> {
    pub function: &'a str,
    pub results: Vec<&'a str>,
    pub arguments: Vec<&'a str>,
}

/// The parts of `call (%r1), f, (%r2)`; none if it is another instruction.
pub(crate) fn parts<'a>(instruction: &Instruction<'a>) -> Option<Parts<'a>> {
    if instruction.op.split('.').next() != Some("call") {
        return None;
    }
    let list = |part: &'a str| {
        part.strip_prefix('(').and_then(|part| part.strip_suffix(')')).map(operands).unwrap_or_default()
    };
    let parts = operands(instruction.operands);
    let at = parts.iter().position(|part| !part.starts_with('('))?;
    let results = if at > 0 { list(parts[0]) } else { Vec::new() };
    let arguments = parts.get(at + 1).map(|part| list(part)).unwrap_or_default();
    Some(Parts { function: parts[at], results, arguments })
}

/// The Rust path of a function. LLVM writes the dots of a symbol, which PTX does not allow, as `_$_`.
pub(crate) fn demangled(symbol: &str) -> String {
    format!("{:#}", rustc_demangle::demangle(&symbol.replace("_$_", ".")))
}

#[cfg(test)]
mod tests {
    use super::super::body::bodies;
    use super::*;

    fn values(body: &str) -> Vec<Vec<Option<u32>>> {
        let text = format!(".entry x()\n{{\n{body}\n}}\n");
        bodies(&text).iter().flat_map(calls).map(|call| call.values).collect()
    }

    #[test]
    fn constants_reach_calls() {
        assert_eq!(values("mov.b32 %r1, 7; call f, (%r1, 3, %r2, -1);"), [[Some(7), Some(3), None, Some(u32::MAX)]]);
        assert_eq!(
            values("mov.b32 %r1, 7; mov.b32 %r2, %r1; add.s32 %r1, %r1, 1; call f, (%r1, %r2);"),
            [[None, Some(7)]]
        );
        assert_eq!(values("mov.b32 %r1, 7; call (%r1), f, (%r1); call f, (%r1);"), [[Some(7)], [None]]);
    }

    #[test]
    fn a_loop_variable_is_a_constant_only_before_the_loop() {
        let text =
            "mov.b32 %r1, 0; call f, (%r1); $L_1: call g, (%r1); add.s32 %r1, %r1, 1; @%p1 bra $L_1; call h, (%r1);";
        assert_eq!(values(text), [[Some(0)], [None], [None]]);
    }

    #[test]
    fn branches_that_agree_keep_a_constant() {
        let both = |a, b| {
            format!(
                "@%p1 bra $L_1; mov.b32 %r1, {a}; bra.uni $L_2; $L_1: mov.b32 %r1, {b}; $L_2: call f, (%r1); ret; \
                 $L_3: .branchtargets $L_1, $L_2;"
            )
        };
        assert_eq!(values(&both(4, 4)), [[Some(4)]]);
        assert_eq!(values(&both(4, 5)), [[None]]);
    }

    #[test]
    fn tables_lead_to_all_their_labels() {
        let text = "mov.b32 %r1, 1; $L_t: .branchtargets $L_1, $L_2; brx.idx %r9, $L_t; $L_1: mov.b32 %r1, 2; \
                    $L_2: call f, (%r1);";
        assert_eq!(values(text), [[None]]);
    }
}
