//! `#[derive(Payload)]`.

mod check;
mod emit;
mod model;

use crate::shape::Struct;
use crate::support::Errors;
use proc_macro2::TokenStream;
use quote::quote;
use syn::DeriveInput;

pub fn derive(input: &DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    let Some(shape) = Struct::parse(input, "a payload", false, &mut errors) else {
        return errors.into_tokens();
    };
    let payload = model::Payload::new(shape, &mut errors);
    check::check(&payload, &mut errors);
    let items = emit::emit(&payload, errors.is_empty());
    let errors = errors.into_tokens();
    quote!(#errors #items)
}
