//! Proves that a shader crate's PTX keeps the contracts of its pipelines.
//!
//! The declaration in `pipeline!` reaches the GPU twice: the host computes payload semantics, record layouts and
//! parameter offsets from it, and the device compiler turns it into instructions. This reads the instructions and
//! compares them with what a host program computes.
//!
//! | what is proven, for each pipeline | rule |
//! | --- | --- |
//! | every program has one entry, whose name begins as OptiX wants it for its kind | [`Rule::Entry`] |
//! | the constant-memory variable is there once, with the parameter struct's size and alignment | [`Rule::ParamsSymbol`] |
//! | all that crosses between host and device is laid out alike in both: parameters, records, payloads, attributes, signatures, exceptions, and the elements of buffers | [`Rule::Layout`] |
//! | parameters are read by `ld.const` at constant addresses, each inside of one field | [`Rule::ParamsLoad`] |
//! | each program announces the payload type of its ray type | [`Rule::PayloadType`] |
//! | each trace call has its ray type's payload, SBT offset, stride and miss index | [`Rule::Trace`] |
//! | payload words are read and written only by programs that may | [`Rule::PayloadWord`] |
//! | programs ask about no other kind of primitive than that of their hits | [`Rule::Primitive`] |
//! | no local memory but for payloads that travel by pointer | [`Rule::LocalMemory`] |
//! | no function calls but those that the caller allows, and of the toolkit's own maths for rare arguments | [`Rule::Call`] |
//! | callables are called, and exceptions thrown, by programs that may | [`Rule::Callable`] |
//! | no barriers, shared memory, fences, atomics on local memory, nor registers and votes that mean something else in OptiX | [`Rule::Instruction`] |
//! | nothing is missing that OptiX would have to find elsewhere | [`Rule::Module`] |
//!
//! Arguments of calls are followed to the constants that they come from. An argument that is not a constant is a
//! finding too.

mod callables;
mod entries;
mod facts;
mod finding;
mod forbidden;
mod functions;
mod host_program;
mod layouts;
mod params;
mod payload;
mod primitives;
#[cfg(test)]
mod tests;
mod trace;

use std::path::Path;

use optix_ptx::{Function, Module};

pub use facts::{Crossing, Field, Kind, Params, Pipeline, Program, Ray};
pub use finding::{Finding, Level, Rule};

use crate::device_build::{Built, Session};
use crate::error::Error;
use crate::options::Shaders;
use crate::ptx;

/// A shader crate, compiled and compared with its pipelines.
#[derive(Clone, Debug)]
pub struct Verified {
    /// The PTX.
    pub built: Built,
    /// The crate's pipelines, as the host sees them.
    pub pipelines: Vec<Pipeline>,
    /// What is wrong. Empty if everything is proven.
    pub findings: Vec<Finding>,
}

impl Shaders {
    /// Compiles the shader crate as [`Shaders::compile_in`] does and [checks](check) its PTX against its pipelines.
    /// Findings do not make it fail.
    ///
    /// ```no_run
    /// let verified = optix_toolchain::Shaders::new("shaders").verify_in("target/optix", &[])?;
    /// verified.findings.iter().for_each(|finding| eprintln!("{finding}"));
    /// # Ok::<(), optix_toolchain::Error>(())
    /// ```
    pub fn verify_in(&self, area: impl AsRef<Path>, allowed: &[String]) -> Result<Verified, Error> {
        let session = Session::open(self, area.as_ref())?;
        let built = session.build()?;
        let pipelines = host_program::pipelines(&session, &built.entries)?;
        let findings = check(&built.text, &pipelines, allowed);
        Ok(Verified { built, pipelines, findings })
    }
}

/// What is wrong with the PTX `text`, given its pipelines. Functions whose demangled path contains one of `allowed` may
/// be called; what they do is checked as if it stood in the programs that call them.
///
/// ```
/// let ptx = ".version 7.8\n.target sm_75\n.visible .entry __raygen__a()\n{\n\tret;\n}\n";
/// let findings = optix_toolchain::verify::check(ptx, &[], &[]);
/// assert_eq!(findings.len(), 1);
/// assert!(findings[0].to_string().contains("no `pipeline!`"));
/// ```
pub fn check(text: &str, pipelines: &[Pipeline], allowed: &[String]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let text = optix_ptx::plain(text);
    let module = Module::read(&text);
    // These are reported for each program, below.
    let forbidden = ptx::forbidden::forbidden(&module);
    if let Err(problem) = ptx::check(&module)
        && !matches!(problem, ptx::Problem::Pointers(_) | ptx::Problem::Forbidden(_))
    {
        findings.push(Finding::error(Rule::Module, "the module", problem.to_string()));
    }
    entries::check(&module, pipelines, &mut findings);
    for pipeline in pipelines {
        let others = pipelines.iter().filter(|other| other.params.symbol != pipeline.params.symbol);
        let others: Vec<&Pipeline> = others.collect();
        params::check(&module, pipeline, &mut findings);
        layouts::check(&module, pipeline, &mut findings);
        for program in &pipeline.programs {
            let item = program.item(pipeline);
            let reached = module.reached(&program.entry);
            for function in &reached {
                params::check_loads(function, pipeline, &others, &item, &mut findings);
                payload::check_words(function, program, pipeline, &item, &mut findings);
                trace::check(function, program, pipeline, &item, &mut findings);
                primitives::check(function, program, &item, &mut findings);
                callables::check(function, program, pipeline, &item, &mut findings);
                forbidden::check(function, &forbidden, &item, &mut findings);
            }
            if let Some(entry) = reached.first() {
                payload::check_type(entry, program, pipeline, &item, &mut findings);
            }
        }
    }
    for one in forbidden.iter().filter(|one| module.get(&one.function).is_none()) {
        findings.push(Finding::error(Rule::Instruction, "the module", one.to_string()));
    }
    functions::check(&module, pipelines, allowed, &mut findings);
    // If several programs call a function, or one calls it several times, the same finding would come again.
    let mut seen = Vec::new();
    findings.retain(|finding| {
        let new = !seen.contains(finding);
        if new {
            seen.push(finding.clone());
        }
        new
    });
    findings
}

/// The name of the item, and of the function that it reaches, if that is not its own entry.
fn place(function: &Function<'_>, item: &str) -> String {
    if function.is_entry {
        item.to_string()
    } else {
        format!("{item}, in `{}`, which it calls", ptx::demangled(function.name))
    }
}
