//! Parses values: names, constants, and constant expressions.

use super::{Parsed, Parser};
use crate::lexer::Token;
use crate::model::{Expression, Type, Typed, Value};
use crate::opcode::{Binary, Cast};
use crate::unknown::Unknown;

impl Parser<'_, '_> {
    pub(super) fn typed(&mut self) -> Parsed<Typed> {
        let ty = self.ty()?;
        let value = self.value(&ty)?;
        Ok(Typed { ty, value })
    }

    /// A value of the type `ty`.
    pub(super) fn value(&mut self, ty: &Type) -> Parsed<Value> {
        self.nested(|parser| parser.value_inside(ty))
    }

    fn value_inside(&mut self, ty: &Type) -> Parsed<Value> {
        match self.next() {
            Token::Local(name) => Ok(Value::Local(name.to_string())),
            Token::Global(name) => Ok(Value::Global(name.to_string())),
            Token::Metadata(name) => Ok(Value::Metadata(name.to_string())),
            Token::Bytes(bytes) => Ok(Value::Bytes(bytes.to_string())),
            Token::Word("null") => Ok(Value::Null),
            Token::Word("undef" | "poison") => Ok(Value::Undef),
            Token::Word("zeroinitializer") => Ok(Value::Zero),
            Token::Word("splat") => self.splat(ty),
            Token::Word("getelementptr") => self.address(),
            Token::Word(word) => match (Cast::of(word), Binary::of(word)) {
                (
                    Some(op @ (Cast::Trunc | Cast::PtrToInt | Cast::IntToPtr | Cast::Bitcast | Cast::Addrspacecast)),
                    _,
                ) => {
                    self.one_of(&["nuw", "nsw"]);
                    self.expect('(')?;
                    let value = self.typed()?;
                    self.expect_word("to")?;
                    let to = self.ty()?;
                    self.expect(')')?;
                    Ok(Value::Expression(Box::new(Expression::Cast { op, value, to })))
                }
                (_, Some(op @ (Binary::Add | Binary::Sub | Binary::Xor))) => {
                    while self.one_of(&["nuw", "nsw"]).is_some() {}
                    self.expect('(')?;
                    let a = self.typed()?;
                    self.expect(',')?;
                    let b = self.typed()?;
                    self.expect(')')?;
                    Ok(Value::Expression(Box::new(Expression::Binary { op, a, b })))
                }
                _ if is_number(word, ty) => Ok(Value::Number(word.to_string())),
                _ => {
                    self.at -= 1;
                    self.unexpected("a value")
                }
            },
            Token::Punctuation('[') => Ok(Value::Aggregate(self.list(']', Self::typed)?)),
            Token::Punctuation('{') => Ok(Value::Aggregate(self.list('}', Self::typed)?)),
            Token::Punctuation('<') if self.eat('{') => {
                let fields = self.list('}', Self::typed)?;
                self.expect('>')?;
                Ok(Value::Aggregate(fields))
            }
            Token::Punctuation('<') => Ok(Value::Aggregate(self.list('>', Self::typed)?)),
            Token::End => self.unexpected("a value"),
            _ => {
                self.at -= 1;
                self.unexpected("a value")
            }
        }
    }

    /// `splat (i32 5)`
    fn splat(&mut self, ty: &Type) -> Parsed<Value> {
        self.expect('(')?;
        let element = self.typed()?;
        self.expect(')')?;
        match ty {
            Type::Vector(count, _) => Ok(Value::Aggregate(vec![element; *count as usize])),
            _ => Err(Unknown::new("`splat` in what is no vector")),
        }
    }

    /// `getelementptr inbounds (i8, ptr @x, i64 8)`
    fn address(&mut self) -> Parsed<Value> {
        let inbounds = self.address_flags()?;
        self.expect('(')?;
        let of = self.ty()?;
        self.expect(',')?;
        let base = self.typed()?;
        let mut indices = Vec::new();
        while self.eat(',') {
            indices.push(self.typed()?);
        }
        self.expect(')')?;
        Ok(Value::Expression(Box::new(Expression::Address { inbounds, of, base, indices })))
    }

    /// Skips the flags of an address computation, and returns whether `inbounds` is among them.
    pub(super) fn address_flags(&mut self) -> Parsed<bool> {
        let mut inbounds = false;
        loop {
            match self.one_of(&["inbounds", "nuw", "nusw", "inrange"]) {
                Some("inrange") => drop(self.parentheses()?),
                Some(flag) => inbounds |= flag == "inbounds",
                None => return Ok(inbounds),
            }
        }
    }
}

/// Whether the word is a constant of the type, in the notations of LLVM up to version 22.
fn is_number(word: &str, ty: &Type) -> bool {
    let digits = word.strip_prefix('-').unwrap_or(word);
    match ty {
        Type::Int(1) if matches!(word, "true" | "false") => true,
        Type::Int(_) => !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()),
        Type::Half => word.strip_prefix("0xH").is_some_and(|hex| is_hex(hex, 4)) || is_decimal(digits),
        Type::Float | Type::Double => word.strip_prefix("0x").is_some_and(|hex| is_hex(hex, 16)) || is_decimal(digits),
        _ => false,
    }
}

fn is_hex(text: &str, most: usize) -> bool {
    (1..=most).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_hexdigit())
}

fn is_decimal(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit()) && text.contains('.') && text.parse::<f64>().is_ok()
}
