//! Checks the variable of the launch parameters, and that they are read field by field.

use optix_ptx::{Function, Instruction, Module, Statement, Variable, operands};

use super::facts::{Field, Params, Pipeline};
use super::finding::{Finding, Rule};
use super::place;
/// The largest field that is loaded directly. For a larger one, the number of instructions is no longer worth it.
const LARGEST_DIRECT: usize = 128;

/// Checks that the variable is there once, with the struct's size and alignment.
pub(super) fn check(module: &Module<'_>, pipeline: &Pipeline, findings: &mut Vec<Finding>) {
    let params = &pipeline.params;
    let mut error = |message: String| {
        let item = format!("launch parameters `{}` of `{}`", params.name, pipeline.name);
        findings.push(Finding::error(Rule::ParamsSymbol, item, message));
    };
    let is_it = |variable: &&Variable<'_>| variable.space == "const" && variable.name == params.symbol;
    let declared: Vec<_> = module.variables.iter().filter(is_it).collect();
    match declared[..] {
        [] => error(format!("there is no constant-memory variable `{}`", params.symbol)),
        [one] => {
            let of = |number: Option<usize>| number.map_or("no".into(), |number| number.to_string());
            let size = one.count.filter(|_| one.kind == "b8");
            // A variable has at least one byte.
            if size != Some(params.size.max(1)) {
                error(format!("the PTX has {} bytes for them, the host {}", of(size), params.size));
            }
            if one.align != Some(params.align) {
                error(format!("the PTX aligns them to {} bytes, the host to {}", of(one.align), params.align));
            }
        }
        _ => error(format!("the variable `{}` is declared {} times", params.symbol, declared.len())),
    }
}

/// Checks that a function uses the variable only to load fields, directly.
pub(super) fn check_loads(
    function: &Function<'_>,
    pipeline: &Pipeline,
    others: &[&Pipeline],
    item: &str,
    findings: &mut Vec<Finding>,
) {
    for statement in function.statements() {
        let Statement::Instruction(instruction) = statement else { continue };
        if mentions(instruction.operands, &pipeline.params.symbol) {
            findings.extend(check_use(instruction, &pipeline.params, &place(function, item)));
        }
        for other in others.iter().filter(|other| mentions(instruction.operands, &other.params.symbol)) {
            findings.push(Finding::error(
                Rule::ParamsLoad,
                place(function, item),
                format!("uses the launch parameters `{}`, which are those of `{}`", other.params.name, other.name),
            ));
        }
    }
}

/// Whether the operands contain the symbol as a whole word.
fn mentions(operands: &str, symbol: &str) -> bool {
    operands.match_indices(symbol).any(|(at, _)| {
        let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '$' | '%');
        !operands[..at].ends_with(is_part) && !operands[at + symbol.len()..].starts_with(is_part)
    })
}

fn check_use(instruction: &Instruction<'_>, params: &Params, item: &str) -> Option<Finding> {
    let Some((offset, width)) = load(instruction, &params.symbol) else {
        return Some(address_taken(params, item));
    };
    let error = |message: String| Some(Finding::error(Rule::ParamsLoad, item, message));
    let end = offset + width;
    let inside = |field: &&Field| field.offset <= offset && end <= field.offset + field.size;
    let Some(field) = params.fields.iter().find(inside) else {
        return error(format!(
            "loads bytes {offset}..{end} of `{}`, which are not inside of one field: {}",
            params.name,
            layout(params)
        ));
    };
    let name = format!("`{}::{}`", params.name, field.name);
    let is_vector = instruction.op.contains(".v");
    if field.bound && is_vector {
        return error(format!(
            "loads the bound field {name} with others by `{}`, so it can't be specialised",
            instruction.op
        ));
    }
    if (offset - field.offset) % width != 0 {
        return error(format!(
            "loads bytes {offset}..{end}, which are no element of the field {name} at {}..{}",
            field.offset,
            field.offset + field.size
        ));
    }
    // A field with this alignment can only be loaded byte by byte.
    (field.bound && width < field.size.min(4)).then(|| {
        let message = format!("loads the bound field {name} in pieces of {width} byte; a field of 4 bytes is one load");
        Finding::warning(Rule::ParamsLoad, item, message)
    })
}

/// Offset and width of `ld.const.b32 %r1, [symbol+8]`; none if it is something else.
fn load(instruction: &Instruction<'_>, symbol: &str) -> Option<(usize, usize)> {
    let kind = instruction.op.strip_prefix("ld.const.")?;
    let (count, kind) = match kind.split_once('.') {
        Some(("v2", kind)) => (2, kind),
        Some(("v4", kind)) => (4, kind),
        Some(_) => return None,
        None => (1, kind),
    };
    let bits: usize = kind.get(1..)?.parse().ok()?;
    let operands = operands(instruction.operands);
    let address = operands.get(1)?.strip_prefix('[')?.strip_suffix(']')?;
    let offset = address.strip_prefix(symbol)?.trim();
    let offset = if offset.is_empty() { 0 } else { offset.strip_prefix('+')?.trim().parse().ok()? };
    Some((offset, count * bits / 8))
}

fn address_taken(params: &Params, item: &str) -> Finding {
    let large: Vec<String> = params
        .fields
        .iter()
        .filter(|field| field.size > LARGEST_DIRECT)
        .map(|field| format!("`{}::{}` ({} bytes)", params.name, field.name, field.size))
        .collect();
    if large.is_empty() {
        let message = format!(
            "takes the address of the launch parameters `{}`, although no field is larger than {LARGEST_DIRECT} bytes",
            params.name
        );
        Finding::error(Rule::ParamsLoad, item, message)
    } else {
        let message = format!("reads {} through a pointer, so it can't be specialised", large.join(", "));
        Finding::warning(Rule::ParamsLoad, item, message)
    }
}

fn layout(params: &Params) -> String {
    let field = |field: &Field| format!("`{}` {}..{}", field.name, field.offset, field.offset + field.size);
    params.fields.iter().map(field).collect::<Vec<_>>().join(", ")
}
