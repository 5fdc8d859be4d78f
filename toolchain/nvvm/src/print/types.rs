//! Prints types. LLVM 7 has no pointer without a pointee, so it becomes a pointer to a byte.

use super::{Printed, Printer};
use crate::Dialect;
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Function, Type, Typed};

impl Printer<'_> {
    pub(super) fn ty(&self, ty: &Type) -> String {
        let list = |types: &[Type]| types.iter().map(|ty| self.ty(ty)).collect::<Vec<_>>().join(", ");
        match ty {
            Type::Void => "void".into(),
            Type::Label => "label".into(),
            Type::Metadata => "metadata".into(),
            Type::Int(bits) => format!("i{bits}"),
            Type::Half => "half".into(),
            Type::Float => "float".into(),
            Type::Double => "double".into(),
            Type::Pointer(space) => self.pointer_to("i8", *space),
            Type::Array(count, element) => format!("[{count} x {}]", self.ty(element)),
            Type::Vector(count, element) => format!("<{count} x {}>", self.ty(element)),
            Type::Struct { fields, packed: false } => format!("{{ {} }}", list(fields)),
            Type::Struct { fields, packed: true } => format!("<{{ {} }}>", list(fields)),
            Type::Named(name) => named(name),
        }
    }

    /// The type of a pointer to `pointee` in an address space.
    pub(super) fn pointer_to(&self, pointee: &str, space: u32) -> String {
        let space = if space == 0 { String::new() } else { format!(" addrspace({space})") };
        match self.dialect {
            Dialect::Llvm7 => format!("{pointee}{space}*"),
            Dialect::Modern => format!("ptr{space}"),
        }
    }

    /// `float (i32, i8*)`
    pub(super) fn signature(&self, function: &Function) -> String {
        let parameters = function.parameters.iter().map(|parameter| match &parameter.by_value {
            Some(ty) => self.pointer_to(&self.ty(ty), 0),
            None => self.ty(&parameter.value.ty),
        });
        let mut parameters: Vec<String> = parameters.collect();
        if function.variadic {
            parameters.push("...".into());
        }
        format!("{} ({})", self.ty(&function.result), parameters.join(", "))
    }

    /// The fields of a struct, also by name.
    pub(super) fn resolve<'t>(&'t self, ty: &'t Type) -> Printed<&'t Type> {
        let Type::Named(name) = ty else { return Ok(ty) };
        let found = self.module.types.iter().find(|(known, _)| known == name);
        match found.and_then(|(_, ty)| ty.as_ref()) {
            Some(Type::Named(_)) | None => Err(Unknown::new(format!("the type `{name}`, which is opaque"))),
            Some(ty) => Ok(ty),
        }
    }

    /// The types that an address computation passes through: `of` itself, then a part of it for each index after the
    /// first.
    pub(super) fn pointee(&self, of: &Type, indices: &[Typed]) -> Printed<Type> {
        let mut ty = of.clone();
        for index in indices.iter().skip(1) {
            let inner = match self.resolve(&ty)? {
                Type::Array(_, element) | Type::Vector(_, element) => (**element).clone(),
                Type::Struct { fields, .. } => {
                    let field = index.value.as_int().and_then(|index| usize::try_from(index).ok());
                    let field = field.and_then(|field| fields.get(field));
                    field.cloned().ok_or_else(|| Unknown::new("a field that the struct does not have"))?
                }
                other => return Err(Unknown::new(format!("an index into {other:?}"))),
            };
            ty = inner;
        }
        Ok(ty)
    }
}

/// The name of a type, `%name`.
pub(super) fn named(name: &str) -> String {
    format!("%\"type.{name}\"")
}
