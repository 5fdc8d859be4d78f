//! `#[raygen]`, `#[miss]`, `#[closesthit]`, `#[anyhit]`, `#[intersection]`, `#[direct_callable]`, `#[continuation_callable]`,
//! `#[exception]`.

mod callable;
mod check;
mod emit;
mod kind;
mod model;

pub use kind::Kind;

use crate::support::{Errors, may_begin, no_arguments};
use proc_macro2::TokenStream;
use quote::quote;
use syn::{Attribute, Item};

pub fn expand(kind: Kind, arguments: TokenStream, item: TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    if !may_begin(&item, true, &mut errors) {
        let errors = errors.into_tokens();
        return quote!(#errors #item);
    }
    no_arguments(arguments, kind.attribute(), &mut errors);
    let mut function = match syn::parse2::<Item>(item.clone()) {
        Ok(Item::Fn(function)) => function,
        Ok(other) => {
            let message = format!("`#[{}]` belongs on a function: {}", kind.attribute(), kind.example());
            errors.at(&other, message);
            let errors = errors.into_tokens();
            return quote!(#errors #item);
        }
        Err(error) => {
            errors.push(error);
            let errors = errors.into_tokens();
            return quote!(#errors #item);
        }
    };
    let other =
        |a: &Attribute| a.path().segments.last().and_then(|s| Kind::ALL.into_iter().find(|k| s.ident == k.attribute()));
    for second in function.attrs.extract_if(.., |a| other(a).is_some()) {
        errors.at(
            second,
            format!(
                "a program is of one kind, and `#[{}]` already says which: write a function for each",
                kind.attribute()
            ),
        );
    }
    // In an impl there is no room for the type that stands for the program.
    let in_impl = model::is_in_impl(&function.sig);
    let program = model::Program::new(kind, &function, in_impl, &mut errors);
    let items = match program {
        _ if in_impl => TokenStream::new(),
        Some(program) if errors.is_empty() => emit::emit(&program),
        // The pipeline must not complain about the program again.
        _ => emit::fallback(kind, &function.sig.ident),
    };
    let errors = errors.into_tokens();
    // Entries call it from another codegen unit, often with constants.
    let inline = (!function.attrs.iter().any(|a| a.path().is_ident("inline")))
        .then(|| quote!(#[cfg_attr(target_arch = "nvptx64", inline)]));
    quote! {
        #errors
        #inline
        #function
        #items
    }
}
