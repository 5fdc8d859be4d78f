//! Instructions that OptiX forbids or gives another meaning.
//!
//! A thread that runs a program may move to another warp or multiprocessor at any moment (guide 6.2), so a program
//! can't rely on the threads beside it. No function of the device crate does, but inline assembly may.

use std::fmt;

use optix_ptx::{Function, Instruction, Module, Parts, Statement, operands};

/// An instruction that OptiX does not run as it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Forbidden {
    /// The function that it is in.
    pub function: String,
    /// The name of the instruction, register or variable.
    pub what: String,
    /// The rule.
    pub why: Why,
}

/// Why an instruction is not run as it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Why {
    /// An atomic on local memory.
    LocalAtomic,
    /// Shared memory, or copies to it.
    SharedMemory,
    /// A barrier, or an instruction of a whole warp or block.
    Together,
    /// A special register that does not exist in OptiX.
    NoRegister,
    /// A special register to which OptiX gives another value.
    ReplacedRegister,
    /// An instruction or register that tells what other threads of the warp do, or which thread or multiprocessor this
    /// is.
    Neighbours,
    /// A memory fence.
    Fence,
}

impl Why {
    /// Whether the module can't be used. If not, the author may have meant it.
    pub const fn is_error(self) -> bool {
        matches!(self, Self::LocalAtomic | Self::SharedMemory | Self::Together | Self::NoRegister)
    }

    /// The rule, and what to do instead.
    const fn text(self) -> &'static str {
        match self {
            Self::LocalAtomic => {
                "is an atomic on a variable of the program, in local memory, where PTX does not define it: no other thread \
                 sees the variable, so use `Cell` or a plain one; atomics are for memory behind views"
            }
            Self::SharedMemory => {
                "uses shared memory, which OptiX forbids, as a program may move to another multiprocessor at any time: keep the value in a \
                 variable, or in memory behind a view"
            }
            Self::Together => {
                "works together with other threads, which OptiX forbids, as threads of a warp or block need not run the same program: \
                 leave it out; threads share what is in memory behind views, by atomics"
            }
            Self::NoRegister => "is a register that is not there in OptiX: leave it out",
            Self::ReplacedRegister => {
                "has another meaning in OptiX, which gives the launch index and dimensions for thread and block: use `launch_index()` and \
                 `launch_dimensions()`"
            }
            Self::Neighbours => {
                "says something of the thread's place or neighbours, which change at any time in OptiX: nothing that is computed may depend \
                 on it"
            }
            Self::Fence => {
                "is a memory fence, which OptiX does not support: use `Ordering::Relaxed`; other launch indices may see writes only after \
                 the launch"
            }
        }
    }
}

impl fmt::Display for Forbidden {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` {}", self.what, self.why.text())
    }
}

/// Everything in a module that OptiX forbids or gives another meaning, once for each function and name.
pub fn forbidden(module: &Module<'_>) -> Vec<Forbidden> {
    let mut found: Vec<Forbidden> = Vec::new();
    let mut add = |function: &str, what: &str, why| {
        let one = Forbidden { function: function.to_string(), what: what.to_string(), why };
        if !found.contains(&one) {
            found.push(one);
        }
    };
    for variable in module.variables.iter().filter(|variable| variable.space == "shared") {
        add("the module", variable.name, Why::SharedMemory);
    }
    for function in module.defined() {
        let mut before = None;
        for statement in function.statements() {
            let is_ours = before.is_some_and(reads_exception_detail);
            before = Some(statement);
            match statement {
                Statement::Directive(directive) if directive.split_whitespace().next() == Some(".shared") => {
                    add(function.name, directive, Why::SharedMemory);
                }
                Statement::Instruction(instruction) => {
                    if let Some(why) = of_operation(instruction).filter(|why| *why != Why::Fence || !is_ours) {
                        add(function.name, instruction.op, why);
                    }
                    for (register, why) in registers(function, instruction) {
                        add(function.name, register, why);
                    }
                }
                _ => {}
            }
        }
    }
    for (function, atomic) in optix_ptx::local_atomics(module) {
        add(function.name, atomic.op, Why::LocalAtomic);
    }
    found
}

/// Whether a statement reads a detail of an exception. The device crate puts a fence behind it, which is for the
/// driver's compiler and not for memory.
fn reads_exception_detail(statement: &Statement<'_>) -> bool {
    let call = match statement {
        Statement::Instruction(instruction) => Parts::of(instruction),
        _ => None,
    };
    call.is_some_and(|call| call.function.starts_with("_optix_get_exception_detail_"))
}

fn of_operation(instruction: &Instruction<'_>) -> Option<Why> {
    let mut parts = instruction.op.split('.');
    let name = parts.next()?;
    // `ld.shared`, `cvta.to.shared`, `red.async.shared::cluster`.
    if parts.clone().any(|part| part == "shared" || part.starts_with("shared::")) {
        return Some(Why::SharedMemory);
    }
    match name {
        "bar"
        | "barrier"
        | "mbarrier"
        | "redux"
        | "shfl"
        | "elect"
        | "setmaxnreg"
        | "griddepcontrol"
        | "clusterlaunchcontrol"
        | "wmma"
        | "mma"
        | "wgmma"
        | "tcgen05"
        | "multimem" => Some(Why::Together),
        "ldmatrix" | "stmatrix" | "mapa" | "getctarank" => Some(Why::SharedMemory),
        "cp" if parts.any(|part| part == "async") => Some(Why::SharedMemory),
        "vote" | "match" | "activemask" => Some(Why::Neighbours),
        "fence" | "membar" => Some(Why::Fence),
        _ => None,
    }
}

/// The special registers that an instruction reads.
fn registers<'a>(function: &Function<'a>, instruction: &Instruction<'a>) -> Vec<(&'a str, Why)> {
    // LLVM and people choose names freely, so a name that is declared in the text is no special register.
    let is_declared = |register: &str| {
        function.statements().iter().any(|statement| match statement {
            Statement::Directive(directive) if directive.starts_with(".reg") => {
                directive.split([',', ' ', '\t']).any(|name| name == register)
            }
            _ => false,
        })
    };
    let read = operands(instruction.operands).into_iter().filter_map(|operand| Some((operand, of_register(operand)?)));
    read.filter(|(register, _)| !is_declared(register)).collect()
}

fn of_register(register: &str) -> Option<Why> {
    let name = register.strip_prefix('%')?.split('.').next()?;
    let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
    let is_numbered = |prefix: &str| {
        let number = name.strip_prefix(prefix);
        number.is_some_and(|number| number.starts_with(|c: char| c.is_ascii_digit()))
    };
    match name {
        "tid" | "ntid" | "ctaid" | "nctaid" => Some(Why::ReplacedRegister),
        "laneid" | "warpid" | "nwarpid" | "smid" | "nsmid" | "gridid" => Some(Why::Neighbours),
        "total_smem_size" | "dynamic_smem_size" | "aggr_smem_size" | "is_explicit_cluster" => Some(Why::NoRegister),
        _ if starts(&["lanemask_"]) => Some(Why::Neighbours),
        _ if starts(&["reserved_smem_", "cluster", "ncluster"]) || is_numbered("pm") || is_numbered("envreg") => {
            Some(Why::NoRegister)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(line: &str) -> Vec<(String, Why)> {
        let text = format!(".version 7.0\n.target sm_75\n.visible .entry __raygen__a()\n{{\n{line}\nret;\n}}\n");
        forbidden(&Module::read(&text)).into_iter().map(|one| (one.what, one.why)).collect()
    }

    #[test]
    fn every_family_is_found() {
        for (line, what, why) in [
            ("bar.sync 0;", "bar.sync", Why::Together),
            ("@%p1 barrier.cluster.arrive;", "barrier.cluster.arrive", Why::Together),
            ("shfl.sync.idx.b32 %r1|%p1, %r2, 0, 31, -1;", "shfl.sync.idx.b32", Why::Together),
            ("redux.sync.add.s32 %r1, %r2, -1;", "redux.sync.add.s32", Why::Together),
            ("wgmma.fence.sync.aligned;", "wgmma.fence.sync.aligned", Why::Together),
            (
                "mma.sync.aligned.m16n8k8.row.col.f32 {%r1}, {%r2};",
                "mma.sync.aligned.m16n8k8.row.col.f32",
                Why::Together,
            ),
            ("st.shared.b32 [%r1], %r2;", "st.shared.b32", Why::SharedMemory),
            ("atom.shared::cta.add.u32 %r1, [%r2], 1;", "atom.shared::cta.add.u32", Why::SharedMemory),
            ("cvta.to.shared.u64 %rd1, %rd2;", "cvta.to.shared.u64", Why::SharedMemory),
            ("mbarrier.init.shared.b64 [%rd1], 1;", "mbarrier.init.shared.b64", Why::SharedMemory),
            (".shared .align 4 .b8 pad[16];", ".shared .align 4 .b8 pad[16]", Why::SharedMemory),
            ("cp.async.wait_all;", "cp.async.wait_all", Why::SharedMemory),
            ("vote.sync.ballot.b32 %r1, %p1, -1;", "vote.sync.ballot.b32", Why::Neighbours),
            ("match.any.sync.b32 %r1, %r2, -1;", "match.any.sync.b32", Why::Neighbours),
            ("activemask.b32 %r1;", "activemask.b32", Why::Neighbours),
            ("fence.sc.sys;", "fence.sc.sys", Why::Fence),
            ("membar.gl;", "membar.gl", Why::Fence),
            ("call (%r9), _optix_get_exception_code, (); membar.cta;", "membar.cta", Why::Fence),
            ("mov.u32 %r1, %tid.x;", "%tid.x", Why::ReplacedRegister),
            ("mad.lo.u32 %r1, %ctaid.x, %ntid.x, %r2;", "%ctaid.x", Why::ReplacedRegister),
            ("mov.u32 %r1, %laneid;", "%laneid", Why::Neighbours),
            ("mov.u32 %r1, %lanemask_lt;", "%lanemask_lt", Why::Neighbours),
            ("mov.u32 %r1, %smid;", "%smid", Why::Neighbours),
            ("mov.u32 %r1, %pm0;", "%pm0", Why::NoRegister),
            ("mov.b32 %r1, %envreg31;", "%envreg31", Why::NoRegister),
            ("mov.u32 %r1, %dynamic_smem_size;", "%dynamic_smem_size", Why::NoRegister),
            ("mov.u32 %r1, %cluster_ctaid.x;", "%cluster_ctaid.x", Why::NoRegister),
        ] {
            assert!(found(line).contains(&(what.to_string(), why)), "{line}: {:?}", found(line));
        }
    }

    #[test]
    fn what_is_allowed_is_not() {
        for line in [
            "call (%r9), _optix_get_exception_detail_0, (); membar.cta;",
            "mov.u64 %rd1, %clock64;",
            "mov.u64 %rd1, %globaltimer;",
            "atom.global.add.u32 %r1, [%rd1], 1;",
            "ld.global.b32 %r1, [%rd1];",
            ".reg .b32 %smid; mov.b32 %r1, %smid;",
            ".reg .pred %pm, %pm_x; mov.pred %pm_x, %p1;",
            "cp.reduce.x; bra $L_bar; $L_bar: call bar, (%r1);",
            "st.local.b32 [%SP], %r1; prefetch.global.L1 [%rd1];",
        ] {
            assert_eq!(found(line), [], "{line}");
        }
    }

    #[test]
    fn shared_variables_are_found() {
        let module = Module::read(".version 7.0\n.target sm_75\n.extern .shared .align 4 .b8 pool[];\n");
        let found = forbidden(&module);
        assert_eq!((found[0].function.as_str(), found[0].what.as_str()), ("the module", "pool"));
    }
}
