//! Random numbers and tokens.

use proc_macro2::{Delimiter, Group, Ident, Literal, Punct, Spacing, Span, TokenTree};

/// Words that mean something to a macro or to Rust, and some that look as if they did.
const WORDS: &[&str] = &[
    "struct",
    "enum",
    "union",
    "fn",
    "impl",
    "for",
    "where",
    "pub",
    "crate",
    "self",
    "Self",
    "super",
    "mut",
    "dyn",
    "const",
    "unsafe",
    "async",
    "extern",
    "static",
    "type",
    "move",
    "as",
    "in",
    "on",
    "_",
    "r#type",
    "r#fn",
    "ŉ",
    "ß",
    "größe",
    "payload",
    "read",
    "write",
    "caller",
    "closesthit",
    "miss",
    "anyhit",
    "intersection",
    "bound",
    "view",
    "optix",
    "repr",
    "C",
    "packed",
    "cfg",
    "derive",
    "Triangles",
    "Custom",
    "params",
    "raygen",
    "rays",
    "hitgroups",
    "trace_depth",
    "Radiance",
    "RadianceAtMiss",
    "AtMiss",
    "FromClosestHit",
    "Decision",
    "RayGen",
    "Miss",
    "ClosestHit",
    "AnyHit",
    "Intersection",
    "Slice",
    "Traversable",
    "Option",
    "u32",
    "f32",
    "Vec3",
    "P",
    "T",
    "camera",
    "__AT_0",
];
const LITERALS: &[&str] =
    &["0", "1", "32", "99999999999999999999", "3.5", "\"x\"", "'c'", "b\"x\"", "7u8", "1e400", "0x_f"];
const PUNCTUATION: &[char] =
    &['#', '!', '<', '>', ':', ',', ';', '=', '&', '*', '-', '+', '?', '.', '|', '$', '\'', '@', '~'];

/// SplitMix64 (Steele, Lea and Flood 2014).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    pub fn of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    pub fn token(&mut self) -> TokenTree {
        match self.below(8) {
            0..=3 => word(self.of::<&str>(WORDS)),
            4 => self.of(LITERALS).parse::<Literal>().expect("a literal").into(),
            5 => {
                let delimiters = [Delimiter::Parenthesis, Delimiter::Brace, Delimiter::Bracket, Delimiter::None];
                let (delimiter, count) = (*self.of(&delimiters), self.below(4));
                Group::new(delimiter, (0..count).map(|_| self.token()).collect()).into()
            }
            // A lifetime's quote stands before a word, or it can't be printed.
            _ => match *self.of::<char>(PUNCTUATION) {
                '\'' => TokenTree::Group(Group::new(Delimiter::None, "'a".parse().expect("a lifetime"))),
                punct => Punct::new(punct, if self.below(2) == 0 { Spacing::Joint } else { Spacing::Alone }).into(),
            },
        }
    }
}

fn word(text: &str) -> TokenTree {
    match text.strip_prefix("r#") {
        Some(raw) => Ident::new_raw(raw, Span::call_site()).into(),
        None => Ident::new(text, Span::call_site()).into(),
    }
}
