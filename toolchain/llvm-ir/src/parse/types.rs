//! Parses types.

use super::{Parsed, Parser};
use crate::lexer::Token;
use crate::model::Type;
use crate::unknown::Unknown;

/// No compiler writes longer vectors than this. Arrays may have any length.
const LONGEST_VECTOR: u64 = 256;

impl Parser<'_, '_> {
    /// Whether the next token begins a type.
    pub(super) fn is_type(&self) -> bool {
        match self.peek() {
            Token::Word(word) => {
                matches!(word, "void" | "label" | "metadata" | "half" | "float" | "double" | "ptr" | "fp128" | "bfloat")
                    || integer(word).is_some()
            }
            Token::Punctuation(c) => matches!(c, '[' | '<' | '{'),
            Token::Local(_) => true,
            _ => false,
        }
    }

    pub(super) fn ty(&mut self) -> Parsed<Type> {
        self.nested(Self::ty_inside)
    }

    fn ty_inside(&mut self) -> Parsed<Type> {
        match self.next() {
            Token::Word("void") => Ok(Type::Void),
            Token::Word("label") => Ok(Type::Label),
            Token::Word("metadata") => Ok(Type::Metadata),
            Token::Word("half") => Ok(Type::Half),
            Token::Word("float") => Ok(Type::Float),
            Token::Word("double") => Ok(Type::Double),
            Token::Word("ptr") => Ok(Type::Pointer(self.address_space()?)),
            Token::Word(word) => match integer(word) {
                Some(bits) => Ok(Type::Int(bits)),
                None => Err(Unknown::new(format!("the type `{word}`"))
                    .hint("use integers of up to 128 bits, `f16`, `f32` or `f64`")),
            },
            Token::Local(name) => Ok(Type::Named(name.to_string())),
            Token::Punctuation('[') => {
                let (count, element) = self.elements(']')?;
                Ok(Type::Array(count, Box::new(element)))
            }
            Token::Punctuation('<') if self.eat('{') => {
                let fields = self.list('}', Self::ty)?;
                self.expect('>')?;
                Ok(Type::Struct { fields, packed: true })
            }
            Token::Punctuation('<') => {
                let (count, element) = self.elements('>')?;
                if count > LONGEST_VECTOR {
                    return Err(Unknown::new(format!("a vector of {count} elements")));
                }
                match element.bits() {
                    Some(_) if !matches!(element, Type::Pointer(_)) => Ok(Type::Vector(count, Box::new(element))),
                    _ => Err(Unknown::new("a vector of what is no number")),
                }
            }
            Token::Punctuation('{') => Ok(Type::Struct { fields: self.list('}', Self::ty)?, packed: false }),
            _ => {
                self.at -= 1;
                self.unexpected("a type")
            }
        }
    }

    fn elements(&mut self, close: char) -> Parsed<(u64, Type)> {
        let count = self.number()?;
        self.expect_word("x")?;
        let element = self.ty()?;
        self.expect(close)?;
        Ok((count, element))
    }

    /// `addrspace(3)`, or nothing.
    pub(super) fn address_space(&mut self) -> Parsed<u32> {
        if !self.eat_word("addrspace") {
            return Ok(0);
        }
        let number = self.number_in_parentheses()?;
        u32::try_from(number).map_err(|_| Unknown::new(format!("address space {number}")))
    }
}

/// The bits of `i32`.
fn integer(word: &str) -> Option<u32> {
    let bits = word.strip_prefix('i')?;
    bits.parse().ok().filter(|bits| (1..=128).contains(bits))
}
