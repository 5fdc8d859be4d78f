//! What must hold of a pipeline before types come into it.

use super::parse::Pipeline;
use crate::limits::{MAX_CALLABLE_DEPTH, MAX_PAYLOAD_TYPES, MAX_TRACE_DEPTH};
use crate::support::Errors;
use quote::ToTokens;
use syn::{Error, Type};

pub fn check(pipeline: &Pipeline, errors: &mut Errors) {
    if pipeline.params.is_none() {
        errors.at(
            &pipeline.ident,
            format!(
                "pipeline `{}` has no launch parameters: add `params: Frame`, a struct with `#[launch_params]`",
                pipeline.ident
            ),
        );
    }
    if pipeline.raygen.is_empty() {
        errors.at(
            &pipeline.ident,
            format!(
                "pipeline `{}` has no ray-generation program, where a launch begins: add `raygen: [camera]`",
                pipeline.ident
            ),
        );
    }
    listed_once(&pipeline.raygen, "ray-generation program", "", errors);
    let records = ": a scene makes as many records of it as there are uses, each with its own data";
    listed_once(&pipeline.direct_callables, "direct callable", records, errors);
    listed_once(&pipeline.continuation_callables, "continuation callable", records, errors);
    rays(pipeline, errors);
    groups(pipeline, errors);
    if let Some(depth) = &pipeline.trace_depth {
        match depth.base10_parse::<u32>() {
            Ok(0..=MAX_TRACE_DEPTH) => {}
            _ => errors.at(depth, format!("the trace depth is a number from 0 to {MAX_TRACE_DEPTH} (guide 6.7)")),
        }
    }
    if let Some(depth) = &pipeline.callable_depth
        && !matches!(depth.base10_parse::<u32>(), Ok(1..=MAX_CALLABLE_DEPTH))
    {
        errors.at(
            depth,
            format!(
                "the depth of callables that call each other is a number from 1 to {MAX_CALLABLE_DEPTH}: each level takes \
                 stack of every launch index (guide 6.8)"
            ),
        );
    }
}

fn listed_once(programs: &[syn::Path], what: &str, remedy: &str, errors: &mut Errors) {
    for (i, program) in programs.iter().enumerate() {
        if programs[..i].iter().any(|p| text(p) == text(program)) {
            errors.at(program, format!("{what} `{}` is listed twice{remedy}", path(program)));
        }
    }
}

fn rays(pipeline: &Pipeline, errors: &mut Errors) {
    for (i, ray) in pipeline.rays.iter().enumerate() {
        if pipeline.rays[..i].iter().any(|r| text(&r.payload) == text(&ray.payload)) {
            let name = path(&ray.payload);
            errors.at(
                &ray.payload,
                format!(
                    "ray type `{name}` is listed twice: a ray type is named by its payload; for two ray types with the same \
                     fields declare two payload structs (that costs nothing)"
                ),
            );
        }
    }
    if let Some(ray) = pipeline.rays.get(MAX_PAYLOAD_TYPES) {
        errors.at(
            &ray.payload,
            format!(
                "a pipeline has {MAX_PAYLOAD_TYPES} ray types at most, one for each payload type that a module may have (guide \
                 14); this one lists {}",
                pipeline.rays.len()
            ),
        );
    }
}

fn groups(pipeline: &Pipeline, errors: &mut Errors) {
    for (i, group) in pipeline.groups.iter().enumerate() {
        let (record, geometry) = (path(&group.record), &group.geometry);
        let names = |g: &super::parse::Group| [text(&g.record), text(&g.geometry)];
        let twice = |g: &super::parse::Group| names(g) == names(group);
        if pipeline.groups[..i].iter().any(twice) {
            errors.at(
                &group.record,
                format!(
                    "hit group `{record} on {geometry}` is listed twice: a material is named by its record; for two \
                     materials with the same data declare two record structs"
                ),
            );
        }
        let missing: Vec<String> = pipeline
            .rays
            .iter()
            .filter(|r| !group.rays.iter().any(|p| text(&p.ray) == text(&r.payload)))
            .map(|r| path(&r.payload))
            .collect();
        let is_listed = |ray: &Type| pipeline.rays.iter().any(|r| text(&r.payload) == text(ray));
        for (j, programs) in group.rays.iter().enumerate() {
            let ray = path(&programs.ray);
            if group.rays[..j].iter().any(|p| text(&p.ray) == text(&programs.ray)) {
                errors.at(&programs.ray, format!("ray type `{ray}` is twice in hit group `{record} on {geometry}`"));
            }
            if !is_listed(&programs.ray) {
                let or = match missing.as_slice() {
                    [] => String::new(),
                    missing => format!(
                        ", or write `{}` here, by which they list it, if `{ray}` is another name of that",
                        missing.join("` or `")
                    ),
                };
                let pipeline = &pipeline.ident;
                errors.at(
                    &programs.ray,
                    format!("`{ray}` is not among the `rays` of `{pipeline}`: add `{ray} {{ miss: .. }}` there{or}"),
                );
            }
        }
        // A ray type that is not listed is likely one that is missing, and has its message.
        if !missing.is_empty() && group.rays.iter().all(|programs| is_listed(&programs.ray)) {
            let inner = if group.has_intersection_program() { " { intersection: .. }" } else { " {}" };
            let entries: Vec<String> = missing.iter().map(|ray| format!("{ray}{inner}")).collect();
            errors.push(Error::new(
                group.span,
                format!(
                    "hit group `{record} on {geometry}` does not say what happens to ray type `{}`: add `{}`{}",
                    missing.join("`, `"),
                    entries.join(", "),
                    if group.has_intersection_program() { "" } else { ", or name programs in the braces" },
                ),
            ));
        }
    }
}

/// For comparisons.
pub fn text(tokens: &impl ToTokens) -> String {
    tokens.to_token_stream().to_string()
}

/// As written.
pub fn path(tokens: &impl ToTokens) -> String {
    text(tokens).replace(" :: ", "::").replace(":: ", "::").replace(" < ", "<").replace(" >", ">").replace("< ", "<")
}
