//! Prints names and constants.

use super::{Printed, Printer};
use crate::Dialect;
use crate::lower::FRESH;
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Expression, Type, Typed, Value};

impl Printer<'_> {
    /// `i32 5`
    pub(super) fn typed(&self, typed: &Typed) -> Printed {
        Ok(format!("{} {}", self.ty(&typed.ty), self.value(&typed.ty, &typed.value)?))
    }

    /// The name of a parameter.
    pub(super) fn untyped(&self, value: &Value) -> Printed {
        match value {
            Value::Local(name) => Ok(local(name)),
            _ => Err(Unknown::new("a parameter without a name")),
        }
    }

    /// The text of a value of the type `ty`, without the type.
    pub(super) fn value(&self, ty: &Type, value: &Value) -> Printed {
        Ok(match value {
            Value::Local(name) => local(name),
            Value::Global(name) => self.address_of(name, ty)?,
            Value::Number(text) => text.clone(),
            Value::Null => "null".into(),
            Value::Undef => "undef".into(),
            Value::Zero => "zeroinitializer".into(),
            Value::Bytes(text) => format!("c\"{text}\""),
            Value::Metadata(name) => format!("!{name}"),
            Value::Aggregate(parts) => {
                let parts = parts.iter().map(|part| self.typed(part)).collect::<Printed<Vec<_>>>()?.join(", ");
                match self.resolve(ty)? {
                    Type::Array(..) => format!("[{parts}]"),
                    Type::Vector(..) => format!("<{parts}>"),
                    Type::Struct { packed: true, .. } => format!("<{{ {parts} }}>"),
                    Type::Struct { packed: false, .. } => format!("{{ {parts} }}"),
                    other => return Err(Unknown::new(format!("a constant of {other:?} with several parts"))),
                }
            }
            Value::Expression(expression) => self.expression(expression)?,
        })
    }

    /// The address of a function or variable, as a pointer without pointee.
    fn address_of(&self, name: &str, ty: &Type) -> Printed {
        let (pointee, space) = if let Some(function) = self.functions.get(name) {
            (self.signature(function), 0)
        } else if let Some(variable) = self.variables.get(name) {
            (self.ty(&variable.ty), variable.space)
        } else {
            return Err(Unknown::new(format!("`@{name}`, which is declared nowhere")));
        };
        if *ty != Type::Pointer(space) {
            return Err(Unknown::new(format!("`@{name}` as {ty:?}")));
        }
        Ok(match self.dialect {
            Dialect::Llvm7 => {
                let from = self.pointer_to(&pointee, space);
                format!("bitcast ({from} {} to {})", self.function_name(name), self.ty(ty))
            }
            Dialect::Modern => global(name),
        })
    }

    fn expression(&self, expression: &Expression) -> Printed {
        Ok(match expression {
            Expression::Cast { op, value, to } => format!("{op} ({} to {})", self.typed(value)?, self.ty(to)),
            Expression::Binary { op, a, b } => format!("{op} ({}, {})", self.typed(a)?, self.typed(b)?),
            Expression::Address { inbounds, of, base, indices } => {
                let Type::Pointer(space) = base.ty else {
                    return Err(Unknown::new("several addresses at once"));
                };
                let base = self.constant_pointer(base, of, space)?;
                let inbounds = if *inbounds { " inbounds" } else { "" };
                let list = indices.iter().map(|index| self.typed(index)).collect::<Printed<Vec<_>>>()?;
                let list: String = list.iter().map(|index| format!(", {index}")).collect();
                let address = format!("getelementptr{inbounds} ({}, {base}{list})", self.ty(of));
                match self.pointee(of, indices)? {
                    Type::Int(8) => address,
                    _ if self.dialect == Dialect::Modern => address,
                    pointee => {
                        let from = self.pointer_to(&self.ty(&pointee), space);
                        format!("bitcast ({from} {address} to {})", self.ty(&Type::Pointer(space)))
                    }
                }
            }
        })
    }

    /// A constant pointer, with its type, as one to `pointee`.
    pub(super) fn constant_pointer(&self, pointer: &Typed, pointee: &Type, space: u32) -> Printed {
        let to = self.pointer_to(&self.ty(pointee), space);
        if self.dialect == Dialect::Modern || *pointee == Type::Int(8) {
            return self.typed(pointer);
        }
        if matches!(pointer.value, Value::Null | Value::Undef) {
            return Ok(format!("{to} {}", self.value(&pointer.ty, &pointer.value)?));
        }
        Ok(format!("{to} bitcast ({} to {to})", self.typed(pointer)?))
    }

    /// The name of a function or variable. The name of an intrinsic contains the types of what its pointers point to.
    pub(super) fn function_name(&self, name: &str) -> String {
        if self.dialect == Dialect::Llvm7 && name.starts_with("llvm.mem") {
            let parts = name.split('.').map(|part| match part.strip_prefix('p') {
                Some(space) if !space.is_empty() && space.bytes().all(|b| b.is_ascii_digit()) => format!("{part}i8"),
                _ => part.to_string(),
            });
            return global(&parts.collect::<Vec<_>>().join("."));
        }
        global(name)
    }
}

/// The name of a local value or a block. Names of the source and names that are made here never coincide.
pub(super) fn local(name: &str) -> String {
    match name.strip_prefix(FRESH) {
        Some(number) => format!("%t.{number}"),
        None if is_plain(name) => format!("%v.{name}"),
        None => format!("%\"v.{name}\""),
    }
}

pub(super) fn global(name: &str) -> String {
    if name.bytes().all(|b| b.is_ascii_digit()) {
        return format!("@unnamed.{name}");
    }
    if is_plain(name) { format!("@{name}") } else { format!("@\"{name}\"") }
}

fn is_plain(name: &str) -> bool {
    name.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '$' | '-'))
}
