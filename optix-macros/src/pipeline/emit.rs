//! The pipeline type, its description for the host, and the entry points of both machines.

use super::check::path;
use super::names::{imports, is_function, kind_of, named, type_of};
use super::parse::{Group, Pipeline, Programs};
use crate::compiler::has_cfg;
use crate::place::place;
use crate::program::Kind;
use crate::support::{block, device_crate, moved, name, place_of};
use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, format_ident, quote, quote_spanned};
use syn::{Ident, Path};

/// Entry points, as they are needed.
struct Entries<'a> {
    pipeline: &'a Pipeline,
    place: String,
    items: TokenStream,
    names: Vec<String>,
    /// The types that cross between host and device: calls of the functions of `Crossing`.
    crossings: Vec<TokenStream>,
}

impl Entries<'_> {
    /// A type that crosses as `what`, a function of `Crossing`.
    fn crosses(&mut self, what: &str, ty: &TokenStream) {
        let (krate, what) = (device_crate(), format_ident!("{what}"));
        self.crossings.push(quote!(#krate::layout::Crossing::#what::<#ty>()));
    }

    /// Makes the entry of a program on both machines; gives the host's `Entry`.
    /// `types` are those of the entry, `item` gives what the program's trait has by a name.
    fn add(
        &mut self,
        kind: Kind,
        program: &Path,
        types: &TokenStream,
        item: &dyn Fn(&str) -> TokenStream,
        of: &[String],
    ) -> TokenStream {
        let krate = &device_crate();
        let mut stem = format!("__{}__{}_{}", kind.attribute(), name(&self.pipeline.ident), symbol(program));
        for part in of {
            stem.push('_');
            stem.push_str(part);
        }
        // Paths that differ in punctuation only.
        let count = self.names.iter().filter(|n| **n == stem).count();
        self.names.push(stem.clone());
        if count > 0 {
            stem.push_str(&format!("_{}", count + 1));
        }
        let entry_name = format!("{stem}_{}", self.place);
        let device = format_ident!("{entry_name}");
        let host = format_ident!("__run_{}", self.names.len() - 1);
        let body = format_ident!("{}", kind.attribute());
        let (run, span) = (item("run"), program_span(program));
        let run = match kind {
            Kind::RayGen | Kind::Exception => quote_spanned!(span=> #run(&__context, __record)),
            Kind::DirectCallable | Kind::ContinuationCallable => {
                quote_spanned!(span=> #run(&__context, __record, __arguments))
            }
            _ => quote_spanned!(span=> #run(&__context, __record, __input)),
        };
        let enter = quote!(#krate::program::entry::#body::<#types>);
        let signature = item("Signature");
        let call = match kind {
            Kind::DirectCallable | Kind::ContinuationCallable => quote! {
                let __arguments = unsafe { #krate::program::entry::arguments::<#signature>(&__cx) };
                let (__context, __record) = unsafe { #enter(&__cx) };
                #krate::program::entry::result::<#signature>(&__cx, #run);
                #krate::ray::Decision::Accept
            },
            Kind::RayGen | Kind::Exception => quote! {
                let (__context, __record) = unsafe { #enter(&__cx) };
                #run;
                #krate::ray::Decision::Accept
            },
            Kind::AnyHit => quote! {
                let (__context, __record, __input) = unsafe { #enter(&__cx) };
                #krate::program::entry::decide(&__cx, #run)
            },
            _ => quote! {
                let (__context, __record, __input) = unsafe { #enter(&__cx) };
                #krate::program::entry::give(&__cx, #run)
            },
        };
        self.items.extend(quote! {
            // SAFETY: the caller's frame is of this program.
            #[cfg(not(target_arch = "nvptx64"))]
            unsafe fn #host(__frame: &#krate::host::Frame<'_>) -> #krate::ray::Decision {
                let __cx = unsafe { #krate::intrinsics::Invocation::new(__frame) };
                #call
            }
        });
        // The generator `rustc_codegen_nvvm` knows entries by attributes of its own; the toolchain asks for them.
        let marked = std::env::var_os("OPTIX_ENTRIES").is_some_and(|by| by == "rustc_codegen_nvvm");
        let mark = match (marked, kind.is_callable()) {
            (false, _) => quote!(),
            (true, false) => quote!(#[nvvm_internal::kernel]),
            (true, true) => quote!(#[nvvm_internal::used]),
        };
        self.items.extend(if kind.is_callable() {
            quote! {
                // SAFETY: `Invocation::call_direct` and its kin call it, by this type, with a record of its own.
                #[cfg(target_arch = "nvptx64")]
                #mark
                #[unsafe(no_mangle)]
                pub unsafe extern "C" fn #device(
                    __arguments: #krate::callable::Packed<<#signature as #krate::callable::Signature>::Arguments>,
                ) -> #krate::callable::Packed<<#signature as #krate::callable::Signature>::Result> {
                    let __cx = unsafe { #krate::intrinsics::Invocation::new() };
                    let (__context, __record) = unsafe { #enter(&__cx) };
                    let __arguments = __arguments.0;
                    #krate::callable::Packed(#run)
                }
            }
        } else {
            quote! {
                // SAFETY: OptiX calls it as a program of its kind, with the record and payload of its hit group or ray type.
                #[cfg(target_arch = "nvptx64")]
                #mark
                #[unsafe(no_mangle)]
                pub unsafe extern "ptx-kernel" fn #device() {
                    let __cx = unsafe { #krate::intrinsics::Invocation::new() };
                    let _ = { #call };
                }
            }
        });
        let (function, attribute) = (path(program), kind.attribute());
        let (of, is_function) = (type_of(program), is_function(program));
        let there = moved(krate, span);
        self.items.extend(quote_spanned! {span=>
            const _: () = {
                use #there::check::HasAttribute as _;
                let __has_attribute = #there::check::Program::<#of>::HAS_ATTRIBUTE;
                #there::check::is_program(__has_attribute, { #is_function }, #function, #attribute);
            };
        });
        quote!(#krate::host::Entry { name: #entry_name, function: #function, body: #host })
    }
}

/// A path as part of a symbol.
fn symbol(path: &impl ToTokens) -> String {
    let text = super::check::path(path).replace("r#", "");
    let mut symbol = String::new();
    for c in text.chars() {
        let c = if c.is_ascii_alphanumeric() { c } else { '_' };
        if c != '_' || !symbol.ends_with('_') {
            symbol.push(c);
        }
    }
    symbol.trim_matches('_').to_owned()
}

/// `<program as krate::program::bound>::item`, all of it where the program's name is: rustc reports a program that does not
/// fit in several places, which are one message if they have one span.
fn of_program(krate: &Ident, program: &Path, bound: &TokenStream, item: &str) -> TokenStream {
    let span = program_span(program);
    let item = format_ident!("{item}");
    let program = type_of(program);
    moved(&quote!(<#program as #krate::program::#bound>::#item), span)
}

/// Where a program's own name is.
pub fn program_span(program: &Path) -> Span {
    match program.segments.last() {
        Some(last) => place_of(&last.ident),
        None => place_of(program),
    }
}

fn option(value: Option<TokenStream>) -> TokenStream {
    match value {
        Some(value) => quote!(__core::option::Option::Some(#value)),
        None => quote!(__core::option::Option::None),
    }
}

fn structure(pipeline: &Pipeline) -> TokenStream {
    let Pipeline { attrs, vis, ident, .. } = pipeline;
    quote! {
        #(#attrs)*
        #vis struct #ident;
    }
}

pub fn emit(pipeline: &Pipeline) -> TokenStream {
    let Pipeline { ident, params, .. } = pipeline;
    // Where an error is that says the struct is private and the pipeline is not.
    let params_type = params.as_ref().map(|params| quote_spanned!(place_of(params)=> type Params = #params;));
    let krate = &device_crate();
    let pipeline_name = name(ident);
    let structure = structure(pipeline);
    let mut entries = Entries {
        pipeline,
        place: place(ident.span(), &pipeline_name),
        items: TokenStream::new(),
        names: Vec::new(),
        crossings: Vec::new(),
    };
    let mut impls = TokenStream::new();
    entries.crossings.push(quote!(<#ident as #krate::pipeline::Pipeline>::PARAMS_CROSSING));

    let raygen: Vec<_> = pipeline.raygen.iter().enumerate().map(|(i, program)| {
        let item = |item: &str| of_program(krate, program, &quote!(RayGenProgram<#ident>), item);
        let record = item("Record");
        entries.crosses("record", &record);
        let entry = entries.add(Kind::RayGen, program, &quote!(#ident, _), &item, &[]);
        let index = i as u32;
        let program = type_of(program);
        impls.extend(quote! {
            // SAFETY: description and numbers are made from one list.
            #[automatically_derived]
            unsafe impl #krate::pipeline::HasRayGen<#program> for #ident {
                const INDEX: __core::primitive::u32 = #index;
                type Record = #record;
            }
        });
        quote!(#krate::host::ProgramDescription { entry: #entry, record: #krate::host::RecordLayout::of::<#record>() })
    }).collect();

    let rays: Vec<_> = pipeline.rays.iter().map(|ray| {
        let payload = &named(&ray.payload);
        let miss = ray.miss.as_ref().map(|program| {
            let record = miss_record(pipeline, payload, Some(program));
            let item = |item: &str| of_program(krate, program, &quote!(MissProgram<#ident, #payload>), item);
            let types = quote!(#ident, #payload, _);
            entries.crosses("record", &record);
            let entry = entries.add(Kind::Miss, program, &types, &item, &[symbol(&ray.payload)]);
            quote!(#krate::host::ProgramDescription { entry: #entry, record: #krate::host::RecordLayout::of::<#record>() })
        });
        if miss.is_none() {
            impls.extend(nothing_to_write(krate, payload, "FromMiss"));
        }
        let miss = option(miss);
        let moved_krate = moved(krate, place_of(payload));
        entries.crossings.push(quote!(<#payload as #moved_krate::payload::Payload>::CROSSING));
        quote! {
            #krate::host::RayDescription { payload: <#payload as #moved_krate::payload::Payload>::DESCRIPTION, miss: #miss }
        }
    }).collect();
    impls.extend(has_rays(pipeline));

    let mut groups = Vec::new();
    for (i, group) in pipeline.groups.iter().enumerate() {
        let (record, geometry, index) = (&named(&group.record), kind_of(&group.geometry), i as u32);
        let span = place_of(record);
        let (there, pipeline_there) = (moved(krate, span), moved(ident, span));
        // Two names of one record conflict: rustc says so where the names are.
        impls.extend(quote_spanned! {span=>
            // SAFETY: description and numbers are made from one list.
            #[automatically_derived]
            unsafe impl #there::pipeline::HasHitGroup<#record, #geometry> for #pipeline_there
            where
                for<'__never> #record: #there::record::SbtRecord, // on trust: a record that is none is reported below
            {
                const INDEX: __core::primitive::u32 = #index;
            }
        });
        groups.push(describe_group(pipeline, group, &mut entries, &mut impls));
    }

    let callables = callables(pipeline, &mut entries, &mut impls);
    let exceptions = exceptions(pipeline, &mut entries, &mut impls);
    let exception = exception_type(pipeline);
    let ray_types = pipeline.rays.len() as u32;
    let depth = option(pipeline.trace_depth.as_ref().map(|depth| depth.to_token_stream()));
    let callable_depth = option(pipeline.callable_depth.as_ref().map(|depth| depth.to_token_stream()));
    // `cargo optix verify` compares the PTX with this. It finds a pipeline by the place in its entries' names, so private ones
    // too; other builds do without the symbol.
    let (crossings, count) = (&entries.crossings, entries.crossings.len());
    let layouts = format!("optix_layouts_{pipeline_name}_{}", entries.place);
    let facts = has_cfg("optix_facts").then(|| {
        let facts = format_ident!("__optix_facts_{}", entries.place);
        quote! {
            #[unsafe(no_mangle)]
            fn #facts() -> &'static #krate::host::PipelineDescription {
                &<#ident as #krate::pipeline::Pipeline>::DESCRIPTION
            }
        }
    });
    let items = entries.items;
    let imports = imports(pipeline);
    let items = block(quote! {
            #imports
            const __CROSSINGS: [#krate::layout::Crossing; #count] = [#(#crossings),*];
            // SAFETY: description and numbers are made from one list.
            #[automatically_derived]
            unsafe impl #krate::pipeline::Pipeline for #ident {
                #params_type
                type Exception = #exception;
                const RAY_TYPES: __core::primitive::u32 = #ray_types;
                const CROSSINGS: &'static [#krate::layout::Crossing] = &__CROSSINGS;
                #[cfg(not(target_arch = "nvptx64"))]
                const DESCRIPTION: #krate::host::PipelineDescription = #krate::host::PipelineDescription {
                    name: #pipeline_name,
                    params: <Self as #krate::pipeline::Pipeline>::PARAMS_DESCRIPTION,
                    raygen: &[#(#raygen),*],
                    rays: &[#(#rays),*],
                    hitgroups: &[#(#groups),*],
                    callables: &[#(#callables),*],
                    exceptions: #exceptions,
                    trace_depth: #depth,
                    callable_depth: #callable_depth,
                    crossings: <Self as #krate::pipeline::Pipeline>::CROSSINGS,
                    layouts: #layouts,
                };
            }
            #[cfg(target_arch = "nvptx64")]
            impl #ident {
                const __OPTIX_LAYOUTS: [[__core::primitive::u64; 2]; #count] = #krate::layout::Crossing::table(__CROSSINGS);
            }
            #impls
            #items
            #facts
    });
    let layouts = layouts_variable(ident, &layouts, count);
    quote!(#structure #items #layouts)
}

/// The variable in the PTX that has the layouts of `count` types. An item, so it can't be in a block.
fn layouts_variable(ident: &Ident, variable: &str, count: usize) -> TokenStream {
    let places: Vec<String> = (0..2 * count).map(|i| format!("{{n{i}}}")).collect();
    let text = format!(".visible .global .align 8 .b64 {variable}[{}] = {{{{{}}}}};", 2 * count, places.join(", "));
    let numbers = (0..2 * count).map(|i| {
        let (name, row, column) = (format_ident!("n{i}"), i / 2, i % 2);
        quote!(#name = const #ident::__OPTIX_LAYOUTS[#row][#column])
    });
    quote! {
        #[cfg(target_arch = "nvptx64")]
        ::core::arch::global_asm!(#text, #(#numbers),*);
    }
}

/// The callables' descriptions, with their entries and impls.
fn callables(pipeline: &Pipeline, entries: &mut Entries<'_>, impls: &mut TokenStream) -> Vec<TokenStream> {
    let (ident, krate) = (&pipeline.ident, &device_crate());
    let direct = pipeline.direct_callables.iter().map(|program| (Kind::DirectCallable, "Direct", program));
    let continuation =
        pipeline.continuation_callables.iter().map(|program| (Kind::ContinuationCallable, "Continuation", program));
    let describe = |(i, (kind, word, program)): (usize, (Kind, &str, &Path))| {
        let (index, program_trait, word) = (i as u32, kind.program_trait(), format_ident!("{word}"));
        let bound = quote!(#program_trait<#ident>);
        let of = |item: &str| of_program(krate, program, &bound, item);
        let (record, signature) = (of("Record"), of("Signature"));
        let (program_name, program_type, span) = (path(program), type_of(program), program_span(program));
        let there = moved(krate, span);
        impls.extend(quote! {
            // SAFETY: description and numbers are made from one list.
            #[automatically_derived]
            unsafe impl #krate::pipeline::HasCallable<#program_type> for #ident {
                const INDEX: __core::primitive::u32 = #index;
                type Record = #record;
                type Signature = #signature;
                type Kind = #krate::callable::#word;
            }
        });
        impls.extend(quote_spanned! {span=>
            const _: () = #there::check::callable::<#signature>(#program_name);
        });
        entries.crosses("record", &record);
        entries.crossings.push(quote!(#krate::layout::Crossing::signature::<#signature>(#program_name)));
        let entry = entries.add(kind, program, &quote!(#ident, _), &of, &[]);
        quote! {
            #krate::host::CallableDescription::of::<#record, #signature, #krate::callable::#word>(#entry)
        }
    };
    direct.chain(continuation).enumerate().map(describe).collect()
}

/// What the pipeline's programs throw.
fn exception_type(pipeline: &Pipeline) -> TokenStream {
    let krate = &device_crate();
    pipeline.throws.as_ref().map_or(quote!(#krate::exception::NoException), ToTokens::to_token_stream)
}

/// The impl that lets programs throw.
fn throws(pipeline: &Pipeline) -> Option<TokenStream> {
    let (ident, krate) = (&pipeline.ident, &device_crate());
    pipeline.throws.as_ref().map(|exception| {
        let span = place_of(exception);
        let (krate, ident) = (moved(krate, span), moved(ident, span));
        quote_spanned! {span=>
            // SAFETY: the description is made from the same declaration.
            #[automatically_derived]
            unsafe impl #krate::pipeline::Throws<#exception> for #ident {}
        }
    })
}

/// The exceptions' description, with the entry and impls.
fn exceptions(pipeline: &Pipeline, entries: &mut Entries<'_>, impls: &mut TokenStream) -> TokenStream {
    let (ident, krate) = (&pipeline.ident, &device_crate());
    impls.extend(throws(pipeline));
    let (throws, variants) = match &pipeline.throws {
        Some(exception) => {
            let span = place_of(exception);
            let krate = moved(krate, span);
            let of = quote_spanned!(span=> <#exception as #krate::exception::UserException>);
            entries.crossings.push(quote!(#of::CROSSING));
            (option(Some(quote!(#of::NAME))), quote!(#of::VARIANTS))
        }
        None => (option(None), quote!(&[])),
    };
    let program = pipeline.exception.as_ref().map(|program| {
        let item = |item: &str| of_program(krate, program, &quote!(ExceptionProgram<#ident>), item);
        let record = item("Record");
        impls.extend(quote! {
            // SAFETY: description and record are made from one declaration.
            #[automatically_derived]
            unsafe impl #krate::pipeline::HasException for #ident {
                type Record = #record;
            }
        });
        entries.crosses("record", &record);
        let entry = entries.add(Kind::Exception, program, &quote!(#ident, _), &item, &[]);
        quote!(#krate::host::ProgramDescription { entry: #entry, record: #krate::host::RecordLayout::of::<#record>() })
    });
    let program = option(program);
    quote!(#krate::host::ExceptionsDescription { throws: #throws, variants: #variants, program: #program })
}

/// A hit group's description, with its entries and checks.
fn describe_group(
    pipeline: &Pipeline,
    group: &Group,
    entries: &mut Entries<'_>,
    impls: &mut TokenStream,
) -> TokenStream {
    let (ident, krate, record) = (&pipeline.ident, &device_crate(), &named(&group.record));
    let geometry = &kind_of(&group.geometry);
    let primitive = quote!(<#geometry as #krate::primitive::Primitive>);
    // A program is checked as what the kind of primitive makes of it.
    let item_of = |program: &Path, made: TokenStream, bound: TokenStream, item: &str| {
        let item = format_ident!("{item}");
        moved(&quote!(<#made as #krate::program::#bound>::#item), program_span(program))
    };
    let intersection = |programs: &Programs, program: &Path, item: &str| {
        let (ray, program_type) = (named(&programs.ray), type_of(program));
        let made = quote!(#primitive::IntersectionProgram<#program_type>);
        item_of(program, made, quote!(IntersectionProgram<#ident, #record, #ray>), item)
    };
    let reported = |programs: &Programs| Some(intersection(programs, programs.intersection.as_ref()?, "Attributes"));
    let any_reported = group.rays.iter().find_map(reported);
    let hits_of = |programs: &Programs| {
        let program = programs.intersection.as_ref();
        let span = program.map_or_else(|| place_of(geometry), program_span);
        let reported = reported(programs).or_else(|| any_reported.clone());
        let reported = reported.unwrap_or_else(|| quote!(#krate::check::NoHits));
        moved(&quote!(#primitive::Hits<#reported>), span)
    };
    let mut first: Option<&Programs> = None;
    // In the order of `rays`, which is the order of the records.
    let rays: Vec<_> = pipeline
        .rays
        .iter()
        .filter_map(|ray| {
            let programs =
                group.rays.iter().find(|p| super::check::text(&p.ray) == super::check::text(&ray.payload))?;
            let (ray, hits) = (&named(&programs.ray), hits_of(programs));
            match (first, &programs.intersection) {
                // Of one program too, which may be written by hand, with hits that depend on the ray.
                (Some(first), Some(program)) => {
                    let other = hits_of(first);
                    let span = place_of(program);
                    let krate = moved(krate, span);
                    impls.extend(quote_spanned! {span=>
                        const _: () = #krate::check::same_hits::<#hits, #other>();
                    });
                }
                (None, _) => first = Some(programs),
                (Some(_), None) => {}
            }
            impls.extend(fits_primitives(group, programs));
            if programs.closesthit.is_none() {
                impls.extend(nothing_to_write(krate, ray, "FromClosestHit"));
            }
            let of = [symbol(&group.record), symbol(&programs.ray), symbol(&group.geometry)];
            let mut entry = |kind: Kind| {
                let program = programs.get(kind)?;
                if kind == Kind::Intersection {
                    let reported = reported(programs)?;
                    let types = quote!(#ident, #reported, #record, #ray);
                    return Some(entries.add(
                        kind,
                        program,
                        &types,
                        &|item| intersection(programs, program, item),
                        &of,
                    ));
                }
                let types = quote!(#ident, #hits, #record, #ray);
                let (program_trait, mut made) = (kind.program_trait(), type_of(program).to_token_stream());
                if any_reported.is_none() {
                    made = quote!(#primitive::ProgramOfBuiltIn<#made>);
                }
                let item = |item: &str| item_of(program, made.clone(), quote!(#program_trait<#types>), item);
                Some(entries.add(kind, program, &types, &item, &of))
            };
            let closesthit = option(entry(Kind::ClosestHit));
            let anyhit = option(entry(Kind::AnyHit));
            let intersection = option(entry(Kind::Intersection));
            Some(quote! {
                #krate::host::HitPrograms { closesthit: #closesthit, anyhit: #anyhit, intersection: #intersection }
            })
        })
        .collect();
    entries.crosses("record", &record.to_token_stream());
    let words = match first {
        Some(programs) => {
            let hits = hits_of(programs);
            entries.crosses("attributes", &hits);
            quote!(<#hits as #krate::primitive::Attributes>::WORDS)
        }
        None => quote!(0),
    };
    quote! {
        #krate::host::HitGroupDescription {
            record: #krate::host::RecordLayout::of::<#record>(),
            geometry: <#geometry as #krate::primitive::Primitive>::TYPE,
            attribute_words: #words,
            rays: &[#(#rays),*],
        }
    }
}

/// Asserts that there is an intersection program for a ray type if primitives of the kind need one, and none if they don't.
fn fits_primitives(group: &Group, programs: &Programs) -> TokenStream {
    let span = programs.intersection.as_ref().map_or_else(|| place_of(&programs.ray), program_span);
    let (krate, geometry) = (moved(&device_crate(), span), moved(&kind_of(&group.geometry), span));
    let (record, kind, ray) = (path(&group.record), path(&group.geometry), path(&programs.ray));
    let given = programs.intersection.is_some();
    quote_spanned! {span=>
        const _: () = #krate::check::intersection_program::<#geometry>(#given, #record, #kind, #ray);
    }
}

/// `<sky as MissProgram<..>>::Record`, or `()` without a miss program.
fn miss_record(pipeline: &Pipeline, payload: &Ident, program: Option<&Path>) -> TokenStream {
    let (ident, krate) = (&pipeline.ident, &device_crate());
    match program {
        Some(program) => of_program(krate, program, &quote!(MissProgram<#ident, #payload>), "Record"),
        None => quote!(()),
    }
}

fn has_rays(pipeline: &Pipeline) -> TokenStream {
    let (ident, krate) = (&pipeline.ident, &device_crate());
    let impls = pipeline.rays.iter().enumerate().map(|(i, ray)| {
        let (payload, index) = (&named(&ray.payload), i as u32);
        let span = place_of(payload);
        let krate = moved(krate, span);
        let has_ray = quote_spanned!(span=> #krate::pipeline::HasRay<#payload>);
        let record = miss_record(pipeline, payload, ray.miss.as_ref());
        // Two names of one payload conflict: rustc says so where the names are.
        let pipeline = moved(ident, span);
        quote_spanned! {span=>
            // SAFETY: description and numbers are made from one list.
            #[automatically_derived]
            unsafe impl #has_ray for #pipeline {
                const INDEX: __core::primitive::u32 = #index;
                type MissRecord = #record;
            }
        }
    });
    quote!(#(#impls)*)
}

/// Asserts that no program is missing here.
fn nothing_to_write(krate: &Ident, payload: &Ident, role: &str) -> TokenStream {
    let span = place_of(payload);
    let role = format_ident!("{role}", span = span);
    let krate = moved(krate, span);
    quote_spanned! {span=>
        const _: () = #krate::check::nothing_to_write::<<#payload as #krate::payload::Payload>::#role>();
    }
}

/// After an error: the pipeline with its ray types, so that its programs have nothing to complain about.
pub fn fallback(pipeline: &Pipeline) -> TokenStream {
    let Pipeline { ident, params, .. } = pipeline;
    let (krate, structure) = (&device_crate(), structure(pipeline));
    let Some(params) = params else {
        return structure;
    };
    let (pipeline_name, exception, throws) = (name(ident), exception_type(pipeline), throws(pipeline));
    let mut seen = Vec::new();
    let rays = pipeline.rays.iter().filter(|ray| {
        let text = super::check::text(&ray.payload);
        let new = !seen.contains(&text);
        seen.push(text);
        new
    });
    let rays = rays.enumerate().map(|(i, ray)| {
        let (payload, index) = (&ray.payload, i as u32);
        quote! {
            // SAFETY: description and numbers are made from one list.
            #[automatically_derived]
            unsafe impl #krate::pipeline::HasRay<#payload> for #ident {
                const INDEX: __core::primitive::u32 = #index;
                type MissRecord = ();
            }
        }
    });
    let items = block(quote! {
            // SAFETY: description and numbers are made from one list.
            #[automatically_derived]
            unsafe impl #krate::pipeline::Pipeline for #ident {
                type Params = #params;
                type Exception = #exception;
                const RAY_TYPES: __core::primitive::u32 = 0;
                const CROSSINGS: &'static [#krate::layout::Crossing] = &[];
                #[cfg(not(target_arch = "nvptx64"))]
                const DESCRIPTION: #krate::host::PipelineDescription = #krate::host::PipelineDescription {
                    name: #pipeline_name,
                    params: <Self as #krate::pipeline::Pipeline>::PARAMS_DESCRIPTION,
                    raygen: &[],
                    rays: &[],
                    hitgroups: &[],
                    callables: &[],
                    exceptions: #krate::host::ExceptionsDescription {
                        throws: __core::option::Option::None,
                        variants: &[],
                        program: __core::option::Option::None,
                    },
                    trace_depth: __core::option::Option::None,
                    callable_depth: __core::option::Option::None,
                    crossings: &[],
                    layouts: "",
                };
            }
            #(#rays)*
            #throws
    });
    quote!(#structure #items)
}
