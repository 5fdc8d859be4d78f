//! What the programs of a PTX file cost, as far as the file tells.
//!
//! ```
//! use optix_toolchain::inspect::{Class, programs};
//! let ptx = ".version 7.8\n.target sm_75\n.const .align 4 .b8 params[4];\n.visible .entry __raygen__a()\n{\n\
//!     \t.reg .b32 %r<3>;\n\tld.const.b32 %r1, [params];\n\tadd.s32 %r2, %r1, 1;\n\tret;\n}\n";
//! let program = &programs(ptx)[0];
//! assert_eq!((program.name.as_str(), program.instructions()), ("__raygen__a", 3));
//! assert_eq!(program.count(Class::Integer), 1);
//! assert_eq!((program.parameters.count, program.parameters.bytes), (1, 4));
//! ```
//!
//! A GPU does not execute PTX. The counts are for comparing two builds of a program; [`ptxas`](ptxas::Ptxas) tells
//! registers, and what counts in the end is OptiX's own compiler.

mod class;
mod loads;
mod pairs;
pub mod ptxas;
mod source;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

pub use class::Class;
pub use loads::Loads;
pub use pairs::pairs;
pub use source::with_source;

use optix_ptx::{Function, Module, Statement};

use crate::ptx::demangled;

/// A device program, or a function that is called instead of inlined.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// The name of an entry; the Rust path of a function.
    pub name: String,
    /// Whether it is an entry.
    pub is_entry: bool,
    /// Bytes of PTX between its braces, without comments.
    pub size: usize,
    /// Instructions as written, by class. Loops count once.
    pub classes: BTreeMap<Class, usize>,
    /// Calls by the name of the function: OptiX's, and those that were not inlined.
    pub calls: BTreeMap<String, usize>,
    /// Bytes of local memory that PTX asks for.
    pub local_memory: usize,
    /// Loads of launch parameters, that is from constant memory.
    pub parameters: Loads,
    /// Loads of the record: through the pointer that `_optix_get_sbt_data_ptr_64` gives, in the program itself.
    pub record: Loads,
}

impl Program {
    /// How many instructions it has, including calls.
    pub fn instructions(&self) -> usize {
        self.classes.values().sum()
    }

    /// How many instructions of a class it has.
    pub fn count(&self, class: Class) -> usize {
        self.classes.get(&class).copied().unwrap_or(0)
    }

    fn of(function: &Function<'_>) -> Self {
        let mut classes = BTreeMap::new();
        for statement in function.statements() {
            if let Statement::Instruction(instruction) = statement {
                *classes.entry(Class::of(instruction.op)).or_default() += 1;
            }
        }
        let mut called = BTreeMap::new();
        for call in function.calls() {
            *called.entry(demangled(call.function)).or_default() += 1;
        }
        Self {
            name: demangled(function.name),
            is_entry: function.is_entry,
            size: function.body().lines().map(|line| line.trim_end().len() + 1).sum(),
            classes,
            calls: called,
            local_memory: function.local_memory().unwrap_or(0),
            parameters: Loads::of_parameters(function),
            record: Loads::of_record(function),
        }
    }
}

/// The entries and functions of a PTX text, in its order.
pub fn programs(ptx: &str) -> Vec<Program> {
    Module::read(&optix_ptx::plain(ptx)).defined().map(Program::of).collect()
}
