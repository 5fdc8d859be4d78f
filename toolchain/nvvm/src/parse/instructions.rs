//! Instructions.

use super::module::is_nothing;
use super::{Parsed, Parser};
use crate::lexer::Token;
use crate::model::{Argument, Call, Callee, Instruction, Op, Ordering, Type, Typed, Value};
use crate::refusal::Unknown;

const BINARY: [&str; 18] = [
    "add", "sub", "mul", "udiv", "sdiv", "urem", "srem", "shl", "lshr", "ashr", "and", "or", "xor", "fadd", "fsub",
    "fmul", "fdiv", "frem",
];
const CASTS: [&str; 14] = [
    "trunc",
    "zext",
    "sext",
    "fptrunc",
    "fpext",
    "fptoui",
    "fptosi",
    "uitofp",
    "sitofp",
    "ptrtoint",
    "ptrtoaddr",
    "inttoptr",
    "bitcast",
    "addrspacecast",
];
/// Flags of integer arithmetic that LLVM 7 knows.
const INTEGER_FLAGS: [&str; 3] = ["nuw", "nsw", "exact"];
/// Flags that LLVM 7 does not know; what they promise need not be used.
const NEWER_FLAGS: [&str; 3] = ["disjoint", "nneg", "samesign"];
const FLOAT_FLAGS: [&str; 8] = ["nnan", "ninf", "nsz", "arcp", "contract", "afn", "reassoc", "fast"];
const ORDERINGS: [&str; 6] = ["unordered", "monotonic", "acquire", "release", "acq_rel", "seq_cst"];
const ATOMICS: [&str; 11] = ["xchg", "add", "sub", "and", "or", "xor", "max", "min", "umax", "umin", "fadd"];
/// What is kept of the metadata on instructions; the rest promises what need not be used.
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
        let word = self.word()?;
        match word {
            op if BINARY.contains(&op) => {
                let known: &[&str] = if op.starts_with('f') { &FLOAT_FLAGS } else { &INTEGER_FLAGS };
                let flags = self.flags(known);
                let a = self.typed()?;
                let b = self.second(&a.ty)?;
                Ok(Op::Binary { op: op.to_string(), flags, a, b })
            }
            op if CASTS.contains(&op) => {
                // No flag of a conversion is LLVM 7's.
                self.flags(&["nuw", "nsw", "nnan", "ninf", "nsz", "arcp", "contract", "afn", "reassoc", "fast"]);
                let value = self.typed()?;
                self.expect_word("to")?;
                let op = if op == "ptrtoaddr" { "ptrtoint" } else { op }.to_string();
                Ok(Op::Cast { op, value, to: self.ty()? })
            }
            "fneg" => {
                self.flags(&FLOAT_FLAGS);
                Ok(Op::Negate { value: self.typed()? })
            }
            "freeze" => Ok(Op::Freeze { value: self.typed()? }),
            "icmp" | "fcmp" => {
                let flags = self.flags(if word == "icmp" { &[] } else { &FLOAT_FLAGS });
                let predicate = self.word()?.to_string();
                let a = self.typed()?;
                let b = self.second(&a.ty)?;
                Ok(Op::Compare { op: word.to_string(), flags, predicate, a, b })
            }
            "select" => {
                self.flags(&FLOAT_FLAGS);
                let condition = self.typed()?;
                let yes = self.typed_after_comma()?;
                Ok(Op::Select { condition, yes, no: self.typed_after_comma()? })
            }
            "phi" => {
                self.flags(&FLOAT_FLAGS);
                self.phi()
            }
            "load" | "store" => self.access(word == "load"),
            "getelementptr" => {
                let inbounds = self.address_flags()?;
                let of = self.ty()?;
                let base = self.typed_after_comma()?;
                let mut indices = Vec::new();
                while self.has_operand() {
                    indices.push(self.typed_after_comma()?);
                }
                Ok(Op::Address { inbounds, of, base, indices })
            }
            "alloca" => {
                let ty = self.ty()?;
                let count = if self.has_operand() && self.peek_at(1) != Token::Word("align") {
                    Some(self.typed_after_comma()?)
                } else {
                    None
                };
                Ok(Op::Alloca { ty, count, align: self.alignment()? })
            }
            "extractvalue" => {
                let aggregate = self.typed()?;
                Ok(Op::ExtractValue { aggregate, indices: self.indices()? })
            }
            "insertvalue" => {
                let aggregate = self.typed()?;
                let value = self.typed_after_comma()?;
                Ok(Op::InsertValue { aggregate, value, indices: self.indices()? })
            }
            "extractelement" => {
                let vector = self.typed()?;
                Ok(Op::ExtractElement { vector, index: self.typed_after_comma()? })
            }
            "insertelement" => {
                let vector = self.typed()?;
                let value = self.typed_after_comma()?;
                Ok(Op::InsertElement { vector, value, index: self.typed_after_comma()? })
            }
            "shufflevector" => {
                let a = self.typed()?;
                let b = self.typed_after_comma()?;
                Ok(Op::Shuffle { a, b, mask: self.typed_after_comma()? })
            }
            "atomicrmw" => {
                self.eat_word("volatile");
                let Some(op) = self.one_of(&ATOMICS) else {
                    return self.unexpected("an atomic operation that the GPU has");
                };
                let pointer = self.typed()?;
                let value = self.typed_after_comma()?;
                let ordering = self.ordering()?;
                self.alignment()?;
                Ok(Op::ReadModifyWrite { op: op.to_string(), pointer, value, ordering })
            }
            "cmpxchg" => {
                while self.one_of(&["weak", "volatile"]).is_some() {}
                let pointer = self.typed()?;
                let expected = self.typed_after_comma()?;
                let new = self.typed_after_comma()?;
                let mut ordering = self.ordering()?;
                // What failure needs; success gives at least as much, and the machine has one for both.
                if let Some(failure) = self.one_of(&ORDERINGS) {
                    ordering.order = stronger(&ordering.order, failure).to_string();
                }
                self.alignment()?;
                Ok(Op::CompareExchange { pointer, expected, new, ordering })
            }
            "fence" => Ok(Op::Fence(self.ordering()?)),
            "tail" | "musttail" | "notail" => {
                self.expect_word("call")?;
                self.call(word != "notail")
            }
            "call" => self.call(false),
            "ret" => {
                let ty = self.ty()?;
                if is_nothing(&ty) {
                    return Ok(Op::Return(None));
                }
                let value = self.value(&ty)?;
                Ok(Op::Return(Some(Typed { ty, value })))
            }
            "br" => self.branch(),
            "switch" => self.switch(),
            "unreachable" => Ok(Op::Unreachable),
            "invoke" | "landingpad" | "resume" | "cleanuppad" | "catchswitch" => {
                Err(Unknown::new("unwinding").hint("device code is compiled with `panic = \"abort\"`"))
            }
            "va_arg" => Err(Unknown::new("a list of variable arguments").hint("pass a slice")),
            other => Err(Unknown::new(format!("the instruction `{other}`"))),
        }
    }

    /// The second operand, of the first one's type.
    fn second(&mut self, ty: &Type) -> Parsed<Value> {
        self.expect(',')?;
        self.value(ty)
    }

    fn typed_after_comma(&mut self) -> Parsed<Typed> {
        self.expect(',')?;
        self.typed()
    }

    /// Whether a comma comes that is not followed by metadata.
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
        match self.one_of(&ORDERINGS) {
            Some(order) => Ok(Ordering { order: order.to_string(), scope }),
            None => self.unexpected("a memory ordering"),
        }
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
        // The type of a function with variable arguments is written out.
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
            // `metadata !5` may also be a node that is written out.
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

    /// `"align"(ptr %1, i64 16) ]`: what an assumption promises.
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

/// The stronger of two orderings of a compare-exchange.
fn stronger<'a>(success: &'a str, failure: &'a str) -> &'a str {
    match (success, failure) {
        ("seq_cst", _) | (_, "seq_cst") => "seq_cst",
        ("release", "acquire") => "acq_rel",
        ("monotonic", "acquire") => "acquire",
        _ => success,
    }
}
