//! Prints metadata: which functions are kernels, the version of the format, loops, lines, and what instructions refer
//! to.

use std::collections::BTreeSet;

use super::{Printer, values};
use crate::Dialect;

impl Printer<'_> {
    pub(super) fn metadata(&mut self) {
        let module = self.module;
        // The nodes that are attached to instructions, and the nodes that those refer to.
        let instructions = module.functions.iter().flat_map(|f| &f.blocks).flat_map(|block| &block.instructions);
        let attached = instructions.flat_map(|instruction| &instruction.metadata);
        let mut waiting: Vec<&str> = attached
            .filter(|(name, _)| !matches!(&**name, "noundef" | "dbg"))
            .map(|(_, node)| node.trim_start_matches('!'))
            .collect();
        let mut used = BTreeSet::new();
        while let Some(name) = waiting.pop() {
            if let Some(text) = module.metadata.get(name)
                && used.insert(name)
            {
                waiting.extend(references(text));
            }
        }
        for name in used {
            self.say(format_args!("!{name} = {}", module.metadata[name]));
        }

        let mut number = self.node + 1;
        // rustc has unrolled the loops that were worth it. More unrolling would copy device functions, and OptiX cuts a
        // program in two at each call of `trace`.
        if !self.loops.is_empty() {
            let mut nodes: Vec<u64> = self.loops.values().copied().collect();
            nodes.sort_unstable();
            for node in nodes {
                self.say(format_args!("!{node} = distinct !{{!{node}, !{number}}}"));
            }
            self.say(format_args!("!{number} = !{{!\"llvm.loop.unroll.disable\"}}"));
            number += 1;
        }
        let lines = self.debug.lines();
        let version = match self.dialect {
            Dialect::Llvm7 if lines.is_empty() => "i32 2, i32 0",
            Dialect::Llvm7 => "i32 2, i32 0, i32 3, i32 1",
            Dialect::Modern => "i32 2, i32 0, i32 3, i32 2",
        };
        lines.iter().for_each(|line| self.say(line));
        self.say(format_args!("!nvvmir.version = !{{!{number}}}"));
        self.say(format_args!("!{number} = !{{{version}}}"));

        let mut kernels = Vec::new();
        for kernel in module.functions.iter().filter(|function| function.kernel && !function.blocks.is_empty()) {
            number += 1;
            let pointer = self.pointer_to(&self.signature(kernel), 0);
            self.say(format_args!("!{number} = !{{{pointer} {}, !\"kernel\", i32 1}}", values::global(&kernel.name)));
            kernels.push(format!("!{number}"));
        }
        if !kernels.is_empty() {
            self.say(format_args!("!nvvm.annotations = !{{{}}}", kernels.join(", ")));
        }
    }
}

/// The numbers in `!{!5, !"text", !6}`.
fn references(text: &str) -> impl Iterator<Item = &str> {
    text.split('!').skip(1).filter_map(|rest| {
        let number = &rest[..rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len())];
        (!number.is_empty()).then_some(number)
    })
}
