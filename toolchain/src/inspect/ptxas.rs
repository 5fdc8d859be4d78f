//! Registers and spills, from NVIDIA's assembler.
//!
//! `ptxas` refuses OptiX's device functions: they are declared nowhere, and several of their results have no calling
//! convention. So each call is replaced by instructions that need the same registers: a store of each argument to
//! shared memory, and a load of each result from there. They are volatile, so that none of them is dropped or merged.
//! (Their addresses are constants and need no register.)
//!
//! The numbers of registers are therefore those of the program's own code. What OptiX needs is different: it splits a
//! program at each trace and call, keeps what lives across them on the stack, and adds its own traversal. The figures
//! are for comparing two builds of a program; the compile log of OptiX tells what it used.

use std::collections::HashMap;
use std::ffi::OsString;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use optix_ptx::{Instruction, Module, Parts, Statement, operands};

use crate::cache::cache;
use crate::error::{Doing, Error};
use crate::ptx::demangled;
use crate::util;

/// What `ptxas` says of a program on one architecture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// The entry's name, or the function's Rust path.
    pub program: String,
    /// Registers per thread; a function that is called has none of its own.
    pub registers: Option<usize>,
    /// Bytes of stack.
    pub stack: usize,
    /// Bytes stored to local memory for lack of registers.
    pub spill_stores: usize,
    /// Bytes loaded from there.
    pub spill_loads: usize,
}

/// An installed `ptxas`.
#[derive(Clone, Debug)]
pub struct Ptxas {
    /// The program to run.
    pub program: PathBuf,
    /// Its version, as `13.0, V13.0.88`.
    pub version: String,
}

impl Ptxas {
    /// Where to get it.
    pub const MISSING: &str = "it is in the CUDA toolkit, and `cargo optix setup --nvvm` installs it";

    /// The one that `OPTIX_PTXAS` names, or in `PATH`, a CUDA toolkit, what `cargo optix setup --nvvm`
    /// installed, or the wheel `nvidia-cuda-nvcc`.
    pub fn find() -> Option<Self> {
        if let Some(chosen) = std::env::var_os("OPTIX_PTXAS").filter(|chosen| !chosen.is_empty()) {
            return Self::at(chosen);
        }
        let roots = ["CUDA_HOME", "CUDA_PATH", "CUDA_ROOT"].into_iter().filter_map(std::env::var_os).map(PathBuf::from);
        let roots = roots.chain(["/usr/local/cuda".into(), "/opt/cuda".into()]);
        let toolkits = roots.map(|root| root.join("bin/ptxas").into_os_string());
        let found = std::iter::once(OsString::from("ptxas")).chain(toolkits).find_map(Self::at);
        let cached = || {
            let programs = cache().map(|cache| optix_nvvm::cached(&cache, "bin/ptxas")).unwrap_or_default();
            programs.into_iter().find_map(|path| Self::at(path.into_os_string()))
        };
        found.or_else(cached).or_else(|| wheels().into_iter().find_map(|path| Self::at(path.into_os_string())))
    }

    fn at(program: OsString) -> Option<Self> {
        let output = Command::new(&program).arg("--version").output().ok()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let version = text.lines().find_map(|line| line.split_once("release "))?.1.trim().to_string();
        Some(Self { program: program.into(), version })
    }

    /// Assembles `ptx` for `arch`, which is no older than the PTX's target. `area` is a folder for temporary files.
    ///
    /// # Errors
    /// What `ptxas` says where it does not assemble it.
    pub fn usage(&self, ptx: &str, arch: &str, area: &Path) -> Result<Vec<Usage>, Error> {
        let folder = area.join("inspect");
        util::create_dir(&folder)?;
        // Several processes may run at a time, so the name of the file is unique.
        let name = util::hash([ptx, arch, &std::process::id().to_string()]);
        let (input, cubin) = (folder.join(format!("{name}.ptx")), folder.join(format!("{name}.cubin")));
        std::fs::write(&input, stand_in(ptx)).doing(|| format!("cannot write {}", input.display()))?;
        let output = Command::new(&self.program).args(["-v", "-arch", arch]).arg(&input).arg("-o").arg(&cubin).output();
        for file in [&input, &cubin] {
            let _ = std::fs::remove_file(file);
        }
        let output = output.doing(|| format!("cannot run {}", self.program.display()))?;
        let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        if !output.status.success() {
            let reason =
                text.lines().find(|line| line.contains("error") || line.contains("fatal")).unwrap_or("it fails");
            return Err(Error::Output { of: format!("ptxas for {arch}"), reason: reason.trim().to_string() });
        }
        Ok(usages(&text))
    }
}

/// `ptxas` in the wheels of the Python in use: `nvidia/cu13/bin`, and `nvidia/cuda_nvcc/bin` before CUDA 13.
fn wheels() -> Vec<PathBuf> {
    let script =
        "import nvidia, glob; print(*(f for p in nvidia.__path__ for f in glob.glob(p + '/cu*/bin/ptxas')), sep='\\n')";
    let output = Command::new("python3").args(["-c", script]).output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().map(PathBuf::from).collect()
}

/// Reads the messages of `-v`.
fn usages(text: &str) -> Vec<Usage> {
    let mut usages: Vec<Usage> = Vec::new();
    for line in text.lines() {
        let number_before = |word: &str| line.split_once(word)?.0.split([' ', ',']).next_back()?.parse().ok();
        if let Some((_, name)) = line.split_once("Function properties for ") {
            usages.push(Usage { program: demangled(name.trim()), ..Usage::default() });
        }
        let Some(usage) = usages.last_mut() else { continue };
        if let Some(stack) = number_before(" bytes stack frame") {
            usage.stack = stack;
            usage.spill_stores = number_before(" bytes spill stores").unwrap_or(0);
            usage.spill_loads = number_before(" bytes spill loads").unwrap_or(0);
        }
        if let Some(registers) = number_before(" registers") {
            usage.registers = Some(registers);
        }
    }
    usages
}

/// The shared memory that stands for OptiX, and its size. A trace call has the most arguments: 15, and 32 payload
/// words.
const STAND_IN: &str = "optix_inspect_stand_in";
const STAND_IN_BYTES: usize = 512;

/// The module with every call of OptiX replaced, and without debug information.
fn stand_in(ptx: &str) -> String {
    let plain = optix_ptx::plain(ptx);
    let mut text = String::with_capacity(plain.len());
    let mut copied = 0;
    for function in Module::read(&plain).defined() {
        let mut registers = Registers::default();
        for statement in function.statements() {
            match statement {
                Statement::Directive(directive) => registers.declare(directive),
                Statement::Instruction(call) => {
                    let Some(stand_in) = stand_in_of(call, &registers) else { continue };
                    let first = if call.guard.is_empty() { call.op } else { call.guard };
                    let at = |part: &str| part.as_ptr() as usize - plain.as_ptr() as usize;
                    // The `@` of a guard belongs to the instruction.
                    let begin = at(first) - usize::from(!call.guard.is_empty());
                    text.push_str(&plain[copied..begin]);
                    text.push_str(&stand_in);
                    copied = at(call.operands) + call.operands.len();
                }
                Statement::Label(_) => {}
            }
        }
    }
    text.push_str(&plain[copied..]);

    let mut module = String::with_capacity(text.len());
    for line in text.lines() {
        match line.split_whitespace().next() {
            Some(".loc") => continue,
            Some(".section") => break, // debug information is the last thing in a file
            Some(".target") => module.push_str(line.split(", debug").next().unwrap_or_default()),
            Some(".address_size") => {
                let _ = write!(module, "{line}\n.shared .align 8 .b8 {STAND_IN}[{STAND_IN_BYTES}];");
            }
            _ => module.push_str(line),
        }
        module.push('\n');
    }
    module
}

/// Stores of the arguments and loads of the results of `call (%r1), _optix_x, (%r2)`, without the last `;`.
///
/// None if it is another instruction.
fn stand_in_of(call: &Instruction<'_>, registers: &Registers<'_>) -> Option<String> {
    let parts = Parts::of(call).filter(|parts| parts.function.starts_with("_optix_"))?;
    let guard = if call.guard.is_empty() { String::new() } else { format!("@{} ", call.guard) };
    let mut lines = Vec::new();
    for (i, argument) in parts.arguments.iter().enumerate() {
        let bits = registers.bits(argument);
        lines.push(format!("{guard}st.volatile.shared.b{bits} [{STAND_IN}+{}], {argument}", i * 8));
    }
    for (i, result) in parts.results.iter().enumerate() {
        let bits = registers.bits(result);
        lines.push(format!("{guard}ld.volatile.shared.b{bits} {result}, [{STAND_IN}+{}]", i * 8));
    }
    if lines.is_empty() {
        lines.push(format!("{guard}exit")); // `_optix_ignore_intersection` and the like do not return
    }
    Some(lines.join(";\n"))
}

/// The widths of the registers that have been declared. Names are valid within a block, so the last declaration holds.
#[derive(Default)]
struct Registers<'a>(HashMap<&'a str, &'a str>);

impl<'a> Registers<'a> {
    /// `.reg .b64 %rd<9>` or `.reg .f32 a, b`
    fn declare(&mut self, directive: &'a str) {
        let Some(declared) = directive.strip_prefix(".reg") else { return };
        let Some((kind, names)) = declared.trim().split_once(char::is_whitespace) else { return };
        for name in operands(names) {
            self.0.insert(name.split('<').next().unwrap_or(name), kind);
        }
    }

    fn bits(&self, operand: &str) -> usize {
        let kind = self.0.get(operand).or_else(|| self.0.get(operand.trim_end_matches(|c: char| c.is_ascii_digit())));
        if kind.is_some_and(|kind| kind.ends_with("64")) { 64 } else { 32 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PTX: &str = ".version 7.8\n.target sm_75, debug\n.address_size 64\n.visible .entry __raygen__a()\n{\n\
        \t.reg .b32 %r<3>;\n\t.reg .b64 %rd<2>;\n\t.loc 1 2 3\n\t@%p1 call (%rd1), _optix_a, ();\n\
        \t{ .reg .f32 f<2>; call (f0,f1),_optix_b,(%r1, 5); mov.b32 %r1, f0; }\n\tret;\n}\n\t.section .debug_str\n{\n}\n";

    #[test]
    fn calls_become_loads_and_stores() {
        assert_eq!(
            stand_in(PTX),
            ".version 7.8\n.target sm_75\n.address_size 64\n.shared .align 8 .b8 optix_inspect_stand_in[512];\n\
             .visible .entry __raygen__a()\n{\n\t.reg .b32 %r<3>;\n\t.reg .b64 %rd<2>;\n\
             \t@%p1 ld.volatile.shared.b64 %rd1, [optix_inspect_stand_in+0];\n\
             \t{ .reg .f32 f<2>; st.volatile.shared.b32 [optix_inspect_stand_in+0], %r1;\n\
             st.volatile.shared.b32 [optix_inspect_stand_in+8], 5;\n\
             ld.volatile.shared.b32 f0, [optix_inspect_stand_in+0];\n\
             ld.volatile.shared.b32 f1, [optix_inspect_stand_in+8]; mov.b32 %r1, f0; }\n\tret;\n}\n"
        );
    }

    #[test]
    fn messages_are_read() {
        let text = "ptxas info    : Compiling entry function '__raygen__a' for 'sm_75'\n\
            ptxas info    : Function properties for __raygen__a\n    16 bytes stack frame, 8 bytes spill stores, 12 bytes \
            spill loads\nptxas info    : Used 7 registers, used 0 barriers, 512 bytes smem, 352 bytes cmem[0]\n";
        let usage =
            Usage { program: "__raygen__a".into(), registers: Some(7), stack: 16, spill_stores: 8, spill_loads: 12 };
        assert_eq!(usages(text), [usage]);
    }
}
