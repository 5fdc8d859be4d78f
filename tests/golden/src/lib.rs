//! PTX in a form that can be compared: the instructions of an entry, without what the compiler numbers as it likes.

use std::collections::HashMap;

/// The entries of a PTX text, callables included: name and body, in the order of the text.
///
/// ```
/// let ptx = ".visible .entry __raygen__a()\n{\n\tret;\n\n}\n\
///            .visible .func  (.param .b32 func_retval0) __direct_callable__b(\n\t.param .b32 a\n)\n{\n\texit;\n\n}\n";
/// let expected = [("__raygen__a", "\n\tret;\n"), ("__direct_callable__b", "\n\texit;\n")];
/// assert_eq!(optix_golden_tests::entries(ptx), expected);
/// ```
pub fn entries(ptx: &str) -> Vec<(&str, &str)> {
    let entry = |text: &'_ str| -> Option<(usize, usize, usize, usize)> {
        let (open, close) = (text.find("\n{\n")?, text.find("\n}")?);
        let name = text[..open].find("__")?;
        Some((name, name + text[name..open].find('(')?, open + 2, close))
    };
    let is_entry = |text: &&str| text.starts_with("entry ") || text.starts_with("func ");
    let texts = ptx.split(".visible .").skip(1).filter(is_entry);
    texts
        .filter_map(|text| entry(text).map(|(name, end, begin, close)| (&text[name..end], &text[begin..close])))
        .collect()
}

/// The instructions and labels of a body in order, one per line. Registers and labels are numbered by their first
/// appearance, the parameters' variable is `params`, and declarations, comments, blocks and white space are left out.
///
/// ```
/// let body = "\t.reg .b32 %r<9>;\n\tld.const.b32 %r7, [frame+4]; // a field\n$L__BB3_2:\n\tadd.s32 \t%r8, %r7, %r7;\n";
/// let lines = optix_golden_tests::normalised(body, "frame");
/// assert_eq!(lines, ["ld.const.b32 %r0, [params+4]", "L0:", "add.s32 %r1, %r0, %r0"]);
/// ```
pub fn normalised(body: &str, params: &str) -> Vec<String> {
    let code: String =
        body.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n");
    let mut names = Names::default();
    let mut lines = Vec::new();
    for statement in code.split(';') {
        let mut words: Vec<&str> = statement.split_whitespace().collect();
        while let Some(word) = words.first() {
            if let Some(label) = word.strip_suffix(':') {
                lines.push(format!("{}:", names.of(label, "L")));
            } else if !matches!(*word, "{" | "}") {
                // A brace before a statement is of a block; those of operands are within one.
                break;
            }
            words.remove(0);
        }
        if words.first().is_some_and(|word| !word.starts_with('.')) {
            lines.push(names.replaced(&words.join(" "), params));
        }
    }
    lines
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

    #[test]
    fn layout_of_inline_assembly_does_not_matter() {
        let a = normalised("{ .reg .f32 f; call (f), x, (); mov.b32 %r9, f; }\n\tst.v2.b32 [%rd1], {%r9, %r9};", "p");
        let b =
            normalised("{\n.reg .f32 f;\ncall (f), x, ();\nmov.b32 %r1, f;\n}\n\tst.v2.b32 \t[%rd5], {%r1, %r1};", "p");
        assert_eq!(a, b);
        assert_eq!(a, ["call (f), x, ()", "mov.b32 %r0, f", "st.v2.b32 [%rd0], {%r0, %r0}"]);
    }

    #[test]
    fn other_registers_and_instructions_do_matter() {
        let lines = |text| normalised(text, "p");
        assert_ne!(lines("add.s32 %r1, %r2, %r3;"), lines("add.s32 %r1, %r2, %r2;"));
        assert_ne!(lines("add.s32 %r1, %r2, %r3;"), lines("sub.s32 %r1, %r2, %r3;"));
        assert_eq!(lines("@%p3 bra $L__BB1_2;\n$L__BB1_2:\n\tret;"), ["@%p0 bra L0", "L0:", "ret"]);
    }
}
