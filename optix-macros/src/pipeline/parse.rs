//! The grammar of `pipeline!`. A mistake costs the item it is in, not the rest.

use crate::program::Kind;
use crate::support::{Errors, cfg_of};
use proc_macro2::{Span, TokenStream, TokenTree};
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Parser};
use syn::spanned::Spanned;
use syn::{Attribute, Error, Ident, LitInt, Path, Result, Token, Type, Visibility};

pub struct Pipeline {
    pub attrs: Vec<Attribute>,
    pub vis: Visibility,
    pub ident: Ident,
    pub params: Option<Type>,
    pub raygen: Vec<Path>,
    pub rays: Vec<Ray>,
    pub groups: Vec<Group>,
    pub direct_callables: Vec<Path>,
    pub continuation_callables: Vec<Path>,
    pub throws: Option<Type>,
    pub exception: Option<Path>,
    pub trace_depth: Option<LitInt>,
    pub callable_depth: Option<LitInt>,
}

/// `Radiance { miss: sky }`.
pub struct Ray {
    pub payload: Type,
    pub miss: Option<Path>,
}

/// `Lambert on Triangles => { .. }`.
pub struct Group {
    pub record: Type,
    /// The kind of primitive. The macro knows none: the device crate has a type of the name.
    pub geometry: Ident,
    pub rays: Vec<Programs>,
    pub span: Span,
}

impl Group {
    /// Whether any of its programs is an intersection program.
    pub fn has_intersection_program(&self) -> bool {
        self.rays.iter().any(|programs| programs.intersection.is_some())
    }
}

/// `Radiance { closesthit: lambert, anyhit: alpha }`.
pub struct Programs {
    pub ray: Type,
    pub closesthit: Option<Path>,
    pub anyhit: Option<Path>,
    pub intersection: Option<Path>,
}

impl Programs {
    pub fn get(&self, kind: Kind) -> Option<&Path> {
        match kind {
            Kind::ClosestHit => self.closesthit.as_ref(),
            Kind::AnyHit => self.anyhit.as_ref(),
            Kind::Intersection => self.intersection.as_ref(),
            _ => None,
        }
    }
}

/// The parts of a pipeline.
const PARTS: [&str; 10] = [
    "params",
    "raygen",
    "rays",
    "hitgroups",
    "direct_callables",
    "continuation_callables",
    "throws",
    "exception",
    "trace_depth",
    "callable_depth",
];

const EXAMPLE: &str =
    "`pipeline! { pub struct PathTracer { params: Frame, raygen: [camera], rays: { .. }, hitgroups: { .. } } }`";

pub fn parse(tokens: TokenStream, errors: &mut Errors) -> Option<Pipeline> {
    let parser = |input: ParseStream<'_>| pipeline(input, errors);
    let result = parser.parse2(tokens);
    errors.keep(result)
}

fn pipeline(input: ParseStream<'_>, errors: &mut Errors) -> Result<Pipeline> {
    let attrs = input.call(Attribute::parse_outer)?;
    if let Some(cfg) = cfg_of(&attrs) {
        errors.at(cfg, "write `#[cfg(..)]` above `pipeline!`, so that it holds for all that the macro makes");
    }
    let vis = input.parse()?;
    if input.parse::<Option<Token![struct]>>()?.is_none() {
        return Err(input.error(format!("expected a struct: {EXAMPLE}")));
    }
    let ident: Ident = input.parse()?;
    if input.peek(Token![<]) {
        return Err(input.error("a pipeline can't be generic: it is one set of programs; declare one for each use"));
    }
    if !input.peek(syn::token::Brace) {
        return Err(input.error(format!("expected the pipeline's parts in braces: {EXAMPLE}")));
    }
    let mut pipeline = Pipeline {
        attrs,
        vis,
        ident,
        params: None,
        raygen: Vec::new(),
        rays: Vec::new(),
        groups: Vec::new(),
        direct_callables: Vec::new(),
        continuation_callables: Vec::new(),
        throws: None,
        exception: None,
        trace_depth: None,
        callable_depth: None,
    };
    let content;
    syn::braced!(content in input);
    let mut seen: Vec<String> = Vec::new();
    list(&content, errors, |input, errors| {
        let key = input.call(Ident::parse_any)?;
        let word = key.to_string();
        if !PARTS.contains(&word.as_str()) {
            return Err(Error::new(
                key.span(),
                format!(
                    "a pipeline has no `{word}`{}: it has `params`, `raygen`, `rays`, `hitgroups`, and where there are any \
                     `direct_callables`, `continuation_callables`, `throws` and `exception`; where they are known better \
                     than from the programs, `trace_depth` and `callable_depth`",
                    guess(&word, &PARTS)
                ),
            ));
        }
        if seen.contains(&word) {
            errors.push(Error::new(key.span(), format!("`{word}` is there twice: write all of it in one place")));
        }
        seen.push(word.clone());
        input.parse::<Token![:]>()?;
        match word.as_str() {
            "params" => pipeline.params = Some(Type::without_plus(input)?),
            "trace_depth" => pipeline.trace_depth = Some(input.parse()?),
            "callable_depth" => pipeline.callable_depth = Some(input.parse()?),
            "throws" => pipeline.throws = Some(Type::without_plus(input)?),
            "exception" => {
                if input.peek(syn::token::Bracket) {
                    return Err(input.error("a pipeline has one exception program: write its name without brackets"));
                }
                pipeline.exception = Some(program(input)?);
            }
            "raygen" => {
                programs_of(input, "the ray-generation programs", "raygen: [camera]", &mut pipeline.raygen, errors)?
            }
            "direct_callables" => {
                let example = "direct_callables: [wood, marble]";
                programs_of(input, "the direct callables", example, &mut pipeline.direct_callables, errors)?;
            }
            "continuation_callables" => {
                let example = "continuation_callables: [mirror]";
                programs_of(
                    input,
                    "the continuation callables",
                    example,
                    &mut pipeline.continuation_callables,
                    errors,
                )?;
            }
            "rays" => {
                if !input.peek(syn::token::Brace) {
                    return Err(input.error("expected the ray types in braces: `rays: { Radiance { miss: sky } }`"));
                }
                let content;
                syn::braced!(content in input);
                list(&content, errors, |input, errors| {
                    pipeline.rays.push(ray(input, errors)?);
                    Ok(())
                });
            }
            _ => {
                if !input.peek(syn::token::Brace) {
                    return Err(input.error(format!("expected the hit groups in braces: `hitgroups: {{ {GROUP} }}`")));
                }
                let content;
                syn::braced!(content in input);
                list(&content, errors, |input, errors| {
                    pipeline.groups.push(group(input, errors)?);
                    Ok(())
                });
            }
        }
        Ok(())
    });
    if !input.is_empty() {
        errors.push(input.error("a `pipeline!` declares one pipeline: write another `pipeline!` for the next"));
        while input.parse::<TokenTree>().is_ok() {}
    }
    Ok(pipeline)
}

const NO_ATTRIBUTES: &str = "nothing inside a pipeline has attributes: it is one set of programs, the same on host and \
                             device; for another set declare another pipeline, with `#[cfg(..)]` above its `pipeline!`";

/// Items with commas between. An item that can't be read costs the tokens up to the next comma.
fn list(input: ParseStream<'_>, errors: &mut Errors, mut item: impl FnMut(ParseStream<'_>, &mut Errors) -> Result<()>) {
    while !input.is_empty() {
        let result = if input.peek(Token![#]) { Err(input.error(NO_ATTRIBUTES)) } else { item(input, errors) };
        let failed = result.is_err();
        if let Err(error) = result {
            errors.push(error);
            while !input.is_empty() && !input.peek(Token![,]) {
                let _ = input.parse::<TokenTree>();
            }
        }
        if input.peek(Token![,]) {
            let _ = input.parse::<Token![,]>();
        } else if !input.is_empty() && !failed {
            errors.push(input.error("expected `,` before this"));
            // So that the list ends: the next item may not begin here.
            if !input.peek(Ident::peek_any) && !input.peek(Token![::]) {
                let _ = input.parse::<TokenTree>();
            }
        }
    }
}

/// Programs in brackets.
fn programs_of(
    input: ParseStream<'_>,
    what: &str,
    example: &str,
    programs: &mut Vec<Path>,
    errors: &mut Errors,
) -> Result<()> {
    if !input.peek(syn::token::Bracket) {
        return Err(input.error(format!("expected {what} in brackets: `{example}`")));
    }
    let content;
    syn::bracketed!(content in input);
    list(&content, errors, |input, _| {
        programs.push(program(input)?);
        Ok(())
    });
    Ok(())
}

/// The path of a program.
fn program(input: ParseStream<'_>) -> Result<Path> {
    if !input.peek(Ident::peek_any) && !input.peek(Token![::]) {
        return Err(
            input.error("expected the name of a program: a function with its kind's attribute, such as `lambert`")
        );
    }
    let with_arguments =
        |input: ParseStream<'_>| input.peek(Token![<]) || input.peek(Token![::]) && input.peek3(Token![<]);
    let mut path = Path { leading_colon: input.parse()?, segments: Default::default() };
    loop {
        let leads = input.peek(Token![crate]) || input.peek(Token![self]) || input.peek(Token![super]);
        let segment = if leads { input.call(Ident::parse_any)? } else { input.parse::<Ident>()? };
        if leads && !input.peek(Token![::]) {
            let message = format!("`{segment}` is a module: name a program in it, such as `{segment}::lambert`");
            return Err(Error::new(segment.span(), message));
        }
        path.segments.push_value(segment.into());
        if with_arguments(input) {
            return Err(
                input.error("a program is named without `<..>`: `pipeline!` fills in the pipeline, record and payload")
            );
        }
        if !input.peek(Token![::]) {
            return Ok(path);
        }
        path.segments.push_punct(input.parse()?);
    }
}

fn ray(input: ParseStream<'_>, errors: &mut Errors) -> Result<Ray> {
    let mut ray = Ray { payload: Type::without_plus(input)?, miss: None };
    if !input.peek(syn::token::Brace) {
        return Err(input
            .error("expected the ray type's miss program in braces: `Radiance { miss: sky }`, or `{}` without one"));
    }
    let content;
    syn::braced!(content in input);
    list(&content, errors, |input, _| {
        let key = input.call(Ident::parse_any)?;
        if key != "miss" {
            let place = if ["closesthit", "anyhit", "intersection"].iter().any(|k| key == k) {
                ": closest-hit, any-hit and intersection programs belong to a hit group, in `hitgroups`"
            } else {
                ""
            };
            return Err(Error::new(
                key.span(),
                format!("a ray type has a `miss` program and nothing else, not `{key}`{place}"),
            ));
        }
        input.parse::<Token![:]>()?;
        if ray.miss.is_some() {
            return Err(Error::new(key.span(), "a ray type has one `miss` program"));
        }
        ray.miss = Some(program(input)?);
        Ok(())
    });
    Ok(ray)
}

const GROUP: &str = "Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} }";

fn group(input: ParseStream<'_>, errors: &mut Errors) -> Result<Group> {
    let record = Type::without_plus(input)?;
    let on = input.parse::<Ident>().ok().filter(|on| on == "on");
    if on.is_none() {
        return Err(Error::new(record.span(), format!("expected a material on a kind of geometry: `{GROUP}`")));
    }
    let geometry: Ident = input.parse()?;
    if !input.peek(Token![=>]) {
        return Err(input.error(format!("expected `=>` and the programs for each ray type: `{GROUP}`")));
    }
    input.parse::<Token![=>]>()?;
    if !input.peek(syn::token::Brace) {
        return Err(input.error(format!("expected the programs for each ray type in braces: `{GROUP}`")));
    }
    let content;
    let brace = syn::braced!(content in input);
    let mut group = Group { span: brace.span.join(), record, geometry, rays: Vec::new() };
    list(&content, errors, |input, errors| {
        group.rays.push(programs(input, errors)?);
        Ok(())
    });
    Ok(group)
}

fn programs(input: ParseStream<'_>, errors: &mut Errors) -> Result<Programs> {
    let mut programs = Programs { ray: Type::without_plus(input)?, closesthit: None, anyhit: None, intersection: None };
    if !input.peek(syn::token::Brace) {
        return Err(input.error(
            "expected the programs for this ray type in braces: `Radiance { closesthit: lambert }`, or `{}` without any",
        ));
    }
    let content;
    syn::braced!(content in input);
    list(&content, errors, |input, _| {
        let key = input.call(Ident::parse_any)?;
        let slot = match key.to_string().as_str() {
            "closesthit" => &mut programs.closesthit,
            "anyhit" => &mut programs.anyhit,
            "intersection" => &mut programs.intersection,
            "miss" => {
                return Err(Error::new(
                    key.span(),
                    "a miss program belongs to the ray type, in `rays`: no material is hit when it runs",
                ));
            }
            other => {
                return Err(Error::new(
                    key.span(),
                    format!(
                        "a hit group has no `{other}`{}: for each ray type it has `closesthit`, `anyhit` and \
                         `intersection`, each optional",
                        guess(other, &["closesthit", "anyhit", "intersection"])
                    ),
                ));
            }
        };
        input.parse::<Token![:]>()?;
        if slot.is_some() {
            return Err(Error::new(key.span(), format!("a hit group has one `{key}` program for each ray type")));
        }
        *slot = Some(program(input)?);
        Ok(())
    });
    Ok(programs)
}

/// " (did you mean `rays`?)" for words that are nearly one of `words`.
fn guess(word: &str, words: &[&str]) -> String {
    let squash = |s: &str| s.to_lowercase().replace('_', "");
    let given = squash(word);
    let near = words.iter().find(|known| {
        let known = squash(known);
        known.starts_with(&given) || given.starts_with(&known) || distance(&known, &given) <= 2
    });
    near.map(|known| format!(" (did you mean `{known}`?)")).unwrap_or_default()
}

/// Insertions, deletions and replacements that lead from one to the other.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut corner = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replace = corner + usize::from(x != *y);
            corner = row[j + 1];
            row[j + 1] = replace.min(row[j] + 1).min(corner + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn guesses() {
        assert_eq!(guess("ray", &["params", "rays"]), " (did you mean `rays`?)");
        assert_eq!(guess("closest_hit", &["closesthit"]), " (did you mean `closesthit`?)");
        assert_eq!(guess("wombat", &["params", "rays"]), "");
        assert_eq!(distance("kitten", "sitting"), 3);
    }

    #[test]
    fn a_mistake_costs_its_item_only() {
        let mut errors = Errors::default();
        let tokens = quote::quote! {
            struct P {
                params: F,
                wombat: [1, 2],
                raygen: [a, 7, self::b, crate, a::super],
                rays: { R { miss: m }, S { hit: x }, T {} },
            }
        };
        let pipeline = parse(tokens, &mut errors).unwrap();
        assert_eq!(pipeline.raygen.len(), 2);
        assert_eq!(pipeline.rays.len(), 3);
        assert_eq!(errors.into_tokens().to_string().matches("compile_error").count(), 5);
    }
}
