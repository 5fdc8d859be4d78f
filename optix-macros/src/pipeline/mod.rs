//! `pipeline!`.

mod check;
mod emit;
mod names;
mod parse;

use crate::support::{Errors, may_begin};
use proc_macro2::TokenStream;
use quote::quote;

pub fn expand(input: TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    if !may_begin(&input, false, &mut errors) {
        return errors.into_tokens();
    }
    let Some(pipeline) = parse::parse(input, &mut errors) else {
        return errors.into_tokens();
    };
    // What was not understood would only look as if it were missing.
    if errors.is_empty() {
        check::check(&pipeline, &mut errors);
    }
    let items = if errors.is_empty() { emit::emit(&pipeline) } else { emit::fallback(&pipeline) };
    let errors = errors.into_tokens();
    quote!(#errors #items)
}
