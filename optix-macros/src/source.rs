//! What a macro does not see: rustc takes out what `#[cfg(..)]` says no to before a derive runs, and shows an attribute its item
//! without what that is in. What is found here is for messages only.

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};
use quote::ToTokens;
use syn::parse::Parser;
use syn::spanned::Spanned;
use syn::{Attribute, Data};

/// What says which machine, or which of its builds, is compiled for.
const OF_TARGET: [&str; 6] = ["windows", "unix", "debug_assertions", "overflow_checks", "panic", "test"];
/// Attributes that change what a derive makes of a field.
const OF_FIELDS: [&str; 2] = ["payload", "view"];

/// An attribute which lets a field depend on the target. That is for the message, which comes at once; that both machines lay
/// types out alike is proven by the layouts in the PTX.
pub fn target_dependent(data: &Data) -> Option<String> {
    if !proc_macro::is_available() {
        return None;
    }
    let span = match data {
        Data::Struct(data) => data.fields.span(),
        Data::Enum(data) => data.brace_token.span.join(),
        Data::Union(data) => data.fields.span(),
    };
    let text = span.unwrap().source_text()?;
    if text.contains("cfg") { of_field(text.parse().ok()?) } else { None }
}

/// The first such attribute, in any braces or brackets but those of an array.
fn of_field(tokens: TokenStream) -> Option<String> {
    let mut before = None;
    tokens.into_iter().find_map(|token| {
        let behind_hash =
            matches!(before.replace(token.clone()), Some(TokenTree::Punct(hash)) if hash.as_char() == '#');
        let TokenTree::Group(group) = token else { return None };
        match group.delimiter() {
            Delimiter::Bracket if behind_hash && depends(group.stream()) => {
                Some(format!("#{}", group.to_token_stream()).replace(" (", "("))
            }
            Delimiter::Bracket => None,
            _ => of_field(group.stream()),
        }
    })
}

/// Whether an attribute depends on the target.
fn depends(attribute: TokenStream) -> bool {
    let tokens: Vec<TokenTree> = attribute.into_iter().collect();
    let [TokenTree::Ident(word), TokenTree::Group(arguments)] = &tokens[..] else { return false };
    names(arguments.stream(), is_of_target)
        && (word == "cfg" || word == "cfg_attr" && names(arguments.stream(), |word| OF_FIELDS.contains(&word)))
}

fn is_of_target(word: &str) -> bool {
    word.starts_with("target_") || OF_TARGET.contains(&word)
}

/// Whether there is a word of that kind.
fn names(tokens: TokenStream, is_it: fn(&str) -> bool) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(word) => is_it(&word.to_string()),
        TokenTree::Group(group) => names(group.stream(), is_it),
        _ => false,
    })
}

/// The attributes that stand directly above an attribute at `span`: derives among them have run and are not seen any more.
pub fn attributes_above(span: Span) -> Vec<Attribute> {
    text_before(span).map(|text| attributes_at_end(&text)).unwrap_or_default()
}

/// The attributes that a text ends with, without comments. None if it ends with something else.
fn attributes_at_end(text: &str) -> Vec<Attribute> {
    let (mut attributes, mut depth, mut rest) = (String::new(), 0usize, text);
    while let Some(first) = rest.chars().next() {
        let (word, after) = rest.split_at(token(rest));
        rest = after;
        match first {
            '(' | '[' => depth += 1,
            ')' | ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 && matches!(first, ';' | '{' | '}') {
            attributes.clear();
        } else if !word.starts_with("//") && !word.starts_with("/*") {
            attributes.push_str(word);
        }
    }
    Attribute::parse_outer.parse_str(&attributes).unwrap_or_default()
}

/// Whether the braces that hold what is at `span` are those of an `impl` or a `trait`. Where the source can't be read, they are
/// not.
pub fn is_in_impl(span: Span) -> bool {
    text_before(span).is_some_and(|text| ends_in_impl(&text))
}

/// The source before a place, where it can be read.
fn text_before(span: Span) -> Option<String> {
    if !proc_macro::is_available() {
        return None;
    }
    let span = span.unwrap();
    let text = std::fs::read_to_string(span.local_file()?).ok()?;
    Some(before(&text, span.line(), span.column()).to_owned())
}

/// The text before a place; lines and characters count from 1.
fn before(text: &str, line: usize, column: usize) -> &str {
    let begin: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let rest = text.get(begin..).unwrap_or_default();
    let length = rest.char_indices().nth(column.saturating_sub(1)).map_or(rest.len(), |(at, _)| at);
    text.get(..begin + length).unwrap_or_default()
}

/// Whether the innermost braces that are open at the text's end are those of an `impl` or a `trait`.
fn ends_in_impl(text: &str) -> bool {
    // What is open: braces with whether they are of an impl, parentheses and brackets without.
    let mut open: Vec<(char, bool)> = Vec::new();
    // Whether what began last is an impl: `None` before the word that says so.
    let mut is_impl = None;
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = token(rest);
        let (word, after) = rest.split_at(length);
        rest = after;
        let outside = !matches!(open.last(), Some(('(' | '[', _)));
        match first {
            '{' => open.push(('{', is_impl == Some(true))),
            '(' | '[' => open.push((first, false)),
            '}' | ')' | ']' => drop(open.pop()),
            _ if outside && (first.is_alphabetic() || first == '_') && is_impl.is_none() => match word {
                "pub" | "unsafe" | "default" | "auto" => {}
                _ => is_impl = Some(matches!(word, "impl" | "trait")),
            },
            _ => {}
        }
        if matches!(first, '{' | '}') || first == ';' && outside {
            is_impl = None;
        }
    }
    matches!(open.last(), Some(('{', true)))
}

/// The length of the first token of a text that is not empty: a comment, a literal with quotes, a word, or a character.
fn token(text: &str) -> usize {
    let first = text.chars().next().map_or(0, char::len_utf8);
    let until = |end: &str, from: usize| text[from..].find(end).map_or(text.len(), |at| from + at + end.len());
    if text.starts_with("//") {
        return until("\n", 2);
    }
    if text.starts_with("/*") {
        let (mut depth, mut at) = (0, 0);
        while let Some(found) = text[at..].find(['/', '*']) {
            at += found;
            match text.as_bytes().get(at..at + 2) {
                Some(b"/*") => (depth, at) = (depth + 1, at + 2),
                Some(b"*/") => (depth, at) = (depth - 1, at + 2),
                _ => at += 1,
            }
            if depth == 0 {
                return at;
            }
        }
        return text.len();
    }
    let word = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    let (prefix, quoted) = text.split_at(word);
    let hashes = quoted.len() - quoted.trim_start_matches('#').len();
    if matches!(prefix, "r" | "br" | "cr") && quoted[hashes..].starts_with('"') {
        return until(&format!("\"{}", "#".repeat(hashes)), word + hashes + 1);
    }
    let quote = match quoted.chars().next() {
        Some('"') if matches!(prefix, "" | "b" | "c") => '"',
        // A lifetime has no second quote behind its first character.
        Some('\'') if matches!(prefix, "" | "b") => match quoted[1..].chars().next() {
            Some('\\') => '\'',
            Some(c) if quoted[1 + c.len_utf8()..].starts_with('\'') => return word + 2 + c.len_utf8(),
            _ => return word.max(first),
        },
        _ => return word.max(first),
    };
    let mut escaped = false;
    for (at, c) in quoted.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if c == quote => return word + at + 1,
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::{attributes_at_end, before, ends_in_impl, of_field, token};

    #[test]
    fn attributes_above_are_seen() {
        let count = |text: &str| attributes_at_end(text).len();
        assert_eq!(count("use a::b;\n/// #[derive(Copy)]\n#[derive(Clone, Copy)] // ;\n#[doc = \"}\"]\n"), 2);
        assert_eq!(count("#[derive(Clone)] struct A; #[repr(C)] "), 1);
        for text in ["", "#[derive(Clone)] struct A {} ", "#[derive(Clone)] fn a", "/* #[derive(Clone)] */", "\"", ")]"]
        {
            assert_eq!(count(text), 0, "{text}");
        }
    }

    #[test]
    fn what_is_in_an_impl_is_seen() {
        for text in [
            "impl Camera { ",
            "mod a { pub struct B; #[doc(hidden)] unsafe impl<T> C for B where T: Fn(u32) { fn d() {} \n #[raygen] pub fn ",
            "pub(crate) trait Shades { const A: [u8; 2] = [b'{', b'\\'']; fn ",
            "/* impl { /* */ */ impl<'a> A<'a> { // }\n fn ",
            "const TEXT: &str = \"}\\\"{\"; impl A { fn b() { r#\"\"}\"#; 'x'; } fn ",
        ] {
            assert!(ends_in_impl(text), "{text}");
        }
        for text in [
            "",
            "fn a() -> impl B { fn ",
            "impl A { fn b() { fn ",
            "impl A {} mod b { fn ",
            "macro_rules! shader { () => { fn ",
            "// impl A {\n fn ",
            "const A: &str = r##\"impl B { \"# \"##; fn ",
            "const A: char = '{'; fn ",
            "impl A { } } } fn ",
            "\"",
            "r#\"",
            "'",
            "/*",
        ] {
            assert!(!ends_in_impl(text), "{text}");
        }
        assert_eq!(before("a\nbä c\n", 2, 3), "a\nbä");
        assert_eq!(before("a\n", 9, 9), "a\n");
    }

    #[test]
    fn every_token_has_a_length() {
        for text in ["ä", "'ä", "'ä'", "'\\''", "b'", "r", "r#a", "/*/", "\"\\", "c\"ä\"", "_"] {
            assert!((1..=text.len()).contains(&token(text)) && text.is_char_boundary(token(text)), "{text}");
        }
    }

    #[test]
    fn what_depends_on_the_target_is_seen() {
        let of = |text: &str| of_field(text.parse().expect("tokens"));
        for text in [
            "{ a: u32, #[cfg(target_arch = \"nvptx64\")] pub b: u32 }",
            "{ #[cfg(not(any(unix, feature = \"x\")))] b: u32 }",
            "(#[cfg(debug_assertions)] u32, u32)",
            "{ A, B { #[cfg(windows)] b: u32 } }",
            "{ #[cfg_attr(target_os = \"cuda\", payload(read(caller)))] b: u32 }",
        ] {
            assert!(of(text).is_some(), "{text}");
        }
        for text in [
            "{ #[cfg(feature = \"target_x\")] a: u32 }",
            "{ #[cfg_attr(target_arch = \"x86_64\", doc = \"x\")] a: [u32; { #[cfg(unix)] { 1 } }] }",
            "struct",
            "",
        ] {
            assert_eq!(of(text), None, "{text}");
        }
    }
}
