//! `#[derive(UserException)]`.

use crate::shape::Repr;
use crate::support::{Errors, block, device_crate, layout, moved, name, place_of, ungroup};
use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote, quote_spanned};
use syn::{Data, DataEnum, DeriveInput, Ident, Index, Member, Type, Variant};

pub fn derive(input: &DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    let what = "what programs throw";
    let variants = match &input.data {
        Data::Enum(DataEnum { variants, .. }) => variants,
        Data::Struct(data) => {
            errors.at(
                data.struct_token,
                format!("{what} is an enum, a variant for each thing that goes wrong, not a struct"),
            );
            return errors.into_tokens();
        }
        Data::Union(data) => {
            errors.at(
                data.union_token,
                format!("{what} is an enum, a variant for each thing that goes wrong, not a union"),
            );
            return errors.into_tokens();
        }
    };
    if !input.generics.params.is_empty() {
        errors.at(&input.generics, format!("{what} can't be generic: a pipeline throws exceptions of one type"));
    }
    if variants.is_empty() {
        errors.at(&input.ident, format!("`{}` has no variants, so it could never be thrown", input.ident));
    }
    for ty in variants.iter().flat_map(|variant| &variant.fields).map(|field| &field.ty) {
        if matches!(ungroup(ty), Type::Reference(_)) {
            errors.at(ty, "details of an exception are values: the launch index they were borrowed from has ended");
        }
    }
    if !errors.is_empty() {
        return errors.into_tokens();
    }
    emit(&input.ident, &Repr::of(&input.attrs), &variants.iter().collect::<Vec<_>>())
}

fn emit(ident: &Ident, repr: &Repr, variants: &[&Variant]) -> TokenStream {
    let (krate, enum_name) = (&device_crate(), name(ident));
    let mut consts = TokenStream::new();
    let (mut names, mut throw, mut decode, mut most) = (Vec::new(), Vec::new(), Vec::new(), TokenStream::new());
    let mut layouts = Vec::new();
    let integer = repr.integer.as_ref().map_or(quote!(isize), ToTokens::to_token_stream);
    for (i, variant) in variants.iter().enumerate() {
        let (code, words) = (format_ident!("__CODE_{i}"), format_ident!("__WORDS_{i}"));
        // As rustc counts discriminants.
        // In the widest type there is, so that none is cut to one that is allowed.
        let value = match (&variant.discriminant, i.checked_sub(1)) {
            (Some((_, value)), _) => quote!({
                const __VALUE: __core::primitive::#integer = #value;
                __VALUE as __core::primitive::i128
            }),
            (None, Some(before)) => {
                let before = format_ident!("__CODE_{before}");
                quote!(#before + 1)
            }
            (None, None) => quote!(0),
        };
        let mut end = quote!(0);
        let (mut patterns, mut stores, mut loads, mut variant_layout) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (k, field) in variant.fields.iter().enumerate() {
            let (ty, span) = (&field.ty, place_of(&field.ty));
            let member = match &field.ident {
                Some(ident) => Member::Named(ident.clone()),
                None => Member::Unnamed(Index { index: k as u32, span }),
            };
            let (value, krate) = (format_ident!("__value_{k}"), moved(krate, span));
            let function = |name: &str| {
                let name = Ident::new(name, span);
                quote_spanned!(span=> <#ty as #krate::words::Words>::#name)
            };
            let (store, load, count) = (function("store"), function("load"), function("COUNT"));
            patterns.push(quote!(#member: #value));
            let (begin, layout) = (end.clone(), function("LAYOUT"));
            variant_layout.push(quote!(.field("", #begin, #layout)));
            end = quote!(#end + #count);
            stores.push(quote!(#store(#value, #krate::words::part_mut(__details, #begin, #end));));
            loads.push(quote!(#member: unsafe { #load(#krate::words::part(__words, #begin, #end)) }));
        }
        let (variant_ident, variant_name, span) = (&variant.ident, name(&variant.ident), place_of(&variant.ident));
        let there = moved(krate, span);
        consts.extend(quote! {
            const #code: __core::primitive::i128 = #value;
            const #words: __core::primitive::usize = #end;
        });
        consts.extend(quote_spanned! {span=>
            const _: () = #there::check::exception(#enum_name, #variant_name, #code, #words);
        });
        layouts.push(quote!(.text(#variant_name).number(#code as __core::primitive::usize) #(#variant_layout)*));
        names.push(quote!((#code as __core::primitive::u32, #variant_name)));
        throw.push(quote!(Self::#variant_ident { #(#patterns),* } => {
            #(#stores)*
            #krate::exception::Thrower::throw::<{ #code as __core::primitive::u32 }>(__thrower, __details)
        }));
        decode.push(quote!(#code => __core::option::Option::Some(Self::#variant_ident { #(#loads),* })));
        most.extend(quote!(let __most = #krate::check::larger(__most, #words);));
    }
    let span = place_of(ident);
    let there = moved(krate, span);
    // Numbers that are literals rustc compares; names may mean others in the block below than outside of it.
    let is_literal =
        |variant: &&Variant| variant.discriminant.as_ref().is_none_or(|(_, value)| matches!(value, syn::Expr::Lit(_)));
    let codes = (!variants.iter().all(is_literal)).then(|| {
        let codes = (0..variants.len()).map(|i| format_ident!("__CODE_{i}"));
        quote_spanned!(span=> const _: () = #there::check::codes(&[#(#codes),*]);)
    });
    let layout = layout(quote!(#krate::layout::Layout::of("exception")), &layouts);
    block(quote! {
            #consts
            #codes
            // SAFETY: `check::exception` has looked at every variant.
            #[automatically_derived]
            unsafe impl #krate::exception::UserException for #ident {
                const NAME: &'static __core::primitive::str = #enum_name;
                const DETAILS: __core::primitive::usize = {
                    let __most = 0;
                    #most
                    __most
                };
                const LAYOUT: #krate::layout::Layout = #layout;
                const VARIANTS: &'static [(__core::primitive::u32, &'static __core::primitive::str)] = &[#(#names),*];
                #[inline(always)]
                #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
                fn throw<__T: #krate::exception::Thrower>(self, __thrower: __T) -> ! {
                    let __details = &mut [0; #krate::exception::MAX_DETAILS];
                    match self {
                        #(#throw)*
                    }
                }
                #[inline(always)]
                unsafe fn decode(
                    __code: __core::primitive::u32,
                    __words: &[__core::primitive::u32],
                ) -> __core::option::Option<Self> {
                    match __code as __core::primitive::i128 {
                        #(#decode,)*
                        _ => __core::option::Option::None,
                    }
                }
            }
    })
}
