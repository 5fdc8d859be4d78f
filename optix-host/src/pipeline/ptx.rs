//! What the PTX of a shader crate says about its programs: entries, and which rays each traces.
//!
//! Only text that the compiler wrote is read here, so the form is known; what can't be read is reported as such.

use std::collections::{BTreeMap, BTreeSet};

/// One entry of a PTX text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PtxEntry<'a> {
    /// Its name.
    pub name: &'a str,
    /// From `.visible .entry` to its closing brace.
    pub text: &'a str,
    /// Where it begins.
    pub begin: usize,
}

/// The entries of a PTX text, in order.
///
/// ```
/// let ptx = ".version 7.8\n.visible .entry __raygen__a()\n{\n ret;\n}\n";
/// assert_eq!(optix_host::pipeline::ptx::entries(ptx)[0].name, "__raygen__a");
/// ```
pub fn entries(ptx: &str) -> Vec<PtxEntry<'_>> {
    const HEAD: &str = ".visible .entry ";
    let mut entries = Vec::new();
    let mut at = 0;
    while let Some(found) = ptx[at..].find(HEAD) {
        let begin = at + found;
        let name_begin = begin + HEAD.len();
        let name_end = ptx[name_begin..].find('(').map_or(ptx.len(), |n| name_begin + n);
        // Inline assembly opens braces of its own; the body's closing brace stands alone on its line.
        let end = ptx[name_end..].find("\n}").map_or(ptx.len(), |n| name_end + n + 2);
        entries.push(PtxEntry { name: ptx[name_begin..name_end].trim(), text: &ptx[begin..end], begin });
        at = end;
    }
    entries
}

/// The text without the entries that `keep` says no to.
pub fn without_entries(ptx: &str, keep: impl Fn(&str) -> bool) -> String {
    let mut result = String::with_capacity(ptx.len());
    let mut at = 0;
    for entry in entries(ptx) {
        if !keep(entry.name) {
            result.push_str(&ptx[at..entry.begin]);
            at = entry.begin + entry.text.len();
        }
    }
    result.push_str(&ptx[at..]);
    result
}

/// Which payload types an entry traces rays with: bits of `OptixPayloadTypeID`, which are ray types in a pipeline of ours.
///
/// Read from the register that is the first argument of each `_optix_trace_typed_32`; `None` where it is not a constant.
pub fn traced_types(entry: &PtxEntry<'_>) -> Option<BTreeSet<u32>> {
    let constants = constants(entry.text);
    let mut types = BTreeSet::new();
    for call in entry.text.split("_optix_trace_typed_32").skip(1) {
        let arguments = call.trim_start_matches(',').trim_start();
        let first = arguments.strip_prefix('(')?.split([',', ')']).next()?.trim();
        types.insert(match first.parse() {
            Ok(value) => value,
            Err(_) => *constants.get(first)?.as_ref()?,
        });
    }
    Some(types)
}

/// Registers that are set once, by a `mov` of a constant; `None` for those set otherwise as well.
fn constants(text: &str) -> BTreeMap<&str, Option<u32>> {
    let mut constants = BTreeMap::new();
    for statement in text.split([';', '\n']) {
        let mut words = statement.trim().splitn(2, [' ', '\t']);
        let (Some(op), Some(operands)) = (words.next(), words.next()) else { continue };
        let Some((target, source)) = operands.split_once(',') else { continue };
        let value = op.starts_with("mov.").then(|| source.trim().parse::<u32>().ok()).flatten();
        constants
            .entry(target.trim())
            .and_modify(|old| {
                if *old != value {
                    *old = None;
                }
            })
            .or_insert(value);
    }
    constants
}
