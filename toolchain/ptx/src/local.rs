//! Atomics on local memory.
//!
//! PTX leaves undefined what `atom` and `red` do with local memory. Their address is in a register, so its origin is
//! followed: from the variables of local memory through copies, conversions and sums, through local memory itself
//! (where `black_box`, for example, stores them), and through the parameters of functions.

use std::collections::{BTreeSet, HashMap};

use crate::calls::Parts;
use crate::module::{Function, Module};
use crate::statement::{Instruction, Statement, operands};

/// The most passes until nothing changes. Code that a compiler wrote needs fewer.
const MOST_PASSES: usize = 64;

/// The instructions `atom` and `red` whose address may be one of local memory, each with the function that it is in.
///
/// ```
/// let text = ".entry x()\n{\n.local .b8 __local_depot0[4];\nmov.b64 %rd1, __local_depot0;\ncvta.local.u64 %rd2, %rd1;\n\
///             atom.add.u32 %r1, [%rd2], 1;\n}\n";
/// let module = optix_ptx::Module::read(text);
/// assert_eq!(optix_ptx::local_atomics(&module)[0].1.op, "atom.add.u32");
/// ```
pub fn local_atomics<'m, 'a>(module: &'m Module<'a>) -> Vec<(&'m Function<'a>, Instruction<'a>)> {
    // For each function, the parameters that may be such addresses.
    let mut parameters: HashMap<&'a str, BTreeSet<usize>> = HashMap::new();
    let functions: Vec<&Function<'a>> = module.defined().collect();
    let mut found = Vec::new();
    for _ in 0..MOST_PASSES {
        let mut changed = false;
        found.clear();
        for function in &functions {
            let empty = BTreeSet::new();
            let flow = Flow::of(function, parameters.get(function.name).unwrap_or(&empty));
            for (callee, position) in flow.passed {
                changed |= module.get(callee).is_some() && parameters.entry(callee).or_default().insert(position);
            }
            found.extend(flow.atomics.into_iter().map(|atomic| (*function, atomic)));
        }
        if !changed {
            break;
        }
    }
    found
}

/// What one function does with addresses of local memory.
struct Flow<'a> {
    atomics: Vec<Instruction<'a>>,
    /// The functions and parameters to which it passes one.
    passed: Vec<(&'a str, usize)>,
}

impl<'a> Flow<'a> {
    fn of(function: &Function<'a>, parameters: &BTreeSet<usize>) -> Self {
        let statements = function.statements();
        let mut local: BTreeSet<&str> = statements.iter().filter_map(variable).collect();
        if local.is_empty() && parameters.is_empty() {
            return Self { atomics: Vec::new(), passed: Vec::new() };
        }
        let offsets = offsets(statements);
        // The places in local memory that hold addresses of local memory. `None` stands for an unknown place.
        let mut kept: BTreeSet<Option<i64>> = BTreeSet::new();
        for _ in 0..MOST_PASSES {
            let before = (local.len(), kept.len());
            for statement in statements {
                let Statement::Instruction(instruction) = statement else { continue };
                if let Some(target) = derived(instruction, &local, function.name, parameters) {
                    local.insert(target);
                }
                for (register, slot) in slots(instruction, &local, &offsets) {
                    if instruction.name() == "st" && local.contains(register) {
                        kept.insert(slot);
                    } else if instruction.name() == "ld"
                        && (kept.contains(&slot) || kept.contains(&None) || slot.is_none() && !kept.is_empty())
                    {
                        local.insert(register);
                    }
                }
            }
            if (local.len(), kept.len()) == before {
                break;
            }
        }
        let (mut atomics, mut passed) = (Vec::new(), Vec::new());
        for statement in statements {
            let Statement::Instruction(instruction) = statement else { continue };
            if matches!(instruction.name(), "atom" | "red") {
                let address = operands(instruction.operands).into_iter().find(|operand| operand.starts_with('['));
                if address.is_some_and(|address| local.contains(base(address))) {
                    atomics.push(*instruction);
                }
            } else if let Some(Parts { function, arguments, .. }) = Parts::of(instruction) {
                let is_local = |(_, argument): &(usize, &&str)| local.contains(**argument);
                passed.extend(arguments.iter().enumerate().filter(is_local).map(|(at, _)| (function, at)));
            }
        }
        Self { atomics, passed }
    }
}

/// For each register that always points to one place in local memory, the offset of that place.
fn offsets<'a>(statements: &[Statement<'a>]) -> HashMap<&'a str, i64> {
    let mut offsets: HashMap<&str, i64> = statements.iter().filter_map(variable).map(|name| (name, 0)).collect();
    let mut changing: BTreeSet<&str> = BTreeSet::new();
    for statement in statements {
        let Statement::Instruction(instruction) = statement else { continue };
        let parts = operands(instruction.operands);
        let offset = match (instruction.name(), &parts[..]) {
            ("mov" | "cvta", [_, source]) => offsets.get(source).copied(),
            ("add", [_, source, sum]) => {
                let sum = sum.parse::<i64>().ok();
                offsets.get(source).and_then(|offset| offset.checked_add(sum?))
            }
            ("st" | "red" | "bra" | "call", _) | (_, []) => continue,
            _ => None,
        };
        let target = parts[0];
        match offset {
            Some(offset) if !changing.contains(target) && *offsets.entry(target).or_insert(offset) == offset => {}
            // There is another register of this name, or this one has other values too.
            _ => {
                changing.insert(target);
                offsets.remove(target);
            }
        }
    }
    offsets
}

/// The registers of 64 bits that an instruction loads from or stores to local memory, with the place.
fn slots<'a>(
    instruction: &Instruction<'a>,
    local: &BTreeSet<&str>,
    offsets: &HashMap<&str, i64>,
) -> Vec<(&'a str, Option<i64>)> {
    let is_wide = instruction.op.split('.').any(|part| matches!(part, "b64" | "u64" | "s64"));
    let parts = operands(instruction.operands);
    let [first, second] = parts[..] else { return Vec::new() };
    let (address, registers) = if instruction.name() == "st" { (first, second) } else { (second, first) };
    if !is_wide
        || !matches!(instruction.name(), "ld" | "st")
        || !local.contains(base(address))
        || instruction.op.contains(".param")
    {
        return Vec::new();
    }
    let sum = address.trim_matches(['[', ']']).strip_prefix(base(address)).unwrap_or_default().replace(['+', ' '], "");
    let sum = if sum.is_empty() { Some(0) } else { sum.parse::<i64>().ok() };
    let begin = offsets.get(base(address)).and_then(|offset| offset.checked_add(sum?));
    let registers = registers.trim_matches(['{', '}']).split(',').map(str::trim).zip(0..);
    registers.map(|(register, place)| (register, begin.and_then(|begin| begin.checked_add(8 * place)))).collect()
}

/// The name in `.local .align 4 .b8 name[4]`.
fn variable<'a>(statement: &Statement<'a>) -> Option<&'a str> {
    let Statement::Directive(directive) = statement else { return None };
    let rest = directive.strip_prefix(".local")?;
    let name = rest.split_whitespace().last()?;
    Some(name.split('[').next().unwrap_or(name))
}

/// What is in `[%rd1+4]` before the sum.
fn base(address: &str) -> &str {
    let inside = address.trim_start_matches('[').trim_end_matches(']');
    inside.split(['+', '-']).next().unwrap_or(inside).trim()
}

/// The address that an instruction computes from an address of local memory, if it is given one.
fn derived<'a>(
    instruction: &Instruction<'a>,
    local: &BTreeSet<&str>,
    function: &str,
    parameters: &BTreeSet<usize>,
) -> Option<&'a str> {
    let operands = operands(instruction.operands);
    let (target, sources) = operands.split_first()?;
    let is_local = |source: &&str| local.contains(*source);
    let is_wide = instruction.op.split('.').any(|part| matches!(part, "b64" | "u64" | "s64"));
    let is_derived = match instruction.name() {
        "mov" | "cvta" | "add" | "sub" | "and" | "or" => is_wide && sources.iter().any(is_local),
        "selp" => is_wide && sources.iter().take(2).any(is_local),
        // The factors are an index and a size.
        "mad" => sources.last().is_some_and(is_local),
        "shf" | "prmt" | "mul" => false,
        "ld" if instruction.op.starts_with("ld.param") => {
            let number = |name: &str| name.strip_prefix(function)?.strip_prefix("_param_")?.parse().ok();
            sources.first().and_then(|source| number(base(source))).is_some_and(|number| parameters.contains(&number))
        }
        "st" if instruction.op.starts_with("st.param") => {
            return sources.first().filter(|source| is_local(source)).map(|_| base(target));
        }
        _ => false,
    };
    is_derived.then_some(*target)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(body: &str, more: &str) -> Vec<String> {
        let text = format!(
            ".entry x(\n\t.param .u64 x_param_0\n)\n{{\n.local .align 4 .b8 \t__local_depot0[8];\nmov.b64 %SPL, __local_depot0;\n\
             cvta.local.u64 %SP, %SPL;\n{body}\nret;\n}}\n{more}"
        );
        let module = Module::read(&text);
        local_atomics(&module).iter().map(|(function, atomic)| format!("{}: {}", function.name, atomic.op)).collect()
    }

    #[test]
    fn addresses_are_followed() {
        for derivation in [
            "add.u64 %rd1, %SP, 4;",
            "mov.b64 %rd2, %SP; mov.b64 %rd1, %rd2;",
            "mad.wide.u32 %rd1, %r1, 4, %SP;",
            "selp.b64 %rd1, %rd9, %SP, %p1;",
            "bra $L_2; $L_1: mov.b64 %rd1, %rd3; bra $L_3; $L_2: add.s64 %rd3, %rd4, %SP; bra $L_1; $L_3:",
            "cvta.to.global.u64 %rd1, %SP;",
            "add.u64 %rd3, %SP, 8; add.u64 %rd4, %SPL, 16; st.local.b64 [%rd4+8], %rd3; ld.local.b64 %rd1, [%SPL+24];",
            "st.local.v2.b64 [%SPL], {%rd9, %SP}; ld.b64 %rd1, [%SP+8];",
            "st.local.b64 [%SPL], %SP; add.s64 %rd3, %SP, %rd5; ld.b64 %rd1, [%rd3];",
        ] {
            assert_eq!(
                found(&format!("{derivation} atom.add.u32 %r2, [%rd1+4], 1;"), ""),
                ["x: atom.add.u32"],
                "{derivation}"
            );
            assert_eq!(
                found(&format!("{derivation} @%p1 red.add.u32 [%rd1], 1;"), ""),
                ["x: red.add.u32"],
                "{derivation}"
            );
        }
    }

    #[test]
    fn addresses_pass_through_calls() {
        let callee = ".func f(\n\t.param .b64 f_param_0,\n\t.param .b64 f_param_1\n)\n{\nld.param.b64 %rd1, [f_param_1];\n\
                      atom.cas.b32 %r1, [%rd1], 0, 1;\nret;\n}\n";
        let call = |first: &str, second: &str| {
            format!("st.param.b64 [param0], {first}; st.param.b64 [param1], {second}; call.uni f, (param0, param1);")
        };
        assert_eq!(found(&call("%rd5", "%SP"), callee), ["f: atom.cas.b32"]);
        assert_eq!(found(&call("%SP", "%rd5"), callee), [""; 0]);
    }

    #[test]
    fn other_addresses_are_not() {
        for body in [
            "ld.param.u64 %rd1, [x_param_0]; atom.add.u32 %r1, [%rd1], 1;",
            "ld.local.b64 %rd1, [%SP]; ld.u64 %rd2, [%rd1]; atom.add.u32 %r1, [%rd2], 1;",
            "st.local.b64 [%SPL], %SP; st.local.b64 [%SPL+8], %rd9; ld.local.b64 %rd1, [%SPL+8]; atom.add.u32 %r1, [%rd1], 1;",
            "st.local.v2.b64 [%SPL], {%rd9, %SP}; ld.local.v2.b64 {%rd1, %rd2}, [%SPL]; atom.add.u32 %r1, [%rd1], 1;",
            "mul.lo.s64 %rd1, %SP, 2; sub.u64 %rd2, %rd3, %rd4; atom.add.u32 %r1, [%rd2], %r9;",
            "st.local.b32 [%SPL], %r1; ld.local.b32 %r2, [%SP]; red.global.add.u32 [%rd7+4], %r2;",
            "setp.eq.s64 %p1, %SP, %rd1; selp.b64 %rd2, %rd1, %rd3, %p1; atom.add.u32 %r1, [%rd2], 1;",
        ] {
            assert_eq!(found(body, ""), [""; 0], "{body}");
        }
    }
}
