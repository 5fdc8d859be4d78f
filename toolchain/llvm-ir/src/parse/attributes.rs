//! Attributes of functions, calls, parameters and results.
//!
//! Most attributes only help the optimiser. Those that LLVM 7 knows and that change the generated code are kept;
//! `captures(none)` and `memory(..)` are translated to LLVM 7's words.

use super::{Parsed, Parser};
use crate::lexer::Token;
use crate::model::{Attributes, Type};
use crate::unknown::Unknown;

/// Attributes of functions that are kept.
const OF_FUNCTIONS: [&str; 8] =
    ["alwaysinline", "cold", "convergent", "inlinehint", "noduplicate", "noinline", "noreturn", "nounwind"];

/// Attributes of parameters that are kept.
const OF_PARAMETERS: [&str; 6] = ["noalias", "noundef", "readonly", "readnone", "signext", "zeroext"];

/// Attributes that change how a value is passed, in a way that nothing here translates.
const REFUSED: [&str; 7] = ["byref", "inalloca", "inreg", "nest", "preallocated", "swifterror", "swiftself"];

/// The attributes of parameters and results that are known.
#[derive(Default)]
pub(super) struct OfValue {
    pub words: Attributes,
    pub by_value: Option<Type>,
    pub align: Option<u64>,
}

impl<'a> Parser<'_, 'a> {
    /// Reads `attributes #5 = { .. }` from the whole text first, because functions that refer to them come before them.
    pub(super) fn read_groups(&mut self) -> Parsed<()> {
        for at in 0..self.tokens.len() {
            if let (Token::Word("attributes"), Some((Token::Group(name), _))) =
                (self.tokens[at].0, self.tokens.get(at + 1))
            {
                self.at = at + 2;
                self.expect('=')?;
                self.expect('{')?;
                let line = self.line();
                let read = self.function_attributes().and_then(|words| self.expect('}').map(|()| words));
                let words = self.or_skipped(read, line)?.unwrap_or_default();
                self.groups.insert(name, words);
            }
        }
        self.at = 0;
        Ok(())
    }

    /// Attributes after a function's parameters or a call's arguments, or in a group.
    pub(super) fn function_attributes(&mut self) -> Parsed<Attributes> {
        let mut words = Attributes::new();
        loop {
            match self.peek() {
                Token::Group(name) => {
                    self.at += 1;
                    let group = self.groups.get(name).ok_or_else(|| Unknown::new(format!("no group #{name}")))?;
                    words.extend(group.iter().cloned());
                }
                // "target-cpu"="sm_75"
                Token::Text(_) => {
                    self.at += 1;
                    if self.eat('=') {
                        self.text()?;
                    }
                }
                Token::Word("memory") => {
                    self.at += 1;
                    let effects = self.parentheses()?;
                    words.extend(memory(&effects).iter().map(|word| word.to_string()));
                }
                Token::Word("optnone" | "naked" | "returns_twice" | "presplitcoroutine") => {
                    return self.unexpected("an attribute that device code may have");
                }
                // This follows the attributes of a definition.
                Token::Word("align" | "section" | "comdat" | "gc" | "prefix" | "prologue" | "personality" | "to") => {
                    break;
                }
                Token::Word(word) => {
                    // A word on a new line begins the next instruction.
                    if self.next_line() != self.line() {
                        break;
                    }
                    self.at += 1;
                    if self.peek() == Token::Punctuation('(') {
                        self.parentheses()?;
                    } else if self.eat('=') {
                        self.number()?;
                    }
                    if OF_FUNCTIONS.contains(&word) {
                        words.push(word.to_string());
                    }
                }
                _ => break,
            }
        }
        words.sort();
        words.dedup();
        Ok(words)
    }

    /// Attributes before a result's type or after a parameter's.
    pub(super) fn value_attributes(&mut self) -> Parsed<OfValue> {
        let mut of = OfValue::default();
        while let Token::Word(word) = self.peek() {
            // A type or a constant may follow.
            let is_value = matches!(word, "null" | "undef" | "poison" | "zeroinitializer" | "splat" | "true" | "false");
            let is_expression = matches!(
                word,
                "getelementptr"
                    | "trunc"
                    | "ptrtoint"
                    | "ptrtoaddr"
                    | "inttoptr"
                    | "bitcast"
                    | "addrspacecast"
                    | "add"
                    | "sub"
                    | "xor"
                    | "asm"
            );
            if self.is_type() || is_value || is_expression || !word.starts_with(|c: char| c.is_ascii_alphabetic()) {
                break;
            }
            if REFUSED.contains(&word) {
                return self.unexpected("an attribute that device code may have");
            }
            self.at += 1;
            match word {
                "byval" => {
                    self.expect('(')?;
                    of.by_value = Some(self.ty()?);
                    self.expect(')')?;
                }
                "align" => of.align = Some(if self.eat('(') { self.number_until(')')? } else { self.number()? }),
                "captures" => {
                    let nothing = self.parentheses()?.as_slice() == [Token::Word("none")];
                    of.words.extend(nothing.then(|| "nocapture".into()));
                }
                _ if self.peek() == Token::Punctuation('(') => drop(self.parentheses()?),
                _ if OF_PARAMETERS.contains(&word) => of.words.push(word.to_string()),
                _ => {}
            }
        }
        Ok(of)
    }

    fn number_until(&mut self, close: char) -> Parsed<u64> {
        let number = self.number()?;
        self.expect(close)?;
        Ok(number)
    }
}

/// `memory(argmem: read)` in LLVM 7's words; nothing if it has none for it.
fn memory(effects: &[Token<'_>]) -> &'static [&'static str] {
    let parts: Vec<&[Token<'_>]> = effects.split(|token| *token == Token::Punctuation(',')).collect();
    match parts[..] {
        [[Token::Word("none")]] => &["readnone"],
        [[Token::Word("read")]] => &["readonly"],
        [[Token::Label("argmem"), Token::Word("read")]] => &["argmemonly", "readonly"],
        [[Token::Label("argmem"), _]] => &["argmemonly"],
        [[Token::Label("inaccessiblemem"), Token::Word("read")]] => &["inaccessiblememonly", "readonly"],
        [[Token::Label("inaccessiblemem"), _]] => &["inaccessiblememonly"],
        _ => &[],
    }
}
