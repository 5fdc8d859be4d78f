//! `#[derive(SbtRecord)]`.

use crate::data::{Fields, device_data, host_data, struct_bounds};
use crate::shape::Struct;
use crate::support::{Errors, block, device_crate};
use proc_macro2::TokenStream;
use quote::quote;
use syn::DeriveInput;

pub fn derive(input: &DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    let Some(model) = Struct::parse(input, "an SBT record", false, &mut errors) else {
        return errors.into_tokens();
    };
    model.require_repr_c("an SBT record", &mut errors);
    let (krate, ident, name) = (&device_crate(), &model.ident, model.name());
    let data = device_data(&model, Fields::Data, "record");
    let host_data = host_data(&model, &mut errors);
    let (host, items) = (host_data.host, host_data.items);
    let bounds = struct_bounds(&model);
    let errors = errors.into_tokens();
    let record = block(quote! {
        #[automatically_derived]
        impl #krate::record::SbtRecord for #ident #bounds {
            const NAME: &'static __core::primitive::str = #name;
            #[cfg(not(target_arch = "nvptx64"))]
            type Host = #host;
        }
    });
    quote!(#errors #data #items #record)
}
