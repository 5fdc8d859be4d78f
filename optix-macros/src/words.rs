//! `#[derive(Words)]` and `#[derive(Attributes)]`: structs in registers.

use crate::data::{must_copy, touch};
use crate::shape::{Struct, construct};
use crate::support::{Errors, begins, block, device_crate, layout, moved, place_of};
use proc_macro2::TokenStream;
use quote::{format_ident, quote, quote_spanned};
use syn::DeriveInput;

/// Where each field's words begin.
struct Places {
    /// `const __AT_0: usize = ..` for each field and `__END`.
    consts: TokenStream,
    stores: Vec<TokenStream>,
    load: TokenStream,
    /// Of type `Layout`.
    layout: TokenStream,
}

fn places(model: &Struct) -> Places {
    let krate = &device_crate();
    let (mut stores, mut loads, mut layouts, mut counts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (i, field) in model.fields.iter().enumerate() {
        let (member, ty) = (&field.member, &field.ty);
        let (at, next) = (format_ident!("__AT_{i}"), format_ident!("__AT_{}", i + 1));
        let span = place_of(ty);
        let krate = moved(krate, span);
        counts.push(quote_spanned!(span=> <#ty as #krate::words::Words>::COUNT));
        let store = quote_spanned!(span=> <#ty as #krate::words::Words>::store);
        stores.push(quote!(#store(self.#member, #krate::words::part_mut(__words, #at, #next));));
        let load = quote_spanned!(span=> <#ty as #krate::words::Words>::load);
        let (name, layout) = (field.name(), quote_spanned!(span=> <#ty as #krate::words::Words>::LAYOUT));
        layouts.push(quote!(.field(#name, #at, #layout)));
        loads.push(quote!(unsafe { #load(#krate::words::part(__words, #at, #next)) }));
    }
    let end = format_ident!("__AT_{}", model.fields.len());
    let mut consts = begins(krate, &counts);
    consts.extend(quote!(const __END: __core::primitive::usize = #end;));
    let load = construct(quote!(Self), &model.fields, &loads);
    let layout = layout(quote!(#krate::layout::Layout::of("struct")), &layouts);
    Places { consts, stores, load, layout }
}

/// `#[derive(Words)]`.
pub fn derive_words(input: &DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    let Some(model) = Struct::parse(input, "a value in registers", true, &mut errors) else {
        return errors.into_tokens();
    };
    let (krate, ident) = (&device_crate(), &model.ident);
    let Places { consts, stores, load, layout } = places(&model);
    let touch = touch(&model);
    let (must_copy, bound) = must_copy(&model);
    let errors = errors.into_tokens();
    let items = block(quote! {
            #consts
            #must_copy
            #[automatically_derived]
            impl #krate::words::Words for #ident #bound {
                const COUNT: __core::primitive::usize = __END;
                const LAYOUT: #krate::layout::Layout = #layout;
                #[inline(always)]
                fn store(self, __words: &mut [__core::primitive::u32]) {
                    #(#stores)*
                }
                #[inline(always)]
                unsafe fn load(__words: &[__core::primitive::u32]) -> Self {
                    // SAFETY: `store` stores each field in the words that it is loaded from.
                    #load
                }
            }
            #touch
    });
    quote!(#errors #items)
}

/// `#[derive(Attributes)]`.
pub fn derive_attributes(input: &DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    let Some(model) = Struct::parse(input, "an attribute set", true, &mut errors) else {
        return errors.into_tokens();
    };
    let (krate, ident, name) = (&device_crate(), &model.ident, model.name());
    let Places { consts, stores, load, layout } = places(&model);
    let span = place_of(ident);
    let moved = moved(krate, span);
    let check = quote_spanned!(span=> const _: () = #moved::check::attribute_words(#name, __END););
    let touch = touch(&model);
    let errors = errors.into_tokens();
    let items = block(quote! {
            #consts
            #check
            // SAFETY: the traits of built-in primitives are for types of the device crate.
            #[automatically_derived]
            unsafe impl #krate::primitive::Reported for #ident {}
            #[automatically_derived]
            impl #krate::primitive::Attributes for #ident {
                const NAME: &'static __core::primitive::str = #name;
                const WORDS: __core::primitive::usize = __END;
                const LAYOUT: #krate::layout::Layout = #layout;
                #[inline(always)]
                unsafe fn load(__words: &[__core::primitive::u32]) -> Self {
                    // SAFETY: `store` stores each field in the words that it is loaded from.
                    #load
                }
                #[inline(always)]
                fn store(self, __words: &mut [__core::primitive::u32]) {
                    #(#stores)*
                }
            }
            #touch
    });
    quote!(#errors #items)
}
