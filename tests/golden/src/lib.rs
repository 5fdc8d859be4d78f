//! PTX in a form that can be compared: the instructions of an entry, without what the compiler numbers as it likes.

use std::collections::HashMap;

use optix_ptx::{Function, Statement};

/// The instructions and labels of a function in order, one per line. Registers and labels are numbered by their first
/// appearance, the parameters' variable is `params`, and declarations, comments, blocks and white space are left out.
///
/// ```
/// let text = ".entry x()\n{\n\t.reg .b32 %r<9>;\n\tld.const.b32 %r7, [frame+4];\n$L__BB3_2:\n\tadd.s32 \t%r8, %r7, %r7;\n}\n";
/// let module = optix_ptx::Module::read(text);
/// let lines = optix_golden_tests::normalised(&module.functions[0], "frame");
/// assert_eq!(lines, ["ld.const.b32 %r0, [params+4]", "L0:", "add.s32 %r1, %r0, %r0"]);
/// ```
pub fn normalised(function: &Function<'_>, params: &str) -> Vec<String> {
    let mut names = Names::default();
    let line = |statement: &Statement<'_>| match statement {
        Statement::Label(label) => Some(format!("{}:", names.of(label, "L"))),
        Statement::Directive(_) => None,
        Statement::Instruction(instruction) => {
            let guard = if instruction.guard.is_empty() { String::new() } else { format!("@{} ", instruction.guard) };
            let text = format!("{guard}{} {}", instruction.op, instruction.operands);
            let words: Vec<&str> = text.split_whitespace().collect();
            Some(names.replaced(&words.join(" "), params))
        }
    };
    function.statements().iter().filter_map(line).collect()
}

/// The instructions of [`normalised`] lines without order: sorted, each register by its class only, labels left out.
///
/// ```
/// let lines = ["ld.b32 %r0, [%rd0+4]", "L0:", "add.s32 %r1, %r0, 1"].map(String::from);
/// assert_eq!(optix_golden_tests::multiset(&lines), ["add.s32 %r, %r, 1", "ld.b32 %r, [%rd+4]"]);
/// ```
pub fn multiset(lines: &[String]) -> Vec<String> {
    let instructions = lines.iter().filter(|line| !line.ends_with(':'));
    let mut multiset: Vec<String> = instructions.map(|line| without_numbers(line)).collect();
    multiset.sort();
    multiset
}

fn without_numbers(line: &str) -> String {
    let mut result = String::new();
    let mut in_register = false;
    for c in line.chars() {
        in_register = c == '%' || in_register && c.is_ascii_alphanumeric();
        if !(in_register && c.is_ascii_digit()) {
            result.push(c);
        }
    }
    result
}

/// New names for registers and labels.
#[derive(Default)]
struct Names {
    new: HashMap<String, String>,
    counts: HashMap<String, usize>,
}

impl Names {
    fn of(&mut self, old: &str, class: &str) -> String {
        if let Some(new) = self.new.get(old) {
            return new.clone();
        }
        let count = self.counts.entry(class.to_string()).or_default();
        let new = format!("{class}{count}");
        *count += 1;
        self.new.insert(old.to_string(), new.clone());
        new
    }

    fn replaced(&mut self, statement: &str, params: &str) -> String {
        let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '$' | '%');
        let mut result = String::new();
        let mut rest = statement;
        while let Some(begin) = rest.find(is_part) {
            let end = rest[begin..].find(|c| !is_part(c)).map_or(rest.len(), |length| begin + length);
            let word = &rest[begin..end];
            result.push_str(&rest[..begin]);
            if word == params {
                result.push_str("params");
            } else if let Some((_, number)) = word.rsplit_once("_param_") {
                result.push_str("param");
                result.push_str(number);
            } else if word.starts_with("prototype_") {
                result.push_str(&self.of(word, "prototype"));
            } else if word.starts_with('$') {
                result.push_str(&self.of(word, "L"));
            } else if word.starts_with('%') {
                let class = word.trim_end_matches(|c: char| c.is_ascii_digit());
                result.push_str(&self.of(word, class));
            } else {
                result.push_str(word);
            }
            rest = &rest[end..];
        }
        result + rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(body: &str) -> Vec<String> {
        normalised(&optix_ptx::Module::read(&format!(".entry x()\n{{\n{body}\n}}\n")).functions[0], "p")
    }

    #[test]
    fn layout_of_inline_assembly_does_not_matter() {
        let a = lines("{ .reg .f32 f; call (f), x, (); mov.b32 %r9, f; }\n\tst.v2.b32 [%rd1], {%r9, %r9};");
        let b = lines("{\n.reg .f32 f;\ncall (f), x, ();\nmov.b32 %r1, f;\n}\n\tst.v2.b32 \t[%rd5], {%r1, %r1};");
        assert_eq!(a, b);
        assert_eq!(a, ["call (f), x, ()", "mov.b32 %r0, f", "st.v2.b32 [%rd0], {%r0, %r0}"]);
    }

    #[test]
    fn other_registers_and_instructions_do_matter() {
        assert_ne!(lines("add.s32 %r1, %r2, %r3;"), lines("add.s32 %r1, %r2, %r2;"));
        assert_ne!(lines("add.s32 %r1, %r2, %r3;"), lines("sub.s32 %r1, %r2, %r3;"));
        assert_eq!(lines("@%p3 bra $L__BB1_2;\n$L__BB1_2:\n\tret;"), ["@%p0 bra L0", "L0:", "ret"]);
    }
}
