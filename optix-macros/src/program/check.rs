//! What must hold of a program's function, whatever its signature says.

use super::kind::Kind;
use crate::support::{Errors, mentions, ungroup};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::ToTokens;
use syn::{FnArg, Generics, Ident, ItemFn, Safety, Type, TypeReference};

/// A program is an ordinary function.
pub fn qualifiers(kind: Kind, function: &ItemFn, errors: &mut Errors) {
    let (sig, phrase) = (&function.sig, kind.phrase());
    if let Some(token) = &sig.asyncness {
        errors.at(token, format!("{phrase} can't be `async`: a device program runs to its end"));
    }
    if let Some(token) = &sig.constness {
        errors.at(token, format!("{phrase} can't be `const`: it asks the machine it runs on"));
    }
    if let Safety::Unsafe(token) = &sig.safety {
        errors.at(
            token,
            format!(
                "{phrase} is not `unsafe`: the pipeline calls it with what its signature asks for; use a block inside"
            ),
        );
    }
    if let Some(abi) = &sig.abi {
        errors.at(
            abi,
            format!("{phrase} is an ordinary Rust function: `pipeline!` makes the entry point with its own calling convention"),
        );
    }
    if let Some(variadic) = &sig.variadic {
        errors.at(variadic, format!("{phrase} can't be variadic"));
    }
}

/// Nothing that a program borrows outlives its call.
pub fn is_for_the_call(argument: &FnArg, errors: &mut Errors) {
    if let FnArg::Typed(argument) = argument
        && let Type::Reference(TypeReference { lifetime: Some(lifetime), .. }) = ungroup(&argument.ty)
        && lifetime.ident == "static"
    {
        errors.at(lifetime, "context and record are borrowed for the call only: take the lifetime away");
    }
}

/// A program that calls itself would be a recursive function with device functions in it, which OptiX refuses (guide 13).
/// What is only found with types, such as a helper that calls back, is found in the PTX.
pub fn calls_itself(function: &ItemFn, errors: &mut Errors) {
    let ident = &function.sig.ident;
    let mut calls = Vec::new();
    let bound = mentions(function.sig.inputs.iter().map(|a| a.to_token_stream()).collect(), &ident.to_string());
    if !bound && only_calls(function.block.to_token_stream(), ident, &mut calls) {
        for call in calls {
            errors.at(
                call,
                format!(
                    "`{ident}` calls itself, but device programs can't be recursive functions (guide 13): write a loop, or \
                     trace a ray whose program goes on"
                ),
            );
        }
    }
}

/// Collects the calls `ident(..)`. False if the name is used otherwise, so that it may be another's.
fn only_calls(tokens: TokenStream, ident: &Ident, calls: &mut Vec<Ident>) -> bool {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    tokens.iter().enumerate().all(|(i, token)| match token {
        TokenTree::Group(group) => only_calls(group.stream(), ident, calls),
        TokenTree::Ident(found) if found == ident => {
            let follows = |c: char| i > 0 && matches!(&tokens[i - 1], TokenTree::Punct(p) if p.as_char() == c);
            if follows('.') || follows(':') {
                return true;
            }
            let after_fn = i > 0 && matches!(&tokens[i - 1], TokenTree::Ident(word) if word == "fn");
            let called =
                matches!(tokens.get(i + 1), Some(TokenTree::Group(g)) if g.delimiter() == Delimiter::Parenthesis);
            if called && !after_fn {
                calls.push(found.clone());
            }
            called && !after_fn
        }
        _ => true,
    })
}

/// A part must say which payload it is of: `R::AtMiss` for a type parameter `R` would be of any.
pub fn names_its_payload(part: &Type, generics: &Generics, errors: &mut Errors) {
    let Type::Path(path) = ungroup(part) else { return };
    let first = path.path.segments.first();
    let parameter = generics.type_params().any(|p| first.is_some_and(|s| s.ident == p.ident));
    if path.qself.is_some() || parameter {
        errors.at(
            part,
            "a program names the payload it is for: take and return a struct such as `RadianceAtClosestHit`; a program for \
             any payload leaves it out",
        );
    }
}
