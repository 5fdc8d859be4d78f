//! Finds which programs a launch can reach. The others are cut from the PTX.

use crate::features::Features;
use optix_device_rs::host::{Entry, PipelineDescription};
use optix_ptx::Module;

/// A program that a launch can reach.
pub(super) struct ReachedProgram {
    pub name: &'static str,
    /// Its name in the source, for messages.
    pub function: &'static str,
    pub stage: Stage,
}

impl ReachedProgram {
    /// Whether the program, or a function that it calls, calls a device function for which `is_it` holds.
    pub fn calls(&self, module: &Module<'_>, is_it: impl Fn(&str) -> bool) -> bool {
        module.reached(self.name).iter().flat_map(|function| function.calls()).any(|call| is_it(call.function))
    }
}

/// When a program runs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    RayGen,
    /// Closest-hit or miss, for a ray type.
    Shading(usize),
    /// Any-hit or intersection, for a ray type.
    Traversal(usize),
    Direct,
    Continuation,
    Exception,
}

/// The programs that a launch can reach in a scene with these features.
pub(super) fn reached_programs(description: &PipelineDescription, features: &Features) -> Vec<ReachedProgram> {
    let mut entries: Vec<ReachedProgram> = Vec::new();
    let mut add = |entry: Entry, stage| {
        if !entries.iter().any(|e| e.name == entry.name && e.stage == stage) {
            entries.push(ReachedProgram { name: entry.name, function: entry.function, stage });
        }
    };
    for raygen in description.raygen {
        add(raygen.entry, Stage::RayGen);
    }
    for (ray, of) in description.rays.iter().enumerate() {
        if let Some(miss) = of.miss {
            add(miss.entry, Stage::Shading(ray));
        }
        for &group in &features.hit_groups {
            let programs = description.hitgroups[group].rays[ray];
            if let Some(entry) = programs.closesthit {
                add(entry, Stage::Shading(ray));
            }
            for entry in [programs.anyhit, programs.intersection].into_iter().flatten() {
                add(entry, Stage::Traversal(ray));
            }
        }
    }
    for callable in features.callables.iter().map(|&index| &description.callables[index]) {
        add(callable.entry, if callable.continuation { Stage::Continuation } else { Stage::Direct });
    }
    if let Some(program) = description.exceptions.program {
        add(program.entry, Stage::Exception);
    }
    entries
}

/// The text of a module without the entries for which `keep` does not hold.
pub(super) fn without_entries(text: &str, module: &Module<'_>, keep: impl Fn(&str) -> bool) -> String {
    let mut result = String::with_capacity(text.len());
    let mut at = 0;
    for entry in module.entries().filter(|entry| !keep(entry.name)) {
        result.push_str(&text[at..entry.range.start]);
        at = entry.range.end;
    }
    result.push_str(&text[at..]);
    result
}

#[cfg(test)]
mod tests {
    use super::super::tests::PTX;
    use super::*;

    #[test]
    fn entries_are_cut_at_their_own_brace() {
        let plain = optix_ptx::plain(PTX);
        let module = Module::read(&plain);
        let rest = without_entries(PTX, &module, |name| name != "__raygen__a");
        assert!(rest.contains("p[16]") && rest.contains("q = 12;\n\n\t// .globl\t__miss__b"), "{rest}");
        let rest = without_entries(PTX, &module, |name| !name.starts_with("__direct"));
        assert!(rest.trim_end().ends_with("helper_param_0\n)\n;"), "{rest}");
        assert_eq!(without_entries(PTX, &module, |_| true), PTX);
    }
}
