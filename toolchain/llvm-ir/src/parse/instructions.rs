//! Parses instructions.

use super::module::is_nothing;
use super::{Parsed, Parser};
use crate::lexer::Token;
use crate::model::{Argument, Call, Callee, Instruction, Op, Ordering, Type, Typed, Value};
use crate::opcode::{Atomic, FloatPredicate, IntPredicate, Opcode, Order, Other, Predicate};
use crate::unknown::Unknown;

/// Flags of integer arithmetic that LLVM 7 knows.
const INTEGER_FLAGS: [&str; 3] = ["nuw", "nsw", "exact"];
/// Flags that LLVM 7 does not know. They only promise something, so they can be left out.
const NEWER_FLAGS: [&str; 3] = ["disjoint", "nneg", "samesign"];
const FLOAT_FLAGS: [&str; 8] = ["nnan", "ninf", "nsz", "arcp", "contract", "afn", "reassoc", "fast"];
/// The metadata on instructions that is kept. The rest only promises something, so it can be left out.
const METADATA: [&str; 6] = ["range", "noalias", "alias.scope", "invariant.load", "noundef", "dbg"];

impl<'a> Parser<'_, 'a> {
    pub(super) fn instruction(&mut self) -> Parsed<Instruction> {
        let line = self.next_line();
        let result = match self.peek() {
            Token::Local(name) => {
                self.at += 1;
                self.expect('=')?;
                Some(name.to_string())
            }
            _ => None,
        };
        let op = self.op()?;
        let metadata = self.attachments()?;
        let is_void = match &op {
            Op::Call(call) => is_nothing(&call.result),
            Op::Store { .. } | Op::Fence(_) | Op::Return(_) | Op::Jump(_) | Op::Branch { .. } => true,
            Op::Switch { .. } | Op::Unreachable => true,
            _ => false,
        };
        if is_void && result.is_some() {
            return Err(Unknown::new("a result of what has none"));
        }
        Ok(Instruction { result, op, metadata, line })
    }

    /// `, !range !5, !noundef !6`
    fn attachments(&mut self) -> Parsed<Vec<(String, String)>> {
        let mut kept = Vec::new();
        while self.peek() == Token::Punctuation(',') {
            let Token::Metadata(name) = self.peek_at(1) else { return self.unexpected("metadata") };
            self.at += 2;
            let Token::Metadata(node) = self.peek() else { return self.unexpected("metadata") };
            self.at += 1;
            if node.is_empty() {
                return self.unexpected("a node with a number");
            }
            if METADATA.contains(&name) {
                kept.push((name.to_string(), format!("!{node}")));
            }
        }
        Ok(kept)
    }

    fn flags(&mut self, known: &[&str]) -> Vec<String> {
        let mut flags = Vec::new();
        loop {
            if let Some(flag) = self.one_of(known) {
                flags.push(flag.to_string());
            } else if self.one_of(&NEWER_FLAGS).is_none() {
                return flags;
            }
        }
    }

    fn op(&mut self) -> Parsed<Op> {
        match Opcode::of(self.word()?)? {
            Opcode::Binary(op) => {
                let known: &[&str] = if op.is_float() { &FLOAT_FLAGS } else { &INTEGER_FLAGS };
                let flags = self.flags(known);
                let a = self.typed()?;
                let b = self.second(&a.ty)?;
                Ok(Op::Binary { op, flags, a, b })
            }
            Opcode::Cast(op) => {
                // LLVM 7 has no flags on conversions.
                self.flags(&["nuw", "nsw", "nnan", "ninf", "nsz", "arcp", "contract", "afn", "reassoc", "fast"]);
                let value = self.typed()?;
                self.expect_word("to")?;
                Ok(Op::Cast { op, value, to: self.ty()? })
            }
            Opcode::Other(other) => self.other(other),
        }
    }

    fn other(&mut self, opcode: Other) -> Parsed<Op> {
        match opcode {
            Other::FNeg => {
                self.flags(&FLOAT_FLAGS);
                Ok(Op::Negate { value: self.typed()? })
            }
            Other::Freeze => Ok(Op::Freeze { value: self.typed()? }),
            Other::ICmp => {
                let flags = self.flags(&[]);
                let predicate = self.one_by(IntPredicate::of, "a comparison of integers")?;
                self.compare(predicate.into(), flags)
            }
            Other::FCmp => {
                let flags = self.flags(&FLOAT_FLAGS);
                let predicate = self.one_by(FloatPredicate::of, "a comparison of floats")?;
                self.compare(predicate.into(), flags)
            }
            Other::Select => {
                self.flags(&FLOAT_FLAGS);
                let condition = self.typed()?;
                let yes = self.typed_after_comma()?;
                Ok(Op::Select { condition, yes, no: self.typed_after_comma()? })
            }
            Other::Phi => {
                self.flags(&FLOAT_FLAGS);
                self.phi()
            }
            Other::Load => self.access(true),
            Other::Store => self.access(false),
            Other::GetElementPtr => {
                let inbounds = self.address_flags()?;
                let of = self.ty()?;
                let base = self.typed_after_comma()?;
                let mut indices = Vec::new();
                while self.has_operand() {
                    indices.push(self.typed_after_comma()?);
                }
                Ok(Op::Address { inbounds, of, base, indices })
            }
            Other::Alloca => {
                let ty = self.ty()?;
                let count = if self.has_operand() && self.peek_at(1) != Token::Word("align") {
                    Some(self.typed_after_comma()?)
                } else {
                    None
                };
                Ok(Op::Alloca { ty, count, align: self.alignment()? })
            }
            Other::ExtractValue => {
                let aggregate = self.typed()?;
                Ok(Op::ExtractValue { aggregate, indices: self.indices()? })
            }
            Other::InsertValue => {
                let aggregate = self.typed()?;
                let value = self.typed_after_comma()?;
                Ok(Op::InsertValue { aggregate, value, indices: self.indices()? })
            }
            Other::ExtractElement => {
                let vector = self.typed()?;
                Ok(Op::ExtractElement { vector, index: self.typed_after_comma()? })
            }
            Other::InsertElement => {
                let vector = self.typed()?;
                let value = self.typed_after_comma()?;
                Ok(Op::InsertElement { vector, value, index: self.typed_after_comma()? })
            }
            Other::ShuffleVector => {
                let a = self.typed()?;
                let b = self.typed_after_comma()?;
                Ok(Op::Shuffle { a, b, mask: self.typed_after_comma()? })
            }
            Other::AtomicRmw => {
                self.eat_word("volatile");
                let op = self.one_by(Atomic::of, "an atomic operation that the GPU has")?;
                let pointer = self.typed()?;
                let value = self.typed_after_comma()?;
                let ordering = self.ordering()?;
                self.alignment()?;
                Ok(Op::ReadModifyWrite { op, pointer, value, ordering })
            }
            Other::CmpXchg => {
                while self.one_of(&["weak", "volatile"]).is_some() {}
                let pointer = self.typed()?;
                let expected = self.typed_after_comma()?;
                let new = self.typed_after_comma()?;
                let mut ordering = self.ordering()?;
                // The ordering for failure is not needed: that for success is at least as strong, and the machine has
                // one for both.
                if let Token::Word(word) = self.peek()
                    && let Some(failure) = Order::of(word)
                {
                    self.at += 1;
                    ordering.order = ordering.order.or(failure);
                }
                self.alignment()?;
                Ok(Op::CompareExchange { pointer, expected, new, ordering })
            }
            Other::Fence => Ok(Op::Fence(self.ordering()?)),
            Other::Tail | Other::NoTail => {
                self.expect_word("call")?;
                self.call(opcode == Other::Tail)
            }
            Other::Call => self.call(false),
            Other::Ret => {
                let ty = self.ty()?;
                if is_nothing(&ty) {
                    return Ok(Op::Return(None));
                }
                let value = self.value(&ty)?;
                Ok(Op::Return(Some(Typed { ty, value })))
            }
            Other::Br => self.branch(),
            Other::Switch => self.switch(),
            Other::Unreachable => Ok(Op::Unreachable),
        }
    }

    fn compare(&mut self, predicate: Predicate, flags: Vec<String>) -> Parsed<Op> {
        let a = self.typed()?;
        let b = self.second(&a.ty)?;
        Ok(Op::Compare { predicate, flags, a, b })
    }

    /// The second operand, which has the type of the first.
    fn second(&mut self, ty: &Type) -> Parsed<Value> {
        self.expect(',')?;
        self.value(ty)
    }

    fn typed_after_comma(&mut self) -> Parsed<Typed> {
        self.expect(',')?;
        self.typed()
    }

    /// Whether the next token is a comma that is not followed by metadata.
    fn has_operand(&self) -> bool {
        self.peek() == Token::Punctuation(',') && !matches!(self.peek_at(1), Token::Metadata(_))
    }

    fn indices(&mut self) -> Parsed<Vec<u64>> {
        let mut indices = Vec::new();
        while self.has_operand() {
            self.expect(',')?;
            indices.push(self.number()?);
        }
        Ok(indices)
    }

    /// `, align 4`, or nothing.
    fn alignment(&mut self) -> Parsed<Option<u64>> {
        if !self.has_operand() {
            return Ok(None);
        }
        self.expect(',')?;
        self.expect_word("align")?;
        Ok(Some(self.number()?))
    }

    fn ordering(&mut self) -> Parsed<Ordering> {
        let mut scope = String::new();
        if self.eat_word("syncscope") {
            self.expect('(')?;
            scope = self.text()?;
            self.expect(')')?;
        }
        Ok(Ordering { order: self.one_by(Order::of, "a memory ordering")?, scope })
    }

    fn access(&mut self, is_load: bool) -> Parsed<Op> {
        let atomic = self.eat_word("atomic");
        let volatile = self.eat_word("volatile");
        let (ty, value) = if is_load {
            (self.ty()?, None)
        } else {
            let value = self.typed()?;
            (value.ty.clone(), Some(value))
        };
        let pointer = self.typed_after_comma()?;
        let ordering = if atomic { Some(self.ordering()?) } else { None };
        let align = self.alignment()?;
        Ok(match value {
            None => Op::Load { ty, pointer, align, volatile, ordering },
            Some(value) => Op::Store { value, pointer, align, volatile, ordering },
        })
    }

    fn phi(&mut self) -> Parsed<Op> {
        let ty = self.ty()?;
        let mut incoming = Vec::new();
        loop {
            self.expect('[')?;
            let value = self.value(&ty)?;
            self.expect(',')?;
            incoming.push((value, self.local()?));
            self.expect(']')?;
            if !self.has_operand() {
                return Ok(Op::Phi { ty, incoming });
            }
            self.expect(',')?;
        }
    }

    fn label(&mut self) -> Parsed<String> {
        self.expect_word("label")?;
        self.local()
    }

    fn branch(&mut self) -> Parsed<Op> {
        if self.peek() == Token::Word("label") {
            return Ok(Op::Jump(self.label()?));
        }
        let condition = self.typed()?;
        if condition.ty != Type::BOOL {
            return Err(Unknown::new("a branch on what is no `i1`"));
        }
        self.expect(',')?;
        let yes = self.label()?;
        self.expect(',')?;
        Ok(Op::Branch { condition: condition.value, yes, no: self.label()? })
    }

    fn switch(&mut self) -> Parsed<Op> {
        let value = self.typed()?;
        self.expect(',')?;
        let default = self.label()?;
        self.expect('[')?;
        let mut cases = Vec::new();
        while !self.eat(']') {
            let case = self.typed()?;
            self.expect(',')?;
            cases.push((case.value, self.label()?));
        }
        Ok(Op::Switch { value, default, cases })
    }

    fn call(&mut self, tail: bool) -> Parsed<Op> {
        let flags = self.flags(&FLOAT_FLAGS);
        self.skip_convention();
        self.value_attributes()?;
        self.address_space()?;
        let result = self.ty()?;
        // For a function with variable arguments, its whole type is written.
        if self.peek() == Token::Punctuation('(') {
            return Err(Unknown::new("a call with variable arguments").hint("pass a slice"));
        }
        let callee = match self.peek() {
            Token::Word("asm") => self.asm()?,
            _ => Callee::Function(self.value(&Type::Pointer(0))?),
        };
        self.expect('(')?;
        let arguments = self.list(')', |parser| {
            let ty = parser.ty()?;
            let of = parser.value_attributes()?;
            // After `metadata` comes `!5`, or a node that is written out.
            let value = if ty == Type::Metadata && parser.peek() == Token::Metadata("") {
                parser.at += 1;
                parser.expect('{')?;
                while !parser.eat('}') {
                    if parser.next() == Token::End {
                        return parser.unexpected("`}`");
                    }
                }
                Value::Undef
            } else {
                parser.value(&ty)?
            };
            let value = Typed { ty, value };
            Ok(Argument { value, attributes: of.words, by_value: of.by_value, align: of.align })
        })?;
        let attributes = self.function_attributes()?;
        if self.eat('[') {
            self.bundles()?;
        }
        Ok(Op::Call(Call { tail, flags, result, callee, arguments, attributes }))
    }

    fn asm(&mut self) -> Parsed<Callee> {
        self.expect_word("asm")?;
        let mut side_effect = false;
        while let Some(word) = self.one_of(&["sideeffect", "alignstack", "inteldialect"]) {
            side_effect |= word == "sideeffect";
        }
        let text = self.text()?;
        self.expect(',')?;
        Ok(Callee::Asm { text, constraints: self.text()?, side_effect })
    }

    /// The promise of an assumption: `"align"(ptr %1, i64 16) ]`.
    fn bundles(&mut self) -> Parsed<()> {
        loop {
            match self.next() {
                Token::Text("align" | "nonnull" | "noundef" | "dereferenceable" | "range" | "separate_storage") => {
                    self.parentheses()?;
                }
                Token::Punctuation(',') => {}
                Token::Punctuation(']') => return Ok(()),
                _ => {
                    self.at -= 1;
                    return self.unexpected("an operand bundle that only promises");
                }
            }
        }
    }
}
