//! The programs' types, payloads, records and kinds of primitive, by names of the macro's own.
//!
//! A function without an attribute has no type of its name, and rustc would say so in words that help nobody. So each program
//! is imported: by a `use`, which takes the function, and its type if it has one; and by a glob, which `use` takes precedence
//! over, of what stands for those that are not there. What that is asked for, `check::is_program` answers.

use super::emit::program_span;
use super::parse::Pipeline;
use crate::support::{device_crate, moved, place_of};
use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote, quote_spanned};
use syn::{Ident, Path, Type};

/// The name of a program's type; paths that differ have names that do.
pub fn type_of(program: &Path) -> Ident {
    format_ident!("__program_{}", word(program), span = program_span(program))
}

/// The name of a payload, record or kind of primitive, at the place where it is mentioned: so a type that is not there is one error, at its first
/// mention.
pub fn named(ty: &Type) -> Ident {
    format_ident!("__type_{}", word(ty), span = place_of(ty))
}

/// The name of a kind of primitive, at the place where it is mentioned.
pub fn kind_of(geometry: &Ident) -> Ident {
    format_ident!("__kind_{}", word(geometry), span = place_of(geometry))
}

/// What is written, as a part of a name.
fn word(tokens: &impl ToTokens) -> String {
    let mut word = String::new();
    for c in super::check::path(tokens).replace("r#", "").chars() {
        match c {
            ':' => word.push_str("_1"),
            '_' => word.push_str("_0"),
            c if c.is_alphanumeric() => word.push(c),
            c => word.push_str(&format!("_{:x}_", c as u32)),
        }
    }
    word
}

/// What makes these names.
pub fn imports(pipeline: &Pipeline) -> TokenStream {
    let mut programs: Vec<&Path> = Vec::new();
    let groups = pipeline.groups.iter().flat_map(|group| &group.rays);
    let of_groups = groups.flat_map(|p| [&p.closesthit, &p.anyhit, &p.intersection].into_iter().flatten());
    let others = pipeline.rays.iter().filter_map(|ray| ray.miss.as_ref()).chain(&pipeline.exception);
    let callables = pipeline.direct_callables.iter().chain(&pipeline.continuation_callables);
    for program in pipeline.raygen.iter().chain(others).chain(of_groups).chain(callables) {
        if !programs.iter().any(|p| type_of(p) == type_of(program)) {
            programs.push(program);
        }
    }
    let mut types: Vec<&Type> = Vec::new();
    let payloads = pipeline.rays.iter().map(|ray| &ray.payload);
    let records = pipeline.groups.iter().map(|group| &group.record);
    for ty in payloads.chain(records) {
        if !types.iter().any(|t| named(t) == named(ty)) {
            types.push(ty);
        }
    }
    let types = types.into_iter().map(|ty| {
        let name = named(ty);
        quote_spanned!(place_of(ty)=> type #name = #ty;)
    });
    let mut kinds: Vec<&Ident> = Vec::new();
    for group in &pipeline.groups {
        if !kinds.contains(&&group.geometry) {
            kinds.push(&group.geometry);
        }
    }
    let kinds = kinds.into_iter().map(|geometry| {
        let (name, krate) = (kind_of(geometry), moved(&device_crate(), place_of(geometry)));
        quote_spanned!(place_of(geometry)=> type #name = #krate::primitive::kinds::#geometry;)
    });
    // A `use` of a name that is not there would fail, so there is a macro of that name.
    let macros = programs.iter().filter_map(|program| {
        let name = program.get_ident()?;
        Some(quote!(macro_rules! #name { () => {} } #name! {}))
    });
    let uses = programs.iter().map(|program| {
        let name = type_of(program);
        quote_spanned!(program_span(program)=> use #program as #name;)
    });
    let (names, numbers): (Vec<_>, Vec<_>) = programs.iter().map(|p| type_of(p)).zip(0usize..).unzip();
    quote! {
        #(#macros)*
        mod __not_there {
            #(
                pub type #names = [(); #numbers];
                pub const #names: bool = false;
            )*
        }
        use __not_there::*;
        #(#uses)*
        #(#types)*
        #(#kinds)*
    }
}

/// Whether there is a function of the program's name: as a pattern, a function's name is a new variable, which matches all,
/// and that of the constant in its place is the constant, which does not match.
pub fn is_function(program: &Path) -> TokenStream {
    let name = type_of(program);
    quote_spanned! {program_span(program)=>
        match true {
            #name => true,
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_that_differ_have_names_that_do() {
        let paths = ["a", "a::b", "a_b", "::a::b", "a__b", "a_1b", "crate::a", "r#crate_a", "A"];
        let names: Vec<String> = paths.iter().map(|p| type_of(&syn::parse_str(p).unwrap()).to_string()).collect();
        for (i, name) in names.iter().enumerate() {
            assert!(!names[..i].contains(name), "{name} of {}", paths[i]);
        }
    }
}
