//! The calls in a function, with the values of constant arguments.

use crate::constants::Constants;
use crate::statement::{Instruction, Statement, operands};

/// A call and what is known of its arguments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Call<'a> {
    /// The function's name, or the register with its address.
    pub function: &'a str,
    /// The operands that take the results.
    pub results: Vec<&'a str>,
    /// The arguments as they are written.
    pub arguments: Vec<&'a str>,
    /// The value of each argument that is a 32-bit constant on every path to the call.
    pub values: Vec<Option<u32>>,
}

/// The parts of a call instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parts<'a> {
    /// The function's name, or the register with its address.
    pub function: &'a str,
    /// The operands that take the results.
    pub results: Vec<&'a str>,
    /// The arguments.
    pub arguments: Vec<&'a str>,
}

impl<'a> Parts<'a> {
    /// The parts of `call (%r1), f, (%r2)`. `None` if it is another instruction.
    ///
    /// ```
    /// let call = optix_ptx::Instruction { guard: "", op: "call", operands: "(%r1), f, (%r2)" };
    /// assert_eq!(optix_ptx::Parts::of(&call).map(|parts| parts.function), Some("f"));
    /// ```
    pub fn of(instruction: &Instruction<'a>) -> Option<Self> {
        if instruction.name() != "call" {
            return None;
        }
        let list = |part: &'a str| {
            part.strip_prefix('(').and_then(|part| part.strip_suffix(')')).map(operands).unwrap_or_default()
        };
        let parts = operands(instruction.operands);
        let at = parts.iter().position(|part| !part.starts_with('('))?;
        let results = if at > 0 { list(parts[0]) } else { Vec::new() };
        let arguments = parts.get(at + 1).map(|part| list(part)).unwrap_or_default();
        Some(Self { function: parts[at], results, arguments })
    }
}

/// The calls in the order of the text.
pub(crate) fn calls<'a>(statements: &[Statement<'a>]) -> Vec<Call<'a>> {
    let parts = |(at, statement): (usize, &Statement<'a>)| match statement {
        Statement::Instruction(instruction) => Some((at, Parts::of(instruction)?)),
        _ => None,
    };
    let parts: Vec<_> = statements.iter().enumerate().filter_map(parts).collect();
    let wanted: Vec<_> = parts.iter().map(|(at, parts)| (*at, parts.arguments.as_slice())).collect();
    let values = Constants::new(statements).at(&wanted);
    let call = |((_, Parts { function, results, arguments }), values)| Call { function, results, arguments, values };
    parts.into_iter().zip(values).map(call).collect()
}
