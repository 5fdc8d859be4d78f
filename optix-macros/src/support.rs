//! What every macro needs: the path of the device crate, errors as values, names.

use crate::{compiler, depth, source};
use proc_macro2::{Group, Span, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote};
use syn::ext::IdentExt;
use syn::spanned::Spanned;
use syn::{Attribute, DeriveInput, Error, Ident, Path, Type};

/// Errors of one expansion, all reported at once.
#[derive(Default)]
pub struct Errors(Option<Error>);

impl Errors {
    /// Adds an error at `tokens`.
    pub fn at(&mut self, tokens: impl ToTokens, message: impl core::fmt::Display) {
        self.push(Error::new_spanned(tokens, message));
    }

    /// Adds an error.
    pub fn push(&mut self, error: Error) {
        match &mut self.0 {
            Some(errors) => errors.combine(error),
            None => self.0 = Some(error),
        }
    }

    /// The value, or the error added.
    pub fn keep<T>(&mut self, result: syn::Result<T>) -> Option<T> {
        result.map_err(|error| self.push(error)).ok()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_none()
    }

    /// One `compile_error!` each; nothing if there is none.
    pub fn into_tokens(self) -> TokenStream {
        self.0.map(Error::into_compile_error).unwrap_or_default()
    }
}

/// Whether a macro can begin; otherwise an error is added that says why not. `code` says that the tokens are a function.
pub fn may_begin(tokens: &TokenStream, code: bool, errors: &mut Errors) -> bool {
    if let Some(problem) = compiler::problem() {
        errors.push(Error::new(Span::call_site(), problem));
        return false;
    }
    depth::check(tokens, code, errors)
}

/// A derive as a function from tokens to tokens.
pub fn derive(input: TokenStream, make: fn(&DeriveInput) -> TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    if !may_begin(&input, false, &mut errors) {
        return errors.into_tokens();
    }
    let input: DeriveInput = match syn::parse2(input) {
        Ok(input) => input,
        Err(error) => return error.into_compile_error(),
    };
    if let Some(attribute) = source::target_dependent(&input.data) {
        let ident = &input.ident;
        let message = format!(
            "`{attribute}` makes `{ident}` another type on the device than on the host, where what one writes the other reads: \
             write the field for both, or two types for two uses"
        );
        errors.at(ident, message);
    }
    let (errors, items) = (errors.into_tokens(), make(&input));
    quote!(#errors #items)
}

/// What generated code calls the device crate; see [`block`].
pub fn device_crate() -> Ident {
    Ident::new("__optix", Span::call_site())
}

/// A block of items that know the device crate as `__optix` and the core library as `__core`.
///
/// Generated code says `unsafe` where a function of the device crate has made sure of something, so it must be that crate's
/// function. A path such as `::core` asks for what the crate calls so, and `extern crate self as core` lets that be any module.
/// So there is one path, and where the crate makes another thing of it, `extern crate`, which asks for what the compiler was given.
/// Elsewhere there is no such item, since rustc would name every type of the device crate by it.
pub fn block(items: TokenStream) -> TokenStream {
    let name = compiler::device_crate();
    let imported =
        if compiler::is_shadowed() { quote!(extern crate #name as __optix;) } else { quote!(use ::#name as __optix;) };
    quote! {
        const _: () = {
            #imported
            use __optix::macro_support::core as __core;
            #items
        };
    }
}

/// The device crate where no [`block`] can be: in the declaration of a type that users name. Code in a block then uses the type
/// with what the path should have led to.
pub fn device_crate_outside() -> Path {
    let name = compiler::device_crate();
    syn::parse_quote!(::#name)
}

/// The arguments of an attribute that has none.
pub fn no_arguments(arguments: TokenStream, attribute: &str, errors: &mut Errors) {
    if !arguments.is_empty() {
        errors.at(arguments, format!("`#[{attribute}]` takes no arguments"));
    }
}

/// Where `tokens` are, for generated code that an error should point to. Names resolve as in the macro's own output.
pub fn place_of(tokens: &impl Spanned) -> Span {
    tokens.span().resolved_at(Span::call_site())
}

/// The tokens, all of them at `span`: an error in a path points to its first and last token.
pub fn moved(tokens: &impl ToTokens, span: Span) -> TokenStream {
    fn at(stream: TokenStream, span: Span) -> TokenStream {
        stream
            .into_iter()
            .map(|mut token| {
                match &token {
                    TokenTree::Group(group) => token = Group::new(group.delimiter(), at(group.stream(), span)).into(),
                    // Its span says which crate it means.
                    TokenTree::Ident(ident) if ident == "$crate" => return token,
                    _ => {}
                }
                token.set_span(span);
                token
            })
            .collect()
    }
    at(tokens.to_token_stream(), span)
}

/// The `#[cfg(..)]` among `attributes`. rustc obeys those on an item before a macro sees it, those inside only after.
pub fn cfg_of(attributes: &[Attribute]) -> Option<&Attribute> {
    attributes.iter().find(|a| a.path().is_ident("cfg"))
}

/// The name without `r#`.
pub fn name(ident: &Ident) -> String {
    ident.unraw().to_string()
}

/// The doc comments among `attributes`.
pub fn docs(attributes: &[Attribute]) -> Vec<&Attribute> {
    attributes.iter().filter(|a| a.path().is_ident("doc")).collect()
}

/// Whether the word occurs.
pub fn mentions(tokens: TokenStream, word: &str) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(ident) => ident == word,
        TokenTree::Group(group) => mentions(group.stream(), word),
        _ => false,
    })
}

/// The type without the invisible groups that `macro_rules!` puts around a `$ty`.
pub fn ungroup(mut ty: &Type) -> &Type {
    loop {
        ty = match ty {
            Type::Group(group) => &group.elem,
            Type::Paren(paren) => &paren.elem,
            other => return other,
        };
    }
}

/// Where each of several values in a row begins, in words: `const __AT_0: usize = 0;` and so on, one more than there are values. Made of one
/// array, since constants that are made of each other nest too deep for the compiler where there are hundreds.
pub fn begins(krate: &Ident, counts: &[TokenStream]) -> TokenStream {
    let all = counts.len() + 1;
    let consts = (0..all).map(|i| {
        let at = format_ident!("__AT_{i}");
        quote!(const #at: __core::primitive::usize = __BEGINS[#i];)
    });
    quote! {
        const __BEGINS: [__core::primitive::usize; #all] = #krate::words::begins(&[#(#counts),*]);
        #(#consts)*
    }
}

/// A layout with these parts, which are calls such as `.field(..)`: a statement each, since calls of calls nest too deep for
/// the compiler where there are thousands.
pub fn layout(of: TokenStream, parts: &[TokenStream]) -> TokenStream {
    quote!({
        let __layout = #of;
        #(let __layout = __layout #parts;)*
        __layout
    })
}
