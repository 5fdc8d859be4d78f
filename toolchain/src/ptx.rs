//! Checks whether OptiX could load a PTX module, and finds what a module keeps in local memory.

pub(crate) mod builtins;
pub mod forbidden;
pub(crate) mod ftz;

use std::fmt;

use optix_ptx::{Call, Function, Module};

pub use forbidden::Forbidden;

/// The device functions that return the address of a callable.
pub(crate) const DIRECT: &str = "_optix_call_direct_callable";
pub(crate) const CONTINUATION: &str = "_optix_call_continuation_callable";

/// Why OptiX could not load a PTX module.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Problem {
    /// It has no entry point.
    NoEntry,
    /// It calls functions or reads variables that are defined nowhere.
    Unresolved(Vec<String>),
    /// These functions call others through pointers that are not addresses of callables.
    Pointers(Vec<String>),
    /// This function calls itself, directly or through others, and also calls device functions of OptiX.
    Recursion(String),
    /// It has instructions that OptiX forbids.
    Forbidden(Vec<Forbidden>),
    /// It is no PTX.
    NotPtx,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoEntry => f.write_str(
                "the PTX has no entry point; a shader crate needs at least one device program, such as a `#[raygen]`",
            ),
            Self::Unresolved(names) => write!(
                f,
                "the PTX uses what is not defined on the device: {}; avoid what calls it (a name that starts with `__` or \
                 `mem` comes from the compiler: 128-bit or 16-bit arithmetic, for example)",
                names.join(", ")
            ),
            Self::Pointers(names) => write!(
                f,
                "{} calls a function through a pointer, which OptiX does not allow; use generics, an enum or a callable",
                names.join(", ")
            ),
            Self::Recursion(name) => {
                write!(f, "{name} calls itself and device functions, which OptiX does not allow together; use a loop")
            }
            Self::Forbidden(found) => {
                for (i, one) in found.iter().enumerate() {
                    write!(f, "{}in {}, {one}", if i == 0 { "" } else { "; " }, one.function)?;
                }
                Ok(())
            }
            Self::NotPtx => f.write_str("this is no PTX; `.version` or `.target` is missing"),
        }
    }
}

impl std::error::Error for Problem {}

/// Checks that OptiX could load a module: it has an entry point, and defines everything that it uses.
///
/// ```
/// let module = optix_ptx::Module::read(".version 6.3\n.target sm_75\n.extern .func missing();\n");
/// let problem = optix_toolchain::ptx::check(&module).unwrap_err();
/// assert!(problem.to_string().contains("not defined on the device: missing"));
/// ```
pub fn check(module: &Module<'_>) -> Result<(), Problem> {
    let functions = module.functions.iter().filter(|function| function.is_extern).map(|function| function.name);
    let variables = module.variables.iter().filter(|variable| variable.is_extern).map(|variable| variable.name);
    let unresolved = functions.chain(variables).filter(|name| !provided(name));
    let unresolved: Vec<_> = unresolved.map(str::to_string).collect();
    let pointers: Vec<_> = module.defined().filter(|f| calls_pointers(f)).map(|f| f.name.to_string()).collect();
    let forbidden: Vec<_> = forbidden::forbidden(module).into_iter().filter(|one| one.why.is_error()).collect();
    let recursive = module.defined().find(|function| is_recursive(module, function));
    if module.version.is_empty() || module.target.is_empty() {
        Err(Problem::NotPtx)
    } else if !unresolved.is_empty() {
        Err(Problem::Unresolved(unresolved))
    } else if module.entries().next().is_none() {
        Err(Problem::NoEntry)
    } else if !pointers.is_empty() {
        Err(Problem::Pointers(pointers))
    } else if let Some(function) = recursive {
        Err(Problem::Recursion(function.name.to_string()))
    } else if !forbidden.is_empty() {
        Err(Problem::Forbidden(forbidden))
    } else {
        Ok(())
    }
}

/// Instructions and registers of a module that OptiX accepts, but that do something else than they seem to, each with
/// the function that has it.
///
/// ```
/// let text = ".visible .entry __miss__x()\n{\n\tmov.u32 %r1, %tid.x;\n}\n";
/// assert_eq!(optix_toolchain::ptx::suspicious(text)[0].what, "%tid.x");
/// ```
pub fn suspicious(text: &str) -> Vec<Forbidden> {
    let text = optix_ptx::plain(text);
    let found = forbidden::forbidden(&Module::read(&text));
    found.into_iter().filter(|one| !one.why.is_error()).collect()
}

/// The entries and functions that keep values in local memory, which is slower than registers, with the bytes.
///
/// ```
/// let text = ".visible .entry __miss__x()\n{\n\t.local .align 4 .b8 \t__local_depot0[16];\n\tret;\n}\n";
/// assert_eq!(optix_toolchain::ptx::local_memory(text), [("__miss__x".to_string(), 16)]);
/// ```
pub fn local_memory(text: &str) -> Vec<(String, usize)> {
    let text = optix_ptx::plain(text);
    let module = Module::read(&text);
    let functions = module.defined();
    functions.filter_map(|function| Some((function.name.to_string(), function.local_memory()?))).collect()
}

/// The Rust path of a function. LLVM writes the dots of a symbol, which PTX does not allow, as `_$_`.
#[cfg(feature = "cli")]
pub(crate) fn demangled(symbol: &str) -> String {
    format!("{:#}", rustc_demangle::demangle(&symbol.replace("_$_", ".")))
}

/// Whether a call gives the address of a callable.
pub(crate) fn is_callable_call(call: &Call<'_>) -> bool {
    matches!(call.function, DIRECT | CONTINUATION)
}

/// Whether a function calls others through pointers. One that asks OptiX for the address of a callable may do so.
fn calls_pointers(function: &Function<'_>) -> bool {
    let calls = function.calls();
    calls.iter().any(|call| call.function.starts_with('%')) && !calls.iter().any(is_callable_call)
}

/// Whether a function calls itself, directly or through others, and also calls device functions.
fn is_recursive(module: &Module<'_>, function: &Function<'_>) -> bool {
    let reached = module.reached(function.name);
    let calls = |is: &dyn Fn(&str) -> bool| reached.iter().flat_map(|f| f.calls()).any(|call| is(call.function));
    calls(&|name| name == function.name) && calls(&|name| name.starts_with("_optix_"))
}

/// What the OptiX and CUDA run times define: device functions, `printf` and `assert`.
fn provided(name: &str) -> bool {
    name.starts_with("_optix_") || matches!(name, "vprintf" | "__assertfail")
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = ".version 6.3\n.target sm_75, debug\n.address_size 64\n";

    #[test]
    fn unresolved_names_are_named() {
        let text = format!(
            "{HEAD}.extern .func  (.param .align 16 .b8 func_retval0[16]) __udivti3\n(\n)\n;\n\
             .extern .global .align 4 .b8 TABLE[64];\n.visible .entry __raygen__a()\n{{\n}}\n"
        );
        let problem = check(&Module::read(&text)).expect_err("unresolved");
        assert_eq!(problem, Problem::Unresolved(vec!["__udivti3".into(), "TABLE".into()]));
    }

    #[test]
    fn a_module_needs_an_entry() {
        assert_eq!(check(&Module::read(HEAD)), Err(Problem::NoEntry));
        assert_eq!(check(&Module::read("")), Err(Problem::NotPtx));
    }
}
