//! The statements of a PTX function.
//!
//! Inline assembly is PTX like the rest, but written by people: several statements on a line, and blocks of its own.
//! So this goes by PTX's grammar, not by the compiler's layout.

/// An entry or a function with its body. Callables count as entries: OptiX leads to them.
#[derive(Clone, Debug)]
pub(crate) struct Body<'a> {
    pub name: &'a str,
    pub is_entry: bool,
    /// Whether the signature declares parameters.
    pub has_parameters: bool,
    /// From the name to the closing brace.
    pub text: &'a str,
    pub statements: Vec<Statement<'a>>,
}

/// One statement; blocks are dissolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Statement<'a> {
    Label(&'a str),
    /// `.reg .b32 %r<4>`
    Directive(&'a str),
    Instruction(Instruction<'a>),
}

/// `@%p1 mov.b32 %r1, 2`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Instruction<'a> {
    /// `%p1` or `!%p1`; empty if it is executed always.
    pub guard: &'a str,
    /// `mov.b32`
    pub op: &'a str,
    /// `%r1, 2`
    pub operands: &'a str,
}

impl Body<'_> {
    /// The bytes that it keeps in local memory, if any: `.local .align 4 .b8 __local_depot0[16]`.
    pub fn local_memory(&self) -> Option<usize> {
        let size = |statement: &Statement<'_>| match statement {
            Statement::Directive(directive) => {
                let (_, size) = directive.strip_prefix(".local")?.rsplit_once('[')?;
                size.trim_end_matches(']').parse::<usize>().ok()
            }
            _ => None,
        };
        self.statements.iter().filter_map(size).reduce(|a, b| a + b)
    }
}

/// The text without comments, and with a `;` behind each `.loc`, so that it is a directive like the others.
pub(crate) fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for line in text.lines() {
        let directive = line.split_whitespace().next();
        if directive == Some(".file") {
            continue; // of the module; its path may hold a `//`
        }
        let line = line.split_once("//").map_or(line, |(code, _)| code);
        plain.push_str(line);
        plain.push_str(if directive == Some(".loc") { ";\n" } else { "\n" });
    }
    plain
}

/// The functions with bodies in a [`plain`] text.
pub(crate) fn bodies(text: &str) -> Vec<Body<'_>> {
    let mut bodies = Vec::new();
    let mut rest = text;
    while let Some((at, is_entry)) = next_function(rest) {
        let signature = &rest[at..];
        // A declaration ends before any brace.
        let end = signature.find(['{', ';']).unwrap_or(signature.len());
        let (head, tail) = signature.split_at(end);
        rest = match tail.strip_prefix('{') {
            Some(tail) => {
                let (statements, rest) = statements(tail);
                let name = super::function_name(head);
                let is_entry = is_entry || super::is_callable(name);
                let parameters = head.rsplit_once('(').is_some_and(|(_, list)| list.contains(".param"));
                let text = &signature[..signature.len() - rest.len()];
                bodies.push(Body { name, is_entry, has_parameters: parameters, text, statements });
                rest
            }
            None => tail.get(1..).unwrap_or_default(),
        };
    }
    bodies
}

/// Where the text behind the next `.entry` or `.func` begins, and whether it is an entry.
fn next_function(text: &str) -> Option<(usize, bool)> {
    let find = |keyword: &str| text.find(keyword).map(|at| at + keyword.len());
    let (entry, function) = (find(".entry "), find(".func"));
    match (entry, function) {
        (Some(entry), Some(function)) if entry < function => Some((entry, true)),
        (Some(entry), None) => Some((entry, true)),
        (_, function) => function.map(|at| (at, false)),
    }
}

/// The statements up to the brace that closes the body, and the text behind it.
fn statements(text: &str) -> (Vec<Statement<'_>>, &str) {
    let mut statements = Vec::new();
    let (mut begin, mut depth, mut in_vector) = (0, 1, false);
    for (at, c) in text.char_indices() {
        let so_far = text[begin..at].trim();
        match c {
            // A brace within a statement is an operand's: `{%r1, %r2}`.
            '{' if !so_far.is_empty() => in_vector = true,
            '}' if in_vector => in_vector = false,
            '{' => {
                depth += 1;
                begin = at + 1;
            }
            '}' => {
                depth -= 1;
                begin = at + 1;
                if depth == 0 {
                    return (statements, &text[begin..]);
                }
            }
            ':' if is_identifier(so_far) => {
                statements.push(Statement::Label(so_far));
                begin = at + 1;
            }
            ';' => {
                statements.extend(statement(so_far));
                begin = at + 1;
            }
            _ => {}
        }
    }
    (statements, "")
}

fn statement(text: &str) -> Option<Statement<'_>> {
    if text.is_empty() {
        return None;
    }
    if text.starts_with('.') {
        return Some(Statement::Directive(text));
    }
    let (guard, text) = match text.strip_prefix('@') {
        Some(guarded) => guarded.split_once(char::is_whitespace).unwrap_or((guarded, "")),
        None => ("", text),
    };
    let text = text.trim();
    // nvcc leaves no space in `call(%r1),_optix_x,()`.
    let (op, operands) = text.split_at(text.find(|c: char| c.is_whitespace() || c == '(').unwrap_or(text.len()));
    Some(Statement::Instruction(Instruction { guard, op, operands: operands.trim() }))
}

fn is_identifier(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '$' | '%'))
}

/// The operands, split at the commas that are in no parentheses, braces or brackets.
pub(crate) fn operands(text: &str) -> Vec<&str> {
    let (mut parts, mut begin, mut depth) = (Vec::new(), 0, 0);
    for (at, c) in text.char_indices() {
        match c {
            '(' | '{' | '[' => depth += 1,
            ')' | '}' | ']' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(text[begin..at].trim());
                begin = at + 1;
            }
            _ => {}
        }
    }
    parts.push(text[begin..].trim());
    parts.retain(|part| !part.is_empty());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = ".version 6.3\n.extern .func (.param .b32 r) vprintf\n(\n.param .b64 a\n)\n;\n\
        .func  (.param .b32 func_retval0) slow(\n\t.param .b32 a\n)\n{\n\tret;\n}\n\
        // .globl x\n.visible .entry __raygen__a()\n{\n\t.reg .b32 %r<3>; // registers\n\t.loc 1 2 3\n\
        $L__BB0_1:\n\t@!%p1 ld.v2.b32 {%r1, %r2}, [%rd1];\n\t{ .reg .f32 f; mov.b32 f, %r1; }\n\tret;\n\n}\n";

    #[test]
    fn statements_are_found_in_blocks_too() {
        let text = plain(TEXT);
        let bodies = bodies(&text);
        let names: Vec<_> = bodies.iter().map(|body| (body.name, body.is_entry, body.has_parameters)).collect();
        assert_eq!(names, [("slow", false, true), ("__raygen__a", true, false)]);
        let instruction = |guard, op, operands| Statement::Instruction(Instruction { guard, op, operands });
        assert_eq!(
            bodies[1].statements,
            [
                Statement::Directive(".reg .b32 %r<3>"),
                Statement::Directive(".loc 1 2 3"),
                Statement::Label("$L__BB0_1"),
                instruction("!%p1", "ld.v2.b32", "{%r1, %r2}, [%rd1]"),
                Statement::Directive(".reg .f32 f"),
                instruction("", "mov.b32", "f, %r1"),
                instruction("", "ret", ""),
            ]
        );
    }

    #[test]
    fn nvcc_writes_calls_without_spaces() {
        let text = ".visible .entry a()\n{\ncall(%r1,%r2),_optix_x,(%r3);\n}\n";
        let Statement::Instruction(call) = bodies(text)[0].statements[0] else { panic!("a call") };
        assert_eq!((call.op, call.operands), ("call", "(%r1,%r2),_optix_x,(%r3)"));
    }

    #[test]
    fn operands_keep_what_belongs_together() {
        assert_eq!(operands("(%r1, none), _optix_x, ()"), ["(%r1, none)", "_optix_x", "()"]);
        assert_eq!(operands("{%r1, %r2}, [a+4]"), ["{%r1, %r2}", "[a+4]"]);
        assert_eq!(operands(""), [] as [&str; 0]);
    }
}
