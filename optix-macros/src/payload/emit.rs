//! The parts of a payload and what ties them to it.

use super::model::{Party, Payload, Transport};
use crate::data::{docs_or, touch};
use crate::shape::Struct;
use crate::support::{begins, block, device_crate, layout, moved, place_of};
use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote, quote_spanned};

/// `RadianceAtMiss` and the like.
struct Part {
    party: Party,
    reads: bool,
    ident: Ident,
    fields: Vec<usize>,
}

impl Part {
    /// The fields that its struct has. Of a struct that nobody gets, all, so that nothing but its use is reported.
    fn indices(&self, shape: &Struct) -> Vec<usize> {
        if self.is_hollow() { (0..shape.fields.len()).collect() } else { self.fields.clone() }
    }

    /// Whether it has nothing of the payload: `()` is in its place, and its struct is there for who asks for it.
    fn is_hollow(&self) -> bool {
        self.fields.is_empty()
    }

    /// `AtMiss` and the like.
    fn role(&self) -> Ident {
        format_ident!("{}{}", if self.reads { "At" } else { "From" }, self.party.suffix())
    }
}

/// `sound` if nothing was wrong with the declaration: its size is asserted only then, so that one mistake is one error.
pub fn emit(payload: &Payload, sound: bool) -> TokenStream {
    let shape = &payload.shape;
    let (krate, ident, name) = (&device_crate(), &shape.ident, shape.name());
    let parts: Vec<Part> = Party::ALL
        .into_iter()
        .flat_map(|party| [(party, false), (party, true)])
        .map(|(party, reads)| {
            let word = if reads { "At" } else { "From" };
            let ident = format_ident!("{}{}{}", name, word, party.suffix(), span = ident.span());
            Part { party, reads, ident, fields: payload.part(party, reads) }
        })
        .collect();

    let structs = parts.iter().map(|part| part_struct(payload, part));
    // So that none is unused.
    let touched = parts.iter().map(|part| {
        let ident = &part.ident;
        let indices = part.indices(shape).into_iter();
        let members: Vec<_> = indices.map(|i| &shape.fields[i].member).collect();
        quote!(const _: fn(#ident) -> #ident = |__value| #ident { #(#members: __value.#members),* };)
    });
    let impls = parts
        .iter()
        .map(|part| if part.is_hollow() { hollow_impls(payload, part, sound) } else { part_impls(payload, part) });
    let types = parts.iter().map(|part| {
        let role = part.role();
        if part.is_hollow() {
            quote!(type #role = ();)
        } else {
            let part = &part.ident;
            quote!(type #role = #part;)
        }
    });

    let (mut counts, mut fields, mut layouts, mut semantics) = (Vec::new(), Vec::new(), Vec::new(), TokenStream::new());
    for (i, (field, access)) in shape.fields.iter().zip(&payload.access).enumerate() {
        let ty = &field.ty;
        let (at, next) = (format_ident!("__AT_{i}"), format_ident!("__AT_{}", i + 1));
        let span = place_of(ty);
        let krate = moved(krate, span);
        counts.push(quote_spanned!(span=> <#ty as #krate::words::Words>::COUNT));
        let name = field.name();
        fields.push(quote!(#krate::payload::Field { name: #name, at: #at, count: #next - #at }));
        let layout = quote_spanned!(span=> <#ty as #krate::words::Words>::LAYOUT);
        layouts.push(quote!(.field(#name, #at, #layout)));
        let bits = Party::ALL.into_iter().flat_map(|party| {
            let read = access.read.has(party).then(|| semantics_bit(&krate, party, "READ"));
            let write = access.write.has(party).then(|| semantics_bit(&krate, party, "WRITE"));
            [read, write]
        });
        let bits = bits.flatten();
        semantics.extend(quote! {
            let mut __i = #at;
            while __i < #next {
                __all[__i] = 0 #(| #bits)*;
                __i += 1;
            }
        });
    }
    let registers = match payload.transport {
        Transport::Registers => quote!(__WORDS),
        Transport::Pointer => quote!(2),
    };
    let (places, end) = (begins(krate, &counts), format_ident!("__AT_{}", shape.fields.len()));
    let layout = layout(quote!(#krate::layout::Layout::of("payload")), &layouts);
    let span = place_of(ident);
    let moved_krate = moved(krate, span);
    let check = match payload.transport {
        Transport::Registers if sound => {
            quote_spanned!(span=> const _: () = #moved_krate::check::payload_words(#name, __WORDS);)
        }
        _ => TokenStream::new(),
    };
    let transport = transport(payload);
    let semantics = match payload.transport {
        Transport::Registers => quote!({
            let mut __all = [0u32; __WORDS];
            #semantics
            __all
        }),
        Transport::Pointer => {
            // The caller gives the address, and who has a part in the payload gets it.
            let parties = parts.iter().filter(|part| part.party != Party::Caller && !part.is_hollow());
            let bits = parties.map(|part| semantics_bit(krate, part.party, "READ"));
            let caller = semantics_bit(krate, Party::Caller, "WRITE");
            quote!([#caller #(| #bits)*; 2])
        }
    };
    let without_closesthit =
        payload.access.iter().all(|access| !access.read.has(Party::Caller) || access.write.has(Party::Caller));
    let without_closesthit = without_closesthit.then(|| {
        quote! {
            // SAFETY: the caller writes all that it reads.
            #[automatically_derived]
            unsafe impl #krate::payload::TracedWithoutClosestHit for #ident {}
        }
    });
    let touch = touch(shape);

    let items = block(quote! {
            #places
            const __WORDS: __core::primitive::usize = #end;
            const __REGISTERS: __core::primitive::usize = #registers;
            #check

            const __SEMANTICS: [__core::primitive::u32; __REGISTERS] = #semantics;

            // SAFETY: the words are counted above (in registers 32 at most, asserted), each part has the fields its party may
            // touch, and the macro proved that what is read was written.
            #[automatically_derived]
            unsafe impl #krate::payload::Payload for #ident {
                const NAME: &'static __core::primitive::str = #name;
                const WORDS: __core::primitive::usize = __WORDS;
                const FIELDS: &'static [#krate::payload::Field] = &[#(#fields),*];
                const LAYOUT: #krate::layout::Layout = #layout;
                const SEMANTICS: &'static [__core::primitive::u32] = &__SEMANTICS;
                const SEMANTICS_AT_TRAVERSE: &'static [__core::primitive::u32] =
                    &#krate::payload::semantics::at_traverse(__SEMANTICS);
                const SEMANTICS_AT_INVOKE: &'static [__core::primitive::u32] =
                    &#krate::payload::semantics::at_invoke(__SEMANTICS);
                type Transport = #transport;
                #(#types)*
            }
            #without_closesthit
            #(#impls)*
            #(#touched)*
            #touch
    });
    quote!(#(#structs)* #items)
}

/// The constant of a party's bit.
fn semantics_bit(krate: &impl ToTokens, party: Party, access: &str) -> TokenStream {
    let name = format_ident!("{}_{}", party.keyword().to_uppercase(), access);
    quote!(#krate::payload::semantics::#name)
}

fn transport(payload: &Payload) -> TokenStream {
    let krate = &device_crate();
    match payload.transport {
        Transport::Registers => quote!(#krate::payload::Registers),
        Transport::Pointer => quote!(#krate::payload::Pointer<__WORDS>),
    }
}

fn part_struct(payload: &Payload, part: &Part) -> TokenStream {
    let shape = &payload.shape;
    let (name, ident) = (shape.name(), &part.ident);
    let vis = &shape.vis;
    let (keyword, phrase) = (part.party.keyword(), part.party.phrase());
    let doc = match (part.party, part.reads) {
        (Party::Caller, false) => format!("What the caller gives to `trace` with a ray of payload [`{name}`]"),
        (Party::Caller, true) => format!("What `trace` returns of payload [`{name}`]"),
        (_, true) => format!("What {phrase} receives of payload [`{name}`]"),
        (_, false) => format!("What {phrase} must return of payload [`{name}`]"),
    };
    let list = if part.reads { "read" } else { "write" };
    let doc = if part.is_hollow() {
        format!("{doc}: nothing, since no field says `{list}({keyword})`; this struct is here for its message.")
    } else {
        format!("{doc}: the fields that say `{list}({keyword})`.")
    };
    let fields = part.indices(shape).into_iter().map(|i| {
        let field = &shape.fields[i];
        let (vis, member, ty) = (&field.vis, &field.member, &field.ty);
        let docs = docs_or(&field.attrs, || format!("Field `{}` of [`{name}`].", field.name()));
        let access = &payload.access[i];
        let who = format!("\n\nWritten by {}, read by {}.", access.write.phrase(), access.read.phrase());
        quote!(#docs #[doc = #who] #vis #member: #ty)
    });
    let hidden = part.is_hollow().then(|| quote!(#[doc(hidden)]));
    quote! {
        #[doc = #doc]
        #hidden
        #vis struct #ident {
            #(#fields,)*
        }
    }
}

/// The fields that a party does not read, for the message that their use gives: what it receives leads there by `Deref`, which
/// the compiler follows for fields that it does not find. They are private in a module of their own, so that nothing reads them,
/// and the name of their struct says why.
fn unread(payload: &Payload, part: &Part) -> Option<TokenStream> {
    let shape = &payload.shape;
    let missing: Vec<_> = (0..shape.fields.len()).filter(|i| !part.fields.contains(i)).collect();
    if !part.reads || missing.is_empty() {
        return None;
    }
    let (ident, name, keyword) = (&part.ident, shape.name(), part.party.keyword());
    let (first, rest) = keyword.split_at(1);
    let unread = format_ident!("{}FieldsWithoutRead{}{}", name, first.to_uppercase(), rest);
    let module = format_ident!("__{}_without_read_{}", name.to_lowercase(), keyword);
    let members: Vec<_> = missing.iter().map(|&i| &shape.fields[i].member).collect();
    Some(quote! {
        mod #module {
            pub struct #unread { #(#members: (),)* }
            pub static FIELDS: #unread = #unread { #(#members: ()),* };
        }
        #[automatically_derived]
        impl __core::ops::Deref for #ident {
            type Target = #module::#unread;
            #[inline(always)]
            fn deref(&self) -> &#module::#unread {
                &#module::FIELDS
            }
        }
    })
}

/// The impls of a part without fields, which is no part of a program of any kind. After a mistake in the payload itself nothing
/// is said about that.
fn hollow_impls(payload: &Payload, part: &Part, sound: bool) -> TokenStream {
    if part.party == Party::Caller {
        return TokenStream::new();
    }
    let (krate, payload_ident, ident) = (&device_crate(), &payload.shape.ident, &part.ident);
    let passage = (!sound).then(|| passage(payload, part, &quote!(loop {}), &quote!({})));
    quote! {
        #[automatically_derived]
        impl #krate::payload::PartOf for #ident {
            type Payload = #payload_ident;
        }
        #passage
    }
}

fn part_impls(payload: &Payload, part: &Part) -> TokenStream {
    let shape = &payload.shape;
    let (krate, payload_ident, ident) = (&device_crate(), &shape.ident, &part.ident);
    let passage = passage(payload, part, &quote!(__part), &quote!(self));
    let places = part.fields.iter().map(|i| (format_ident!("__AT_{i}"), format_ident!("__AT_{}", i + 1)));
    let masks = places.clone().map(|(at, next)| quote!(#krate::payload::word_mask(#at, #next - #at)));
    let (indices, transport) = (&part.fields, transport(payload));
    let fields: Vec<_> = part.fields.iter().map(|&i| &shape.fields[i]).collect();
    let loads = fields.iter().zip(places.clone()).map(|(field, (at, next))| {
        let (member, ty) = (&field.member, &field.ty);
        let span = place_of(ty);
        let krate = moved(krate, span);
        let load = quote_spanned!(span=> <#ty as #krate::words::Words>::load);
        quote!(#member: unsafe { #load(#krate::words::part(__words, #at, #next)) })
    });
    let stores = fields.iter().zip(places).map(|(field, (at, next))| {
        let (member, ty) = (&field.member, &field.ty);
        let span = place_of(ty);
        let krate = moved(krate, span);
        let store = quote_spanned!(span=> <#ty as #krate::words::Words>::store);
        quote!(#store(self.#member, #krate::words::part_mut(__words, #at, #next));)
    });
    let text = part.ident.to_string();
    let shown = fields.iter().map(|field| {
        let (member, name) = (&field.member, field.name());
        quote!(.field(#name, (&&#krate::check::Show(&self.#member)).shown()))
    });
    let debug = quote! {
        #[automatically_derived]
        impl __core::fmt::Debug for #ident {
            fn fmt(&self, __f: &mut __core::fmt::Formatter<'_>) -> __core::fmt::Result {
                use #krate::check::{ShowValue as _, ShowName as _};
                __f.debug_struct(#text) #(#shown)* .finish()
            }
        }
    };
    // One error of a field that can't be copied, where derives would give two.
    let copies = quote! {
        #[automatically_derived]
        impl __core::clone::Clone for #ident {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }
        #[automatically_derived]
        impl __core::marker::Copy for #ident {}
    };
    let unread = unread(payload, part);
    quote! {
        #debug
        #copies
        #unread
        // SAFETY: a field's words are counted by its type.
        #[automatically_derived]
        unsafe impl #krate::payload::Part for #ident {
            type Transport = #transport;
            const FIELDS: &'static [__core::primitive::usize] = &[#(#indices),*];
            const MASK: __core::primitive::u32 = 0 #(| #masks)*;
            #[inline(always)]
            unsafe fn load(__words: &[__core::primitive::u32]) -> Self {
                // SAFETY: the caller's, field by field.
                Self { #(#loads),* }
            }
            #[inline(always)]
            fn store(self, __words: &mut [__core::primitive::u32]) {
                #(#stores)*
            }
        }
        #[automatically_derived]
        impl #krate::payload::PartOf for #ident {
            type Payload = #payload_ident;
        }
        #passage
    }
}

/// What says that a program of the party's kind receives or returns the part, with the bodies that do it.
fn passage(payload: &Payload, part: &Part, take: &TokenStream, give: &TokenStream) -> TokenStream {
    if part.party == Party::Caller {
        return TokenStream::new();
    }
    let (krate, payload, ident, role) = (&device_crate(), &payload.shape.ident, &part.ident, part.role());
    let part_type = quote!(<#payload as #krate::payload::Payload>::#role);
    if part.reads {
        let passage = format_ident!("ReceivedBy{}", part.party.suffix());
        quote! {
            #[automatically_derived]
            impl #krate::check::#passage<#payload> for #ident {
                #[inline(always)]
                fn take(__part: #part_type) -> Self {
                    #take
                }
            }
        }
    } else {
        let passage = format_ident!("ReturnedBy{}", part.party.suffix());
        quote! {
            #[automatically_derived]
            impl #krate::check::#passage<#payload> for #ident {
                #[inline(always)]
                fn give(self) -> #part_type {
                    #give
                }
            }
        }
    }
}
