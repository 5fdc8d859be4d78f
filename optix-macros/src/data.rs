//! `DeviceData`, with the host counterpart of structs that hold views.

use crate::shape::{Field, Form, Struct, construct};
use crate::support::{Errors, block, device_crate, device_crate_outside, docs, layout, moved, place_of};
use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote, quote_spanned};
use syn::{DeriveInput, Ident};

/// `#[derive(DeviceData)]`.
pub fn derive(input: &DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    let Some(model) = Struct::parse(input, "a device-data struct", true, &mut errors) else {
        return errors.into_tokens();
    };
    model.require_repr_c("a device-data struct", &mut errors);
    let data = device_data(&model, Fields::Data, "struct");
    let host_data = host_data(&model, &mut errors);
    let items = host_data.items;
    let errors = errors.into_tokens();
    quote!(#errors #data #items)
}

/// Asserts that a struct, which messages call `what`, is aligned as memory of either machine is.
pub fn alignment(model: &Struct, what: &str) -> TokenStream {
    let (ident, name, span) = (&model.ident, model.name(), place_of(&model.ident));
    let krate = moved(&device_crate(), span);
    let check = quote_spanned!(span=> #krate::check::alignment);
    quote_spanned!(span=> const _: () = #check(#what, #name, __core::mem::align_of::<#ident>());)
}

/// What the fields of a struct are.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Fields {
    /// Views of device memory, and plain data.
    Data,
    /// Elements of buffers.
    Elements,
}

impl Fields {
    /// The trait that a field must have, and what in it writes the field and says its layout.
    fn asked(self, field: &Field) -> (TokenStream, Ident, Ident) {
        let (of, write, layout) = match self {
            Self::Elements => (quote!(view::Element), "write_element", "ELEMENT_LAYOUT"),
            Self::Data if field.view => (quote!(data::DeviceData), "write_to", "LAYOUT"),
            Self::Data => (quote!(data::Plain), "write_plain", "PLAIN_LAYOUT"),
        };
        let (ty, span) = (&field.ty, place_of(&field.ty));
        let (krate, of) = (moved(&device_crate(), span), moved(&of, span));
        (quote_spanned!(span=> <#ty as #krate::#of>), Ident::new(write, span), Ident::new(layout, span))
    }
}

/// The impl of `DeviceData`: each field at its offset. `what` the struct is called in messages.
pub fn device_data(model: &Struct, fields: Fields, what: &str) -> TokenStream {
    let (krate, ident) = (&device_crate(), &model.ident);
    let writes = model.fields.iter().map(|field| {
        let (member, ty, span) = (&field.member, &field.ty, place_of(&field.ty));
        let krate = moved(krate, span);
        let (asked, write, _) = fields.asked(field);
        let write = quote_spanned!(span=> #asked::#write);
        let same = quote_spanned!(span=> #krate::check::same);
        quote! {{
            const __AT: __core::primitive::usize = __core::mem::offset_of!(#ident, #member);
            let __field = self.#member;
            #same(&raw const __field, __core::marker::PhantomData::<#ty>);
            #write(&__field, &mut __bytes[__AT..__AT + __core::mem::size_of::<#ty>()]);
        }}
    });
    let layouts: Vec<_> = model
        .fields
        .iter()
        .map(|field| {
            let (member, name, span) = (&field.member, field.name(), place_of(&field.ty));
            let (asked, _, layout) = fields.asked(field);
            let layout = quote_spanned!(span=> #asked::#layout);
            quote!(.field(#name, __core::mem::offset_of!(#ident, #member), #layout))
        })
        .collect();
    let of = quote!(#krate::layout::Layout::of_size(__core::mem::size_of::<Self>(), __core::mem::align_of::<Self>()));
    let layout = layout(of, &layouts);
    let views = model.fields.iter().filter(|field| field.view && fields == Fields::Data).map(|field| {
        let (ty, span) = (&field.ty, place_of(&field.ty));
        let krate = moved(krate, span);
        quote_spanned!(span=> const _: () = #krate::check::view::<#ty>();)
    });
    let (touch, alignment, bounds) = (touch(model), alignment(model, what), view_bounds(model, krate));
    block(quote! {
        // SAFETY: the layout is C's, each field has a layout that host and device share, and padding is not written.
        #[automatically_derived]
        unsafe impl #krate::data::DeviceData for #ident where #bounds {
            #[inline]
            fn write_to(&self, __bytes: &mut [__core::primitive::u8]) {
                #(#writes)*
            }
            const LAYOUT: #krate::layout::Layout = #layout;
        }
        #alignment
        #touch
        #(#views)*
    })
}

/// What reports once, at the struct's name, that it is not `Copy`; and the bound with which an impl leaves it at that. With a
/// lifetime, since rustc reports a plain bound that does not hold.
pub fn must_copy(model: &Struct) -> (TokenStream, TokenStream) {
    let ident = &model.ident;
    let span = place_of(ident);
    let krate = moved(&device_crate(), span);
    let assertion = quote_spanned!(span=> const _: () = #krate::check::copied::<#ident>(););
    (assertion, quote!(where for<'__never> #ident: __core::marker::Copy))
}

/// The bounds with which an impl says nothing more about a struct whose `DeviceData` has an error: that it has it, whatever that
/// asks for, and [`view_bounds`]. With a lifetime, so that rustc takes it on trust.
pub fn struct_bounds(model: &Struct) -> TokenStream {
    let (krate, ident) = (&device_crate(), &model.ident);
    let views = view_bounds(model, krate);
    quote!(where for<'__never> #ident: #krate::data::DeviceData, #views)
}

/// What `device_data` asserts once, of each view: so nothing that is made of the struct reports it again. With a lifetime,
/// since rustc reports a plain bound that does not hold.
fn view_bounds(model: &Struct, krate: &impl ToTokens) -> TokenStream {
    let bounds = model.fields.iter().filter(|field| field.view).map(|field| {
        let (ty, span) = (&field.ty, place_of(&field.ty));
        let krate = moved(krate, span);
        quote_spanned!(span=> for<'__never> #ty: #krate::check::View,)
    });
    quote!(#(#bounds)*)
}

/// Uses every field, so that no lint calls a struct or field dead that only the other machine reads.
pub fn touch(model: &Struct) -> TokenStream {
    let ident = &model.ident;
    let values: Vec<_> = model
        .fields
        .iter()
        .map(|f| {
            let member = &f.member;
            quote!(__value.#member)
        })
        .collect();
    let rebuilt = construct(ident, &model.fields, &values);
    quote! {
        const _: fn(#ident) -> #ident = |__value| #rebuilt;
    }
}

/// The host counterpart: its type, and the items that make it.
pub struct HostData {
    pub host: Ident,
    pub items: TokenStream,
}

/// What says that a struct without views is plain data, and its own host counterpart.
pub fn own_host_data(model: &Struct) -> TokenStream {
    let (krate, ident, bounds) = (&device_crate(), &model.ident, struct_bounds(model));
    block(quote! {
        // SAFETY: no field is a view, and each is plain itself.
        #[automatically_derived]
        unsafe impl #krate::data::Plain for #ident #bounds {}
        #[cfg(not(target_arch = "nvptx64"))]
        #[automatically_derived]
        unsafe impl #krate::host::HostData for #ident #bounds {
            type Device = #ident;
            #[inline]
            fn lower(&self, _: &mut #krate::host::KeepAlive) -> #ident {
                *self
            }
        }
    })
}

/// The struct is its own host counterpart, or has one in which owners stand in place of views.
pub fn host_data(model: &Struct, errors: &mut Errors) -> HostData {
    let (krate, ident, vis) = (&device_crate(), &model.ident, &model.vis);
    if !model.has_views() {
        return HostData { host: ident.clone(), items: own_host_data(model) };
    }
    if model.form == Form::Tuple {
        errors.at(
            ident,
            format!(
                "`{ident}` holds views of device memory, so its fields need names: its host counterpart has the same ones"
            ),
        );
        return HostData { host: ident.clone(), items: TokenStream::new() };
    }
    let outside = device_crate_outside();
    let (bounds, views, views_outside) =
        (struct_bounds(model), view_bounds(model, krate), view_bounds(model, &outside));
    let host = format_ident!("{}Host", model.name(), span = ident.span());
    let fields = model.fields.iter().map(|field| {
        let (vis, member, ty) = (&field.vis, &field.member, &field.ty);
        let docs = docs_or(&field.attrs, || format!("Field `{}` of [`{}`].", field.name(), model.name()));
        let ty = if field.view {
            let span = place_of(ty);
            let outside = moved(&outside, span);
            quote_spanned!(span=> <#ty as #outside::host::View>::Owner)
        } else {
            quote!(#ty)
        };
        quote!(#docs #vis #member: #ty)
    });
    let clones: Vec<_> = model
        .fields
        .iter()
        .map(|field| {
            let member = &field.member;
            if field.view { quote!(__core::clone::Clone::clone(&self.#member)) } else { quote!(self.#member) }
        })
        .collect();
    let clone = construct(&host, &model.fields, &clones);
    let lowered: Vec<_> = model
        .fields
        .iter()
        .map(|field| {
            let (member, ty) = (&field.member, &field.ty);
            if field.view {
                let span = place_of(ty);
                let krate = moved(krate, span);
                let of = quote_spanned!(span=> <#ty as #krate::host::View>::of);
                quote!(#of(&self.#member, __keep))
            } else {
                quote!(self.#member)
            }
        })
        .collect();
    let lowered = construct(ident, &model.fields, &lowered);
    let doc = format!(
        "What an application fills in for a [`{}`]: in each view's place the owner of the memory it shows.",
        model.name()
    );
    let impls = block(quote! {
        #[automatically_derived]
        impl __core::clone::Clone for #host where #views {
            fn clone(&self) -> Self {
                #clone
            }
        }
        #[automatically_derived]
        unsafe impl #krate::host::HostData for #host #bounds {
            type Device = #ident;
            fn lower(&self, __keep: &mut #krate::host::KeepAlive) -> #ident {
                #lowered
            }
        }
        #[automatically_derived]
        unsafe impl #krate::host::View for #ident #bounds {
            type Owner = #host;
            fn of(__owner: &#host, __keep: &mut #krate::host::KeepAlive) -> Self {
                #krate::host::HostData::lower(__owner, __keep)
            }
        }
    });
    let items = quote! {
        #[doc = #doc]
        #[cfg(not(target_arch = "nvptx64"))]
        #vis struct #host
        where
            #views_outside
        {
            #(#fields,)*
        }
        // So that a crate may name the host counterpart without asking which machine it is compiled for.
        #[doc(hidden)]
        #[cfg(target_arch = "nvptx64")]
        #vis enum #host {}
        #[cfg(not(target_arch = "nvptx64"))]
        #impls
    };
    HostData { host, items }
}

/// The user's doc comment, or another.
pub fn docs_or(attributes: &[syn::Attribute], otherwise: impl FnOnce() -> String) -> TokenStream {
    let docs = docs(attributes);
    if docs.is_empty() {
        let text = otherwise();
        quote!(#[doc = #text])
    } else {
        quote!(#(#docs)*)
    }
}
