//! Macros.

mod data;
mod element;
mod params;
mod payload;
mod pipeline;
mod program;
mod record;
mod shape;
mod support;
mod words;

use proc_macro::TokenStream;
use syn::{DeriveInput, parse_macro_input};

/// P
#[proc_macro_derive(Payload, attributes(payload, optix))]
pub fn derive_payload(input: TokenStream) -> TokenStream {
    payload::derive(&parse_macro_input!(input as DeriveInput)).into()
}
/// P
#[proc_macro_derive(SbtRecord, attributes(view, optix))]
pub fn derive_sbt_record(input: TokenStream) -> TokenStream {
    record::derive(&parse_macro_input!(input as DeriveInput)).into()
}
/// P
#[proc_macro_derive(DeviceData, attributes(view, optix))]
pub fn derive_device_data(input: TokenStream) -> TokenStream {
    data::derive(&parse_macro_input!(input as DeriveInput)).into()
}
/// P
#[proc_macro_derive(Element, attributes(optix))]
pub fn derive_element(input: TokenStream) -> TokenStream {
    element::derive(&parse_macro_input!(input as DeriveInput)).into()
}
/// P
#[proc_macro_derive(Words, attributes(optix))]
pub fn derive_words(input: TokenStream) -> TokenStream {
    words::derive_words(&parse_macro_input!(input as DeriveInput)).into()
}
/// P
#[proc_macro_derive(Attributes, attributes(optix))]
pub fn derive_attributes(input: TokenStream) -> TokenStream {
    words::derive_attributes(&parse_macro_input!(input as DeriveInput)).into()
}
/// P
#[proc_macro_attribute]
pub fn launch_params(arguments: TokenStream, item: TokenStream) -> TokenStream {
    params::expand(arguments.into(), item.into()).into()
}
/// P
#[proc_macro_attribute]
pub fn raygen(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::RayGen, arguments.into(), item.into()).into()
}
/// P
#[proc_macro_attribute]
pub fn miss(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::Miss, arguments.into(), item.into()).into()
}
/// P
#[proc_macro_attribute]
pub fn closesthit(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::ClosestHit, arguments.into(), item.into()).into()
}
/// P
#[proc_macro_attribute]
pub fn anyhit(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::AnyHit, arguments.into(), item.into()).into()
}
/// P
#[proc_macro_attribute]
pub fn intersection(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::Intersection, arguments.into(), item.into()).into()
}
/// P
#[proc_macro]
pub fn pipeline(input: TokenStream) -> TokenStream {
    pipeline::expand(input.into()).into()
}
