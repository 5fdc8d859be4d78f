//! The programs of `device_functions.tsv`: each kind of program calls what it may in a case that must compile, and what it may
//! not in a case of which every line must fail.

use std::fmt::Write;

/// A column of the table.
struct Kind {
    name: &'static str,
    /// Bound of the pipeline, context and result.
    signature: &'static str,
    /// The value that the program returns.
    result: &'static str,
}

const RAYS: &str = "P: HasRay<Shadow> + Throws<Fault>";

/// In the order of the table's second column.
const KINDS: [Kind; 8] = [
    Kind { name: "raygen", signature: "&RayGen<P>)", result: "" },
    Kind { name: "intersection", signature: "&Intersection<P, BallHit>)", result: "" },
    Kind { name: "anyhit", signature: "&AnyHit<P, Triangles>) -> Decision", result: "    Decision::Accept\n" },
    Kind { name: "closesthit", signature: "&ClosestHit<P, Triangles>)", result: "" },
    Kind { name: "miss", signature: "&Miss<P>)", result: "" },
    Kind { name: "exception", signature: "&Exception<P>)", result: "" },
    Kind { name: "direct_callable", signature: "&DirectCallable<P>)", result: "" },
    Kind { name: "continuation_callable", signature: "&ContinuationCallable<P>)", result: "" },
];

/// The contexts of the kinds, in this order.
pub fn contexts() -> [&'static str; 8] {
    KINDS.map(|kind| {
        let name = kind.signature.trim_start_matches('&');
        name.split('<').next().unwrap_or(name)
    })
}

/// What the programs refer to.
const DECLARATIONS: &str = "\
#[derive(Payload)]
pub struct Shadow {
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub uv: Vec2,
}

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost,
}

pub fn instances() -> Instances {
    unreachable!()
}

pub fn triangles() -> TriangleVertices {
    unreachable!()
}

pub fn direct() -> Callable<fn(u32) -> u32> {
    unreachable!()
}

pub fn continuation() -> Callable<fn(u32) -> u32, Continuation> {
    unreachable!()
}
";

/// A file of `ui`.
pub struct Program {
    pub text: String,
    /// Lines that must not compile.
    pub refused: Vec<usize>,
}

/// The calls that a kind of program may make, or may not; one that stands for several functions once.
fn calls(functions: &[Vec<String>], kind: usize, allowed: bool) -> Vec<&str> {
    let mut calls = Vec::new();
    for function in functions {
        let (mark, call) = (function[1].as_bytes()[kind] == b'1', function[2].as_str());
        if mark == allowed && !call.starts_with('(') && !calls.contains(&call) {
            calls.push(call);
        }
    }
    calls
}

fn function(kind: &Kind, calls: &[&str], indent: &str) -> String {
    let bound = if kind.name == "exception" { "P: HasRay<Shadow> + Pipeline<Exception = Fault>" } else { RAYS };
    let mut text = format!("{indent}#[{}]\n{indent}pub fn program<{bound}>(at: {} {{\n", kind.name, kind.signature);
    for call in calls {
        let _ = writeln!(text, "{indent}    let _ = {call};");
    }
    if !kind.result.is_empty() {
        let _ = write!(text, "{indent}{}", kind.result);
    }
    let _ = writeln!(text, "{indent}}}");
    text
}

/// The files, by name.
pub fn programs(functions: &[Vec<String>]) -> Vec<(String, Program)> {
    let mut pass = format!(
        "//! G005: every device function from every kind of program that may call it; made from `device_functions.tsv`.\n\
         #![deny(warnings)]\n\nuse optix_device_rs::callable::Continuation;\nuse optix_device_rs::prelude::*;\n\n{DECLARATIONS}"
    );
    let mut files = Vec::new();
    for (column, kind) in KINDS.iter().enumerate() {
        let name = format!("device_functions_in_{}", kind.name);
        let program = function(kind, &calls(functions, column, true), "    ");
        let _ = write!(pass, "\nmod {name} {{\n    use super::*;\n\n{program}}}\n");

        let refused = calls(functions, column, false);
        let text = format!(
            "// {}: {} program calls no function that is another's\n// Made from `device_functions.tsv`.\n\n\
             use optix_device_rs::callable::Continuation;\nuse optix_device_rs::prelude::*;\n\n{DECLARATIONS}\n{}\nfn main() {{}}\n",
            rules(kind),
            article(kind.name),
            function(kind, &refused, "")
        );
        let first = text.lines().position(|line| line.contains("pub fn program<")).map_or(0, |line| line + 2);
        let refused = (first..first + refused.len()).collect();
        files.push((format!("{name}.rs"), Program { text, refused }));
    }
    pass.push_str("\nfn main() {}\n");
    files.push(("pass/device_functions.rs".into(), Program { text: pass, refused: Vec::new() }));
    files
}

/// The rules of the checklist that the case of a kind covers.
fn rules(kind: &Kind) -> &'static str {
    match kind.name {
        "raygen" => "G005, G014, G029, G040",
        "intersection" => "G005, H007, I006",
        "anyhit" => "G005, G029, H007, I006",
        "closesthit" | "miss" => "G005, G029, G040",
        "exception" => "G005, I005, I006, I027",
        "direct_callable" => "G005, H007, I006, I008",
        _ => "G005",
    }
}

fn article(kind: &str) -> String {
    let article = if kind.starts_with(['a', 'e', 'i']) { "an" } else { "a" };
    format!("{article} {kind}")
}

/// The section of `docs/contracts.md`.
pub fn section(functions: &[Vec<String>]) -> String {
    let heads: Vec<_> = KINDS.iter().map(|kind| kind.name.replace('_', " ")).collect();
    let mut page = format!(
        "\n## Device functions\n\nWhich kinds of program may call which of OptiX's device functions (guide 13), and the call. Every one is \
         tried from every kind: in [device_functions](../tests/macros/ui/pass/device_functions.rs) where it is allowed, in \
         `device_functions_in_*` where it is not.\n\n| OptiX | call | {} |\n| --- | --- |{}\n",
        heads.join(" | "),
        " --- |".repeat(KINDS.len())
    );
    let mut missing: Vec<(&str, Vec<&str>)> = Vec::new();
    for function in functions {
        let (name, call) = (&function[0], &function[2]);
        if let Some(why) = call.strip_prefix('(') {
            let why = why.trim_end_matches(')');
            match missing.iter_mut().find(|(reason, _)| *reason == why) {
                Some((_, names)) => names.push(name),
                None => missing.push((why, vec![name])),
            }
            continue;
        }
        let marks: Vec<_> = function[1].chars().map(|mark| if mark == '1' { "yes" } else { "" }).collect();
        let _ = writeln!(page, "| `{name}` | `{}` | {} |", call.replace("|| ", ""), marks.join(" | "));
    }
    page.push_str("\nDevice functions without a call of their own:\n\n| why | OptiX |\n| --- | --- |\n");
    for (why, names) in missing {
        let names: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
        let _ = writeln!(page, "| {why} | {} |", names.join(", "));
    }
    page
}
