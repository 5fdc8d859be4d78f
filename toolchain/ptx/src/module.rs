//! Modules, and the functions and variables that they declare.

use std::cell::OnceCell;
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use crate::calls::calls;
use crate::statement::{Statement, statements};
use crate::{Call, Prototype};

/// A module.
#[derive(Clone, Debug, Default)]
pub struct Module<'a> {
    /// The version in `.version`, such as `7.8`; empty if there is none.
    pub version: &'a str,
    /// The architecture in `.target`, such as `sm_75`; empty if there is none.
    pub target: &'a str,
    /// The variables outside of functions, in order.
    pub variables: Vec<Variable<'a>>,
    /// The functions, those that are only declared among them, in order.
    pub functions: Vec<Function<'a>>,
    /// The first function with a body, by name.
    by_name: HashMap<&'a str, usize>,
}

/// `.visible .const .align 8 .b8 name[16] = {..}`
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variable<'a> {
    /// Its name.
    pub name: &'a str,
    /// Whether it is defined elsewhere.
    pub is_extern: bool,
    /// `const`, `global`, ..
    pub space: &'a str,
    /// The type: `b8`.
    pub kind: &'a str,
    /// The alignment in bytes, if it is stated.
    pub align: Option<usize>,
    /// How many elements it has: 16 for `[16]`, 1 without brackets.
    pub count: Option<usize>,
    /// The text of its value after the `=`; empty if it has none.
    pub value: &'a str,
}

impl Variable<'_> {
    /// The integers of its value; empty if it has other values. One above `i64::MAX` is given as the negative number
    /// with the same bits.
    pub fn numbers(&self) -> Vec<u64> {
        let number = |text: &str| text.parse().ok().or_else(|| text.parse::<i64>().ok().map(i64::cast_unsigned));
        let value = self.value.trim_start_matches('{').trim_end_matches('}').trim();
        let numbers = value.split(',').map(|text| number(text.trim())).collect::<Option<_>>();
        numbers.unwrap_or_default()
    }
}

/// A function, which may be an entry.
#[derive(Clone, Debug)]
pub struct Function<'a> {
    /// Its name.
    pub name: &'a str,
    /// Whether OptiX itself may call it: because it is an `.entry`, or its name is that of a callable.
    pub is_entry: bool,
    /// Whether it is defined elsewhere.
    pub is_extern: bool,
    /// Whether it declares parameters.
    pub has_parameters: bool,
    /// The types of its parameters and results, if they can be read.
    pub prototype: Option<Prototype>,
    /// Its range in the text, from its first directive to its closing brace.
    pub range: Range<usize>,
    /// The text between its braces.
    body: Option<&'a str>,
    statements: OnceCell<Vec<Statement<'a>>>,
    calls: OnceCell<Vec<Call<'a>>>,
}

/// Whether a function is a callable, by OptiX's prefixes.
pub fn is_callable(name: &str) -> bool {
    name.starts_with("__direct_callable__") || name.starts_with("__continuation_callable__")
}

impl<'a> Module<'a> {
    /// Reads a module from a [`plain`](crate::plain) text. The bodies of functions are read when they are asked for.
    pub fn read(text: &'a str) -> Self {
        let mut module = Self::default();
        let mut at = 0;
        while let Some(skipped) = text[at..].find(|c: char| !c.is_whitespace()) {
            at += skipped;
            let item = Item::at(text, at);
            module.add(&item, at);
            at = item.end;
        }
        module
    }

    /// The function with a body that has this name.
    pub fn get(&self, name: &str) -> Option<&Function<'a>> {
        self.functions.get(*self.by_name.get(name)?)
    }

    /// The functions with bodies, in order.
    pub fn defined(&self) -> impl Iterator<Item = &Function<'a>> {
        self.functions.iter().filter(|function| function.body.is_some())
    }

    /// The entries with bodies, in order.
    pub fn entries(&self) -> impl Iterator<Item = &Function<'a>> {
        self.defined().filter(|function| function.is_entry)
    }

    /// The function of this name and every function that it calls, directly or indirectly, each once. Empty if there is
    /// none of this name.
    pub fn reached(&self, name: &str) -> Vec<&Function<'a>> {
        let mut reached: Vec<&Function<'a>> = self.get(name).into_iter().collect();
        let mut known: BTreeSet<&str> = reached.iter().map(|function| function.name).collect();
        let mut at = 0;
        while let Some(function) = reached.get(at).copied() {
            let callees = function.calls().iter().filter_map(|call| self.get(call.function));
            reached.extend(callees.filter(|callee| known.insert(callee.name)));
            at += 1;
        }
        reached
    }

    fn add(&mut self, item: &Item<'a>, begin: usize) {
        let mut rest = item.head;
        let mut is_extern = false;
        while let Some((word, behind)) = directive(rest) {
            match word {
                "extern" => is_extern = true,
                "visible" | "weak" | "common" => {}
                "version" => return self.version = behind.trim(),
                "target" => return self.target = behind.split(',').next().unwrap_or_default().trim(),
                "entry" | "func" => {
                    let Some(function) = Function::read(item, begin, word, behind, is_extern) else { return };
                    if function.body.is_some() {
                        self.by_name.entry(function.name).or_insert(self.functions.len());
                    }
                    return self.functions.push(function);
                }
                "const" | "global" | "shared" | "tex" => {
                    return self.variables.extend(variable(word, behind, is_extern));
                }
                _ => return,
            }
            rest = behind;
        }
    }
}

impl<'a> Function<'a> {
    /// Reads a function whose head has `rest` after `.entry` or `.func`: result, name and parameters.
    fn read(item: &Item<'a>, begin: usize, word: &str, rest: &'a str, is_extern: bool) -> Option<Self> {
        let prototype = Prototype::read(rest);
        let rest = match rest.trim_start().strip_prefix('(') {
            Some(result) => result.split_once(')')?.1,
            None => rest,
        };
        let (name, rest) = identifier(rest.trim_start());
        Some(Self {
            name,
            is_entry: word == "entry" || is_callable(name),
            is_extern,
            has_parameters: rest.contains(".param"),
            prototype,
            range: begin..item.end,
            body: item.block,
            statements: OnceCell::new(),
            calls: OnceCell::new(),
        })
    }

    /// Its statements; none if it is only declared.
    pub fn statements(&self) -> &[Statement<'a>] {
        self.statements.get_or_init(|| self.body.map(statements).unwrap_or_default())
    }

    /// Its calls in the order of the text.
    pub fn calls(&self) -> &[Call<'a>] {
        self.calls.get_or_init(|| calls(self.statements()))
    }

    /// The bytes that it keeps in local memory, if any: `.local .align 4 .b8 __local_depot0[16]`.
    pub fn local_memory(&self) -> Option<usize> {
        let size = |statement: &Statement<'_>| match statement {
            Statement::Directive(directive) => {
                let (_, size) = directive.strip_prefix(".local")?.rsplit_once('[')?;
                size.trim_end_matches(']').parse::<usize>().ok()
            }
            _ => None,
        };
        self.statements().iter().filter_map(size).reduce(usize::saturating_add)
    }

    /// What stands between its braces; empty if it is only declared.
    pub fn body(&self) -> &'a str {
        self.body.unwrap_or_default()
    }
}

/// A declaration or definition, or a line such as `.version 7.8`.
struct Item<'a> {
    /// The text up to its `;`, the end of its line, or the brace that opens a block.
    head: &'a str,
    /// The text inside of the block.
    block: Option<&'a str>,
    /// The position after the item.
    end: usize,
}

impl<'a> Item<'a> {
    /// The item that begins at `begin`. It has at least one byte.
    fn at(text: &'a str, begin: usize) -> Self {
        let rest = &text[begin..];
        let is_line = |(word, _)| matches!(word, "version" | "target" | "address_size" | "file" | "loc");
        if directive(rest).is_some_and(is_line) {
            let head = rest.split('\n').next().unwrap_or_default();
            return Self { head, block: None, end: begin + head.len() };
        }
        let mut from = 0;
        loop {
            let Some(found) = rest[from..].find(['{', '}', ';']).map(|at| from + at) else {
                return Self { head: rest, block: None, end: text.len() };
            };
            let head = &rest[..found];
            if !rest[found..].starts_with('{') {
                return Self { head, block: None, end: begin + found + 1 };
            }
            let (inside, length) = block(&rest[found..]);
            // The braces around a variable's value are a part of its head.
            if !head.contains('=') {
                return Self { head, block: Some(inside), end: begin + found + length };
            }
            from = found + length;
        }
    }
}

/// The inside of the block that the text begins with, and the block's length including its braces. A block that is
/// never closed extends to the end.
fn block(text: &str) -> (&str, usize) {
    let mut depth = 0_usize;
    for (at, brace) in text.bytes().enumerate() {
        match brace {
            b'{' => depth += 1,
            b'}' if depth == 1 => return (&text[1..at], at + 1),
            b'}' => depth -= 1,
            _ => {}
        }
    }
    (&text[1..], text.len())
}

/// Reads a variable whose declaration has `rest` after the space's name.
fn variable<'a>(space: &'a str, mut rest: &'a str, is_extern: bool) -> Option<Variable<'a>> {
    let (mut kind, mut align) = ("", None);
    while let Some((word, behind)) = directive(rest) {
        rest = behind;
        match word {
            "align" => {
                let (number, behind) = identifier(rest.trim_start());
                (align, rest) = (number.parse().ok(), behind);
            }
            "attribute" => rest = rest.split_once(')')?.1,
            word => kind = word,
        }
    }
    let (name, rest) = identifier(rest.trim_start());
    let (shape, value) = rest.split_once('=').unwrap_or((rest, ""));
    let shape = shape.trim();
    let count = match shape.strip_prefix('[') {
        Some(count) => count.strip_suffix(']').and_then(|count| count.trim().parse().ok()),
        None => Some(1),
    };
    Some(Variable { name, is_extern, space, kind, align, count, value: value.trim() })
}

/// `word` and `rest` of `.word rest`.
fn directive(text: &str) -> Option<(&str, &str)> {
    let (word, rest) = identifier(text.trim_start().strip_prefix('.')?);
    (!word.is_empty()).then_some((word, rest))
}

/// The name that the text begins with, and the rest.
fn identifier(text: &str) -> (&str, &str) {
    let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '$' | '%');
    text.split_at(text.find(|c| !is_part(c)).unwrap_or(text.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PTX: &str = "\
.version 6.3
.target sm_75, debug
.address_size 64
	.file	1 \"/a//{b.rs\"
.extern .func  (.param .b32 func_retval0) vprintf
(
	.param .b64 a
)
;
.extern .global .align 4 .b8 TABLE[64];
.visible .const .align 8 .b8 p[16];
.visible .global .align 8 .b64 p_layout = -2;
.global .align 4 .b8 words[4] = {1, 2, 3, 4};
.func  (.param .b32 func_retval0) slow(
	.param .b32 a
)
;
.func  (.param .b32 func_retval0) slow(
	.param .b32 a
)
{
	call deeper, ();
	ret;
}
.func deeper(){ call slow, (); }
// .globl __raygen__a }
.visible .entry __raygen__a()
{
	{
	call (%r5), slow, (4);
	}
	ret;
}
.visible .func  (.param .align 4 .b8 func_retval0[12]) __direct_callable__c(
	.param .b32 __direct_callable__c_param_0
)
{
	.local .align 4 .b8 	__local_depot0[16];
	ret;
}
	.section	.debug_str
	{
$L__info: .b8 1
	}
";

    #[test]
    fn declarations_are_found() {
        let text = crate::plain(PTX);
        let module = Module::read(&text);
        assert_eq!((module.version, module.target), ("6.3", "sm_75"));
        let functions = module.functions.iter();
        let functions: Vec<_> = functions.map(|f| (f.name, f.is_entry, f.is_extern, f.has_parameters)).collect();
        assert_eq!(
            functions,
            [
                ("vprintf", false, true, true),
                ("slow", false, false, true),
                ("slow", false, false, true),
                ("deeper", false, false, false),
                ("__raygen__a", true, false, false),
                ("__direct_callable__c", true, false, true),
            ]
        );
        let variable = |name, space, kind, align, count, value| Variable {
            name,
            is_extern: name == "TABLE",
            space,
            kind,
            align: Some(align),
            count: Some(count),
            value,
        };
        assert_eq!(
            module.variables,
            [
                variable("TABLE", "global", "b8", 4, 64, ""),
                variable("p", "const", "b8", 8, 16, ""),
                variable("p_layout", "global", "b64", 8, 1, "-2"),
                variable("words", "global", "b8", 4, 4, "{1, 2, 3, 4}"),
            ]
        );
        let numbers: Vec<_> = module.variables.iter().map(Variable::numbers).collect();
        assert_eq!(numbers, [vec![], vec![], vec![u64::MAX - 1], vec![1, 2, 3, 4]]);
    }

    #[test]
    fn functions_end_at_their_own_brace() {
        let text = crate::plain(PTX);
        let module = Module::read(&text);
        let entries: Vec<_> = module.entries().map(|entry| &PTX[entry.range.clone()]).collect();
        assert!(entries[0].starts_with(".visible .entry __raygen__a()") && entries[0].ends_with("ret;\n}"));
        assert!(entries[1].starts_with(".visible .func") && entries[1].ends_with("ret;\n}"));
        assert_eq!(module.get("__direct_callable__c").and_then(Function::local_memory), Some(16));
    }

    #[test]
    fn calls_lead_to_functions_once() {
        let text = crate::plain(PTX);
        let names = |name| Module::read(&text).reached(name).iter().map(|f| f.name).collect::<Vec<_>>();
        assert_eq!(names("__raygen__a"), ["__raygen__a", "slow", "deeper"]);
        assert_eq!(names("vprintf"), [] as [&str; 0]);
    }
}
