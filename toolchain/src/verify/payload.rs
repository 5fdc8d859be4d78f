//! Checks the payload type that a program announces, and the words that it gets and sets.

use optix_ptx::Function;

use super::facts::{Pipeline, Program};
use super::finding::{Finding, Rule};
use super::place;

const SET_TYPES: &str = "_optix_set_payload_types";
const GET: &str = "_optix_get_payload";
const SET: &str = "_optix_set_payload";

/// Checks that a program with a payload announces its ray type's, once and before anything else, and that other
/// programs announce none.
pub(super) fn check_type(
    entry: &Function<'_>,
    program: &Program,
    pipeline: &Pipeline,
    item: &str,
    findings: &mut Vec<Finding>,
) {
    let mut error = |message: String| findings.push(Finding::error(Rule::PayloadType, item, message));
    let is_payload_call = |name: &str| matches!(name, SET_TYPES | GET | SET);
    let calls: Vec<_> = entry.calls().iter().filter(|call| is_payload_call(call.function)).collect();
    let announced: Vec<_> = calls.iter().filter(|call| call.function == SET_TYPES).collect();
    let Some(ray) = program.ray else {
        if !announced.is_empty() {
            error("announces a payload type, although it has no payload".into());
        }
        return;
    };
    let expected = 1 << ray;
    match announced[..] {
        [] => error(format!("does not announce its payload type, {expected} ({})", types(expected, pipeline))),
        [call] => match call.values.first().copied().flatten() {
            None => error("announces a payload type that is not a constant".into()),
            Some(value) if value != expected => error(format!(
                "announces payload type {value} ({}), but it runs for type {expected} ({})",
                types(value, pipeline),
                types(expected, pipeline)
            )),
            Some(_) if calls[0].function != SET_TYPES => {
                error("announces its payload type after it has used the payload".into());
            }
            Some(_) => {}
        },
        _ => error(format!("announces payload types {} times", announced.len())),
    }
}

/// The payloads whose `OptixPayloadTypeID` bits are in `mask`.
fn types(mask: u32, pipeline: &Pipeline) -> String {
    let rays = pipeline.rays.iter().enumerate().filter(|(ray, _)| mask >> ray & 1 != 0);
    let names: Vec<String> = rays.map(|(_, ray)| format!("`{}`", ray.payload)).collect();
    if names.is_empty() { format!("no ray type of `{}`", pipeline.name) } else { names.join(" and ") }
}

/// Checks that the numbers of payload words are constants, and that the program may get or set those words.
pub(super) fn check_words(
    function: &Function<'_>,
    program: &Program,
    pipeline: &Pipeline,
    item: &str,
    findings: &mut Vec<Finding>,
) {
    let calls = function.calls().iter().filter(|call| matches!(call.function, GET | SET));
    for call in calls {
        let mut error =
            |message: String| findings.push(Finding::error(Rule::PayloadWord, place(function, item), message));
        let (verb, participle) = if call.function == GET { ("gets", "read") } else { ("sets", "written") };
        let ray = program.ray.and_then(|ray| pipeline.rays.get(ray));
        let (Some(ray), Some((read, write))) = (ray, program.kind.semantics()) else {
            error(format!("{verb} a payload word, although it has no payload"));
            continue;
        };
        let Some(word) = call.values.first().copied().flatten() else {
            error(format!("{verb} a payload word whose number is not a constant"));
            continue;
        };
        let needed = if call.function == GET { read } else { write };
        match ray.semantics.get(word as usize) {
            None => {
                error(format!("{verb} payload word {word}, but `{}` has {} words", ray.payload, ray.semantics.len()))
            }
            Some(semantics) if semantics & needed == 0 => error(format!(
                "{verb} payload word {word}, which `{}` does not let be {participle} by {} programs",
                ray.payload,
                program.kind.word()
            )),
            Some(_) => {}
        }
    }
}
