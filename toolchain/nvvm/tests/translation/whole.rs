//! Every function of `core` and glam, as rustc optimises it, through the translation for LLVM 7 and libNVVM.
//!
//! `cargo test -p optix-nvvm --release --test translation whole -- --ignored --nocapture`

use std::collections::{BTreeMap, BTreeSet};

use optix_nvvm::{Dialect, Library, libdevice, translate};

use super::{ir_of, library};

/// What may be refused, by words of the reason: types that LLVM 7's NVPTX does not have, atomics that the GPU does not have, and
/// what device code has no use for.
const REFUSED: [&str; 10] = [
    "the type `fp128`",
    "the type `i256`",
    "an atomic Int(8)",
    "an atomic Int(16)",
    "`nand` where an atomic operation",
    "`fma` of `f16`",
    "the intrinsic `llvm.powi`",
    "the intrinsic `llvm.clmul`",
    "the intrinsic `llvm.va_end`",
    "`bitreverse` of 3 bits",
];

/// The functions of a module, each with what it needs to be a module of its own.
struct Functions<'a> {
    /// By symbol: the definition, and the declaration of the same.
    bodies: BTreeMap<&'a str, (String, String)>,
    /// Variables and declarations by symbol, metadata and groups of attributes by number: lines.
    lines: BTreeMap<&'a str, &'a str>,
    /// The types that have names.
    types: String,
}

impl<'a> Functions<'a> {
    fn of(text: &'a str) -> Self {
        let mut functions = Self { bodies: BTreeMap::new(), lines: BTreeMap::new(), types: String::new() };
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            if line.starts_with("define ") {
                let name = words(line).find(|word| word.starts_with('@')).unwrap_or_default();
                let mut body = format!("{line}\n");
                for line in lines.by_ref() {
                    body.push_str(line);
                    body.push('\n');
                    if line == "}" {
                        break;
                    }
                }
                functions.bodies.insert(name, (body, declaration(line)));
            } else if let Some(line) = line.strip_prefix("attributes ") {
                functions.lines.insert(words(line).next().unwrap_or_default(), line);
            } else if line.starts_with("declare ") {
                functions.lines.insert(words(line).find(|word| word.starts_with('@')).unwrap_or_default(), line);
            } else if line.starts_with('%') {
                functions.types.extend([line, "\n"]);
            } else if line.starts_with(['@', '!']) {
                functions.lines.insert(words(line).next().unwrap_or_default(), line);
            }
        }
        functions
    }

    /// A module of some functions alone.
    fn module(&self, names: &[&str]) -> String {
        let mut text = self.types.clone();
        text.extend(names.iter().map(|name| self.bodies[name].0.as_str()));
        let mut known: BTreeSet<&str> = names.iter().copied().collect();
        let mut waiting: Vec<&str> = names.iter().flat_map(|name| words(&self.bodies[name].0)).collect();
        while let Some(name) = waiting.pop() {
            if !name.starts_with(['@', '#', '!']) || !known.insert(name) {
                continue;
            }
            if let Some((_, declaration)) = self.bodies.get(name) {
                text.push_str(declaration);
                waiting.extend(words(declaration));
            } else if let Some(line) = self.lines.get(name) {
                text.push_str(if name.starts_with('#') { "attributes " } else { "" });
                text.push_str(line);
                text.push('\n');
                waiting.extend(words(line));
            }
        }
        text
    }
}

/// Names and numbers with their marks: `@name`, `#5`, `!5`.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '$' | '-' | '@' | '#' | '!');
    text.split(move |c| !is_part(c)).filter(|word| !word.is_empty())
}

/// The declaration of what a line begins to define.
fn declaration(line: &str) -> String {
    let line = line.trim_end_matches(" {").replacen("define ", "declare ", 1);
    let is_linkage = |word: &&str| !matches!(*word, "internal" | "private" | "linkonce_odr" | "weak_odr" | "hidden");
    line.split(' ').filter(is_linkage).collect::<Vec<_>>().join(" ") + "\n"
}

/// Has libNVVM verify and compile functions; those that it refuses come back, with its reason.
fn refused_by_libnvvm<'a>(
    library: &Library,
    functions: &Functions<'_>,
    names: &[&'a str],
    arch: &str,
) -> Vec<(&'a str, String)> {
    let module = translate(&functions.module(names), Dialect::Llvm7);
    let compiled = module.map_err(|refusal| refusal.to_string()).and_then(|module| {
        let libdevice = libdevice(&library.path).and_then(|path| std::fs::read(path).ok());
        let libdevice = libdevice.as_deref().filter(|_| module.needs_libdevice);
        library.compile(&module, libdevice, &[format!("-arch=compute_{arch}")]).map_err(|failure| failure.to_string())
    });
    match (compiled, names) {
        (Ok(_), _) => Vec::new(),
        (Err(reason), [name]) => vec![(*name, reason)],
        (Err(_), names) => {
            let (a, b) = names.split_at(names.len() / 2);
            [a, b].iter().flat_map(|half| refused_by_libnvvm(library, functions, half, arch)).collect()
        }
    }
}

#[test]
#[ignore = "compiles all of core and glam for five architectures: minutes"]
fn every_function_of_core_and_glam() {
    let Some(library) = library("every_function_of_core_and_glam") else { return };
    let Some(texts) = ir_of::core_and_glam("every_function_of_core_and_glam") else { return };
    let mut wrong = Vec::new();
    for (name, text) in &texts {
        let functions = Functions::of(text);
        let (mut accepted, mut refused) = (Vec::new(), BTreeMap::<String, Vec<&str>>::new());
        for function in functions.bodies.keys() {
            match translate(&functions.module(&[function]), Dialect::Llvm7) {
                Ok(_) => accepted.push(*function),
                Err(refusal) => refused.entry(refusal.reason).or_default().push(function),
            }
        }
        println!("{name}: {} functions, {} translated", functions.bodies.len(), accepted.len());
        for (reason, functions) in &refused {
            println!("  {} refused: {reason}, as {}", functions.len(), functions[0]);
            if !REFUSED.iter().any(|known| reason.contains(known)) {
                wrong.push(format!("{name}: {reason}: {functions:?}"));
            }
        }
        for arch in ["75", "80", "86", "89", "90"] {
            let batches = accepted.chunks(250);
            let refused: Vec<_> =
                batches.flat_map(|batch| refused_by_libnvvm(&library, &functions, batch, arch)).collect();
            println!("  compute_{arch}: libNVVM accepts {} of {}", accepted.len() - refused.len(), accepted.len());
            wrong.extend(refused.into_iter().map(|(function, reason)| format!("{name}: {function}: {reason}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
