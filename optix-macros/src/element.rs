//! `#[derive(Element)]`: what a device buffer holds.

use crate::data::{Fields, device_data, own_host_data, struct_bounds};
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
    let (data, own) = (device_data(&model, Fields::Elements, "element"), own_host_data(&model));
    let bounds = struct_bounds(&model);
    let errors = errors.into_tokens();
    let element = block(quote! {
        // SAFETY: any bytes are valid for each field, and there is no padding (asserted below).
        #[automatically_derived]
        unsafe impl #krate::view::Element for #ident #bounds {}
        #no_padding
    });
    quote!(#errors #data #own #element)
}
