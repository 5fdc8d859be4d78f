//! What every macro needs: the path of the device crate, errors as values, names.

use proc_macro2::{Group, Span, TokenStream, TokenTree};
use quote::{ToTokens, quote};
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

/// A derive as a function from tokens to tokens.
pub fn derive(input: TokenStream, make: fn(&DeriveInput) -> TokenStream) -> TokenStream {
    match syn::parse2(input) {
        Ok(input) => make(&input),
        Err(error) => error.into_compile_error(),
    }
}

/// The device crate's path, unless `crate = path` says otherwise.
pub fn default_crate() -> Path {
    syn::parse_quote!(::optix_device_rs)
}

/// Parses the arguments of an attribute: nothing, or `crate = path`.
pub fn crate_argument(arguments: TokenStream, attribute: &str, errors: &mut Errors) -> Path {
    if arguments.is_empty() {
        return default_crate();
    }
    let parse = |input: syn::parse::ParseStream<'_>| {
        if !input.peek(syn::Token![crate]) {
            return Err(input.error(format!(
                "`#[{attribute}]` takes no arguments (but `crate = path`, where optix-device-rs has another name)"
            )));
        }
        input.parse::<syn::Token![crate]>()?;
        input.parse::<syn::Token![=]>()?;
        let path = crate_path(input)?;
        input.parse::<Option<syn::Token![,]>>()?;
        Ok(path)
    };
    errors.keep(syn::parse::Parser::parse2(parse, arguments)).unwrap_or_else(default_crate)
}

/// The path after `crate =`.
pub fn crate_path(input: syn::parse::ParseStream<'_>) -> syn::Result<Path> {
    if input.peek(syn::LitStr) {
        return Err(input.error("expected a path, without quotes, such as `rt` or `crate::toolkit::rt`"));
    }
    Path::parse_mod_style(input)
}

/// Reads `#[optix(crate = path)]` of a derive.
pub fn crate_of(attributes: &[Attribute], errors: &mut Errors) -> Path {
    let mut path = default_crate();
    for attribute in attributes.iter().filter(|a| a.path().is_ident("optix")) {
        let result = attribute.parse_nested_meta(|meta| {
            if meta.path.is_ident("crate") {
                path = crate_path(meta.value()?)?;
                Ok(())
            } else {
                Err(meta.error("unknown option: expected `crate = path`"))
            }
        });
        errors.keep(result);
    }
    path
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

/// Lints that generated items would set off although the user can do nothing about them.
pub fn allow() -> TokenStream {
    quote! {
        #[allow(
            unsafe_code, unexpected_cfgs, dead_code, unused_qualifications, unreachable_pub, private_interfaces, private_bounds,
            non_camel_case_types, non_upper_case_globals, non_snake_case, missing_docs, unused_variables,
            clippy::undocumented_unsafe_blocks, clippy::multiple_unsafe_ops_per_block, clippy::missing_safety_doc,
            clippy::pedantic, clippy::restriction, clippy::nursery, clippy::style, clippy::complexity
        )]
    }
}

/// Eight digits that tell apart things of one name, the same in host and device builds: they come from the package and
/// from the place in its source, not from how a compiler prints tokens or where the package lies on disk.
pub fn place(span: Span, name: &str) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    let mut mix = |text: &str| {
        for byte in text.bytes().chain([0]) {
            hash = (hash ^ byte as u64).wrapping_mul(0x100_0000_01b3);
        }
    };
    mix(name);
    mix(&std::env::var("CARGO_PKG_NAME").unwrap_or_default());
    if proc_macro::is_available() {
        let span = span.unwrap();
        let file = span.file();
        let mut parts = file.rsplit(['/', '\\']);
        mix(parts.next().unwrap_or_default());
        mix(parts.next().unwrap_or_default());
        mix(&span.line().to_string());
        mix(&span.column().to_string());
    }
    format!("{:08x}", (hash ^ hash >> 32) as u32)
}
