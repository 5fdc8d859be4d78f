//! `#[derive(Element)]`: what a device buffer holds.

use crate::data::touch;
use crate::shape::Struct;
use crate::support::{Errors, allow};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::DeriveInput;
use syn::spanned::Spanned;

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
        let write = quote_spanned!(ty.span()=> #krate::check::write_element::<#ty>);
        quote! {{
            const __AT: usize = ::core::mem::offset_of!(#ident, #member);
            #write(&self.#member, &mut __bytes[__AT..__AT + ::core::mem::size_of::<#ty>()]);
        }}
    });
    let types = model.fields.iter().map(|f| &f.ty);
    let no_padding = (!broken).then(|| quote_spanned! {ident.span()=>
        const _: () = #krate::check::no_padding(
            #name,
            ::core::mem::size_of::<#ident>(),
            0 #(+ ::core::mem::size_of::<#types>())*,
        );
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
                fn write_to(&self, __bytes: &mut [u8]) {
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
            impl #krate::host::Twin for #ident {
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
