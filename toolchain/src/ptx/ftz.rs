//! Flushing subnormal numbers to zero.
//!
//! LLVM chooses `.ftz` by an attribute of each function, and `rustc` has no option for that. So `.ftz` is added to the
//! instructions. Inline assembly stays as its author wrote it.

/// The text with `.ftz` added to every `f32` instruction that can have it.
pub(crate) fn flushed(text: &str) -> String {
    let mut flushed = String::with_capacity(text.len() + text.len() / 32);
    let mut in_asm = false;
    for line in text.lines() {
        match line.trim() {
            "// begin inline asm" => in_asm = true,
            "// end inline asm" => in_asm = false,
            _ => {}
        }
        // `@%p1 add.f32 %r1, ..`
        let code = line.trim_start();
        let guard = if code.starts_with('@') { code.find(char::is_whitespace).unwrap_or(0) } else { 0 };
        let begin = line.len() - code[guard..].trim_start().len();
        let op = line[begin..].split_whitespace().next().unwrap_or_default();
        match place(op).filter(|_| !in_asm) {
            Some(at) => {
                let (before, after) = line.split_at(begin + at);
                flushed.extend([before, ".ftz", after, "\n"]);
            }
            None => flushed.extend([line, "\n"]),
        }
    }
    flushed
}

/// The position of `.ftz` in an instruction's name, if the instruction can have it.
fn place(op: &str) -> Option<usize> {
    const TAKE_IT: [&str; 18] = [
        "abs", "add", "cos", "div", "ex2", "fma", "lg2", "max", "min", "mul", "neg", "rcp", "rsqrt", "set", "setp",
        "sin", "sqrt", "sub",
    ];
    let name = op.split('.').next()?;
    let mut types = op.match_indices('.').filter(|(at, _)| is_type(&op[at + 1..]));
    let (first, _) = types.next()?;
    let is = |kind: &str, at: usize| op[at + 1..].split('.').next() == Some(kind);
    let takes = match name {
        // A conversion from an integer or to an `f64` meets no subnormal `f32`.
        "cvt" => types.next().is_some_and(|(from, _)| is("f32", from) || is("f64", from) && is("f32", first)),
        _ => TAKE_IT.contains(&name) && is("f32", first),
    };
    let modifiers = [".sat", ".NaN", ".xorsign"];
    let before = modifiers.iter().filter_map(|modifier| op.find(modifier)).min().unwrap_or(first).min(first);
    (takes && !op.contains(".ftz")).then_some(before)
}

/// Whether it starts with a type: `f32`, `s32`, `b16`.
fn is_type(text: &str) -> bool {
    let kind = text.split('.').next().unwrap_or_default();
    matches!(kind.get(..1), Some("f" | "s" | "u" | "b")) && kind[1..].parse::<u32>().is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_goes_where_ptx_wants_it() {
        for (plain, wanted) in [
            ("\tfma.rn.f32 \t%r1, %r2, %r3, %r4;", "\tfma.rn.ftz.f32 \t%r1, %r2, %r3, %r4;"),
            ("@%p1 add.sat.f32 %r1, %r2, %r3;", "@%p1 add.ftz.sat.f32 %r1, %r2, %r3;"),
            ("\tmin.NaN.f32 %r1, %r2, %r3;", "\tmin.ftz.NaN.f32 %r1, %r2, %r3;"),
            ("\tsetp.lt.f32 %p1, %r2, %r3;", "\tsetp.lt.ftz.f32 %p1, %r2, %r3;"),
            ("\tcvt.rzi.s32.f32 %r1, %r2;", "\tcvt.rzi.ftz.s32.f32 %r1, %r2;"),
            ("\tcvt.rn.f32.f64 %r1, %rd2;", "\tcvt.rn.ftz.f32.f64 %r1, %rd2;"),
        ] {
            assert_eq!(flushed(plain), format!("{wanted}\n"));
        }
    }

    #[test]
    fn what_does_not_take_it_stays() {
        let text = "\tcvt.rn.f32.s32 %r1, %r2;\n\tadd.f64 %rd1, %rd2, %rd3;\n\tselp.f32 %r1, %r2, %r3, %p1;\n\
            \tmov.b32 %r1, 0f3F800000;\n\t// begin inline asm\n\tadd.f32 f, f, f;\n\t// end inline asm\n\tld.global.f32 %f1, [%rd1];\n";
        assert_eq!(flushed(text), text);
    }
}
