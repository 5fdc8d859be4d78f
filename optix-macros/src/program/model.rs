//! What a program's signature says.

use super::callable;
use super::check::{calls_itself, is_for_the_call, names_its_payload, qualifiers};
use super::kind::Kind;
use crate::source;
use crate::support::{Errors, cfg_of, mentions, place_of, ungroup};
use proc_macro2::Span;
use quote::ToTokens;
use syn::{
    Error, FnArg, GenericArgument, GenericParam, Generics, Ident, ItemFn, PatType, PathArguments, Receiver, ReturnType,
    Type, TypeReference,
};

/// A program.
pub struct Program {
    pub kind: Kind,
    pub ident: Ident,
    pub generics: Generics,
    /// First argument of the context.
    pub pipeline: Type,
    /// Second argument of the context.
    pub hits: Option<Type>,
    pub record: Option<Type>,
    /// The payload part it receives.
    pub input: Option<Type>,
    /// The payload part it returns.
    pub output: Option<Type>,
    /// What the caller of a callable passes.
    pub arguments: Vec<Type>,
    /// What a callable returns.
    pub result: Option<Type>,
    /// Where the context's type is.
    pub context_span: Span,
    /// Where the result's type is, else the name.
    pub result_span: Span,
    /// An any-hit program that returns `(Decision, ())`.
    pub returns_unit_part: bool,
}

impl Program {
    /// Reads a signature. `in_impl` says whether the function [`is_in_impl`].
    pub fn new(kind: Kind, function: &ItemFn, in_impl: bool, errors: &mut Errors) -> Option<Self> {
        let sig = &function.sig;
        qualifiers(kind, function, errors);
        calls_itself(function, errors);
        for argument in &sig.inputs {
            is_for_the_call(argument, errors);
        }
        for argument in &sig.inputs {
            let (FnArg::Typed(PatType { attrs, .. }) | FnArg::Receiver(Receiver { attrs, .. })) = argument;
            if let Some(cfg) = cfg_of(attrs) {
                errors.at(cfg, "a program has the same arguments on host and device: write two programs, each with `#[cfg(..)]` above its attribute");
            }
        }
        let mut arguments = sig.inputs.iter();
        let context = arguments.next();
        let Some(context) = context else {
            let message = format!(
                "{} takes its context first: `{}: {}`",
                kind.phrase(),
                kind.argument_name(),
                kind.context_example()
            );
            errors.push(Error::new(sig.paren_token.span.join(), message));
            return None;
        };
        let context_span = match context {
            FnArg::Typed(PatType { ty, .. }) => match ungroup(ty) {
                Type::Reference(reference) => place_of(&reference.elem),
                ty => place_of(ty),
            },
            FnArg::Receiver(receiver) => place_of(receiver),
        };
        let result_span = match &sig.output {
            ReturnType::Type(_, ty) => place_of(ty),
            ReturnType::Default => place_of(&sig.ident),
        };
        let context = context_type(kind, context, errors);
        let mut typed = Vec::new();
        for argument in arguments {
            match argument {
                FnArg::Typed(argument) => typed.push(&*argument.ty),
                FnArg::Receiver(receiver) => errors.at(receiver, "a program has no `self`"),
            }
        }
        let (record, input, output, arguments, result) = if kind.is_callable() {
            let (record, arguments) = callable::arguments(kind, &typed, errors);
            (record, None, None, arguments, callable::result(&sig.output, errors))
        } else {
            let (record, input) = record_and_payload(kind, &typed, errors);
            (record, input, output(kind, &sig.output, sig, errors), Vec::new(), None)
        };
        for part in [&input, &output].into_iter().flatten() {
            names_its_payload(part, &sig.generics, errors);
        }
        let returns_unit_part = output.is_none()
            && matches!(&sig.output, ReturnType::Type(_, ty) if matches!(ungroup(ty), Type::Tuple(t) if t.elems.len() == 2));
        if sig.receiver().is_none() && in_impl {
            let (phrase, ident) = (kind.phrase(), &sig.ident);
            let types = if names_self(sig) { ", and name the types that `Self` stands for" } else { "" };
            errors.push(Error::new(
                ident.span(),
                format!("{phrase} is a free function, no method: move `{ident}` out of the `impl` or `trait`{types}"),
            ));
        }
        let (pipeline, hits) = context?;
        for ty in [Some(&pipeline), hits.as_ref(), record.as_ref()].into_iter().flatten() {
            for word in ["impl", "dyn"] {
                if mentions(ty.to_token_stream(), word) {
                    errors.at(
                        ty,
                        format!("a program's arguments have named types: write a type parameter instead of `{word}`"),
                    );
                }
            }
        }
        let program = Self {
            kind,
            ident: sig.ident.clone(),
            generics: sig.generics.clone(),
            pipeline,
            hits,
            record,
            input,
            output,
            arguments,
            result,
            context_span,
            result_span,
            returns_unit_part,
        };
        program.check_generics(errors);
        Some(program)
    }

    /// Every parameter must follow from the types that `pipeline!` knows.
    fn check_generics(&self, errors: &mut Errors) {
        for parameter in &self.generics.params {
            let (ident, tokens) = match parameter {
                GenericParam::Lifetime(lifetime) => {
                    errors.at(
                        lifetime,
                        "a program needs no named lifetimes: context and record are borrowed for the call",
                    );
                    continue;
                }
                GenericParam::Type(parameter) => (&parameter.ident, parameter.to_token_stream()),
                GenericParam::Const(parameter) => (&parameter.ident, parameter.to_token_stream()),
            };
            // A hit group says what its record and its hits are. Ray generation and miss have a record of their own, and
            // intersection programs say what hits there are.
            let has_group = self.kind.has_hits();
            let types = [
                Some(&self.pipeline),
                self.hits.as_ref().filter(|_| self.kind != Kind::Intersection),
                self.record.as_ref().filter(|_| has_group),
                self.input.as_ref(),
                self.output.as_ref(),
            ];
            if !types.into_iter().flatten().any(|ty| mentions(ty.to_token_stream(), &ident.to_string())) {
                errors.at(
                    tokens,
                    format!(
                        "`pipeline!` can't tell what `{ident}` is: {} gets from it {}, as in `{}`; name the type",
                        self.kind.phrase(),
                        self.kind.known(),
                        self.kind.generic_example()
                    ),
                );
            }
        }
    }
}

/// Whether the function is in an impl or a trait, where there is no room for the type that stands for it.
pub fn is_in_impl(sig: &syn::Signature) -> bool {
    sig.receiver().is_some() || names_self(sig) || source::is_in_impl(sig.ident.span())
}

fn names_self(sig: &syn::Signature) -> bool {
    mentions(sig.to_token_stream(), "Self")
}

/// Pipeline and hits of `&ClosestHit<PathTracer, Triangles>`.
fn context_type(kind: Kind, argument: &FnArg, errors: &mut Errors) -> Option<(Type, Option<Type>)> {
    let (phrase, example) = (kind.phrase(), kind.context_example());
    let argument = match argument {
        FnArg::Receiver(receiver) => {
            errors.at(
                receiver,
                format!("a program has no `self`: {phrase} is a free function whose first argument is `{example}`"),
            );
            return None;
        }
        FnArg::Typed(argument) => argument,
    };
    let expected = || format!("{phrase} takes its context first, `{example}`");
    let inner = match ungroup(&argument.ty) {
        Type::Reference(TypeReference { mutability: Some(token), .. }) => {
            errors.at(token, format!("{phrase} takes its context by shared reference: `{example}`"));
            return None;
        }
        Type::Reference(reference) => ungroup(&reference.elem),
        ty => {
            let by_value = Kind::of_context(ty) == Some(kind);
            let message = if by_value {
                format!("{phrase} takes its context by reference: write `&` before it, as in `{example}`")
            } else {
                expected()
            };
            errors.at(&argument.ty, message);
            return None;
        }
    };
    match Kind::of_context(inner) {
        Some(found) if found == kind => {}
        Some(found) => {
            errors.at(
                &argument.ty,
                format!(
                    "this is the context of {}, but the attribute makes {phrase}: write `{example}`, or `#[{}]` above \
                     the function",
                    found.phrase(),
                    found.attribute()
                ),
            );
            return None;
        }
        None => {
            errors.at(&argument.ty, expected());
            return None;
        }
    }
    let Type::Path(path) = inner else { return None };
    let segment = path.path.segments.last()?;
    let types: Vec<&Type> = match &segment.arguments {
        PathArguments::AngleBracketed(arguments) => arguments
            .args
            .iter()
            .filter_map(|a| match a {
                GenericArgument::Type(ty) => Some(ty),
                _ => None,
            })
            .collect(),
        _ => Vec::new(),
    };
    match (types.as_slice(), kind.has_hits()) {
        ([pipeline], false) => Some(((*pipeline).clone(), None)),
        ([pipeline, hits], true) => Some(((*pipeline).clone(), Some((*hits).clone()))),
        (_, hits) => {
            let of = if hits { "the pipeline and what its hits carry" } else { "the pipeline" };
            errors.at(
                segment,
                format!("`{}` is the context of one kind of pipeline: name {of}, as in `{example}`", kind.context()),
            );
            None
        }
    }
}

/// The arguments after the context: `record: &T`, then the payload part, each optional.
fn record_and_payload(kind: Kind, arguments: &[&Type], errors: &mut Errors) -> (Option<Type>, Option<Type>) {
    let most = if kind.has_payload() { 2 } else { 1 };
    let example = kind.example();
    if let Some(extra) = arguments.get(most) {
        let takes = if kind.has_payload() {
            "its context, a record and its part of the payload"
        } else {
            "its context and a record"
        };
        errors.at(extra, format!("{} takes {takes}, and nothing else: {example}", kind.phrase()));
        return (None, None);
    }
    let (mut record, mut input) = (None, None);
    for (i, ty) in arguments.iter().enumerate() {
        match ungroup(ty) {
            Type::Reference(TypeReference { mutability: Some(token), .. }) => errors.at(
                token,
                "a record is read-only: programs of many launch indices read it at once; take it as `&T`, and write to a \
                 `SliceMut` of the launch parameters or of the record",
            ),
            Type::Reference(reference) if i == 0 => record = Some((*reference.elem).clone()),
            Type::Reference(_) => {
                let message = if record.is_some() {
                    "a program takes one record; its part of the payload comes by value, without `&`".to_owned()
                } else {
                    format!("the record comes before the payload, which comes last and by value: {example}")
                };
                errors.at(ty, message);
            }
            Type::ImplTrait(_) => errors.at(ty, "a program's arguments have named types: name its part of the payload"),
            _ if !kind.has_payload() => errors.at(
                ty,
                format!("{} gets no payload; its record is taken by reference: `record: &T`", kind.phrase()),
            ),
            _ if i + 1 == arguments.len() => {
                if is_part(kind, ty, true, errors) {
                    input = Some((*ty).clone());
                }
            }
            // The payload, which comes last; the record has its own message.
            _ if matches!(arguments.get(i + 1), Some(Type::Reference(_))) => {}
            _ => errors.at(ty, "the record is taken by reference: write `&` before its type"),
        }
    }
    (record, input)
}

/// The payload part in the result.
fn output(kind: Kind, output: &ReturnType, sig: &syn::Signature, errors: &mut Errors) -> Option<Type> {
    let ty = match output {
        ReturnType::Default if kind == Kind::AnyHit => {
            errors.push(Error::new(
                sig.ident.span(),
                "an any-hit program decides about the hit: it returns `Decision` (`Accept`, `Ignore` or `Terminate`), or \
                 `(Decision, ..FromAnyHit)` where it writes the payload",
            ));
            return None;
        }
        ReturnType::Default => return None,
        ReturnType::Type(_, ty) => ungroup(ty),
    };
    let unit = matches!(ty, Type::Tuple(tuple) if tuple.elems.is_empty());
    match kind {
        Kind::RayGen | Kind::Exception => {
            if !unit {
                let phrase = kind.phrase();
                errors.at(ty, format!("{phrase} returns nothing: it writes its result through the launch parameters"));
            }
            None
        }
        Kind::AnyHit => match ty {
            Type::Tuple(tuple) if tuple.elems.len() == 2 => {
                let part = &tuple.elems[1];
                let unit = matches!(part, Type::Tuple(tuple) if tuple.elems.is_empty());
                (!unit && is_part(kind, part, false, errors)).then(|| part.clone())
            }
            Type::Path(path) if path.path.segments.last().is_some_and(|s| s.ident == "Decision") => None,
            _ => {
                errors.at(
                    ty,
                    "an any-hit program returns `Decision` (`Accept`, `Ignore` or `Terminate`), or \
                     `(Decision, ..FromAnyHit)` where it writes the payload",
                );
                None
            }
        },
        _ if unit => None,
        _ => match ty {
            Type::Reference(_) => {
                errors.at(ty, "a program returns its part of the payload by value");
                None
            }
            Type::Never(_) => {
                errors.at(ty, "a program returns: its result goes back to the caller of `trace`");
                None
            }
            Type::ImplTrait(_) => {
                errors.at(ty, "a program's result has a named type");
                None
            }
            _ => is_part(kind, ty, false, errors).then(|| ty.clone()),
        },
    }
}

/// Whether a type is a payload part of the right kind, by its name. Types are checked later; this is for the message.
fn is_part(kind: Kind, ty: &Type, received: bool, errors: &mut Errors) -> bool {
    let word = if received { "At" } else { "From" };
    let suffix = format!("{word}{}", kind.context());
    let last = match ungroup(ty) {
        Type::Path(path) => path.path.segments.last().map(|s| s.ident.to_string()),
        _ => None,
    };
    let (phrase, does) = (kind.phrase(), if received { "receives" } else { "returns" });
    match last.as_deref() {
        Some("Decision") if !received => {
            errors.at(ty, format!("{phrase} decides nothing about a hit: only an any-hit program returns `Decision`"));
            return false;
        }
        Some(name @ ("Option" | "Result")) if !received => {
            errors.at(
                ty,
                format!("{phrase} writes its part of the payload on every path: return the struct `..{suffix}` itself, without `{name}`"),
            );
            return false;
        }
        _ => {}
    }
    if last.as_ref().is_some_and(|name| name.ends_with(&suffix)) {
        return true;
    }
    let of_another = last.as_ref().and_then(|name| {
        let parties = ["Caller", "ClosestHit", "Miss", "AnyHit", "Intersection"];
        let suffixes = parties.iter().flat_map(|party| [format!("At{party}"), format!("From{party}")]);
        suffixes.into_iter().find_map(|suffix| name.strip_suffix(&suffix).map(str::to_owned))
    });
    let message = match of_another {
        Some(payload) if !payload.is_empty() => {
            format!("{phrase} {does} `{payload}{suffix}` of payload `{payload}`: this is another party's part")
        }
        _ if received => format!(
            "{phrase} {does} its part of the payload, a struct `..{suffix}` that `#[derive(Payload)]` makes, under its own \
             name; if this is its record, take it by reference: write `&` before the type"
        ),
        _ => format!(
            "{phrase} {does} its part of the payload, a struct `..{suffix}` that `#[derive(Payload)]` makes, or nothing"
        ),
    };
    errors.at(ty, message);
    false
}
