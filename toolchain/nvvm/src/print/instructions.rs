//! Prints instructions.

use std::fmt::Write;

use super::{Printed, Printer, align, values};
use crate::Dialect;
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Call, Callee, Op, Type, Typed, Value};
use optix_llvm_ir::opcode::{Other, Predicate};

impl Printer<'_> {
    /// The text of an instruction without the name of its result. Lines that have to come before it are printed.
    pub(super) fn op(&mut self, op: &Op) -> Printed {
        Ok(match op {
            Op::Binary { op, flags, a, b } => {
                format!("{op}{} {}, {}", spaced(flags), self.typed(a)?, self.value(&a.ty, b)?)
            }
            Op::Compare { predicate, flags, a, b } => {
                let op = match predicate {
                    Predicate::Int(_) => Other::ICmp,
                    Predicate::Float(_) => Other::FCmp,
                };
                format!("{op}{} {predicate} {}, {}", spaced(flags), self.typed(a)?, self.value(&a.ty, b)?)
            }
            Op::Cast { op, value, to } => format!("{op} {} to {}", self.typed(value)?, self.ty(to)),
            Op::Select { condition, yes, no } => {
                format!("select {}, {}, {}", self.typed(condition)?, self.typed(yes)?, self.typed(no)?)
            }
            Op::Phi { ty, incoming } => {
                let mut text = format!("phi {}", self.ty(ty));
                for (at, (value, from)) in incoming.iter().enumerate() {
                    let comma = if at == 0 { "" } else { "," };
                    let _ = write!(text, "{comma} [ {}, {} ]", self.value(ty, value)?, values::local(from));
                }
                text
            }
            Op::Load { ty, pointer, align, volatile, ordering: None } => {
                let pointer = self.pointer(pointer, ty)?;
                format!("load {}{}, {pointer}{}", volatile_word(*volatile), self.ty(ty), alignment(*align))
            }
            Op::Store { value, pointer, align, volatile, ordering: None } => {
                let pointer = self.pointer(pointer, &value.ty)?;
                format!("store {}{}, {pointer}{}", volatile_word(*volatile), self.typed(value)?, alignment(*align))
            }
            Op::Address { inbounds, of, base, indices } => return self.address(*inbounds, of, base, indices),
            Op::Alloca { ty, count, align } => {
                let count = match count {
                    Some(count) => format!(", {}", self.typed(count)?),
                    None => String::new(),
                };
                let text = format!("alloca {}{count}{}", self.ty(ty), alignment(*align));
                return Ok(self.without_pointee(text, ty, 0));
            }
            Op::ExtractValue { aggregate, indices } => {
                format!("extractvalue {}{}", self.typed(aggregate)?, numbers(indices))
            }
            Op::InsertValue { aggregate, value, indices } => {
                format!("insertvalue {}, {}{}", self.typed(aggregate)?, self.typed(value)?, numbers(indices))
            }
            Op::ExtractElement { vector, index } => {
                format!("extractelement {}, {}", self.typed(vector)?, self.typed(index)?)
            }
            Op::InsertElement { vector, value, index } => {
                format!("insertelement {}, {}, {}", self.typed(vector)?, self.typed(value)?, self.typed(index)?)
            }
            Op::Shuffle { a, b, mask } => {
                format!("shufflevector {}, {}, {}", self.typed(a)?, self.typed(b)?, self.typed(mask)?)
            }
            Op::Call(call) => self.call(call)?,
            Op::Return(None) => "ret void".into(),
            Op::Return(Some(value)) => format!("ret {}", self.typed(value)?),
            Op::Jump(to) => format!("br label {}", values::local(to)),
            Op::Branch { condition, yes, no } => {
                let condition = self.value(&Type::BOOL, condition)?;
                format!("br i1 {condition}, label {}, label {}", values::local(yes), values::local(no))
            }
            Op::Switch { value, default, cases } => {
                let mut text = format!("switch {}, label {} [", self.typed(value)?, values::local(default));
                for (case, to) in cases {
                    let case = self.value(&value.ty, case)?;
                    let _ = write!(text, " {} {case}, label {}", self.ty(&value.ty), values::local(to));
                }
                text + " ]"
            }
            Op::Unreachable => "unreachable".into(),
            Op::Load { .. }
            | Op::Store { .. }
            | Op::Negate { .. }
            | Op::Freeze { .. }
            | Op::ReadModifyWrite { .. }
            | Op::CompareExchange { .. }
            | Op::Fence(_) => return Err(Unknown::new("an instruction that was not lowered")),
        })
    }

    /// A pointer with its type, as one to `pointee`.
    fn pointer(&mut self, pointer: &Typed, pointee: &Type) -> Printed {
        let Type::Pointer(space) = pointer.ty else {
            return Err(Unknown::new(format!("an access through {:?}", pointer.ty)));
        };
        if !matches!(pointer.value, Value::Local(_)) || self.dialect == Dialect::Modern || *pointee == Type::Int(8) {
            return self.constant_pointer(pointer, pointee, space);
        }
        let to = self.pointer_to(&self.ty(pointee), space);
        let name = self.fresh();
        let from = self.typed(pointer)?;
        self.say(format_args!("  {name} = bitcast {from} to {to}"));
        Ok(format!("{to} {name}"))
    }

    fn address(&mut self, inbounds: bool, of: &Type, base: &Typed, indices: &[Typed]) -> Printed {
        let Type::Pointer(space) = base.ty else {
            return Err(Unknown::new("several addresses at once"));
        };
        if indices.iter().any(|index| !matches!(index.ty, Type::Int(_))) {
            return Err(Unknown::new("several addresses at once"));
        }
        let base = self.pointer(base, of)?;
        let inbounds = if inbounds { "inbounds " } else { "" };
        let mut text = format!("getelementptr {inbounds}{}, {base}", self.ty(of));
        for index in indices {
            let _ = write!(text, ", {}", self.typed(index)?);
        }
        let pointee = self.pointee(of, indices)?;
        Ok(self.without_pointee(text, &pointee, space))
    }

    /// Text that converts the result of the instruction `text`, a pointer to `pointee`, to a pointer without pointee.
    fn without_pointee(&mut self, text: String, pointee: &Type, space: u32) -> String {
        if self.dialect == Dialect::Modern || *pointee == Type::Int(8) {
            return text;
        }
        let name = self.fresh();
        self.say(format_args!("  {name} = {text}"));
        let from = self.pointer_to(&self.ty(pointee), space);
        format!("bitcast {from} {name} to {}", self.ty(&Type::Pointer(space)))
    }

    fn call(&mut self, call: &Call) -> Printed {
        let result = self.ty(&call.result);
        let callee = match &call.callee {
            Callee::Asm { text, constraints, side_effect } => {
                let side_effect = if *side_effect { "sideeffect " } else { "" };
                format!("asm {side_effect}\"{text}\", \"{constraints}\"")
            }
            Callee::Function(Value::Global(name)) => {
                let Some(function) = self.functions.get(name.as_str()) else {
                    return Err(Unknown::new(format!("a call of `{name}`, which is declared nowhere")));
                };
                let same = function.result == call.result
                    && !function.variadic
                    && function.parameters.len() == call.arguments.len()
                    && function.parameters.iter().zip(&call.arguments).all(|(parameter, argument)| {
                        parameter.value.ty == argument.value.ty && parameter.by_value == argument.by_value
                    });
                if !same {
                    return Err(Unknown::new("a call with other types than the function's"));
                }
                self.function_name(name)
            }
            Callee::Function(value) => {
                let pointer = Typed::new(Type::Pointer(0), value.clone());
                let arguments: Vec<String> = call.arguments.iter().map(|a| self.ty(&a.value.ty)).collect();
                match self.dialect {
                    Dialect::Modern => self.value(&pointer.ty, value)?,
                    Dialect::Llvm7 => {
                        let name = self.fresh();
                        let from = self.typed(&pointer)?;
                        let to = format!("{result} ({})*", arguments.join(", "));
                        self.say(format_args!("  {name} = bitcast {from} to {to}"));
                        name
                    }
                }
            }
        };
        let copies_memory = call.name().is_some_and(|name| name.starts_with("llvm.mem"));
        let mut arguments = Vec::new();
        for argument in &call.arguments {
            let words = self.value_attributes(argument);
            let align = if copies_memory || argument.by_value.is_some() { align(argument) } else { String::new() };
            arguments.push(match (&argument.by_value, self.dialect) {
                (Some(ty), Dialect::Llvm7) => {
                    let pointer = self.pointer(&argument.value, ty)?;
                    let (ty, name) = pointer.split_once("* ").unwrap_or((&pointer, ""));
                    format!("{ty}*{words} byval{align} {name}")
                }
                (by_value, _) => {
                    let copy = by_value.as_ref().map(|ty| format!(" byval({})", self.ty(ty))).unwrap_or_default();
                    let value = self.value(&argument.value.ty, &argument.value.value)?;
                    format!("{}{words}{copy}{align} {value}", self.ty(&argument.value.ty))
                }
            });
        }
        let tail = if call.tail { "tail " } else { "" };
        let attributes = self.attributes(&call.attributes);
        Ok(format!("{tail}call {result} {callee}({}){attributes}", arguments.join(", ")))
    }
}

fn spaced(words: &[String]) -> String {
    words.iter().map(|word| format!(" {word}")).collect()
}

fn numbers(indices: &[u64]) -> String {
    indices.iter().map(|index| format!(", {index}")).collect()
}

fn alignment(align: Option<u64>) -> String {
    align.map(|align| format!(", align {align}")).unwrap_or_default()
}

fn volatile_word(volatile: bool) -> &'static str {
    if volatile { "volatile " } else { "" }
}
