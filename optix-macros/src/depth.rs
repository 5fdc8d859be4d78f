//! How deep tokens nest. Parsing them goes as deep on the compiler's stack, which ends the compiler where it is used up.

use crate::support::Errors;
use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Deeper than any type or program that a person writes, and far from what the stack allows.
const MOST: usize = 100;

/// Whether `tokens` may be parsed; otherwise an error is added. Of an item, `body` says that its last braces are a program's code,
/// where `<` compares.
pub fn check(tokens: &TokenStream, body: bool, errors: &mut Errors) -> bool {
    let deepest = deepest(tokens.clone(), body);
    if let Some(token) = &deepest {
        errors.at(token, format!("this nests more than {MOST} deep, which the compiler's stack has no room for"));
    }
    deepest.is_none()
}

/// The first token that is too deep.
fn deepest(tokens: TokenStream, body: bool) -> Option<TokenTree> {
    let mut waiting = vec![(tokens, 0, body, true)];
    while let Some((tokens, depth, has_body, are_types)) = waiting.pop() {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let is_braces =
            |token: &TokenTree| matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace);
        let body = tokens.iter().rposition(is_braces).filter(|_| has_body);
        // Opened by `<`, said by `&` and `*`, and results of results.
        let (mut angles, mut prefixes, mut arrows) = (0_usize, 0, 0);
        let mut before = ' ';
        for (at, token) in tokens.into_iter().enumerate() {
            let mut punct = ' ';
            match &token {
                TokenTree::Punct(token) => {
                    punct = token.as_char();
                    match punct {
                        '<' if are_types => angles += 1,
                        '>' if before == '-' => arrows += usize::from(are_types),
                        '>' => angles = angles.saturating_sub(1),
                        '&' | '*' | '!' | '-' => prefixes += 1,
                        ',' | ';' => (prefixes, arrows) = (0, 0),
                        '\'' => {}
                        _ => prefixes = 0,
                    }
                }
                TokenTree::Ident(word) if before == '\'' || word == "const" || word == "mut" => {}
                _ => prefixes = 0,
            }
            before = punct;
            let depth = depth + angles + prefixes + arrows;
            if depth > MOST {
                return Some(token);
            }
            if let TokenTree::Group(group) = token {
                waiting.push((group.stream(), depth + 1, false, are_types && body != Some(at)));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{MOST, deepest};

    #[test]
    fn nesting_of_every_kind_is_counted() {
        let of = |begin: &str, end: &str, count: usize| {
            let text = format!("struct S {{ a: {}u32{} }}", begin.repeat(count), end.repeat(count));
            deepest(text.parse().expect("tokens"), false).is_some()
        };
        for (begin, end) in [
            ("[", "; 1]"),
            ("(", ",)"),
            ("Option<", ">"),
            ("&", ""),
            ("*const ", ""),
            ("&'a mut ", ""),
            ("fn() -> ", ""),
            ("A<{", "}>"),
        ] {
            assert!(!of(begin, end, MOST / 3) && of(begin, end, MOST + 1) && of(begin, end, 2000), "{begin}");
        }
    }

    #[test]
    fn comparisons_in_code_are_no_nesting() {
        let text = format!("fn f(a: A<u32>) -> B {{ {} }}", "if a < b { c() }".repeat(500));
        assert!(deepest(text.parse().expect("tokens"), true).is_none());
        let text = format!("fn f() {{ {}{} }}", "{".repeat(200), "}".repeat(200));
        assert!(deepest(text.parse().expect("tokens"), true).is_some());
    }
}
