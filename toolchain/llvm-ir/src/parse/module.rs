//! Parses definitions: variables, functions and metadata, all of which start at the left margin.

use super::{Parsed, Parser};
use crate::lexer::Token;
use crate::model::{Argument, Block, DebugNode, Function, Module, Type, Typed, Value, Variable};
use crate::unknown::Unknown;

const LINKAGES: [&str; 11] = [
    "private",
    "internal",
    "external",
    "weak",
    "weak_odr",
    "linkonce",
    "linkonce_odr",
    "common",
    "appending",
    "available_externally",
    "extern_weak",
];

/// Words before a symbol that do not change its code.
const VISIBILITY: [&str; 8] = [
    "dso_local",
    "dso_preemptable",
    "default",
    "hidden",
    "protected",
    "unnamed_addr",
    "local_unnamed_addr",
    "externally_initialized",
];

/// Calling conventions. On the device there is only one, apart from that of kernels.
const CONVENTIONS: [&str; 5] = ["ccc", "fastcc", "coldcc", "ptx_device", "tailcc"];

impl Parser<'_, '_> {
    pub(super) fn module(&mut self) -> Parsed<Module> {
        self.read_groups()?;
        let mut module = Module::default();
        while self.peek() != Token::End {
            let line = self.next_line();
            let read = self.definition(&mut module);
            self.or_skipped(read, line)?;
            self.function.clear();
        }
        Ok(module)
    }

    fn definition(&mut self, module: &mut Module) -> Parsed<()> {
        match self.next() {
            Token::Word("source_filename") => {
                self.expect('=')?;
                self.text()?;
            }
            Token::Word("target") => {
                self.word()?;
                self.expect('=')?;
                self.text()?;
            }
            Token::Word("module") => {
                self.expect_word("asm")?;
                let line = self.text()?;
                module.asm.push(line);
            }
            Token::Word("attributes") => self.skip_group()?,
            Token::Word("define") => {
                let function = self.function(true)?;
                module.functions.push(function);
            }
            Token::Word("declare") => {
                let function = self.function(false)?;
                module.functions.push(function);
            }
            Token::Comdat(_) => {
                self.expect('=')?;
                self.expect_word("comdat")?;
                self.word()?;
            }
            Token::Local(name) => {
                self.expect('=')?;
                self.expect_word("type")?;
                let ty = if self.eat_word("opaque") { None } else { Some(self.ty()?) };
                module.types.push((name.to_string(), ty));
            }
            Token::Global(name) => {
                let variable = self.variable(name)?;
                module.variables.push(variable);
            }
            Token::Metadata(name) => {
                self.expect('=')?;
                let distinct = self.eat_word("distinct");
                if let Token::Metadata(kind) = self.peek()
                    && kind.starts_with("DI")
                {
                    let node = self.debug_node()?;
                    module.debug.insert(name.to_string(), node);
                } else {
                    let text = self.metadata_node(distinct)?;
                    module.metadata.insert(name.to_string(), text);
                }
            }
            _ => {
                self.at -= 1;
                return self.unexpected("a definition");
            }
        }
        Ok(())
    }

    /// Skips `#5 = { .. }`, which has been read before.
    fn skip_group(&mut self) -> Parsed<()> {
        loop {
            match self.next() {
                Token::Punctuation('}') => return Ok(()),
                Token::End => return self.unexpected("`}`"),
                _ => {}
            }
        }
    }

    fn linkage(&mut self) -> Option<String> {
        self.one_of(&LINKAGES).map(str::to_string)
    }

    fn variable(&mut self, name: &str) -> Parsed<Variable> {
        self.expect('=')?;
        let linkage = self.linkage();
        let mut unnamed_address = false;
        let mut space = 0;
        let constant = loop {
            match self.peek() {
                Token::Word("thread_local") => return self.unexpected("a variable of the device"),
                Token::Word("addrspace") => space = self.address_space()?,
                Token::Word(word) if VISIBILITY.contains(&word) => {
                    unnamed_address |= word == "unnamed_addr";
                    self.at += 1;
                }
                Token::Word("constant") => break true,
                Token::Word("global") => break false,
                _ => return self.unexpected("`global` or `constant`"),
            }
        };
        self.at += 1;
        let ty = self.ty()?;
        // A declaration has no value; then a new line or a comma follows.
        let declared = matches!(linkage.as_deref(), Some("external" | "extern_weak"));
        let value = if declared { None } else { Some(self.value(&ty)?) };
        let (mut section, mut align) = (None, None);
        while self.eat(',') {
            match self.next() {
                Token::Word("section") => section = Some(self.text()?),
                Token::Word("align") => align = Some(self.number()?),
                Token::Word("comdat") => {
                    drop(if self.peek() == Token::Punctuation('(') { self.parentheses()? } else { Vec::new() })
                }
                Token::Metadata(_) => drop(self.next()),
                _ => {
                    self.at -= 1;
                    return self.unexpected("an alignment or a section");
                }
            }
        }
        Ok(Variable { name: name.to_string(), linkage, unnamed_address, space, constant, ty, value, section, align })
    }

    /// `!{!6, !"name"}`, as text.
    fn metadata_node(&mut self, distinct: bool) -> Parsed<String> {
        let mut text = String::from(if distinct { "distinct " } else { "" });
        let line = self.next_line();
        // A node ends at the end of its line.
        while self.next_line() == line && self.peek() != Token::End {
            self.metadata_token(&mut text)?;
        }
        Ok(text)
    }

    /// `!DILocation(line: 12, scope: !5)`
    fn debug_node(&mut self) -> Parsed<DebugNode> {
        let Token::Metadata(kind) = self.next() else { return self.unexpected("a node") };
        let mut node = DebugNode { kind: kind.to_string(), fields: Vec::new() };
        self.expect('(')?;
        let mut depth = 0;
        let (mut name, mut text) = (String::new(), String::new());
        loop {
            match self.peek() {
                Token::Label(label) if depth == 0 && text.is_empty() => {
                    self.at += 1;
                    name = label.to_string();
                    continue;
                }
                Token::Punctuation(c @ (',' | ')')) if depth == 0 => {
                    self.at += 1;
                    node.fields.push((std::mem::take(&mut name), std::mem::take(&mut text).trim_end().to_string()));
                    if c == ')' {
                        return Ok(node);
                    }
                    continue;
                }
                Token::Punctuation('(' | '{') => depth += 1,
                Token::Punctuation(')' | '}') => depth -= 1,
                Token::End => return self.unexpected("`)`"),
                _ => {}
            }
            self.metadata_token(&mut text)?;
        }
    }

    /// Appends the text of the token that comes next.
    fn metadata_token(&mut self, text: &mut String) -> Parsed<()> {
        match self.next() {
            Token::Metadata(name) => text.push_str(&format!("!{name}")),
            Token::Word(word) => text.push_str(&format!("{word} ")),
            Token::Label(word) => text.push_str(&format!("{word}: ")),
            Token::Text(string) => text.push_str(&format!("\"{string}\"")),
            Token::Punctuation(c) => text.push(c),
            Token::Global(name) => text.push_str(&format!("@\"{name}\"")),
            _ => {
                self.at -= 1;
                return self.unexpected("metadata");
            }
        }
        Ok(())
    }

    fn function(&mut self, defined: bool) -> Parsed<Function> {
        let line = self.line();
        // Metadata may come first in a declaration.
        while let Token::Metadata(_) = self.peek() {
            self.at += 2;
        }
        let linkage = self.linkage();
        while self.one_of(&VISIBILITY).is_some() {}
        let kernel = self.convention()?;
        self.value_attributes()?;
        let result = self.ty()?;
        let name = self.global()?;
        self.function = name.clone();
        self.expect('(')?;
        let mut variadic = false;
        let parameters = self.list(')', |parser| {
            if parser.peek() == Token::Ellipsis {
                parser.at += 1;
                variadic = true;
                return Ok(None);
            }
            let ty = parser.ty()?;
            let of = parser.value_attributes()?;
            let value = match parser.peek() {
                Token::Local(name) => {
                    parser.at += 1;
                    Value::Local(name.to_string())
                }
                _ => Value::Undef,
            };
            let value = Typed { ty, value };
            Ok(Some(Argument { value, attributes: of.words, by_value: of.by_value, align: of.align }))
        })?;
        let parameters: Vec<Argument> = parameters.into_iter().flatten().collect();
        while self.one_of(&VISIBILITY).is_some() {}
        let mut attributes = self.function_attributes()?;
        // libNVVM itself adds `readnone` to functions for which it holds, and then refuses that beside
        // `inaccessiblememonly`. The attributes of calls are kept.
        attributes.retain(|word| word != "inaccessiblememonly");
        let (blocks, debug) = (Vec::new(), None);
        let mut function =
            Function { name, linkage, kernel, result, parameters, variadic, attributes, debug, blocks, line };
        if !defined {
            return Ok(function);
        }
        loop {
            match self.next() {
                Token::Punctuation('{') => break,
                Token::Word("align") => drop(self.number()?),
                Token::Word("section") => drop(self.text()?),
                Token::Word("comdat") => {
                    if self.peek() == Token::Punctuation('(') {
                        self.parentheses()?;
                    }
                }
                Token::Word("personality") => drop(self.typed()?),
                Token::Metadata(name) => {
                    if let (Token::Metadata(node), "dbg") = (self.next(), name) {
                        function.debug = Some(node.to_string());
                    }
                }
                _ => {
                    self.at -= 1;
                    return self.unexpected("the body of the function");
                }
            }
        }
        function.blocks = self.blocks(&function.parameters)?;
        Ok(function)
    }

    /// Reads a calling convention; returns whether it is that of kernels.
    fn convention(&mut self) -> Parsed<bool> {
        if self.eat_word("ptx_kernel") {
            return Ok(true);
        }
        self.one_of(&CONVENTIONS);
        Ok(false)
    }

    /// Skips a calling convention such as `fastcc`.
    pub(super) fn skip_convention(&mut self) {
        self.one_of(&CONVENTIONS);
    }

    fn blocks(&mut self, parameters: &[Argument]) -> Parsed<Vec<Block>> {
        let is_number = |name: &String| name.bytes().all(|b| b.is_ascii_digit());
        let unnamed = parameters.iter().filter(|p| matches!(&p.value.value, Value::Local(name) if is_number(name)));
        // If the first block has no name, its name is the next number.
        let mut block = Block { name: unnamed.count().to_string(), instructions: Vec::new() };
        let mut blocks = Vec::new();
        loop {
            match self.peek() {
                Token::Punctuation('}') => {
                    self.at += 1;
                    blocks.push(block);
                    break;
                }
                Token::Label(name) => {
                    self.at += 1;
                    if block.instructions.is_empty() {
                        if !blocks.is_empty() && !self.lenient {
                            return Err(Unknown::new("a block without instructions"));
                        }
                        block.name = name.to_string();
                    } else {
                        blocks.push(std::mem::replace(
                            &mut block,
                            Block { name: name.to_string(), instructions: Vec::new() },
                        ));
                    }
                }
                // Skips `#dbg_value(..)`, which is for debuggers.
                Token::Group(record) if record.starts_with("dbg_") => {
                    self.at += 1;
                    self.parentheses()?;
                }
                Token::End => return self.unexpected("`}`"),
                _ => {
                    let line = self.next_line();
                    let read = self.instruction();
                    block.instructions.extend(self.or_skipped(read, line)?);
                }
            }
        }
        Ok(blocks)
    }
}

/// Whether a type is `void`, which has no values.
pub(super) fn is_nothing(ty: &Type) -> bool {
    *ty == Type::Void
}
