//! The values that registers hold at a statement.
//!
//! Inline assembly takes constants in registers, and LLVM uses one register for a value in several places, also as the
//! first value of a loop variable. So it is not enough to look for registers that are set once. What a register holds
//! at a call is found by constant propagation over the control flow, for the few registers that are set to several
//! values.

use std::collections::HashMap;

use crate::flow::{Block, blocks, is_jump};
use crate::statement::{Statement, operands};

/// The most values (registers times blocks) that are followed. Beyond that, they count as unknown.
const MOST_VALUES: usize = 1 << 22;
/// The most passes over a function until values no longer change. Code needs two more than its loops are nested.
const MOST_PASSES: usize = 64;

/// What is known of a register's value at one place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Value {
    /// It is not set on any path to this place.
    Unset,
    Constant(u32),
    /// It has one of several values, or an unknown one.
    Unknown,
}

impl Value {
    fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Unset, value) | (value, Self::Unset) => value,
            (one, other) if one == other => one,
            _ => Self::Unknown,
        }
    }
}

/// Where a register's value comes from.
#[derive(Clone, Copy, Debug)]
enum Source {
    Constant(u32),
    /// Another register.
    Copy(usize),
    Other,
}

struct Assignment {
    /// The statement.
    at: usize,
    register: usize,
    source: Source,
}

/// The registers of a function, with what is assigned to them.
pub(crate) struct Constants<'s, 'a> {
    statements: &'s [Statement<'a>],
    registers: HashMap<&'a str, usize>,
    /// In the order of the text.
    assignments: Vec<Assignment>,
    /// For each register, its only value if it has just one, wherever it has a value.
    everywhere: Vec<Value>,
}

impl<'s, 'a> Constants<'s, 'a> {
    pub fn new(statements: &'s [Statement<'a>]) -> Self {
        let mut constants =
            Self { statements, registers: HashMap::new(), assignments: Vec::new(), everywhere: Vec::new() };
        for (at, statement) in statements.iter().enumerate() {
            constants.add(at, statement);
        }
        constants
    }

    fn register(&mut self, name: &'a str) -> usize {
        let next = self.everywhere.len();
        let register = *self.registers.entry(name).or_insert(next);
        if register == next {
            self.everywhere.push(Value::Unset);
        }
        register
    }

    /// Adds the assignments of a statement.
    fn add(&mut self, at: usize, statement: &Statement<'a>) {
        let Statement::Instruction(instruction) = statement else { return };
        let operands = operands(instruction.operands);
        let is_call = instruction.name() == "call";
        let is_target = |first: &&&str| !is_jump(instruction) && (!is_call || first.starts_with('('));
        let Some(targets) = operands.first().filter(is_target) else { return };
        let is_move = instruction.name() == "mov" && instruction.guard.is_empty();
        let source = match operands.get(1).filter(|_| is_move) {
            Some(source) => match number(source) {
                Some(number) => Source::Constant(number),
                None => Source::Copy(self.register(source)),
            },
            None => Source::Other,
        };
        // `%p1|%p2`, `{%r1, %r2}` and `(%r1, %r2)` name several registers.
        let targets = targets.split(['|', ',', '(', ')', '{', '}']).map(str::trim);
        for target in targets.filter(|target| !target.is_empty()) {
            let register = self.register(target);
            let value = if let Source::Constant(number) = source { Value::Constant(number) } else { Value::Unknown };
            self.everywhere[register] = self.everywhere[register].or(value);
            self.assignments.push(Assignment { at, register, source });
        }
    }

    /// The values of operands at statements, which are in the order of the text.
    pub fn at(&self, wanted: &[(usize, &[&'a str])]) -> Vec<Vec<Option<u32>>> {
        let state = State::new(self, wanted.iter().flat_map(|(_, operands)| operands.iter()));
        state.unwrap_or_else(|| State::nothing(self)).values(wanted)
    }
}

/// The values, at the beginning of each block, of registers whose value depends on the control flow.
struct State<'c, 's, 'a> {
    constants: &'c Constants<'s, 'a>,
    /// The index of each register among those that are followed.
    place: HashMap<usize, usize>,
    blocks: Vec<Block>,
    /// The values: all registers of the first block, then those of the next.
    values: Vec<Value>,
}

impl<'c, 's, 'a> State<'c, 's, 'a> {
    /// Follows no register.
    fn nothing(constants: &'c Constants<'s, 'a>) -> Self {
        let blocks = vec![Block { statements: 0..constants.statements.len(), next: Vec::new() }];
        Self { constants, place: HashMap::new(), blocks, values: Vec::new() }
    }

    /// Follows the registers that these operands depend on. `None` if that is too much work.
    fn new<'o>(constants: &'c Constants<'s, 'a>, operands: impl Iterator<Item = &'o &'a str>) -> Option<Self>
    where
        'a: 'o,
    {
        let place = followed(constants, operands);
        if place.is_empty() {
            return Some(Self::nothing(constants));
        }
        let blocks = blocks(constants.statements);
        if blocks.len().checked_mul(place.len())? > MOST_VALUES {
            return None;
        }
        let values = vec![Value::Unset; blocks.len() * place.len()];
        let mut state = Self { constants, place, blocks, values };
        let mut reached = vec![false; state.blocks.len()];
        if let Some(first) = reached.first_mut() {
            *first = true;
        }
        // A value only goes from unset to a constant to unknown, so this ends, but perhaps not soon.
        for _ in 0..MOST_PASSES {
            if !state.pass(&mut reached) {
                return Some(state);
            }
        }
        None
    }

    /// Passes the values on from each block to its successors. Returns whether that changed any.
    fn pass(&mut self, reached: &mut [bool]) -> bool {
        let width = self.place.len();
        let mut changed = false;
        for number in 0..self.blocks.len() {
            if !reached[number] {
                continue;
            }
            let block = &self.blocks[number];
            let mut values = self.values[number * width..][..width].to_vec();
            for assignment in self.assignments(block) {
                self.assign(assignment, &mut values);
            }
            for &next in &block.next {
                changed |= !std::mem::replace(&mut reached[next], true);
                for (old, new) in self.values[next * width..][..width].iter_mut().zip(&values) {
                    let both = old.or(*new);
                    changed |= both != *old;
                    *old = both;
                }
            }
        }
        changed
    }

    fn assignments(&self, block: &Block) -> &'c [Assignment] {
        let all = &self.constants.assignments;
        let from = |at: usize| all.partition_point(|assignment| assignment.at < at);
        &all[from(block.statements.start)..from(block.statements.end)]
    }

    fn assign(&self, assignment: &Assignment, values: &mut [Value]) {
        if let Some(&place) = self.place.get(&assignment.register) {
            values[place] = match assignment.source {
                Source::Constant(number) => Value::Constant(number),
                Source::Copy(register) => self.value(register, values),
                Source::Other => Value::Unknown,
            };
        }
    }

    fn value(&self, register: usize, values: &[Value]) -> Value {
        match (self.place.get(&register), self.constants.everywhere[register]) {
            (Some(&place), _) => values[place],
            // Nothing assigns special registers, such as `%laneid`, nor addresses of variables.
            (None, Value::Unset) => Value::Unknown,
            (None, value) => value,
        }
    }

    fn values(&self, wanted: &[(usize, &[&'a str])]) -> Vec<Vec<Option<u32>>> {
        let width = self.place.len();
        let mut found = Vec::new();
        let mut wanted = wanted.iter().peekable();
        for (number, block) in self.blocks.iter().enumerate() {
            let mut values =
                self.values.get(number * width..).unwrap_or_default().iter().take(width).copied().collect::<Vec<_>>();
            let mut assignments = self.assignments(block).iter().peekable();
            while let Some((at, operands)) = wanted.next_if(|(at, _)| block.statements.contains(at)) {
                while let Some(assignment) = assignments.next_if(|assignment| assignment.at < *at) {
                    self.assign(assignment, &mut values);
                }
                found.push(operands.iter().map(|operand| self.known(operand, &values)).collect());
            }
        }
        found
    }

    fn known(&self, operand: &str, values: &[Value]) -> Option<u32> {
        number(operand).or_else(|| match self.value(*self.constants.registers.get(operand)?, values) {
            Value::Constant(number) => Some(number),
            _ => None,
        })
    }
}

/// Numbers the registers that are followed: of the operands' registers, and those that are copied to them, the ones
/// that hold a constant at some places only.
fn followed<'o, 'a: 'o>(
    constants: &Constants<'_, 'a>,
    operands: impl Iterator<Item = &'o &'a str>,
) -> HashMap<usize, usize> {
    let mut sources: HashMap<usize, Vec<Source>> = HashMap::new();
    for Assignment { register, source, .. } in &constants.assignments {
        if constants.everywhere[*register] == Value::Unknown && !matches!(source, Source::Other) {
            sources.entry(*register).or_default().push(*source);
        }
    }
    let mut waiting: Vec<usize> = operands.filter_map(|operand| constants.registers.get(operand).copied()).collect();
    let mut followed = HashMap::new();
    while let Some(register) = waiting.pop() {
        let Some(sources) = sources.get(&register) else { continue };
        let next = followed.len();
        if *followed.entry(register).or_insert(next) == next {
            waiting.extend(sources.iter().filter_map(|source| match source {
                Source::Copy(source) => Some(source),
                _ => None,
            }));
        }
    }
    followed
}

/// Reads a number as PTX writes it, as 32 bits.
fn number(text: &str) -> Option<u32> {
    if let Some(bits) = text.strip_prefix("0f").or_else(|| text.strip_prefix("0x")) {
        return u32::from_str_radix(bits, 16).ok();
    }
    let number = text.parse::<i64>().ok()?;
    // A register of 32 bits has no sign.
    u32::try_from(number).ok().or_else(|| i32::try_from(number).ok().map(i32::cast_unsigned))
}

#[cfg(test)]
mod tests {
    use crate::Module;

    fn values(body: &str) -> Vec<Vec<Option<u32>>> {
        let text = format!(".entry x()\n{{\n{body}\n}}\n");
        Module::read(&text).functions[0].calls().iter().map(|call| call.values.clone()).collect()
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
    fn copies_that_go_round_are_followed() {
        let text = "mov.b32 %r1, 4; mov.b32 %r2, 4; $L_1: mov.b32 %r3, %r1; mov.b32 %r1, %r2; mov.b32 %r2, %r3; \
                    call f, (%r1, %r3); @%p1 bra $L_1;";
        assert_eq!(values(text), [[Some(4), Some(4)]]);
        assert_eq!(values(&text.replacen("%r2, 4", "%r2, 5", 1)), [[None, None]]);
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
