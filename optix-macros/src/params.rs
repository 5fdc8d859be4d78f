//! `#[launch_params]`.

use crate::data::{Fields, device_data, docs_or, host_data, struct_bounds};
use crate::place::place;
use crate::shape::{Field, Repr, Struct, is_slice};
use crate::source;
use crate::support::{
    Errors, block, cfg_of, device_crate, device_crate_outside, may_begin, moved, name, no_arguments, place_of,
};
use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use syn::spanned::Spanned;
use syn::{Attribute, DeriveInput, Error, Ident, Item, ItemStruct, Member};

pub fn expand(arguments: TokenStream, item: TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    if !may_begin(&item, false, &mut errors) {
        let errors = errors.into_tokens();
        return quote!(#errors #item);
    }
    no_arguments(arguments, "launch_params", &mut errors);
    let mut item = match syn::parse2::<Item>(item.clone()) {
        Ok(Item::Struct(item)) => item,
        Ok(other) => {
            errors.at(&other, "`#[launch_params]` belongs on a struct: the values that every program of a launch sees");
            let errors = errors.into_tokens();
            return quote!(#errors #other);
        }
        Err(error) => {
            errors.push(error);
            let errors = errors.into_tokens();
            return quote!(#errors #item);
        }
    };
    let model = Struct::parse(&DeriveInput::from(item.clone()), "a launch-parameter struct", false, &mut errors);
    let above = source::attributes_above(Span::call_site());
    if derives(&above, "Clone") || derives(&above, "Copy") {
        let message = "write `#[launch_params]` above `#[derive(..)]`: it derives `Clone` and `Copy` where they are not, and sees only \
                       what stands below it";
        errors.push(Error::new(Span::call_site(), message));
    }
    strip(&mut item);
    let Some(model) = model else {
        let errors = errors.into_tokens();
        return quote!(#errors #item);
    };
    check(&model, &mut errors);
    let data = device_data(&model, Fields::Data, "launch-parameter struct");
    let host_data = host_data(&model, &mut errors);
    let (host, host_data) = (host_data.host, host_data.items);
    let bounds = bounds(&model);
    let view = view(&model);
    let params = launch_params(&model, &host);
    let errors = errors.into_tokens();
    let missing = missing_attributes(&item.attrs, &above);
    quote! {
        #errors
        #missing
        #item
        #data
        #host_data
        #bounds
        #view
        #params
    }
}

/// Takes out what only this macro understands, and `cfg`, which [`check`] has reported: what is made of the field needs it.
fn strip(item: &mut ItemStruct) {
    for field in &mut item.fields {
        field.attrs.retain(|a| !["bound", "view", "cfg"].iter().any(|word| a.path().is_ident(word)));
    }
}

/// `#[repr(C)]` and the derives that the struct does not have itself: of its attributes, and those above the macro's.
fn missing_attributes(attributes: &[Attribute], above: &[Attribute]) -> TokenStream {
    let derived = |what: &str| derives(attributes, what) || derives(above, what);
    let repr = (!Repr::of(attributes).fixed).then(|| quote!(#[repr(C)]));
    let clone = (!derived("Clone")).then(|| quote!(#[derive(::core::clone::Clone)]));
    let copy = (!derived("Copy")).then(|| quote!(#[derive(::core::marker::Copy)]));
    quote!(#repr #clone #copy)
}

/// Whether a trait is derived.
fn derives(attributes: &[Attribute], what: &str) -> bool {
    attributes.iter().filter(|a| a.path().is_ident("derive")).any(|a| {
        let mut found = false;
        let _ = a.parse_nested_meta(|meta| {
            found |= meta.path.segments.last().is_some_and(|s| s.ident == what);
            Ok(())
        });
        found
    })
}

fn check(model: &Struct, errors: &mut Errors) {
    if let Some(packed) = Repr::of(&model.attrs).packed {
        errors.at(packed, "launch parameters can't be packed: programs load each field at its own alignment");
    }
    for field in &model.fields {
        if let Some(cfg) = cfg_of(&field.attrs) {
            errors.at(
                cfg,
                format!(
                    "launch parameter `{}` can't be `#[cfg(..)]`: host and device must see the same fields; write two \
                     structs, each with `#[cfg(..)]` above its `#[launch_params]`",
                    field.name()
                ),
            );
        }
        if field.bound.is_some() && field.view {
            errors.at(
                &field.ty,
                format!(
                    "`{}` can't be `#[bound]`: a view is an address, which no two launches need share; bind numbers",
                    field.name()
                ),
            );
        }
    }
}

fn ident_of(field: &Field) -> Option<&Ident> {
    match &field.member {
        Member::Named(ident) => Some(ident),
        Member::Unnamed(_) => None,
    }
}

fn field_value(model: &Struct, field: &Field) -> TokenStream {
    let (krate, ident, member, ty) = (&device_crate(), &model.ident, &field.member, &field.ty);
    let (name, bound, slice) = (field.name(), field.bound.is_some(), is_slice(&field.ty));
    quote! {
        #krate::params::Field {
            name: #name,
            offset: __core::mem::offset_of!(#ident, #member),
            size: __core::mem::size_of::<#ty>(),
            bound: #bound,
            slice: #slice,
        }
    }
}

/// `Frame::MAX_BOUNCES` for `#[bound] max_bounces`.
fn bounds(model: &Struct) -> TokenStream {
    let (krate, ident) = (&device_crate(), &model.ident);
    let mut checks = TokenStream::new();
    let consts: Vec<_> = model
        .fields
        .iter()
        .filter(|f| f.bound.is_some() && !f.view)
        .filter_map(|field| {
            let (vis, ty) = (&field.vis, &field.ty);
            let name = format_ident!("{}", name(ident_of(field)?).to_uppercase(), span = field.member.span());
            let doc = format!("Field `{}`, to bind to a constant when the pipeline is built.", field.name());
            let value = field_value(model, field);
            let (name_there, field_name) = (model.name(), field.name());
            let span = place_of(ty);
            let there = moved(krate, span);
            let check = quote_spanned!(span=> #there::check::bound_field);
            checks.extend(quote_spanned! {span=>
                const _: () = #check(#name_there, #field_name, __core::mem::size_of::<#ty>());
            });
            Some(quote! {
                #[doc = #doc]
                // SAFETY: the field is of this struct and this type.
                #vis const #name: #krate::params::Bound<#ident, #ty> = unsafe { #krate::params::Bound::new(#value) };
            })
        })
        .collect();
    if consts.is_empty() {
        return TokenStream::new();
    }
    block(quote! {
        #[automatically_derived]
        impl #ident {
            #(#consts)*
        }
        #checks
    })
}

/// What programs get from `params()`.
fn view(model: &Struct) -> TokenStream {
    let (krate, ident, vis) = (&device_crate(), &model.ident, &model.vis);
    let view = format_ident!("{}View", model.name(), span = ident.span());
    let methods = model.fields.iter().map(|field| {
        let (vis, member, ty) = (&field.vis, &field.member, &field.ty);
        let docs = docs_or(&field.attrs, || format!("Field `{}` of [`{}`].", field.name(), model.name()));
        let load = quote!(#krate::intrinsics::load_param::<#ident, #ty, { __core::mem::offset_of!(#ident, #member) }>);
        quote! {
            #docs
            #[inline(always)]
            #[must_use]
            #vis fn #member(self) -> #ty {
                // `Self` is another type here than in the struct, where a macro of the user's may hide it.
                let _: fn(&#ident) -> *const #ty = |__params| &raw const __params.#member;
                // SAFETY: the struct has this field at this offset.
                unsafe { #load(self.__base) }
            }
        }
    });
    let doc = format!("What a program sees of [`{}`]: a method for each field, which loads that field.", model.name());
    let outside = device_crate_outside();
    let members = model.fields.iter().map(|field| &field.member);
    let not_assigned = not_assigned(model, &view);
    let impls = block(quote! {
        #not_assigned
        // So that no method is unused.
        const _: () = {
            #(let _ = #view::#members;)*
        };
        #[automatically_derived]
        impl #view<'_> {
            #(#methods)*
        }
        #[automatically_derived]
        impl __core::clone::Clone for #view<'_> {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }
        #[automatically_derived]
        impl __core::marker::Copy for #view<'_> {}
        #[automatically_derived]
        impl<'a> __core::convert::From<#krate::intrinsics::ParamsBase<'a, #ident>> for #view<'a> {
            #[inline(always)]
            fn from(__base: #krate::intrinsics::ParamsBase<'a, #ident>) -> Self {
                Self { __base }
            }
        }
    });
    quote! {
        #[doc = #doc]
        #vis struct #view<'a> {
            #[doc(hidden)]
            __base: #outside::intrinsics::ParamsBase<'a, #ident>,
        }
        #impls
    }
}

/// The fields, for the message that an assignment to one gives: the view leads there by `Deref`, which the compiler follows for
/// fields that it does not find. They are private in a module of their own, so that nothing gets at them, and the name of their
/// struct says why. The methods come first.
fn not_assigned(model: &Struct, view: &Ident) -> Option<TokenStream> {
    if model.fields.is_empty() {
        return None;
    }
    let read_only = format_ident!("{}IsReadByMethodsAndWrittenOnlyThroughItsSliceMuts", model.name());
    let members: Vec<_> = model.fields.iter().map(|field| &field.member).collect();
    Some(quote! {
        mod __read_only {
            pub struct #read_only { #(#members: (),)* }
            pub static FIELDS: #read_only = #read_only { #(#members: ()),* };
            // Where no program writes `params().field` they would be dead code.
            const _: fn(&#read_only) = |__all| {
                #(let _ = &__all.#members;)*
            };
        }
        #[automatically_derived]
        impl __core::ops::Deref for #view<'_> {
            type Target = __read_only::#read_only;
            #[inline(always)]
            fn deref(&self) -> &__read_only::#read_only {
                &__read_only::FIELDS
            }
        }
    })
}

/// `LaunchParams`, the constant-memory symbol, and the loads from it.
fn launch_params(model: &Struct, host: &Ident) -> TokenStream {
    let (krate, ident, name) = (&device_crate(), &model.ident, model.name());
    let view = format_ident!("{}View", name, span = ident.span());
    let symbol = format!("optix_params_{name}_{}", place(ident.span(), &name));
    let declare = format!(".visible .const .align {{align}} .b8 {symbol}[{{size}}];");
    let loads =
        [("long", "b64", "u64", 8usize), ("word", "b32", "u32", 4), ("half", "u16", "u16", 2), ("byte", "u8", "u8", 1)];
    let loads = loads.map(|(function, load, ty, unit)| {
        let load = format!("ld.const.{load} {{v}}, [{symbol}+{{at}}];");
        let (function, ty) = (format_ident!("{function}"), format_ident!("{ty}"));
        // PTX has no registers of 8 bits, and those of 16 are no class of inline assembly's operands here.
        let (class, register) = if unit == 8 { ("reg64", "u64") } else { ("reg32", "u32") };
        let (class, register) = (format_ident!("{class}"), format_ident!("{register}"));
        quote! {
            #[cfg(target_arch = "nvptx64")]
            #[inline(always)]
            fn #function<const OFFSET: __core::primitive::usize, const INDEX: __core::primitive::usize>() -> __core::primitive::#ty {
                let __value: __core::primitive::#register;
                // Not `nomem`, so that no load is moved over a trace call: loading again costs less than keeping the value.
                // SAFETY: reads from the symbol, which does not change while programs run.
                unsafe {
                    __core::arch::asm!(
                        #load,
                        v = out(#class) __value,
                        at = const OFFSET + #unit * INDEX,
                        options(pure, readonly, nostack, preserves_flags),
                    )
                };
                __value as __core::primitive::#ty
            }
        }
    });
    let address = format!("{{{{ .reg .b64 a; mov.b64 a, {symbol}; cvta.const.u64 {{v}}, a; }}}}");
    let (fields, bounds) = (model.fields.iter().map(|field| field_value(model, field)), struct_bounds(model));
    let impls = block(quote! {
        // SAFETY: symbol and fields are made from the struct.
        #[automatically_derived]
        unsafe impl #krate::params::LaunchParams for #ident #bounds {
            const NAME: &'static __core::primitive::str = #name;
            const SYMBOL: &'static __core::primitive::str = #symbol;
            const FIELDS: &'static [#krate::params::Field] = &[#(#fields),*];
            type View<'a> = #view<'a>;
            #[cfg(not(target_arch = "nvptx64"))]
            type Host = #host;
        }

        #[automatically_derived]
        impl #krate::params::ParamsSymbol for #ident {
            #(#loads)*

            #[cfg(target_arch = "nvptx64")]
            #[inline(always)]
            fn address() -> *const __core::primitive::u8 {
                let __value: __core::primitive::u64;
                // SAFETY: takes the symbol's address.
                unsafe {
                    __core::arch::asm!(
                        #address,
                        v = out(reg64) __value,
                        options(pure, nomem, nostack, preserves_flags),
                    )
                };
                __value as *const __core::primitive::u8
            }
        }

        #[cfg(target_arch = "nvptx64")]
        impl #ident {
            const __OPTIX_ALIGN: __core::primitive::usize = __core::mem::align_of::<Self>();
            // A variable has at least one byte.
            const __OPTIX_SIZE: __core::primitive::usize = #krate::check::larger(__core::mem::size_of::<Self>(), 1);
        }
    });
    quote! {
        #impls
        // An item, so it can't be in a block.
        #[cfg(target_arch = "nvptx64")]
        ::core::arch::global_asm!(#declare, align = const #ident::__OPTIX_ALIGN, size = const #ident::__OPTIX_SIZE);
    }
}
