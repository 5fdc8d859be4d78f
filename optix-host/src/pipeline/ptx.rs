//! What the PTX of a shader crate says about its programs: entries, and which rays each traces.
//!
//! Only text that the compiler wrote is read here, so the form is known; what can't be read is reported as such.

use std::collections::{BTreeMap, BTreeSet};

/// One entry of a PTX text: a program that OptiX starts, or a callable, which is a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PtxEntry<'a> {
    /// Its name.
    pub name: &'a str,
    /// From `.visible` to its closing brace.
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
    let mut entries = Vec::new();
    let mut at = 0;
    while let Some(found) = ptx[at..].find(".visible .") {
        let begin = at + found;
        at = begin + 1;
        // A declaration ends before any brace.
        let head_end = ptx[begin..].find(['{', ';']).map_or(ptx.len(), |end| begin + end);
        let name = if ptx[head_end..].starts_with('{') { entry_name(&ptx[begin..head_end]) } else { None };
        if let Some(name) = name {
            at = body_end(ptx, head_end);
            entries.push(PtxEntry { name, text: &ptx[begin..at], begin });
        }
    }
    entries
}

/// The name of the entry or callable with this head.
fn entry_name(head: &str) -> Option<&str> {
    if let Some(rest) = head.strip_prefix(".visible .entry ") {
        return Some(rest.split('(').next()?.trim());
    }
    let rest = head.strip_prefix(".visible .func")?.trim_start();
    // The result comes before the name.
    let rest = if rest.starts_with('(') { rest.split_once(')')?.1.trim_start() } else { rest };
    let is_callable = rest.starts_with("__direct_callable__") || rest.starts_with("__continuation_callable__");
    is_callable.then_some(rest.split('(').next()?.trim())
}

/// Behind the closing brace of the first block after `from`. Inline assembly opens blocks of its own inside.
fn body_end(ptx: &str, from: usize) -> usize {
    let mut depth = 0;
    for (at, brace) in ptx[from..].match_indices(['{', '}']) {
        depth += if brace == "{" { 1 } else { -1 };
        if depth == 0 {
            return from + at + 1;
        }
    }
    ptx.len()
}

/// The layout fingerprint that `#[launch_params]` put beside the parameter variable `symbol`; `None` where there is none.
pub fn layout_fingerprint(ptx: &str, symbol: &str) -> Option<u64> {
    let begin = ptx.find(&format!("{symbol}_layout = "))? + symbol.len() + "_layout = ".len();
    let number = ptx[begin..].split(';').next()?.trim();
    // A number above `i64::MAX` may be written as the negative one with the same bits.
    number.parse().ok().or_else(|| number.parse::<i64>().ok().map(i64::cast_unsigned))
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

#[cfg(test)]
mod tests {
    use super::*;

    const PTX: &str = "\
.visible .const .align 8 .b8 p[16];
.visible .global .align 8 .b64 p_layout = -2;

.visible .entry __raygen__a()
{
\tmov.b32 \t%r1, 2;
\tmov.b32 \t%r2, 1;
\tmov.b32 \t%r2, %r9;
\t{
\tcall (%r5), _optix_trace_typed_32, (%r1, %rd1, f0);
}
\t{
\tcall (%r5), _optix_trace_typed_32, (4, %rd1, f0);
}
\tret;
}
\t// .globl\t__miss__b
.visible .entry __miss__b()
{
\tcall (%r5), _optix_trace_typed_32, (%r2, %rd1, f0);
\tret;
}
.visible .func  (.param .b32 func_retval0) helper(
\t.param .b32 helper_param_0
)
;
.visible .func  (.param .align 4 .b8 func_retval0[12]) __direct_callable__c(
\t.param .b32 __direct_callable__c_param_0
)
{
\tret;
}
";

    #[test]
    fn entries_end_at_their_own_brace() {
        let found = entries(PTX);
        assert_eq!(
            found.iter().map(|e| e.name).collect::<Vec<_>>(),
            ["__raygen__a", "__miss__b", "__direct_callable__c"]
        );
        assert!(found[0].text.ends_with("ret;\n}"));
        let rest = without_entries(PTX, |name| name != "__raygen__a");
        let without_callable = without_entries(PTX, |name| !name.starts_with("__direct"));
        assert!(without_callable.trim_end().ends_with("helper_param_0\n)\n;"), "{without_callable}");
        assert!(rest.contains("p_layout") && rest.contains("__miss__b") && !rest.contains("__raygen__a()"));
    }

    #[test]
    fn libnvvm_writes_other_ptx() {
        let ptx = "//\n// Generated by NVIDIA NVVM Compiler\n//\n\n.version 9.0\n.target sm_75\n.address_size 64\n\n\n\
            .visible .const .align 8 .b8 p[16];\n.visible .global .align 8 .b64 p_layout = 12;\n\n\n\t// .globl\t__raygen__a\n\n\
            .visible .entry __raygen__a()\n{\n\t.reg .b32 \t%r<9>;\n\n\n\tmov.u32 \t%r4, 2;\n\t// begin inline asm\n\t{\n\
            call (%r5), _optix_trace_typed_32, (%r4, %rd1, f0);\n}\n\t// end inline asm\n\tret;\n\n}\n";
        let found = entries(ptx);
        assert_eq!(found.iter().map(|entry| entry.name).collect::<Vec<_>>(), ["__raygen__a"]);
        assert_eq!(traced_types(&found[0]), Some(BTreeSet::from([2])));
        assert_eq!(layout_fingerprint(ptx, "p"), Some(12));
    }

    #[test]
    fn traced_types_are_constants_or_unknown() {
        let found = entries(PTX);
        assert_eq!(traced_types(&found[0]), Some(BTreeSet::from([2, 4])));
        assert_eq!(traced_types(&found[1]), None);
    }

    #[test]
    fn fingerprints_are_read_with_either_sign() {
        assert_eq!(layout_fingerprint(PTX, "p"), Some(u64::MAX - 1));
        assert_eq!(layout_fingerprint(PTX, "q"), None);
    }
}
