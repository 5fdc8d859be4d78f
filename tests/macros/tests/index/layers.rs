//! The layers of optix-host: no module uses one of its own layer or of a layer above.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The top-level modules of optix-host from the ground up. Those of one layer don't know each other.
const LAYERS: &[&[&str]] = &[
    &["limits", "affine"],
    &["error"],
    &["geometry", "texture"],
    &["features"],
    &["scene"],
    &["plan"],
    &["sbt"],
    &["backend"],
    &["cpu", "optix"],
    &["device"],
    &["build"],
    &["pipeline"],
    &["launch"],
    &["cust"],
];

/// Identifiers and single characters of a Rust file, each with its line; without comments and literals.
fn tokens(text: &str) -> Vec<(usize, String)> {
    fn add(stream: TokenStream, tokens: &mut Vec<(usize, String)>) {
        for tree in stream {
            let line = tree.span().start().line;
            match tree {
                TokenTree::Group(group) => {
                    let (open, close) = match group.delimiter() {
                        Delimiter::Brace => ("{", "}"),
                        Delimiter::Bracket => ("[", "]"),
                        Delimiter::Parenthesis => ("(", ")"),
                        Delimiter::None => ("", ""),
                    };
                    tokens.push((line, open.to_owned()));
                    add(group.stream(), tokens);
                    tokens.push((group.span_close().start().line, close.to_owned()));
                }
                TokenTree::Ident(ident) => tokens.push((line, ident.to_string())),
                TokenTree::Punct(punct) => tokens.push((line, punct.to_string())),
                TokenTree::Literal(_) => {}
            }
        }
    }
    let mut tokens = Vec::new();
    add(text.parse().expect("a Rust file"), &mut tokens);
    tokens
}

fn is_path_separator(tokens: &[(usize, &str)], at: usize) -> bool {
    matches!(tokens.get(at..at + 2), Some([(_, ":"), (_, ":")]))
}

/// The names that stand at the crate's root in the paths of a file whose module is `depth` levels below the root, with
/// their lines: `b` and `c` in `crate::{b::x, c}`, and `b` in `super::super::b` two levels below.
fn root_names(text: &str, depth: usize) -> Vec<(usize, String)> {
    let tokens = tokens(text);
    let tokens: Vec<(usize, &str)> = tokens.iter().map(|(line, token)| (*line, token.as_str())).collect();
    let mut names = Vec::new();
    // Whether each brace that is open belongs to a module.
    let mut braces = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let token = tokens[at].1;
        let begins_path = at == 0 || !is_path_separator(&tokens, at.saturating_sub(2));
        if token == "{" {
            braces.push(at >= 2 && tokens[at - 2].1 == "mod");
        } else if token == "}" {
            braces.pop();
        }
        let mut levels = 0;
        let mut next = at + 1;
        if token == "crate" && begins_path {
            levels = usize::MAX;
        } else if token == "super" && begins_path {
            levels = 1;
            while is_path_separator(&tokens, next) && tokens.get(next + 2).is_some_and(|token| token.1 == "super") {
                levels += 1;
                next += 3;
            }
        }
        if levels >= depth + braces.iter().filter(|&&module| module).count() && is_path_separator(&tokens, next) {
            next += 2;
            match tokens.get(next) {
                Some(&(_, "{")) => {
                    let mut nested = 0;
                    let mut first = true;
                    for &(line, token) in &tokens[next..] {
                        match token {
                            "{" => nested += 1,
                            "}" => nested -= 1,
                            "," => first |= nested == 1,
                            name => {
                                if first {
                                    names.push((line, name.to_owned()));
                                }
                                first = false;
                            }
                        }
                        if nested == 0 {
                            break;
                        }
                    }
                }
                Some(&(line, name)) => names.push((line, name.to_owned())),
                None => {}
            }
        }
        at += 1;
    }
    names
}

/// The modules from which `lib.rs` takes what it shows at the root, by name. What is of other crates is left out.
fn reexports(text: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for statement in text.split("pub use ").skip(1).filter_map(|rest| rest.split_once(';')).map(|(path, _)| path) {
        let (module, names) = statement.split_once("::").unwrap_or((statement, ""));
        for name in names.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|name| !name.is_empty()) {
            if layer(module).is_some() {
                found.insert(name.to_owned(), module.to_owned());
            }
        }
    }
    found
}

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|modules| modules.contains(&module))
}

/// The arrows from `module` that don't run down, among these names: to which module, and in which line.
fn upward(module: &str, names: Vec<(usize, String)>, reexports: &BTreeMap<String, String>) -> Vec<(usize, String)> {
    let from = layer(module).unwrap_or_else(|| panic!("`{module}` has no layer: give it one in `LAYERS`"));
    let target = |(line, name): (usize, String)| {
        let target = reexports.get(&name).cloned().unwrap_or(name);
        let to = layer(&target).unwrap_or_else(|| panic!("`{module}`, line {line}: `crate::{target}` has no layer"));
        (target != module && to >= from).then_some((line, target))
    };
    names.into_iter().filter_map(target).collect()
}

fn walk(folder: &Path, path: &[String], visit: &mut impl FnMut(&Path, &[String])) {
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let name = entry.file_stem().unwrap().to_str().unwrap();
        let inner = [path, &[name.to_owned()]].concat();
        if entry.is_dir() {
            walk(&entry, &inner, visit);
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            visit(&entry, if name == "mod" { path } else { &inner });
        }
    }
}

#[test]
fn no_arrow_runs_up_in_the_host_crate() {
    let source = super::root().join("../../optix-host/src");
    let reexports = reexports(&fs::read_to_string(source.join("lib.rs")).unwrap());
    let mut wrong = Vec::new();
    walk(&source, &[], &mut |file, path| {
        let module = path[0].as_str();
        if module == "lib" {
            return;
        }
        let text = fs::read_to_string(file).unwrap();
        for (line, target) in upward(module, root_names(&text, path.len()), &reexports) {
            let file = file.strip_prefix(&source).unwrap().display();
            wrong.push(format!("{file}:{line}: `{module}` uses `{target}`"));
        }
    });
    wrong.sort();
    assert!(wrong.is_empty(), "these run up the layers of optix-host:\n{}", wrong.join("\n"));
}

#[test]
fn arrows_are_found_in_every_form() {
    let names = |text: &str, depth| root_names(text, depth).into_iter().map(|(_, name)| name).collect::<Vec<_>>();
    assert_eq!(names("use crate::a::{b, c};\nfn f() -> crate::d::E { $crate::g!() }", 1), ["a", "d", "g"]);
    assert_eq!(names("use crate::{a::{x, y}, B,\n c::d};", 1), ["a", "B", "c"]);
    assert_eq!(names("use super::{a, b::c}; use super::super::d;", 1), ["a", "b", "d"]);
    assert_eq!(
        names("use super::a; use super::super::d; mod m { use super::super::e; use super::super::super::f; }", 2),
        ["d", "f"]
    );
    assert_eq!(
        names("pub(crate) fn f<'a>(_: &'a str) { g(\"crate::a\", r#\"crate::\"b\"#, '\"', '\\'') } // crate::c", 1),
        [""; 0]
    );
    assert_eq!(names("const A: char = '\"'; use crate::a;", 1), ["a"]);
    let reexports = reexports("pub use device::{Device, Kind};\npub use error::Error;\npub use glam;");
    let up = |module, text| {
        upward(module, root_names(text, 1), &reexports).into_iter().map(|(_, to)| to).collect::<Vec<_>>()
    };
    assert_eq!(up("scene", "use crate::{Device, Error};"), ["device"]);
    assert_eq!(up("cpu", "use crate::optix::driver; use crate::cpu::traversal; use crate::plan::Plan;"), ["optix"]);
}
