//! `#[derive(Element)]`: what a device buffer holds.

use crate::data::{alignment, touch};
use crate::shape::Struct;
use crate::support::{Errors, block, device_crate, moved, place_of};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::DeriveInput;

pub fn derive(input: &DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    let Some(model) = Struct::parse(input, "a buffer element", true, &mut errors) else {
        return errors.into_tokens();
    };
    model.require_repr_c("a buffer element", &mut errors);
    let broken = !errors.is_empty();
    let (krate, ident, name) = (&device_crate(), &model.ident, model.name());
    let writes = model.fields.iter().map(|field| {
        let (member, ty) = (&field.member, &field.ty);
        let span = place_of(ty);
        let krate = moved(krate, span);
        let write = quote_spanned!(span=> <#ty as #krate::view::Element>::write_element);
        let same = quote_spanned!(span=> #krate::check::same);
        quote! {{
            const __AT: __core::primitive::usize = __core::mem::offset_of!(#ident, #member);
            let __field = self.#member;
            #same(&raw const __field, __core::marker::PhantomData::<#ty>);
            #write(&__field, &mut __bytes[__AT..__AT + __core::mem::size_of::<#ty>()]);
        }}
    });
    let places = model.fields.iter().map(|field| {
        let ty = &field.ty;
        let span = place_of(ty);
        let krate = moved(krate, span);
        let (name, member) = (field.name(), &field.member);
        let size = quote_spanned!(span=> <#ty as #krate::view::Element>::SIZE);
        quote!((#name, __core::mem::offset_of!(#ident, #member), #size))
    });
    let no_padding = (!broken).then(|| {
        let span = place_of(ident);
        let check = quote_spanned!(span=> check::no_padding);
        let krate = moved(krate, span);
        quote_spanned! {span=>
            const _: () = #krate::#check(#name, __core::mem::size_of::<#ident>(), &[#(#places),*]);
        }
    });
    let layout = model.fields.iter().map(|field| {
        let (member, ty, name) = (&field.member, &field.ty, field.name());
        let span = place_of(ty);
        let krate = moved(krate, span);
        let layout = quote_spanned!(span=> <#ty as #krate::view::Element>::ELEMENT_LAYOUT);
        quote!(.field(#name, __core::mem::offset_of!(#ident, #member), #layout))
    });
    let (touch, alignment) = (touch(&model), alignment(&model, "element"));
    let errors = errors.into_tokens();
    let items = block(quote! {
            // SAFETY: the layout is C's, and each field is an `Element`.
            #[automatically_derived]
            unsafe impl #krate::data::DeviceData for #ident {
                #[inline]
                fn write_to(&self, __bytes: &mut [__core::primitive::u8]) {
                    #(#writes)*
                }
                const LAYOUT: #krate::layout::Layout = #krate::layout::Layout::of_size(
                    __core::mem::size_of::<Self>(),
                    __core::mem::align_of::<Self>(),
                ) #(#layout)*;
            }
            // SAFETY: any bytes are valid for each field, and there is no padding (asserted below).
            #[automatically_derived]
            unsafe impl #krate::view::Element for #ident {}
            // SAFETY: elements have no views.
            #[automatically_derived]
            unsafe impl #krate::data::Plain for #ident {}
            #[cfg(not(target_arch = "nvptx64"))]
            #[automatically_derived]
            unsafe impl #krate::host::Twin for #ident {
                type Device = #ident;
                #[inline]
                fn lower(&self, _: &mut #krate::host::KeepAlive) -> #ident {
                    *self
                }
            }
            #no_padding
            #alignment
            #touch
    });
    quote!(#errors #items)
}
