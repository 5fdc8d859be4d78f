//! Written by optix-toolchain; see its `verify` module. Prints the pipelines of a shader crate as JSON.

use optix_device_rs::host::{Entry, HitGroupDescription, PipelineDescription};
use optix_device_rs::primitive::PrimitiveType;

fn main() {
    let pipelines: Vec<String> = facts::all().into_iter().map(pipeline).collect();
    println!("[{}]", pipelines.join(","));
}

fn pipeline(pipeline: &PipelineDescription) -> String {
    let params = pipeline.params;
    let fields = list(params.fields, |field| {
        format!(
            r#"{{"name":{:?},"offset":{},"size":{},"bound":{}}}"#,
            field.name, field.offset, field.size, field.bound
        )
    });
    let rays = list(pipeline.rays, |ray| {
        let payload = ray.payload;
        format!(
            r#"{{"payload":{:?},"semantics":{:?},"memory_words":{}}}"#,
            payload.name, payload.semantics, payload.memory_words
        )
    });
    let crossings = list(pipeline.crossings, |crossing| {
        format!(
            r#"{{"what":{:?},"name":{:?},"size":{},"unit":{:?},"layout":"{}"}}"#,
            crossing.what,
            crossing.name,
            crossing.size,
            crossing.unit(),
            crossing.layout.get()
        )
    });
    let throws = pipeline.exceptions.throws.map_or("null".to_string(), |throws| format!("{throws:?}"));
    format!(
        r#"{{"name":{:?},"params":{{"name":{:?},"symbol":{:?},"size":{},"align":{},"fields":{fields}}},"rays":{rays},"throws":{throws},"layouts":{:?},"crossings":{crossings},"programs":{}}}"#,
        pipeline.name,
        params.name,
        params.symbol,
        params.size,
        params.align,
        pipeline.layouts,
        list(&programs(pipeline), String::clone)
    )
}

fn programs(pipeline: &PipelineDescription) -> Vec<String> {
    let mut programs = Vec::new();
    let mut add = |kind: &str, entry: &Entry, ray: Option<usize>, group: Option<&HitGroupDescription>| {
        let ray = ray.map_or("null".to_string(), |ray| ray.to_string());
        let material = group.map_or("null".to_string(), |group| format!("{:?}", group.record.name));
        let primitive = group.map_or("null".to_string(), |group| format!("{:?}", group.geometry.name()));
        let others = PrimitiveType::ALL.iter().filter(|other| group.is_some_and(|group| group.geometry != **other));
        let undefined: Vec<&str> = others.flat_map(|other| other.queries()).copied().collect();
        programs.push(format!(
            r#"{{"kind":{kind:?},"entry":{:?},"function":{:?},"ray":{ray},"material":{material},"primitive":{primitive},"undefined":{undefined:?}}}"#,
            entry.name, entry.function
        ));
    };
    for program in pipeline.raygen {
        add("raygen", &program.entry, None, None);
    }
    for (index, ray) in pipeline.rays.iter().enumerate() {
        if let Some(miss) = &ray.miss {
            add("miss", &miss.entry, Some(index), None);
        }
    }
    for group in pipeline.hitgroups {
        for (index, ray) in group.rays.iter().enumerate() {
            let of_group = [("closesthit", &ray.closesthit), ("anyhit", &ray.anyhit), ("intersection", &ray.intersection)];
            for (kind, entry) in of_group {
                if let Some(entry) = entry {
                    add(kind, entry, Some(index), Some(group));
                }
            }
        }
    }
    for callable in pipeline.callables {
        let kind = if callable.continuation { "continuation_callable" } else { "direct_callable" };
        add(kind, &callable.entry, None, None);
    }
    if let Some(program) = &pipeline.exceptions.program {
        add("exception", &program.entry, None, None);
    }
    programs
}

fn list<T>(items: &[T], text: impl Fn(&T) -> String) -> String {
    let items: Vec<String> = items.iter().map(text).collect();
    format!("[{}]", items.join(","))
}

