//! Parses the text of LLVM IR to a [`Module`].
//!
//! It reads what LLVM 17 and later versions print. A word that it does not know is refused or, in [`known`], left out
//! with the instruction or definition that contains it.

mod attributes;
mod instructions;
mod module;
mod types;
mod values;

use std::collections::HashMap;

use super::lexer::{Token, tokens};
use super::model::{Attributes, Module};
use super::unknown::{Refused, Unknown};

type Parsed<T> = Result<T, Unknown>;

/// Reads a module.
pub fn module(text: &str) -> Result<Module, Refused> {
    let refused = |(unknown, line)| Refused { unknown, line, function: String::new() };
    let tokens = tokens(text).map_err(refused)?;
    let mut parser = Parser::new(&tokens, false);
    parser.module().map_err(|unknown| Refused { unknown, line: parser.line(), function: parser.function })
}

/// Reads the known parts of a module. Unknown definitions and instructions are left out. A text that does not even
/// consist of LLVM's tokens gives an empty module.
pub fn known(text: &str) -> Module {
    let Ok(tokens) = tokens(text) else { return Module::default() };
    Parser::new(&tokens, true).module().unwrap_or_default()
}

struct Parser<'t, 'a> {
    tokens: &'t [(Token<'a>, usize)],
    at: usize,
    groups: HashMap<&'a str, Attributes>,
    /// Whether unknown things are left out instead of refused.
    lenient: bool,
    /// The symbol of the function that is being read.
    function: String,
    /// How deep types and constants are nested.
    depth: u32,
}

/// No compiler nests deeper than this.
const DEEPEST: u32 = 64;

impl<'t, 'a> Parser<'t, 'a> {
    fn new(tokens: &'t [(Token<'a>, usize)], lenient: bool) -> Self {
        Self { tokens, at: 0, groups: HashMap::new(), lenient, function: String::new(), depth: 0 }
    }

    /// What was read. `None` if it contains something unknown and is left out; then reading continues after the line
    /// `line`, in which it begins.
    fn or_skipped<T>(&mut self, read: Parsed<T>, line: usize) -> Parsed<Option<T>> {
        match read {
            Err(_) if self.lenient => {
                let last = line.max(self.line());
                while self.peek() != Token::End && self.next_line() <= last {
                    self.at += 1;
                }
                Ok(None)
            }
            read => read.map(Some),
        }
    }

    fn peek(&self) -> Token<'a> {
        self.peek_at(0)
    }

    fn peek_at(&self, ahead: usize) -> Token<'a> {
        self.tokens.get(self.at + ahead).map_or(Token::End, |(token, _)| *token)
    }

    /// The line of the token that was read last.
    fn line(&self) -> usize {
        self.tokens.get(self.at.saturating_sub(1)).map_or(0, |(_, line)| *line)
    }

    /// The line of the token that comes next.
    fn next_line(&self) -> usize {
        self.tokens.get(self.at).map_or(0, |(_, line)| *line)
    }

    fn next(&mut self) -> Token<'a> {
        let token = self.peek();
        self.at += usize::from(token != Token::End);
        token
    }

    fn unexpected<T>(&self, wanted: &str) -> Parsed<T> {
        Err(Unknown::new(match self.peek() {
            Token::Word(word) => format!("`{word}` where {wanted} should be"),
            Token::End => format!("the end where {wanted} should be"),
            token => format!("{token:?} where {wanted} should be"),
        }))
    }

    fn eat(&mut self, c: char) -> bool {
        let found = self.peek() == Token::Punctuation(c);
        self.at += usize::from(found);
        found
    }

    fn expect(&mut self, c: char) -> Parsed<()> {
        if self.eat(c) { Ok(()) } else { self.unexpected(&format!("`{c}`")) }
    }

    fn eat_word(&mut self, word: &str) -> bool {
        let found = self.peek() == Token::Word(word);
        self.at += usize::from(found);
        found
    }

    fn expect_word(&mut self, word: &str) -> Parsed<()> {
        if self.eat_word(word) { Ok(()) } else { self.unexpected(&format!("`{word}`")) }
    }

    /// Takes the next word, if it is one of these.
    fn one_of(&mut self, words: &[&str]) -> Option<&'a str> {
        match self.peek() {
            Token::Word(word) if words.contains(&word) => {
                self.at += 1;
                Some(word)
            }
            _ => None,
        }
    }

    /// Takes the next word and returns what it stands for.
    fn one_by<T>(&mut self, of: impl Fn(&str) -> Option<T>, wanted: &str) -> Parsed<T> {
        let known = match self.peek() {
            Token::Word(word) => of(word),
            _ => None,
        };
        match known {
            Some(known) => {
                self.at += 1;
                Ok(known)
            }
            None => self.unexpected(wanted),
        }
    }

    fn word(&mut self) -> Parsed<&'a str> {
        match self.peek() {
            Token::Word(word) => {
                self.at += 1;
                Ok(word)
            }
            _ => self.unexpected("a word"),
        }
    }

    fn local(&mut self) -> Parsed<String> {
        match self.next() {
            Token::Local(name) => Ok(name.to_string()),
            _ => {
                self.at -= 1;
                self.unexpected("a local name")
            }
        }
    }

    fn global(&mut self) -> Parsed<String> {
        match self.peek() {
            Token::Global(name) => {
                self.at += 1;
                Ok(name.to_string())
            }
            _ => self.unexpected("a global name"),
        }
    }

    fn text(&mut self) -> Parsed<String> {
        match self.peek() {
            Token::Text(text) => {
                self.at += 1;
                Ok(text.to_string())
            }
            _ => self.unexpected("a text"),
        }
    }

    fn number(&mut self) -> Parsed<u64> {
        let word = self.word()?;
        word.parse().map_err(|_| Unknown::new(format!("`{word}` where a number should be")))
    }

    /// A number in parentheses.
    fn number_in_parentheses(&mut self) -> Parsed<u64> {
        self.expect('(')?;
        let number = self.number()?;
        self.expect(')')?;
        Ok(number)
    }

    /// Reads items with commas between them, up to the closing mark. The opening mark has been read already.
    fn list<T>(&mut self, close: char, mut item: impl FnMut(&mut Self) -> Parsed<T>) -> Parsed<Vec<T>> {
        let mut items = Vec::new();
        if self.eat(close) {
            return Ok(items);
        }
        loop {
            items.push(item(self)?);
            if self.eat(close) {
                return Ok(items);
            }
            self.expect(',')?;
        }
    }

    /// Reads something that may contain another of its kind, and counts the nesting.
    fn nested<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth == DEEPEST {
            return Err(Unknown::new("nesting deeper than any compiler's"));
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }

    /// Skips a text in parentheses, the first of which comes next; returns its words.
    fn parentheses(&mut self) -> Parsed<Vec<Token<'a>>> {
        self.expect('(')?;
        let (mut depth, mut inside) = (1, Vec::new());
        loop {
            match self.next() {
                Token::Punctuation('(') => depth += 1,
                Token::Punctuation(')') => depth -= 1,
                Token::End => return self.unexpected("`)`"),
                _ => {}
            }
            if depth == 0 {
                return Ok(inside);
            }
            inside.push(self.tokens[self.at - 1].0);
        }
    }
}
