//! Definitions of functions that the compiler calls and nothing on the device defines.
//!
//! They are written in PTX, because `rustc` would keep a definition in Rust whether or not something calls it.

/// Names and definitions. `memcmp` compares slices; for the other functions of its kind LLVM emits instructions.
const DEFINITIONS: [(&str, &str); 1] = [("memcmp", include_str!("../../templates/memcmp.ptx"))];

/// The text with these definitions in place of the declarations.
pub(crate) fn defined(mut text: String) -> String {
    for (name, definition) in DEFINITIONS {
        if let Some(declaration) = declaration(&text, name) {
            text.replace_range(declaration, definition);
        }
    }
    text
}

/// The range of `.extern .func (..) name (..) ;` in the text.
fn declaration(text: &str, name: &str) -> Option<std::ops::Range<usize>> {
    const EXTERN: &str = ".extern .func";
    text.match_indices(EXTERN).find_map(|(at, _)| {
        let end = at + text[at..].find(';')? + 1;
        let mut words = text[at..end].split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        words.any(|word| word == name).then_some(at..end)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_become_definitions() {
        let other = ".extern .func other\n(\n\t.param .b64 a\n)\n;\n";
        let text = format!(
            "{other}.extern .func  (.param .b32 func_retval0) memcmp\n(\n\t.param .b64 a\n)\n;\n.entry x()\n{{\n}}\n"
        );
        let text = defined(text);
        assert!(text.starts_with(other) && text.ends_with("\n.entry x()\n{\n}\n"));
        assert_eq!(text.matches(".extern").count(), 1);
        assert_eq!(text.matches(") memcmp(").count(), 1);
        assert_eq!(defined(other.to_string()), other);
    }
}
