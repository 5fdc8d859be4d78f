//! Finds the source that an instruction comes from.
//!
//! Line information tells for each instruction which functions were inlined, up to the function that it is in. After
//! that follow the functions that use this function, directly or through a table.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use crate::model::{DebugNode, Function, Instruction, Module};

/// A function that an instruction comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame<'m> {
    /// Its name, without its generic parameters.
    pub function: &'m str,
    /// The file.
    pub file: PathBuf,
    /// The line in it, from 1.
    pub line: u32,
}

/// The uses of symbols in a module.
pub struct Origins<'m> {
    debug: &'m BTreeMap<String, DebugNode>,
    /// The uses of each symbol, in the order of the text.
    uses: HashMap<&'m str, Vec<Use<'m>>>,
}

/// A use of a symbol.
#[derive(Clone, Copy)]
struct Use<'m> {
    /// The function or variable in which it is used.
    within: &'m str,
    /// The instruction; `None` in a variable.
    instruction: Option<&'m Instruction>,
}

impl<'m> Origins<'m> {
    pub fn new(module: &'m Module) -> Self {
        let mut uses: HashMap<&'m str, Vec<Use<'m>>> = HashMap::new();
        for variable in &module.variables {
            let of = Use { within: &variable.name, instruction: None };
            variable.value.iter().for_each(|value| value.globals(&mut |name| uses.entry(name).or_default().push(of)));
        }
        for (function, instruction) in module.instructions() {
            let of = Use { within: &function.name, instruction: Some(instruction) };
            instruction.op.values(&mut |value| value.globals(&mut |name| uses.entry(name).or_default().push(of)));
        }
        Self { debug: &module.debug, uses }
    }

    /// The functions that an instruction of `function` comes from, the innermost first: those that were inlined, and
    /// then those that use `function`.
    pub fn of(&self, function: &'m Function, instruction: &'m Instruction) -> Vec<Frame<'m>> {
        // An instruction may use several of the symbols, and functions may use each other, so each is visited once.
        let mut instructions = vec![instruction];
        let mut symbols = vec![function.name.as_str()];
        let mut at = 0;
        while let Some(symbol) = symbols.get(at) {
            for user in self.uses.get(symbol).into_iter().flatten() {
                let is_known = |user: &Instruction| instructions.iter().any(|known| std::ptr::eq(*known, user));
                instructions.extend(user.instruction.filter(|user| !is_known(user)));
                if !symbols.contains(&user.within) {
                    symbols.push(user.within);
                }
            }
            at += 1;
        }
        instructions.into_iter().flat_map(|instruction| self.inlined(instruction)).collect()
    }

    /// The functions that were inlined to make an instruction, up to the one that it is in.
    fn inlined(&self, instruction: &'m Instruction) -> Vec<Frame<'m>> {
        let mut frames = Vec::new();
        let attached = instruction.metadata.iter().find(|(name, _)| name == "dbg");
        let mut location = attached.and_then(|(_, node)| self.node(node));
        // A chain that has more links than there are nodes has no end.
        for _ in 0..self.debug.len() {
            let Some(node) = location else { break };
            frames.extend(self.frame(node));
            location = self.follow(node, "inlinedAt");
        }
        frames
    }

    fn frame(&self, location: &'m DebugNode) -> Option<Frame<'m>> {
        let mut scope = self.follow(location, "scope")?;
        for _ in 0..self.debug.len() {
            if !scope.kind.starts_with("DILexicalBlock") {
                break;
            }
            scope = self.follow(scope, "scope")?;
        }
        let file = self.follow(scope, "file")?;
        let name = text(scope, "name");
        Some(Frame {
            function: name.split('<').next().unwrap_or(name),
            file: Path::new(text(file, "directory")).join(text(file, "filename")),
            line: location.field("line").and_then(|line| line.parse().ok()).unwrap_or(0),
        })
    }

    /// The node that a field refers to.
    fn follow(&self, node: &DebugNode, field: &str) -> Option<&'m DebugNode> {
        self.node(node.field(field)?)
    }

    /// The node `!5`.
    fn node(&self, name: &str) -> Option<&'m DebugNode> {
        self.debug.get(name.strip_prefix('!')?)
    }
}

/// The text in a field, without its quotation marks.
fn text<'m>(node: &'m DebugNode, field: &str) -> &'m str {
    node.field(field).unwrap_or_default().trim_matches('"')
}
