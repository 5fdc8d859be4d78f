//! The type that stands for a program, and its impl of the program trait.

use super::kind::{Kind, Roles};
use super::model::Program;
use crate::shape::is_plain;
use crate::support::{block, device_crate, mentions, moved, place_of};
use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote, quote_spanned};
use syn::{GenericParam, Generics, Ident};

/// The type of the program's name. It is public even where the function is not: a pipeline names it in public impls. Its name is
/// the macro's, so that no lint finds a type with a function's name.
fn marker(ident: &Ident) -> TokenStream {
    let mut ident = ident.clone();
    ident.set_span(place_of(&ident));
    quote! {
        #[doc(hidden)]
        pub struct #ident {}
    }
}

pub fn emit(program: &Program) -> TokenStream {
    let Program { kind, ident, pipeline, .. } = program;
    let (krate, marker) = (&device_crate(), marker(ident));
    let context = format_ident!("{}", kind.context());
    let trait_there = Ident::new(&kind.program_trait().to_string(), program.context_span);
    let payload_trait = quote!(#krate::payload::Payload);

    let mut generics = without_defaults(&program.generics);
    // Before the user's, with their bounds in place: rustc suggests bounds after the last parameter.
    let mut parameter = |parameter| generics.params.insert(0, parameter);

    // Record: what the program names, else whatever the hit group has.
    let record = match &program.record {
        Some(record) => record.to_token_stream(),
        None if kind.has_hits() => {
            parameter(syn::parse_quote!(__Rec: #krate::record::SbtRecord));
            quote!(__Rec)
        }
        None => quote!(()),
    };
    // Payload: that of the part it receives or returns, else any that asks for nothing.
    let payload = match (kind.roles(), program.input.as_ref().or(program.output.as_ref())) {
        (None, _) => quote!(()),
        (Some(_), Some(part)) => {
            let span = place_of(part);
            let krate = moved(krate, span);
            quote_spanned!(span=> <#part as #krate::payload::PartOf>::Payload)
        }
        (Some(Roles { from, .. }), None) => {
            parameter(syn::parse_quote!(__R: #payload_trait<#from: #krate::check::MayReturnNothing>));
            quote!(__R)
        }
    };

    // The call.
    let record_argument = program.record.as_ref().map(|_| quote!(, __record));
    let input_argument = program.input.as_ref().zip(kind.roles()).map(|(input, Roles { received, .. })| {
        let span = place_of(input);
        let (krate, payload) = (moved(krate, span), moved(&payload, span));
        let take = quote_spanned!(span=> <#input as #krate::check::#received<#payload>>::take);
        quote!(, #take(__input))
    });
    // A context or a decision that only has the right name is reported where its type is.
    let context_argument = quote_spanned!(program.context_span=> __cx);
    let mut function = ident.clone();
    function.set_span(ident.span().located_at(program.result_span));
    let call = quote_spanned!(program.result_span=> #function(#context_argument #record_argument #input_argument));
    let nothing = kind.roles().map(|Roles { from, .. }| {
        let span = place_of(ident);
        let (krate, payload, payload_trait, from) =
            (moved(krate, span), moved(&payload, span), moved(&payload_trait, span), moved(&from, span));
        quote_spanned! {span=>
            <<#payload as #payload_trait>::#from as #krate::check::MayReturnNothing>::nothing()
        }
    });
    let give = program.output.as_ref().zip(kind.roles()).map(|(output, Roles { returned, .. })| {
        let span = place_of(output);
        let (krate, payload, returned) = (moved(krate, span), moved(&payload, span), moved(&returned, span));
        quote_spanned!(span=> <#output as #krate::check::#returned<#payload>>::give)
    });
    let body = match (kind, give) {
        (Kind::RayGen | Kind::Exception, _) => quote!(#call;),
        (Kind::AnyHit, Some(give)) => quote! {
            let (__decision, __part) = #call;
            (__decision, #give(__part))
        },
        (Kind::AnyHit, None) if program.returns_unit_part => quote! {
            let (__decision, ()) = #call;
            (__decision, #nothing)
        },
        (Kind::AnyHit, None) => quote!((#call, #nothing)),
        (_, Some(give)) => quote!(#give(#call)),
        (_, None) => quote! {
            #call;
            #nothing
        },
    };

    let hits = program.hits.as_ref();
    let record_type = quote_spanned!(place_of(&record)=> type Record = #record;);
    let (trait_arguments, context_arguments, assoc) = match kind {
        Kind::RayGen | Kind::Exception => (quote!(#pipeline), quote!(#pipeline), record_type),
        Kind::Miss => (quote!(#pipeline, #payload), quote!(#pipeline), record_type),
        Kind::ClosestHit | Kind::AnyHit => {
            (quote!(#pipeline, #hits, #record, #payload), quote!(#pipeline, #hits), TokenStream::new())
        }
        Kind::Intersection => {
            (quote!(#pipeline, #record, #payload), quote!(#pipeline, #hits), quote!(type Attributes = #hits;))
        }
        Kind::DirectCallable | Kind::ContinuationCallable => return emit_callable(program),
    };
    let (input, output) = match kind.roles() {
        None => (TokenStream::new(), TokenStream::new()),
        Some(Roles { at, from, .. }) => {
            let span = program.input.as_ref().or(program.output.as_ref()).map_or(program.context_span, place_of);
            let part = |role: &Ident| moved(&quote!(<#payload as #payload_trait>::#role), span);
            let (input, output) = (part(&at), part(&from));
            let decision = quote!(#krate::ray::Decision);
            let output = if *kind == Kind::AnyHit { quote!((#decision, #output)) } else { output };
            (quote!(, __input: #input), quote!(-> #output))
        }
    };
    let checked = checked_record(program, &mut generics);
    let (impl_generics, _, where_clause) = generics.split_for_impl();
    let krate_there = moved(krate, program.context_span);
    let implemented = quote_spanned! {program.context_span=>
        #krate_there::program::#trait_there<#trait_arguments>
    };
    let items = block(quote! {
            #checked
            #[automatically_derived]
            impl #impl_generics #implemented for #ident #where_clause {
                #assoc
                #[inline(always)]
                fn run(__cx: &#krate::program::#context<#context_arguments>, __record: &#record #input) #output {
                    #body
                }
            }
    });
    quote!(#marker #items)
}

/// What reports once, where a program names its record, that it is none; the program's impl takes it on trust, which is added to
/// its `generics`. `None` without a record, and for one that depends on a type parameter, which has bounds.
fn checked_record(program: &Program, generics: &mut Generics) -> Option<TokenStream> {
    let record = program.record.as_ref()?;
    let mut parameters = program.generics.params.iter().filter_map(|parameter| match parameter {
        GenericParam::Type(parameter) => Some(&parameter.ident),
        GenericParam::Const(parameter) => Some(&parameter.ident),
        GenericParam::Lifetime(_) => None,
    });
    if parameters.any(|parameter| mentions(record.to_token_stream(), &parameter.to_string())) {
        return None;
    }
    let krate = &device_crate();
    let trusted = syn::parse_quote!(for<'__never> #record: #krate::record::SbtRecord);
    generics.make_where_clause().predicates.push(trusted);
    let span = place_of(record);
    let krate = moved(krate, span);
    Some(quote_spanned!(span=> const _: () = #krate::check::record::<#record>();))
}

fn emit_callable(program: &Program) -> TokenStream {
    let Program { kind, ident, pipeline, arguments, result, .. } = program;
    let (krate, marker) = (&device_crate(), marker(ident));
    let context = format_ident!("{}", kind.context());
    let record = program.record.as_ref().map_or(quote!(()), ToTokens::to_token_stream);
    let record_argument = program.record.as_ref().map(|_| quote!(, __record));
    let names: Vec<_> = (0..arguments.len()).map(|i| format_ident!("__argument_{i}")).collect();
    let context_argument = quote_spanned!(program.context_span=> __cx);
    let call = quote_spanned!(program.result_span=> #ident(#context_argument #record_argument #(, #names)*));
    let mut generics = without_defaults(&program.generics);
    let checked = checked_record(program, &mut generics);
    let (impl_generics, _, where_clause) = generics.split_for_impl();
    let trait_there = Ident::new(&kind.program_trait().to_string(), program.context_span);
    let krate_there = moved(krate, program.context_span);
    let implemented = quote_spanned!(program.context_span=> #krate_there::program::#trait_there<#pipeline>);
    let record_type = quote_spanned!(place_of(&record)=> type Record = #record;);
    // A type that can't be passed is most likely the first that is not a number or a vector.
    let of_interest = arguments.iter().chain(result).find(|ty| !is_plain(ty));
    let span = of_interest.map_or(program.context_span, place_of);
    let signature = moved(&quote!(fn(#(#arguments),*) -> #result), span);
    let arguments = moved(&quote!((#(#arguments,)*)), span);
    let (names, body) = (quote!((#(#names,)*)), quote!({ #call }));
    let run = quote_spanned! {span=>
        #[inline(always)]
        fn run(__cx: &#krate::program::#context<#pipeline>, __record: &#record, #names: #arguments) -> #result #body
    };
    let items = block(quote! {
            #checked
            #[automatically_derived]
            impl #impl_generics #implemented for #ident #where_clause {
                #record_type
                type Signature = #signature;
                #run
            }
    });
    quote!(#marker #items)
}

/// Type parameters of a function may have no defaults, nor may those of an impl.
fn without_defaults(generics: &Generics) -> Generics {
    let mut generics = generics.clone();
    for parameter in &mut generics.params {
        if let GenericParam::Type(parameter) = parameter {
            parameter.default = None;
        }
    }
    generics
}

/// For a program with errors: fits everywhere, so that nothing else is reported.
pub fn fallback(kind: Kind, ident: &Ident) -> TokenStream {
    let (krate, marker, trait_name) = (&device_crate(), marker(ident), kind.program_trait());
    let pipeline = quote!(__P: #krate::pipeline::Pipeline);
    let hits = quote!(__A: #krate::primitive::Attributes);
    let record = quote!(__Rec: #krate::record::SbtRecord);
    let payload = quote!(__R: #krate::payload::Payload);
    let at = |role: &str| {
        let role = format_ident!("{role}");
        quote!(<__R as #krate::payload::Payload>::#role)
    };
    let (generics, arguments, assoc, signature) = match kind {
        Kind::RayGen => (
            quote!(#pipeline),
            quote!(__P),
            quote!(
                type Record = ();
            ),
            quote!((_: &#krate::program::RayGen<__P>, _: &())),
        ),
        Kind::Exception => (
            quote!(#pipeline),
            quote!(__P),
            quote!(
                type Record = ();
            ),
            quote!((_: &#krate::program::Exception<__P>, _: &())),
        ),
        Kind::DirectCallable | Kind::ContinuationCallable => {
            let context = format_ident!("{}", kind.context());
            (
                quote!(#pipeline),
                quote!(__P),
                quote!(
                    type Record = ();
                    type Signature = fn();
                ),
                quote!((_: &#krate::program::#context<__P>, _: &(), _: ())),
            )
        }
        Kind::Miss => {
            let (at, from) = (at("AtMiss"), at("FromMiss"));
            (
                quote!(#pipeline, #payload),
                quote!(__P, __R),
                quote!(
                    type Record = ();
                ),
                quote!((_: &#krate::program::Miss<__P>, _: &(), _: #at) -> #from),
            )
        }
        Kind::ClosestHit => {
            let (at, from) = (at("AtClosestHit"), at("FromClosestHit"));
            (
                quote!(#pipeline, #hits, #record, #payload),
                quote!(__P, __A, __Rec, __R),
                TokenStream::new(),
                quote!((_: &#krate::program::ClosestHit<__P, __A>, _: &__Rec, _: #at) -> #from),
            )
        }
        Kind::AnyHit => {
            let (at, from) = (at("AtAnyHit"), at("FromAnyHit"));
            (
                quote!(#pipeline, #hits, #record, #payload),
                quote!(__P, __A, __Rec, __R),
                TokenStream::new(),
                quote!((_: &#krate::program::AnyHit<__P, __A>, _: &__Rec, _: #at) -> (#krate::ray::Decision, #from)),
            )
        }
        Kind::Intersection => {
            let (at, from) = (at("AtIntersection"), at("FromIntersection"));
            let hits = quote!(#krate::check::NoHits);
            (
                quote!(#pipeline, #record, #payload),
                quote!(__P, __Rec, __R),
                quote!(type Attributes = #hits;),
                quote!((_: &#krate::program::Intersection<__P, #hits>, _: &__Rec, _: #at) -> #from),
            )
        }
    };
    let items = block(quote! {
            #[automatically_derived]
            impl<#generics> #krate::program::#trait_name<#arguments> for #ident {
                #assoc
                fn run #signature {
                    loop {}
                }
            }
    });
    quote!(#marker #items)
}
