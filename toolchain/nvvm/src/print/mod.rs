//! Prints a lowered [`Module`] as the text that libNVVM reads.

mod debug;
mod instructions;
mod metadata;
mod types;
mod values;

use std::collections::{HashMap, HashSet};
use std::fmt::Write;

use super::Dialect;
use super::refusal::Refusal;
use debug::Debug;
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Argument, Function, Instruction, Module, Op, Variable};

/// NVVM's data layout. That of rustc agrees with it.
const LAYOUT: &str = "e-p:64:64:64-i1:8:8-i8:8:8-i16:16:16-i32:32:32-i64:64:64-i128:128:128-f32:32:32-f64:64:64-v16:16:16-\
                      v32:32:32-v64:64:64-v128:128:128-n16:32:64";

/// Prints the module. `text` is the text that it was read from.
pub(super) fn module(module: &Module, dialect: Dialect, text: &str) -> Result<String, Refusal> {
    let numbers = module.metadata.keys().chain(module.debug.keys()).filter_map(|name| name.parse::<u64>().ok());
    let node = numbers.max().unwrap_or(0);
    let mut printer = Printer {
        module,
        dialect,
        functions: module.functions.iter().map(|function| (function.name.as_str(), function)).collect(),
        variables: module.variables.iter().map(|variable| (variable.name.as_str(), variable)).collect(),
        out: String::new(),
        count: 0,
        line: 0,
        node: node.saturating_add(debug::NUMBERS),
        debug: Debug::new(module, dialect, node.saturating_add(1)),
        loops: HashMap::new(),
        before: HashSet::new(),
    };
    printer.head().map_err(|unknown| Refusal::of(unknown, text, usize::MAX, ""))?;
    for function in &module.functions {
        printer.line = function.line;
        printer.function(function).map_err(|unknown| Refusal::of(unknown, text, printer.line, &function.name))?;
    }
    printer.metadata();
    Ok(printer.out)
}

struct Printer<'m> {
    module: &'m Module,
    dialect: Dialect,
    functions: HashMap<&'m str, &'m Function>,
    variables: HashMap<&'m str, &'m Variable>,
    out: String,
    /// Counts the names that are made here.
    count: usize,
    /// The line of the source that is being printed.
    line: usize,
    /// The last number that was given to a metadata node.
    node: u64,
    /// The line information of functions and instructions.
    debug: Debug<'m>,
    /// The metadata of each loop, by the function and the loop's first block.
    loops: HashMap<(&'m str, &'m str), u64>,
    /// The blocks of the function that have been printed.
    before: HashSet<&'m str>,
}

type Printed<T = String> = Result<T, Unknown>;

impl<'m> Printer<'m> {
    /// Appends a line. Writing to a string does not fail.
    fn say(&mut self, line: impl std::fmt::Display) {
        let _ = writeln!(self.out, "{line}");
    }

    /// A new name.
    fn fresh(&mut self) -> String {
        self.count += 1;
        format!("%p.{}", self.count)
    }

    fn head(&mut self) -> Printed<()> {
        self.say(format_args!("target datalayout = \"{LAYOUT}\""));
        self.say("target triple = \"nvptx64-nvidia-cuda\"");
        for line in &self.module.asm {
            self.say(format_args!("module asm \"{line}\""));
        }
        for (name, ty) in &self.module.types {
            let ty = ty.as_ref().map_or("opaque".to_string(), |ty| self.ty(ty));
            self.say(format_args!("{} = type {ty}", types::named(name)));
        }
        for variable in &self.module.variables {
            self.variable(variable)?;
        }
        Ok(())
    }

    fn variable(&mut self, variable: &Variable) -> Printed<()> {
        let mut line = format!("{} = ", values::global(&variable.name));
        if let Some(linkage) = &variable.linkage {
            let _ = write!(line, "{linkage} ");
        }
        if variable.unnamed_address {
            line.push_str("unnamed_addr ");
        }
        if variable.space != 0 {
            let _ = write!(line, "addrspace({}) ", variable.space);
        }
        line.push_str(if variable.constant { "constant " } else { "global " });
        line.push_str(&self.ty(&variable.ty));
        if let Some(value) = &variable.value {
            let _ = write!(line, " {}", self.value(&variable.ty, value)?);
        }
        if let Some(section) = &variable.section {
            let _ = write!(line, ", section \"{section}\"");
        }
        if let Some(align) = variable.align {
            let _ = write!(line, ", align {align}");
        }
        self.say(line);
        Ok(())
    }

    fn function(&mut self, function: &'m Function) -> Printed<()> {
        let declared = function.blocks.is_empty();
        let mut line = String::from(if declared { "declare " } else { "define " });
        if let Some(linkage) = &function.linkage {
            let _ = write!(line, "{linkage} ");
        }
        let _ = write!(line, "{} {}(", self.ty(&function.result), self.function_name(&function.name));
        let mut copies = Vec::new();
        for (at, parameter) in function.parameters.iter().enumerate() {
            line.push_str(if at == 0 { "" } else { ", " });
            line.push_str(&self.parameter(parameter, declared, &mut copies)?);
        }
        if function.variadic {
            line.push_str(if function.parameters.is_empty() { "..." } else { ", ..." });
        }
        line.push(')');
        line.push_str(&self.attributes(&function.attributes));
        if declared {
            self.say(line);
            return Ok(());
        }
        line.push_str(&self.debug.attachment("", function.debug.as_deref()));
        self.say(format_args!("{line} {{"));
        self.before.clear();
        for (at, block) in function.blocks.iter().enumerate() {
            self.before.insert(&block.name);
            self.say(format_args!("{}:", values::local(&block.name).trim_start_matches('%')));
            if at == 0 {
                for copy in copies.drain(..) {
                    self.say(copy);
                }
            }
            for instruction in &block.instructions {
                self.line = instruction.line;
                self.instruction(instruction, &function.name)?;
            }
        }
        self.say("}");
        Ok(())
    }

    /// A parameter. `copies` gets the conversion of one that is passed by value to a pointer without pointee.
    fn parameter(&mut self, parameter: &Argument, declared: bool, copies: &mut Vec<String>) -> Printed {
        let name = if declared { String::new() } else { format!(" {}", self.untyped(&parameter.value.value)?) };
        let words = self.value_attributes(parameter);
        Ok(match (&parameter.by_value, self.dialect) {
            (Some(ty), Dialect::Llvm7) => {
                let ty = self.ty(ty);
                let raw = if declared { String::new() } else { self.fresh() };
                copies.push(format!("{name} = bitcast {ty}* {raw} to i8*"));
                format!("{ty}*{words} byval{} {raw}", align(parameter))
            }
            (Some(ty), Dialect::Modern) => {
                format!("ptr{words} byval({}){}{name}", self.ty(ty), align(parameter))
            }
            _ => format!("{}{words}{name}", self.ty(&parameter.value.ty)),
        })
    }

    /// Attributes of a parameter, with a space before each.
    fn value_attributes(&self, argument: &Argument) -> String {
        // LLVM 7 does not know the first of these, modern LLVM not the second.
        let unknown = match self.dialect {
            Dialect::Llvm7 => "noundef",
            Dialect::Modern => "nocapture",
        };
        argument.attributes.iter().filter(|word| *word != unknown).map(|word| format!(" {word}")).collect()
    }

    /// Attributes of a function, with a space before each.
    fn attributes(&self, words: &[String]) -> String {
        let modern = |word: &str| match word {
            "readnone" => Some("memory(none)".to_string()),
            "readonly" if !words.iter().any(|word| word.ends_with("memonly")) => Some("memory(read)".to_string()),
            "readonly" | "argmemonly" | "inaccessiblememonly" => None,
            word => Some(word.to_string()),
        };
        let words = words.iter().filter_map(|word| match self.dialect {
            Dialect::Llvm7 => Some(word.clone()),
            Dialect::Modern => modern(word),
        });
        words.map(|word| format!(" {word}")).collect()
    }

    fn instruction(&mut self, instruction: &'m Instruction, function: &'m str) -> Printed<()> {
        let result = instruction.result.as_deref().map(values::local);
        let mut text = self.op(&instruction.op)?;
        if matches!(instruction.op, Op::Load { .. } | Op::Store { .. }) {
            for (name, node) in instruction.metadata.iter().filter(|(name, _)| !matches!(&**name, "noundef" | "dbg")) {
                let _ = write!(text, ", !{name} {node}");
            }
        }
        if let Op::Jump(_) | Op::Branch { .. } = &instruction.op
            && let Some(first) = instruction.op.successors().into_iter().find(|to| self.before.contains(to))
        {
            let node = self.node + 1;
            let node = *self.loops.entry((function, first)).or_insert(node);
            self.node = self.node.max(node);
            let _ = write!(text, ", !llvm.loop !{node}");
        }
        let source = instruction.metadata.iter().find(|(name, _)| name == "dbg").map(|(_, node)| node.as_str());
        text.push_str(&self.debug.attachment(",", source));
        match result {
            Some(result) => self.say(format_args!("  {result} = {text}")),
            None => self.say(format_args!("  {text}")),
        }
        Ok(())
    }
}

/// ` align 8`, or nothing.
fn align(argument: &Argument) -> String {
    argument.align.map(|align| format!(" align {align}")).unwrap_or_default()
}
