//! What a macro does not see: rustc takes out what `#[cfg(..)]` says no to before a derive runs.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::ToTokens;
use syn::Data;
use syn::spanned::Spanned;

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

#[cfg(test)]
mod tests {
    use super::of_field;

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
