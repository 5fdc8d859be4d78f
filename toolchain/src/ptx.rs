//! What a PTX file holds, and whether OptiX could load it.

#[cfg_attr(not(feature = "cli"), allow(dead_code, reason = "a build script asks for local memory only"))]
pub(crate) mod body;
#[cfg(feature = "cli")]
pub(crate) mod calls;
pub(crate) mod ftz;

use std::fmt;

/// The names in a PTX module.
///
/// ```
/// let module = optix_toolchain::ptx::Module::read(".version 6.3\n.target sm_75\n.visible .entry __raygen__x()\n{\n}\n")?;
/// assert_eq!(module.entries, ["__raygen__x"]);
/// # Ok::<(), optix_toolchain::ptx::Problem>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Module<'a> {
    /// The entry points: programs that OptiX starts, and callables, which are functions in PTX.
    pub entries: Vec<&'a str>,
    /// The functions that were not inlined.
    pub functions: Vec<&'a str>,
    /// `.version`, such as `6.3`.
    pub version: &'a str,
    /// `.target`, such as `sm_75`.
    pub target: &'a str,
}

/// Why OptiX could not load a PTX module.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Problem {
    /// It has no entry point.
    NoEntry,
    /// It calls or reads what is defined nowhere.
    Unresolved(Vec<String>),
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
            Self::NotPtx => f.write_str("this is no PTX; `.version` or `.target` is missing"),
        }
    }
}

impl std::error::Error for Problem {}

impl<'a> Module<'a> {
    /// Reads the declarations and checks them.
    pub fn read(text: &'a str) -> Result<Self, Problem> {
        let mut module = Self { entries: Vec::new(), functions: Vec::new(), version: "", target: "" };
        let mut unresolved = Vec::new();
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            // Declarations start at the left margin; instructions and inline assembly that is a call do not matter.
            if let Some(version) = line.strip_prefix(".version ") {
                module.version = version.trim();
            } else if let Some(target) = line.strip_prefix(".target ") {
                module.target = target.split(',').next().unwrap_or_default().trim();
            } else if let Some((_, rest)) = line.split_once(".entry ") {
                module.entries.push(identifier(rest));
            } else if line.starts_with(".extern ") {
                let name = extern_name(line, &mut lines);
                if !provided(name) {
                    unresolved.push(name.to_string());
                }
            } else if let Some((before, rest)) = line.split_once(".func") {
                let is_declaration = line.trim_end().ends_with(';');
                if (before.is_empty() || before.starts_with('.')) && !is_declaration {
                    let name = function_name_on(rest, &mut lines);
                    let names = if is_callable(name) { &mut module.entries } else { &mut module.functions };
                    names.push(name);
                }
            }
        }
        // LLVM declares a function before its first use as well as where it defines it.
        module.functions.sort_unstable();
        module.functions.dedup();
        if module.version.is_empty() || module.target.is_empty() {
            Err(Problem::NotPtx)
        } else if !unresolved.is_empty() {
            Err(Problem::Unresolved(unresolved))
        } else if module.entries.is_empty() {
            Err(Problem::NoEntry)
        } else {
            Ok(module)
        }
    }
}

/// The entries and functions that keep something in local memory, with the bytes: memory where registers should be.
///
/// ```
/// let text = ".visible .entry __miss__x()\n{\n\t.local .align 4 .b8 \t__local_depot0[16];\n\tret;\n}\n";
/// assert_eq!(optix_toolchain::ptx::local_memory(text), [("__miss__x".to_string(), 16)]);
/// ```
pub fn local_memory(text: &str) -> Vec<(String, usize)> {
    let text = body::plain(text);
    let bodies = body::bodies(&text);
    bodies.iter().filter_map(|body| Some((body.name.to_string(), body.local_memory()?))).collect()
}

/// Whether a function is a callable, by OptiX's prefixes.
pub(crate) fn is_callable(name: &str) -> bool {
    name.starts_with("__direct_callable__") || name.starts_with("__continuation_callable__")
}

/// What the OptiX and CUDA run times define: device functions, `printf` and `assert`.
fn provided(name: &str) -> bool {
    name.starts_with("_optix_") || matches!(name, "vprintf" | "__assertfail")
}

/// `.extern .func  (.param .b32 func_retval0) name` or `.extern .global .align 4 .b8 name[];`
fn extern_name<'a>(line: &'a str, lines: &mut std::str::Lines<'a>) -> &'a str {
    match line.split_once(".func") {
        Some((_, rest)) => function_name_on(rest, lines),
        None => identifier(line.split_whitespace().next_back().unwrap_or_default()),
    }
}

/// [`function_name`], which may be on the next line.
fn function_name_on<'a>(rest: &'a str, lines: &mut std::str::Lines<'a>) -> &'a str {
    match function_name(rest) {
        "" => identifier(lines.next().unwrap_or_default().trim_start()),
        name => name,
    }
}

/// The name after `.func` or `.entry`: behind the result's parentheses, if there are any.
fn function_name(rest: &str) -> &str {
    let rest = rest.trim_start();
    let rest = if rest.starts_with('(') { rest.split_once(')').map_or("", |(_, name)| name) } else { rest };
    identifier(rest.trim_start())
}

fn identifier(text: &str) -> &str {
    let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '$' | '%' | '.');
    &text[..text.find(|c| !is_part(c)).unwrap_or(text.len())]
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = ".version 6.3\n.target sm_75, debug\n.address_size 64\n";

    #[test]
    fn names_are_found() {
        let text = format!(
            "{HEAD}.extern .func  (.param .b32 func_retval0) vprintf\n(\n)\n;\n\
             .func  (.param .b32 func_retval0) slow_path(\n\t.param .b32 a\n)\n{{\n}}\n\
             .visible .func  (.param .b32 func_retval0) __direct_callable__b(\n\t.param .b32 a\n)\n{{\n}}\n\
             .visible .entry __raygen__a(\n)\n{{\n\tcall (%r1), _optix_get_launch_index_x, ();\n}}\n"
        );
        let module = Module::read(&text).expect("valid");
        assert_eq!(module.entries, ["__direct_callable__b", "__raygen__a"]);
        assert_eq!(module.functions, ["slow_path"]);
        assert_eq!((module.version, module.target), ("6.3", "sm_75"));
    }

    #[test]
    fn unresolved_names_are_named() {
        let text = format!(
            "{HEAD}.extern .func  (.param .align 16 .b8 func_retval0[16]) __udivti3\n(\n)\n;\n\
             .extern .global .align 4 .b8 TABLE[64];\n.visible .entry __raygen__a()\n{{\n}}\n"
        );
        let problem = Module::read(&text).expect_err("unresolved");
        assert_eq!(problem, Problem::Unresolved(vec!["__udivti3".into(), "TABLE".into()]));
    }

    #[test]
    fn a_module_needs_an_entry() {
        assert_eq!(Module::read(HEAD), Err(Problem::NoEntry));
        assert_eq!(Module::read(""), Err(Problem::NotPtx));
    }
}
