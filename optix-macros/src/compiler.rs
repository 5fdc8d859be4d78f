//! What the compiler was given, in whose process a macro runs.
//!
//! From that follows under which name the user's crate knows the device crate: Cargo.toml may give a dependency any name, and may list one under several of which some are switched off by features; what
//! holds for this compilation is `--extern rt=/../liboptix_device_rs-0123.rmeta`.

use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

const LIBRARY: &str = "liboptix_device_rs";
const NAME: &str = "optix_device_rs";

/// The device crate among what the compiler was given.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Found {
    /// The device crate, under this name.
    Name(String),
    /// Other crates, but not this one.
    Missing,
    /// More than one.
    Several(Vec<String>),
}

fn found() -> &'static Found {
    static FOUND: OnceLock<Found> = OnceLock::new();
    FOUND.get_or_init(|| find(&arguments()))
}

/// The name of the device crate.
pub fn device_crate() -> Ident {
    match found() {
        Found::Name(name) => Ident::new(name, Span::call_site()),
        _ => Ident::new(NAME, Span::call_site()),
    }
}

/// Why there is no device crate to refer to, if there is none.
pub fn problem() -> Option<String> {
    match found() {
        Found::Name(_) => None,
        Found::Missing => Some(
            "what this macro makes refers to optix-device-rs, which is not among the dependencies of this crate: add it to \
             `[dependencies]` in its Cargo.toml, under any name"
                .into(),
        ),
        Found::Several(names) => Some(format!(
            "there are several crates `{NAME}` among the dependencies of this crate, `{}`: what this macro makes refers to one",
            names.join("`, `")
        )),
    }
}

/// Whether the crate may call another thing by the name of the device crate: by `extern crate self as name` in its root. Macros
/// can't make that of a name that the compiler was given, so it stands in the root's file.
pub fn is_shadowed() -> bool {
    static IS_SHADOWED: OnceLock<bool> = OnceLock::new();
    *IS_SHADOWED.get_or_init(|| {
        let (Found::Name(name), arguments) = (found(), arguments()) else { return false };
        let is_compiler = arguments.iter().any(|argument| argument.starts_with("--extern"));
        is_compiler && root(&arguments).is_none_or(|root| renames_to(root, name))
    })
}

/// The crate's root, if it can be read.
fn root(arguments: &[String]) -> Option<TokenStream> {
    let mut files = arguments.iter().filter(|argument| argument.ends_with(".rs") && !argument.starts_with('-'));
    let (root, None) = (files.next()?, files.next()) else { return None };
    std::fs::read_to_string(root).ok()?.parse().ok()
}

/// Whether there is an `extern crate other as name`.
fn renames_to(root: TokenStream, name: &str) -> bool {
    let word = |token: TokenTree| match token {
        TokenTree::Ident(ident) => crate::support::name(&ident),
        _ => String::new(),
    };
    let words: Vec<String> = root.into_iter().map(word).collect();
    words.windows(5).any(|words| words[0] == "extern" && words[1] == "crate" && words[3] == "as" && words[4] == name)
}

/// Whether the compiler was given `--cfg word`. Asked here, so that no crate has to know the word.
pub fn has_cfg(word: &str) -> bool {
    let arguments = arguments();
    arguments.windows(2).any(|pair| pair[0] == "--cfg" && pair[1] == word)
        || arguments.contains(&format!("--cfg={word}"))
}

/// The compiler's arguments, with those that it reads from files.
fn arguments() -> Vec<String> {
    let lines = |file: &str| std::fs::read_to_string(file).map(|text| text.lines().map(str::to_owned).collect());
    let text = |argument: OsString| argument.to_string_lossy().into_owned();
    let arguments = std::env::args_os().skip(1).map(text).map(|argument| match argument.strip_prefix('@') {
        Some(file) => lines(file).unwrap_or_default(),
        None => vec![argument],
    });
    arguments.flatten().collect()
}

/// The device crate among `--extern name=path`. Where there are no such arguments, this is no compiler but an editor's helper,
/// and the name is the usual one.
fn find(arguments: &[String]) -> Found {
    let behind_flag = arguments.iter().zip(arguments.iter().skip(1)).filter(|(flag, _)| *flag == "--extern");
    let joined = arguments.iter().filter_map(|argument| argument.strip_prefix("--extern="));
    let externs = behind_flag.map(|(_, value)| value.as_str()).chain(joined);
    // `priv:name=path` has options before the name.
    let externs = externs.filter_map(|value| value.split_once('='));
    let mut externs = externs.map(|(name, path)| (name.rsplit(':').next().unwrap_or(name), path)).peekable();
    if externs.peek().is_none() {
        return Found::Name(NAME.into());
    }
    let is_it = |path: &Path| {
        let rest = path.file_name().and_then(|file| file.to_str()?.strip_prefix(LIBRARY));
        rest.is_some_and(|rest| rest.starts_with(['-', '.']))
    };
    let found: Vec<_> =
        externs.map(|(name, path)| (name, PathBuf::from(path))).filter(|(_, path)| is_it(path)).collect();
    match &found[..] {
        [] => Found::Missing,
        [(name, first), others @ ..] if others.iter().all(|(_, path)| path == first) => Found::Name((*name).into()),
        several => Found::Several(several.iter().map(|(name, _)| (*name).into()).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::{Found, find, renames_to, root};

    fn of(arguments: &str) -> Found {
        find(&arguments.split(' ').map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn the_name_is_what_the_compiler_was_given() {
        let name = |name: &str| Found::Name(name.into());
        assert_eq!(of("--crate-name a --extern glam=/x/libglam-1.rmeta"), Found::Missing);
        assert_eq!(of("--crate-name a"), name("optix_device_rs"));
        assert_eq!(of("--extern glam=/g.rlib --extern rt=/x=y/liboptix_device_rs-01.rmeta -v"), name("rt"));
        assert_eq!(of("--extern=priv,noprelude:rt=/x/liboptix_device_rs.rlib"), name("rt"));
        assert_eq!(of("--extern rt=/x/liboptix_device_rs_more-01.rlib"), Found::Missing);
        let twice = "--extern a=/x/liboptix_device_rs-01.rmeta --extern b=/x/liboptix_device_rs-0";
        assert_eq!(of(&format!("{twice}1.rmeta")), name("a"));
        assert_eq!(of(&format!("{twice}2.rmeta")), Found::Several(vec!["a".into(), "b".into()]));
    }

    #[test]
    fn what_shadows_the_name_is_seen() {
        let renames = |text: &str| renames_to(text.parse().expect("tokens"), "rt");
        assert!(renames("#![no_std] extern crate alloc; extern crate self as rt; fn main() {}"));
        assert!(renames("pub extern /* so */ crate r#other\nas r#rt;"));
        assert!(!renames("extern crate rt; extern crate rt as other; mod a { use x as rt; } fn extern_crate() {}"));
        let root = |arguments: &str| root(&arguments.split(' ').map(str::to_owned).collect::<Vec<_>>());
        assert!(
            root(&format!("--edition=2024 {} --error-format=json", concat!(env!("CARGO_MANIFEST_DIR"), "/src/lib.rs")))
                .is_some()
        );
        assert!(root("--edition=2024 - --error-format=json").is_none() && root("a.rs b.rs").is_none());
    }
}
