//! A model of LLVM IR, as far as rustc writes it for device code after link-time optimisation.
//!
//! Poison is represented as `undef`, which is one of the values that poison may become. Attributes and flags that can
//! be left out without changing the meaning of a program are left out by the parser, unless both dialects know them.

use std::collections::BTreeMap;

use crate::opcode::{Atomic, Binary, Cast, Order, Predicate};

/// A type. The parser refuses other types of LLVM.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Type {
    Void,
    Label,
    Metadata,
    Int(u32),
    Half,
    Float,
    Double,
    /// A pointer to the address space.
    Pointer(u32),
    Array(u64, Box<Type>),
    Vector(u64, Box<Type>),
    Struct {
        fields: Vec<Type>,
        packed: bool,
    },
    Named(String),
}

impl Type {
    pub const BOOL: Self = Self::Int(1);

    /// The bits of a number or pointer; `None` for other types.
    pub fn bits(&self) -> Option<u32> {
        match self {
            Self::Int(bits) => Some(*bits),
            Self::Half => Some(16),
            Self::Float => Some(32),
            Self::Double | Self::Pointer(_) => Some(64),
            _ => None,
        }
    }

    pub fn is_float(&self) -> bool {
        matches!(self, Self::Half | Self::Float | Self::Double)
    }

    /// The type of the elements of a vector; other types are returned as they are.
    pub fn element(&self) -> &Self {
        if let Self::Vector(_, element) = self { element } else { self }
    }

    /// A vector of `element` with as many elements as this one; `element` itself if this is no vector.
    pub fn with_element(&self, element: Self) -> Self {
        if let Self::Vector(count, _) = self { Self::Vector(*count, Box::new(element)) } else { element }
    }
}

/// A value without its type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Value {
    Local(String),
    Global(String),
    /// An integer or a float as it was written, `true` or `false`.
    Number(String),
    Null,
    Undef,
    /// `zeroinitializer`
    Zero,
    /// Elements or fields, as the type says.
    Aggregate(Vec<Typed>),
    /// `c"..."` with its escapes.
    Bytes(String),
    Expression(Box<Expression>),
    /// Metadata such as `!5`, used as an argument.
    Metadata(String),
}

impl Value {
    pub fn int(value: i128) -> Self {
        Self::Number(value.to_string())
    }

    /// Calls `f` with the name of each function and variable in it.
    pub fn globals<'v>(&'v self, f: &mut impl FnMut(&'v str)) {
        match self {
            Self::Global(name) => f(name),
            Self::Aggregate(parts) => parts.iter().for_each(|part| part.value.globals(f)),
            Self::Expression(expression) => match &**expression {
                Expression::Cast { value, .. } => value.value.globals(f),
                Expression::Address { base, indices, .. } => {
                    base.value.globals(f);
                    indices.iter().for_each(|index| index.value.globals(f));
                }
                Expression::Binary { a, b, .. } => {
                    a.value.globals(f);
                    b.value.globals(f);
                }
            },
            Self::Local(_)
            | Self::Number(_)
            | Self::Null
            | Self::Undef
            | Self::Zero
            | Self::Bytes(_)
            | Self::Metadata(_) => {}
        }
    }

    /// The value of an integer constant.
    pub fn as_int(&self) -> Option<i128> {
        match self {
            Self::Number(text) if text == "true" => Some(1),
            Self::Number(text) if text == "false" => Some(0),
            Self::Number(text) => text.parse().ok(),
            Self::Zero => Some(0),
            _ => None,
        }
    }
}

/// A value with its type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Typed {
    pub ty: Type,
    pub value: Value,
}

impl Typed {
    pub fn new(ty: Type, value: Value) -> Self {
        Self { ty, value }
    }

    pub fn int(bits: u32, value: i128) -> Self {
        Self::new(Type::Int(bits), Value::int(value))
    }
}

/// A constant that is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expression {
    Cast { op: Cast, value: Typed, to: Type },
    Address { inbounds: bool, of: Type, base: Typed, indices: Vec<Typed> },
    Binary { op: Binary, a: Typed, b: Typed },
}

/// The memory ordering of an atomic operation, and the threads for which it holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ordering {
    pub order: Order,
    /// `syncscope("..")`; empty for the system.
    pub scope: String,
}

/// Attributes of a function or call, in LLVM 7's words.
pub type Attributes = Vec<String>;

/// An argument or a parameter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Argument {
    pub value: Typed,
    pub attributes: Attributes,
    /// What the pointer points to is passed as a copy.
    pub by_value: Option<Type>,
    pub align: Option<u64>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Callee {
    Function(Value),
    Asm { text: String, constraints: String, side_effect: bool },
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Call {
    pub tail: bool,
    pub flags: Vec<String>,
    pub result: Type,
    pub callee: Callee,
    pub arguments: Vec<Argument>,
    pub attributes: Attributes,
}

impl Call {
    /// The name of the function that is called, if it is known.
    pub fn name(&self) -> Option<&str> {
        if let Callee::Function(Value::Global(name)) = &self.callee { Some(name) } else { None }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Op {
    Binary { op: Binary, flags: Vec<String>, a: Typed, b: Value },
    Negate { value: Typed },
    Freeze { value: Typed },
    Cast { op: Cast, value: Typed, to: Type },
    Compare { predicate: Predicate, flags: Vec<String>, a: Typed, b: Value },
    Select { condition: Typed, yes: Typed, no: Typed },
    Phi { ty: Type, incoming: Vec<(Value, String)> },
    Load { ty: Type, pointer: Typed, align: Option<u64>, volatile: bool, ordering: Option<Ordering> },
    Store { value: Typed, pointer: Typed, align: Option<u64>, volatile: bool, ordering: Option<Ordering> },
    Address { inbounds: bool, of: Type, base: Typed, indices: Vec<Typed> },
    Alloca { ty: Type, count: Option<Typed>, align: Option<u64> },
    ExtractValue { aggregate: Typed, indices: Vec<u64> },
    InsertValue { aggregate: Typed, value: Typed, indices: Vec<u64> },
    ExtractElement { vector: Typed, index: Typed },
    InsertElement { vector: Typed, value: Typed, index: Typed },
    Shuffle { a: Typed, b: Typed, mask: Typed },
    ReadModifyWrite { op: Atomic, pointer: Typed, value: Typed, ordering: Ordering },
    CompareExchange { pointer: Typed, expected: Typed, new: Typed, ordering: Ordering },
    Fence(Ordering),
    Call(Call),
    Return(Option<Typed>),
    Jump(String),
    Branch { condition: Value, yes: String, no: String },
    Switch { value: Typed, default: String, cases: Vec<(Value, String)> },
    Unreachable,
}

/// Calls `$f` with a reference, which may be `mut`, to each value of the instruction `$op`.
macro_rules! each_value {
    ($op:expr, $f:expr $(, $mut:tt)?) => {
        match $op {
            Op::Binary { a, b, .. } | Op::Compare { a, b, .. } => {
                $f(&$($mut)? a.value);
                $f(b);
            }
            Op::Negate { value } | Op::Freeze { value } | Op::Cast { value, .. } => $f(&$($mut)? value.value),
            Op::Select { condition, yes, no } => [condition, yes, no].into_iter().for_each(|v| $f(&$($mut)? v.value)),
            Op::Phi { incoming, .. } => incoming.into_iter().for_each(|(value, _)| $f(value)),
            Op::Load { pointer, .. } => $f(&$($mut)? pointer.value),
            Op::Store { value, pointer, .. } | Op::ReadModifyWrite { value, pointer, .. } => {
                $f(&$($mut)? value.value);
                $f(&$($mut)? pointer.value);
            }
            Op::Address { base, indices, .. } => {
                $f(&$($mut)? base.value);
                indices.into_iter().for_each(|index| $f(&$($mut)? index.value));
            }
            Op::Alloca { count, .. } => count.into_iter().for_each(|count| $f(&$($mut)? count.value)),
            Op::ExtractValue { aggregate, .. } => $f(&$($mut)? aggregate.value),
            Op::InsertValue { aggregate, value, .. } => {
                [aggregate, value].into_iter().for_each(|v| $f(&$($mut)? v.value));
            }
            Op::ExtractElement { vector, index } => {
                [vector, index].into_iter().for_each(|v| $f(&$($mut)? v.value));
            }
            Op::InsertElement { vector, value, index } => {
                [vector, value, index].into_iter().for_each(|v| $f(&$($mut)? v.value));
            }
            Op::Shuffle { a, b, .. } => [a, b].into_iter().for_each(|v| $f(&$($mut)? v.value)),
            Op::CompareExchange { pointer, expected, new, .. } => {
                [pointer, expected, new].into_iter().for_each(|v| $f(&$($mut)? v.value));
            }
            Op::Call(call) => {
                if let Callee::Function(function) = &$($mut)? call.callee {
                    $f(function);
                }
                (&$($mut)? call.arguments).into_iter().for_each(|argument| $f(&$($mut)? argument.value.value));
            }
            Op::Return(value) => value.into_iter().for_each(|value| $f(&$($mut)? value.value)),
            Op::Branch { condition, .. } => $f(condition),
            Op::Switch { value, .. } => $f(&$($mut)? value.value),
            Op::Jump(_) | Op::Fence(_) | Op::Unreachable => {}
        }
    };
}

impl Op {
    /// Calls `f` with each value that it uses.
    pub fn values<'v>(&'v self, f: &mut impl FnMut(&'v Value)) {
        each_value!(self, f);
    }

    /// Calls `f` with each value that it uses, which `f` may change.
    pub fn values_mut(&mut self, f: &mut impl FnMut(&mut Value)) {
        each_value!(self, f, mut);
    }

    /// The blocks that may be executed next.
    pub fn successors(&self) -> Vec<&str> {
        match self {
            Self::Jump(to) => vec![to],
            Self::Branch { yes, no, .. } => vec![yes, no],
            Self::Switch { default, cases, .. } => {
                std::iter::once(default).chain(cases.iter().map(|(_, to)| to)).map(String::as_str).collect()
            }
            _ => Vec::new(),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instruction {
    pub result: Option<String>,
    pub op: Op,
    /// The metadata attached to it, such as `("range", "!5")`.
    pub metadata: Vec<(String, String)>,
    /// The line of the source text, from 0.
    pub line: usize,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    pub name: String,
    pub instructions: Vec<Instruction>,
}

/// A function; a declaration has no blocks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function {
    pub name: String,
    pub linkage: Option<String>,
    pub kernel: bool,
    pub result: Type,
    /// The value is the parameter's name, or undefined if it has none.
    pub parameters: Vec<Argument>,
    pub variadic: bool,
    pub attributes: Attributes,
    /// The number of the metadata node that describes its source.
    pub debug: Option<String>,
    pub blocks: Vec<Block>,
    pub line: usize,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variable {
    pub name: String,
    pub linkage: Option<String>,
    pub unnamed_address: bool,
    pub space: u32,
    pub constant: bool,
    pub ty: Type,
    pub value: Option<Value>,
    pub section: Option<String>,
    pub align: Option<u64>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Module {
    /// The lines of `module asm`, with their escapes.
    pub asm: Vec<String>,
    /// Named types; one without fields is opaque.
    pub types: Vec<(String, Option<Type>)>,
    pub variables: Vec<Variable>,
    pub functions: Vec<Function>,
    /// `!5 = ..`, by name and text.
    pub metadata: BTreeMap<String, String>,
    /// `!5 = !DILocation(..)` and its kin, by name.
    pub debug: BTreeMap<String, DebugNode>,
}

/// A node of debug information.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DebugNode {
    /// `DILocation`
    pub kind: String,
    /// Name and text: `("line", "12")`, `("scope", "!5")`.
    pub fields: Vec<(String, String)>,
}

impl Module {
    /// Every instruction, with the function that it is in.
    pub fn instructions(&self) -> impl Iterator<Item = (&Function, &Instruction)> {
        let blocks =
            self.functions.iter().flat_map(|function| function.blocks.iter().map(move |block| (function, block)));
        blocks.flat_map(|(function, block)| block.instructions.iter().map(move |instruction| (function, instruction)))
    }
}

impl DebugNode {
    /// The text of a field.
    pub fn field(&self, name: &str) -> Option<&str> {
        self.fields.iter().find(|(known, _)| known == name).map(|(_, text)| text.as_str())
    }
}
