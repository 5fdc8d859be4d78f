//! Appends instructions to the function that is being lowered.

use std::collections::{HashMap, HashSet};

use super::{Called, Lowered};
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Argument, Attributes, Call, Callee, Instruction, Op, Type, Typed, Value};
use optix_llvm_ir::opcode::{Binary, Cast, IntPredicate, Predicate};

/// The first character of names that are made here. No compiler writes it.
pub(crate) const FRESH: char = '~';

pub(super) struct Builder<'a> {
    called: &'a mut Called,
    /// The functions that the module defines.
    own: &'a HashSet<String>,
    out: Vec<Instruction>,
    /// The values that replace the results of instructions.
    renamed: HashMap<String, Value>,
    /// The local names whose values can't be undefined.
    pub defined: HashSet<String>,
    /// The line of the text that is being lowered.
    pub line: usize,
    /// Its debug location.
    debug: Option<(String, String)>,
    count: usize,
}

impl<'a> Builder<'a> {
    pub fn new(called: &'a mut Called, own: &'a HashSet<String>, defined: HashSet<String>) -> Self {
        Self { called, own, out: Vec::new(), renamed: HashMap::new(), defined, line: 0, debug: None, count: 0 }
    }

    /// From here on, what is appended replaces this instruction.
    pub fn at(&mut self, instruction: &Instruction) {
        self.line = instruction.line;
        self.debug = instruction.metadata.iter().find(|(name, _)| name == "dbg").cloned();
    }

    /// Takes the instructions that were appended since the last call.
    pub fn take(&mut self) -> Vec<Instruction> {
        std::mem::take(&mut self.out)
    }

    pub fn into_renamed(self) -> HashMap<String, Value> {
        self.renamed
    }

    pub fn keep(&mut self, instruction: Instruction) {
        self.out.push(instruction);
    }

    pub fn rename(&mut self, name: String, value: Value) {
        self.renamed.insert(name, value);
    }

    /// Whether the module defines the function.
    pub fn is_own(&self, function: &str) -> bool {
        self.own.contains(function)
    }

    /// Appends an instruction with a result.
    fn push(&mut self, op: Op, ty: Type) -> Typed {
        let name = format!("{FRESH}{}", self.count);
        self.count += 1;
        self.append(Some(name.clone()), op);
        Typed::new(ty, Value::Local(name))
    }

    fn push_void(&mut self, op: Op) {
        self.append(None, op);
    }

    fn append(&mut self, result: Option<String>, op: Op) {
        let metadata = self.debug.iter().cloned().collect();
        self.out.push(Instruction { result, op, metadata, line: self.line });
    }

    pub fn binary(&mut self, op: Binary, a: &Typed, b: &Typed) -> Typed {
        let ty = a.ty.clone();
        self.push(Op::Binary { op, flags: Vec::new(), a: a.clone(), b: b.value.clone() }, ty)
    }

    /// `binary` with a constant integer.
    pub fn with(&mut self, op: Binary, a: &Typed, b: i128) -> Typed {
        self.binary(op, a, &constant(&a.ty, b))
    }

    pub fn compare(&mut self, predicate: impl Into<Predicate>, a: &Typed, b: &Typed) -> Typed {
        let ty = a.ty.with_element(Type::BOOL);
        self.push(Op::Compare { predicate: predicate.into(), flags: Vec::new(), a: a.clone(), b: b.value.clone() }, ty)
    }

    pub fn select(&mut self, condition: &Typed, yes: &Typed, no: &Typed) -> Typed {
        let op = Op::Select { condition: condition.clone(), yes: yes.clone(), no: no.clone() };
        self.push(op, yes.ty.clone())
    }

    /// `a` if the comparison holds, else `b`.
    pub fn select_by(&mut self, predicate: IntPredicate, a: &Typed, b: &Typed) -> Typed {
        let condition = self.compare(predicate, a, b);
        self.select(&condition, a, b)
    }

    /// A conversion, which is left out if the value has the type already.
    pub fn cast(&mut self, op: Cast, value: &Typed, to: &Type) -> Typed {
        if value.ty == *to {
            return value.clone();
        }
        self.push(Op::Cast { op, value: value.clone(), to: to.clone() }, to.clone())
    }

    pub fn extract(&mut self, vector: &Typed, index: u64) -> Typed {
        let index = Typed::int(32, index.into());
        self.push(Op::ExtractElement { vector: vector.clone(), index }, vector.ty.element().clone())
    }

    pub fn insert(&mut self, vector: &Typed, value: Typed, index: u64) -> Typed {
        let index = Typed::int(32, index.into());
        self.push(Op::InsertElement { vector: vector.clone(), value, index }, vector.ty.clone())
    }

    /// A struct of two fields.
    pub fn pair(&mut self, a: &Typed, b: &Typed) -> Typed {
        let ty = Type::Struct { fields: vec![a.ty.clone(), b.ty.clone()], packed: false };
        let none = Typed::new(ty.clone(), Value::Undef);
        let one = self.push(Op::InsertValue { aggregate: none, value: a.clone(), indices: vec![0] }, ty.clone());
        self.push(Op::InsertValue { aggregate: one, value: b.clone(), indices: vec![1] }, ty)
    }

    /// Calls a function of LLVM 7 or libdevice whose result depends only on its arguments.
    pub fn pure(&mut self, name: &str, result: &Type, arguments: &[&Typed]) -> Result<Typed, Unknown> {
        let arguments = arguments.iter().map(|value| argument((*value).clone())).collect();
        let call = self.call_of(name, result, arguments, vec!["nounwind".into(), "readnone".into()])?;
        Ok(self.push(Op::Call(call), result.clone()))
    }

    /// As [`Self::pure`], for a function with effects and no result.
    pub fn effect(&mut self, name: &str, arguments: Vec<Argument>, attributes: Attributes) -> Result<(), Unknown> {
        let call = self.call_of(name, &Type::Void, arguments, attributes)?;
        self.push_void(Op::Call(call));
        Ok(())
    }

    /// As [`Self::pure`], for a function that the module declares itself.
    pub fn call(&mut self, name: &str, call: &Call) -> Lowered {
        let call = self.call_of(name, &call.result, call.arguments.clone(), call.attributes.clone())?;
        Ok(if call.result == Type::Void {
            self.push_void(Op::Call(call));
            None
        } else {
            let result = call.result.clone();
            Some(self.push(Op::Call(call), result))
        })
    }

    fn call_of(
        &mut self,
        name: &str,
        result: &Type,
        arguments: Vec<Argument>,
        attributes: Attributes,
    ) -> Result<Call, Unknown> {
        let types: Vec<Type> = arguments.iter().map(|argument| argument.value.ty.clone()).collect();
        let signature = (result.clone(), types);
        match self.called.get(name) {
            Some(known) if *known != signature => {
                return Err(Unknown::new(format!("`{name}` with two types")));
            }
            Some(_) => {}
            None => drop(self.called.insert(name.to_string(), signature)),
        }
        let callee = Callee::Function(Value::Global(name.to_string()));
        Ok(Call { tail: false, flags: Vec::new(), result: result.clone(), callee, arguments, attributes })
    }

    /// Inline assembly whose result depends only on its operands. The letter of the constraint gives the class of the
    /// result's register.
    pub fn asm(&mut self, text: &str, constraints: &str, result: &Type, operands: &[&Typed]) -> Typed {
        let call = asm_call(text, constraints, result, operands, false);
        self.push(Op::Call(call), result.clone())
    }

    /// Inline assembly that reads or writes memory.
    pub fn asm_memory(&mut self, text: &str, constraints: &str, result: &Type, operands: &[&Typed]) -> Typed {
        let call = asm_call(text, constraints, result, operands, true);
        if *result == Type::Void {
            self.push_void(Op::Call(call));
            return Typed::new(Type::Void, Value::Undef);
        }
        self.push(Op::Call(call), result.clone())
    }
}

pub(super) fn argument(value: Typed) -> Argument {
    Argument { value, attributes: Vec::new(), by_value: None, align: None }
}

pub(super) fn asm_call(text: &str, constraints: &str, result: &Type, operands: &[&Typed], memory: bool) -> Call {
    let mut constraints = constraints.to_string();
    let mut attributes = vec!["nounwind".to_string()];
    if memory {
        constraints.push_str(if constraints.is_empty() { "~{memory}" } else { ",~{memory}" });
    } else {
        attributes.push("readnone".into());
    }
    Call {
        tail: false,
        flags: Vec::new(),
        result: result.clone(),
        callee: Callee::Asm { text: text.into(), constraints, side_effect: memory },
        arguments: operands.iter().map(|value| argument((*value).clone())).collect(),
        attributes,
    }
}

/// A constant of the type with this integer in each element.
pub(super) fn constant(ty: &Type, value: i128) -> Typed {
    let value = match ty {
        Type::Vector(count, element) => {
            Value::Aggregate(vec![Typed::new((**element).clone(), Value::int(value)); *count as usize])
        }
        _ => Value::int(value),
    };
    Typed::new(ty.clone(), value)
}

/// A constant of the type with this float in each element. For `half` and `float` it must be exactly representable.
pub(super) fn float(ty: &Type, value: f64) -> Typed {
    let one = match ty.element() {
        Type::Half => unreachable!("arithmetic on `half` is done in `float`"),
        _ => Value::Number(format!("0x{:016X}", value.to_bits())),
    };
    let value = match ty {
        Type::Vector(count, element) => Value::Aggregate(vec![Typed::new((**element).clone(), one); *count as usize]),
        _ => one,
    };
    Typed::new(ty.clone(), value)
}
