//! `#[derive(Element)]`: what a device buffer holds.

use crate::data::touch;
use crate::shape::Struct;
use crate::support::{Errors, allow, moved, place_of};
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
    let (krate, ident, allow, name) = (&model.krate, &model.ident, allow(), model.name());
    let writes = model.fields.iter().map(|field| {
        let (member, ty) = (&field.member, &field.ty);
        let span = place_of(ty);
        let krate = moved(krate, span);
        let write = quote_spanned!(span=> <#ty as #krate::view::Element>::write_element);
        quote! {{
            const __AT: ::core::primitive::usize = ::core::mem::offset_of!(#ident, #member);
            let __field = self.#member;
            #write(&__field, &mut __bytes[__AT..__AT + ::core::mem::size_of::<#ty>()]);
        }}
    });
    let sizes = model.fields.iter().map(|field| {
        let ty = &field.ty;
        let span = place_of(ty);
        let krate = moved(krate, span);
        quote_spanned!(span=> <#ty as #krate::view::Element>::SIZE)
    });
    let no_padding = (!broken).then(|| {
        let span = place_of(ident);
        let check = quote_spanned!(span=> check::no_padding);
        let krate = moved(krate, span);
        quote_spanned! {span=>
            const _: () = #krate::#check(#name, ::core::mem::size_of::<#ident>(), 0 #(+ #sizes)*);
        }
    });
    let touch = touch(&model);
    let errors = errors.into_tokens();
    quote! {
        #errors
        #allow
        const _: () = {
            // SAFETY: the layout is C's, and each field is an `Element`.
            #[automatically_derived]
            unsafe impl #krate::data::DeviceData for #ident {
                #[inline]
                fn write_to(&self, __bytes: &mut [::core::primitive::u8]) {
                    #(#writes)*
                }
            }
            // SAFETY: any bytes are valid for each field, and there is no padding (asserted below).
            #[automatically_derived]
            unsafe impl #krate::view::Element for #ident {}
            #[automatically_derived]
            impl #krate::data::Plain for #ident {}
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
            #touch
        };
    }
}
