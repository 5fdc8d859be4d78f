//! What a callable takes and returns.

use super::kind::Kind;
use crate::support::{Errors, mentions, ungroup};
use quote::ToTokens;
use syn::{ReturnType, Type, TypeReference};

/// As many as signatures have.
const MAX_ARGUMENTS: usize = 8;

/// What comes after the context: the record, by reference, and what the caller passes, by value.
pub fn arguments(kind: Kind, types: &[&Type], errors: &mut Errors) -> (Option<Type>, Vec<Type>) {
    let mut record = None;
    let mut arguments = Vec::new();
    for (i, ty) in types.iter().enumerate() {
        match ungroup(ty) {
            Type::Reference(TypeReference { mutability: Some(token), .. }) => errors.at(
                token,
                "a callable changes nothing of its caller's: take a record as `&T`, the arguments by value, and return \
                 what is new",
            ),
            Type::Reference(reference) if i == 0 => record = Some((*reference.elem).clone()),
            Type::Reference(_) => errors.at(
                ty,
                format!(
                    "arguments of a callable are passed by value, in registers: only its record is a reference, and comes \
                     right after the context: {}",
                    kind.example()
                ),
            ),
            ty if named(ty, errors) => arguments.push(ty.clone()),
            _ => {}
        }
    }
    if let Some(extra) = arguments.get(MAX_ARGUMENTS) {
        errors.at(
            extra,
            format!(
                "a callable takes {MAX_ARGUMENTS} arguments at most: put some into a struct with `#[derive(Words)]`"
            ),
        );
    }
    (record, arguments)
}

/// What it returns; `()` if nothing.
pub fn result(output: &ReturnType, errors: &mut Errors) -> Option<Type> {
    let ReturnType::Type(_, ty) = output else { return Some(syn::parse_quote!(())) };
    match ungroup(ty) {
        Type::Reference(_) => errors.at(ty, "a callable returns by value, in registers"),
        Type::Never(_) => errors.at(ty, "a callable returns to its caller; what may end the launch index is `throw`"),
        ty if named(ty, errors) => return Some(ty.clone()),
        _ => {}
    }
    None
}

/// Whether a type is one that a caller can know.
fn named(ty: &Type, errors: &mut Errors) -> bool {
    if matches!(ty, Type::FnPtr(_)) || mentions(ty.to_token_stream(), "dyn") {
        errors.at(
            ty,
            "there are no function pointers on the device (guide 15.3): take a `Callable<fn(..) -> ..>`, which may come as an \
             argument, from the record or from the launch parameters",
        );
        false
    } else if mentions(ty.to_token_stream(), "impl") {
        errors.at(ty, "arguments and result of a callable have named types, which its callers know");
        false
    } else {
        true
    }
}
