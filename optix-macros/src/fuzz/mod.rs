//! Feeds every macro with mutated and arbitrary tokens: whatever comes, a macro answers with tokens and does not panic.
//!
//! A panic in a macro is an error without a place in the user's source. Inputs start from the programs of the
//! compile-time suite that compile. `FUZZ_SECONDS=600 cargo test -p optix-macros --release fuzz -- --nocapture` runs
//! longer than the tests do.

mod random;
mod seeds;

use crate::program::Kind;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use random::Random;
use seeds::Seeds;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// A macro and the tokens it is given: those in its brackets, and the item.
type Macro = (&'static str, fn(TokenStream, TokenStream) -> TokenStream);

/// Every macro of this crate.
const MACROS: [Macro; 17] = [
    ("Payload", |_, item| crate::support::derive(item, crate::payload::derive)),
    ("SbtRecord", |_, item| crate::support::derive(item, crate::record::derive)),
    ("DeviceData", |_, item| crate::support::derive(item, crate::data::derive)),
    ("Element", |_, item| crate::support::derive(item, crate::element::derive)),
    ("Words", |_, item| crate::support::derive(item, crate::words::derive_words)),
    ("Attributes", |_, item| crate::support::derive(item, crate::words::derive_attributes)),
    ("UserException", |_, item| crate::support::derive(item, crate::exception::derive)),
    ("launch_params", crate::params::expand),
    ("raygen", |arguments, item| crate::program::expand(Kind::RayGen, arguments, item)),
    ("miss", |arguments, item| crate::program::expand(Kind::Miss, arguments, item)),
    ("closesthit", |arguments, item| crate::program::expand(Kind::ClosestHit, arguments, item)),
    ("anyhit", |arguments, item| crate::program::expand(Kind::AnyHit, arguments, item)),
    ("intersection", |arguments, item| crate::program::expand(Kind::Intersection, arguments, item)),
    ("direct_callable", |arguments, item| crate::program::expand(Kind::DirectCallable, arguments, item)),
    ("continuation_callable", |arguments, item| crate::program::expand(Kind::ContinuationCallable, arguments, item)),
    ("exception", |arguments, item| crate::program::expand(Kind::Exception, arguments, item)),
    ("pipeline", |_, item| crate::pipeline::expand(item)),
];

/// Changes the tokens in one place, at any depth.
fn mutate(tokens: TokenStream, random: &mut Random, seeds: &Seeds) -> TokenStream {
    let mut tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let groups: Vec<usize> = (0..tokens.len()).filter(|i| matches!(tokens[*i], TokenTree::Group(_))).collect();
    if !groups.is_empty() && random.below(4) != 0 {
        let at = *random.of(&groups);
        if let TokenTree::Group(group) = &tokens[at] {
            tokens[at] = Group::new(group.delimiter(), mutate(group.stream(), random, seeds)).into();
        }
        return tokens.into_iter().collect();
    }
    let (at, other) = (random.below(tokens.len()), random.below(tokens.len()));
    match random.below(8) {
        0 if !tokens.is_empty() => drop(tokens.remove(at)),
        1 if !tokens.is_empty() => tokens.insert(at, tokens[other].clone()),
        2 if !tokens.is_empty() => tokens.swap(at, other),
        3 if !tokens.is_empty() => tokens[at] = random.token(),
        4 if !tokens.is_empty() => drop(tokens.drain(at.min(other)..at.max(other))),
        // A macro_rules variable of a type or an expression comes in an invisible group.
        5 if !tokens.is_empty() => {
            let (from, to) = (at.min(other), at.max(other));
            let inner = tokens.drain(from..to).collect();
            tokens.insert(from, Group::new(Delimiter::None, inner).into());
        }
        6 => {
            let (_, arguments, item) = random.of(&seeds.0);
            let mut donor: Vec<TokenTree> = [item, arguments][random.below(2)].clone().into_iter().collect();
            for _ in 0..random.below(4) {
                let inner =
                    donor.iter().filter_map(|t| if let TokenTree::Group(g) = t { Some(g.stream()) } else { None });
                let inner: Vec<_> = inner.collect();
                if inner.is_empty() {
                    break;
                }
                donor = random.of(&inner).clone().into_iter().collect();
            }
            let from = random.below(donor.len());
            let count = random.below((donor.len() - from).min(12) + 1);
            tokens.splice(at..at, donor.drain(from..from + count));
        }
        _ => tokens.insert(at, random.token()),
    }
    tokens.into_iter().collect()
}

/// The parser of Rust and that of macros go down as deep as the tokens do.
fn depth(tokens: &TokenStream) -> usize {
    let inner = tokens.clone().into_iter().map(|t| if let TokenTree::Group(g) = t { depth(&g.stream()) } else { 0 });
    1 + inner.max().unwrap_or(0)
}

/// Runs the macro; a panic fails the test with what set it off. A derive's or `pipeline!`'s output is Rust.
fn run((name, expand): &Macro, arguments: &TokenStream, item: &TokenStream) {
    let input = || format!("\nmacro: {name}\narguments: {arguments}\nitem: {item}");
    let output = catch_unwind(AssertUnwindSafe(|| expand(arguments.clone(), item.clone())));
    let Ok(output) = output else { panic!("a macro panicked{}", input()) };
    // What attributes are given comes back as it was, which may not be Rust.
    let own = name.starts_with(char::is_uppercase) || *name == "pipeline";
    if own && let Err(error) = syn::parse2::<syn::File>(output.clone()) {
        panic!("a macro's output is not Rust: {error}\noutput: {output}{}", input());
    }
}

#[test]
fn fuzz() {
    let seconds = std::env::var("FUZZ_SECONDS").ok().and_then(|s| s.parse().ok());
    let seeds = Seeds::read();
    for (name, _) in MACROS {
        assert!(seeds.0.iter().any(|(seed, ..)| *seed == name), "the suite has no program with {name}");
    }
    let mut random = Random(0x0971);
    let end = Instant::now() + Duration::from_secs(seconds.unwrap_or(60));
    // Without a wish for more time, a number of inputs, so that every run is the same.
    let most = if seconds.is_some() { u64::MAX } else { 4_000 };
    let mut count = 0;
    while count < most && Instant::now() < end {
        let (name, mut arguments, mut item) = random.of(&seeds.0).clone();
        if random.below(16) == 0 {
            let length = random.below(24);
            item = (0..length).map(|_| random.token()).collect();
        }
        for _ in 0..random.below(6) {
            if random.below(8) == 0 {
                arguments = mutate(arguments, &mut random, &seeds);
            } else {
                item = mutate(item, &mut random, &seeds);
            }
        }
        if depth(&item).max(depth(&arguments)) > 24 {
            continue;
        }
        // Mostly the macro the input was written for.
        let makro =
            if random.below(6) == 0 { random.of(&MACROS) } else { MACROS.iter().find(|m| m.0 == name).expect("known") };
        run(makro, &arguments, &item);
        count += 1;
    }
    println!("{count} inputs");
}
