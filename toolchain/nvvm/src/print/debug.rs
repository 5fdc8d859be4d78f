//! Line information: the part of rustc's debug information that tells where instructions come from.
//!
//! Every function belongs to one compile unit, because libNVVM accepts only one.

use std::collections::BTreeMap;

use crate::Dialect;
use optix_llvm_ir::model::{DebugNode, Module};

/// How many numbers of nodes are reserved for the nodes that are made here.
pub(super) const NUMBERS: u64 = 4;

/// The nodes to print, by name.
pub(super) struct Debug<'m> {
    nodes: &'m BTreeMap<String, DebugNode>,
    dialect: Dialect,
    /// The text of each node that was visited. `None` if the node, or one that it refers to, is not as rustc writes it.
    printed: BTreeMap<&'m str, Option<String>>,
    /// The number of the compile unit. The next two are those of a type and of the list that the type has.
    unit: u64,
}

impl<'m> Debug<'m> {
    /// Collects the nodes that functions and instructions of the module refer to. New nodes get numbers from `number`
    /// on.
    pub fn new(module: &'m Module, dialect: Dialect, number: u64) -> Self {
        let mut debug = Self { nodes: &module.debug, dialect, printed: BTreeMap::new(), unit: number };
        for function in module.functions.iter().filter(|function| !function.blocks.is_empty()) {
            if let Some(node) = &function.debug {
                debug.node(node);
            }
            for instruction in function.blocks.iter().flat_map(|block| &block.instructions) {
                if let Some((_, node)) = instruction.metadata.iter().find(|(name, _)| name == "dbg") {
                    debug.node(node);
                }
            }
        }
        debug
    }

    /// `, !dbg !5` with the given prefix, or nothing.
    pub fn attachment(&self, before: &str, node: Option<&str>) -> String {
        let number = node.map(|node| node.trim_start_matches('!'));
        match number.filter(|number| self.printed.get(number).is_some_and(Option::is_some)) {
            Some(number) => format!("{before} !dbg !{number}"),
            None => String::new(),
        }
    }

    /// Whether the node can be printed. Its text is stored.
    fn node(&mut self, name: &str) -> Option<()> {
        let (name, node) = self.nodes.get_key_value(name.trim_start_matches('!'))?;
        if !self.printed.contains_key(name.as_str()) {
            // rustc writes no node that refers to itself.
            self.printed.insert(name, None);
            let text = self.text(node);
            self.printed.insert(name, text);
        }
        self.printed[name.as_str()].as_ref().map(|_| ())
    }

    fn text(&mut self, node: &'m DebugNode) -> Option<String> {
        let place = |node: &DebugNode| {
            let number = |name| node.field(name).unwrap_or("0").to_string();
            (number("line"), number("column"))
        };
        let (line, column) = place(node);
        let plain = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        if !plain(&line) || !plain(&column) {
            return None;
        }
        Some(match node.kind.as_str() {
            "DIFile" => {
                let (name, folder) = (node.field("filename")?, node.field("directory").unwrap_or("\"\""));
                format!("!DIFile(filename: {name}, directory: {folder})")
            }
            "DISubprogram" => {
                let file = self.reference(node, "file")?;
                let name = node.field("name")?;
                let linkage = node.field("linkageName").map(|name| format!(", linkageName: {name}"));
                let (unit, ty) = (self.unit, self.unit + 1);
                let kind = match self.dialect {
                    Dialect::Llvm7 => "isLocal: false, isDefinition: true, isOptimized: true",
                    Dialect::Modern => "spFlags: DISPFlagDefinition | DISPFlagOptimized",
                };
                format!(
                    "distinct !DISubprogram(name: {name}{}, scope: {file}, file: {file}, line: {line}, type: !{ty}, \
                     scopeLine: {line}, {kind}, unit: !{unit})",
                    linkage.unwrap_or_default()
                )
            }
            "DILexicalBlock" => {
                let (scope, file) = (self.reference(node, "scope")?, self.reference(node, "file")?);
                format!("distinct !DILexicalBlock(scope: {scope}, file: {file}, line: {line}, column: {column})")
            }
            "DILexicalBlockFile" => {
                let (scope, file) = (self.reference(node, "scope")?, self.reference(node, "file")?);
                format!("!DILexicalBlockFile(scope: {scope}, file: {file}, discriminator: 0)")
            }
            "DILocation" => {
                let scope = self.reference(node, "scope")?;
                let caller = match node.field("inlinedAt") {
                    Some(_) => format!(", inlinedAt: {}", self.reference(node, "inlinedAt")?),
                    None => String::new(),
                };
                format!("!DILocation(line: {line}, column: {column}, scope: {scope}{caller})")
            }
            _ => return None,
        })
    }

    /// The node that a field refers to, if it can be printed.
    fn reference(&mut self, node: &'m DebugNode, field: &str) -> Option<&'m str> {
        let name = node.field(field)?;
        self.node(name).map(|()| name)
    }

    /// The lines of the module; none where no function has debug information.
    pub fn lines(&self) -> Vec<String> {
        let is_file = |name: &str| self.nodes[name].kind == "DIFile";
        let file = self.printed.iter().find(|(name, text)| text.is_some() && is_file(name));
        let Some((file, _)) = file else { return Vec::new() };
        let printed = self.printed.iter().filter_map(|(name, text)| Some(format!("!{name} = {}", text.as_ref()?)));
        let mut lines: Vec<String> = printed.collect();
        let (unit, ty, list, version) = (self.unit, self.unit + 1, self.unit + 2, self.unit + 3);
        lines.push(format!(
            "!{unit} = distinct !DICompileUnit(language: DW_LANG_C99, file: !{file}, producer: \"rustc\", isOptimized: true, \
             runtimeVersion: 0, emissionKind: LineTablesOnly)"
        ));
        lines.push(format!("!{ty} = !DISubroutineType(types: !{list})"));
        lines.push(format!("!{list} = !{{null}}"));
        lines.push(format!("!{version} = !{{i32 2, !\"Debug Info Version\", i32 3}}"));
        lines.push(format!("!llvm.dbg.cu = !{{!{unit}}}"));
        lines.push(format!("!llvm.module.flags = !{{!{version}}}"));
        lines
    }
}
