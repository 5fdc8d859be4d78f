//! The control flow of a function.

use std::collections::HashMap;
use std::ops::Range;

use crate::statement::{Instruction, Statement, operands};

/// A block: statements that are always executed one after the other.
pub(crate) struct Block {
    /// The range of the statements.
    pub statements: Range<usize>,
    /// The blocks that may be executed next.
    pub next: Vec<usize>,
}

/// The blocks of a function in the order of the text; the first is executed first.
pub(crate) fn blocks(statements: &[Statement<'_>]) -> Vec<Block> {
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

    let ranges = || begins.windows(2).map(|range| range[0]..range[1]);
    let mut labels = HashMap::new();
    let mut tables = HashMap::new();
    for (number, range) in ranges().enumerate() {
        if let Some(Statement::Label(label)) = statements.get(range.start) {
            labels.insert(*label, number);
            if let Some(Statement::Directive(directive)) = statements.get(range.start + 1)
                && let Some(targets) = directive.strip_prefix(".branchtargets")
            {
                tables.insert(*label, operands(targets));
            }
        }
    }
    let next = |number: usize, last: &Statement<'_>| {
        let mut next = Vec::new();
        let mut falls_through = true;
        if let Statement::Instruction(jump) = last
            && is_jump(jump)
        {
            let operands = operands(jump.operands);
            match jump.name() {
                "bra" => next.extend(operands.first().and_then(|label| labels.get(label))),
                "brx" => {
                    let targets = operands.get(1).and_then(|table| tables.get(table));
                    next.extend(targets.into_iter().flatten().filter_map(|label| labels.get(label)));
                }
                _ => {}
            }
            falls_through = !jump.guard.is_empty();
        }
        next.extend((falls_through && number + 2 < begins.len()).then_some(number + 1));
        next
    };
    let block = |(number, range): (usize, Range<usize>)| Block {
        next: next(number, &statements[range.end - 1]),
        statements: range,
    };
    ranges().enumerate().map(block).collect()
}

/// Whether control may continue at another statement than the next one.
pub(crate) fn is_jump(instruction: &Instruction<'_>) -> bool {
    matches!(instruction.name(), "bra" | "brx" | "ret" | "exit")
}
