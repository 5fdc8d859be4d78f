//! The statements of a function.

/// One statement. Blocks, which inline assembly has, are dissolved into their statements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statement<'a> {
    /// `$L__BB0_1`, without its colon.
    Label(&'a str),
    /// `.reg .b32 %r<4>`
    Directive(&'a str),
    /// Anything that is executed.
    Instruction(Instruction<'a>),
}

/// `@%p1 mov.b32 %r1, 2`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction<'a> {
    /// `%p1` or `!%p1`; empty if it is executed always.
    pub guard: &'a str,
    /// `mov.b32`
    pub op: &'a str,
    /// `%r1, 2`
    pub operands: &'a str,
}

impl Instruction<'_> {
    /// The operation's name up to the first dot: `mov`.
    pub fn name(&self) -> &str {
        self.op.split('.').next().unwrap_or_default()
    }
}

/// The statements of a body.
pub(crate) fn statements(text: &str) -> Vec<Statement<'_>> {
    let mut statements = Vec::new();
    // The position where the current statement began, if it has begun, and whether it may still be a label.
    let (mut begin, mut is_name, mut in_vector) = (None, true, false);
    for (at, c) in text.bytes().enumerate() {
        match (c, begin) {
            // A brace within a statement belongs to an operand, such as `{%r1, %r2}`.
            (b'{', Some(_)) => in_vector = true,
            (b'}', _) if in_vector => in_vector = false,
            (b'{' | b'}', _) => begin = None,
            (b':', Some(from)) if is_name => {
                statements.push(Statement::Label(&text[from..at]));
                begin = None;
            }
            // Such a directive ends at the end of its line.
            (b'\n', Some(from)) if text[from..].starts_with(".loc") => {
                statements.push(Statement::Directive(text[from..at].trim_end()));
                begin = None;
            }
            (b';', from) => {
                statements.extend(from.map(|from| statement(text[from..at].trim_end())));
                begin = None;
            }
            (c, None) if !c.is_ascii_whitespace() => (begin, is_name) = (Some(at), is_part(c)),
            (c, _) => is_name &= is_part(c),
        }
    }
    statements
}

fn statement(text: &str) -> Statement<'_> {
    if text.starts_with('.') {
        return Statement::Directive(text);
    }
    let (guard, text) = match text.strip_prefix('@') {
        Some(guarded) => guarded.split_once(char::is_whitespace).unwrap_or((guarded, "")),
        None => ("", text),
    };
    let text = text.trim();
    // nvcc writes no space in `call(%r1),_optix_x,()`.
    let (op, operands) = text.split_at(text.find(|c: char| c.is_whitespace() || c == '(').unwrap_or(text.len()));
    Statement::Instruction(Instruction { guard, op, operands: operands.trim() })
}

/// Whether the byte may be a part of a name.
fn is_part(c: u8) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, b'_' | b'$' | b'%')
}

/// Splits operands at the commas that are not inside of parentheses, braces or brackets.
///
/// ```
/// assert_eq!(optix_ptx::operands("{%r1, %r2}, [a+4]"), ["{%r1, %r2}", "[a+4]"]);
/// ```
pub fn operands(text: &str) -> Vec<&str> {
    let (mut parts, mut begin, mut depth) = (Vec::new(), 0, 0_i64);
    for (at, c) in text.bytes().enumerate() {
        match c {
            b'(' | b'{' | b'[' => depth += 1,
            b')' | b'}' | b']' => depth -= 1,
            b',' if depth == 0 => {
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

    #[test]
    fn statements_are_found_in_blocks_too() {
        let text = "\t.reg .b32 %r<3>;\n\t.loc 1 2 3\n$L__BB0_1:\n\t@!%p1 ld.v2.b32 {%r1, %r2}, [%rd1];\n\
            \t{ .reg .f32 f; mov.b32 f, %r1; }\n\tret;\n\n";
        let instruction = |guard, op, operands| Statement::Instruction(Instruction { guard, op, operands });
        assert_eq!(
            statements(text),
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
        let Statement::Instruction(call) = statements("\ncall(%r1,%r2),_optix_x,(%r3);\n")[0] else { panic!("a call") };
        assert_eq!((call.op, call.operands), ("call", "(%r1,%r2),_optix_x,(%r3)"));
    }

    #[test]
    fn operands_keep_what_belongs_together() {
        assert_eq!(operands("(%r1, none), _optix_x, ()"), ["(%r1, none)", "_optix_x", "()"]);
        assert_eq!(operands(""), [] as [&str; 0]);
    }
}
