//! The public traits of the device crate: none that others rely on may be implemented by safe code.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Who may implement a trait.
#[derive(PartialEq)]
enum Kind {
    Unsafe,
    Sealed,
    Open,
}

/// A public trait, by the file that declares it.
struct Trait {
    key: String,
    name: String,
    kind: Kind,
    /// Its lines of documentation.
    docs: String,
}

/// The traits of a file.
fn traits(file: &str, text: &str) -> Vec<Trait> {
    let mut docs = String::new();
    let mut found = Vec::new();
    for line in text.lines() {
        let line = line.trim();
        if line.starts_with("///") {
            docs.push_str(line);
            docs.push('\n');
        } else if let Some(rest) = line.strip_prefix("pub unsafe trait ").or(line.strip_prefix("pub trait ")) {
            let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            let kind = match line.starts_with("pub unsafe") {
                true => Kind::Unsafe,
                false if rest.contains("Sealed") => Kind::Sealed,
                false => Kind::Open,
            };
            // Those that a macro declares have their name from the macro.
            if !name.is_empty() && name != "Sealed" {
                found.push(Trait { key: format!("{file}:{name}"), name, kind, docs: std::mem::take(&mut docs) });
            }
        } else if line.is_empty() {
            docs.clear();
        }
    }
    found
}

fn walk(folder: &Path, root: &Path, found: &mut Vec<Trait>) {
    let mut paths: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            walk(&path, root, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let file = path.strip_prefix(root).unwrap().to_str().unwrap().to_owned();
            found.extend(traits(&file, &fs::read_to_string(&path).unwrap()));
        }
    }
}

/// The section of the page. Panics where a trait is neither unsafe nor sealed nor said to be harmless in `public_traits.tsv`.
pub fn section(root: &Path, table: &[Vec<String>]) -> String {
    let source = root.join("../../optix-device-rs/src");
    let mut found = Vec::new();
    walk(&source, &source, &mut found);
    let source = root.join("../../optix-host/src");
    walk(&source, &source, &mut found);
    let mut reasons: BTreeMap<&str, &str> =
        table.iter().map(|row| (row[0].as_str(), row.get(1).map_or("", String::as_str))).collect();
    let mut section = String::from(
        "\n## Public traits\n\nThose of optix-device-rs and of optix-host, and why no safe code can break a promise by implementing one. The few of the \
         macros' payload parts (`ReceivedBy..`, `ReturnedBy..`) only pass a part on.\n\n| trait | safe code |\n| --- | --- |\n",
    );
    for found in &found {
        let reason = reasons.remove(found.key.as_str());
        let why = match (&found.kind, reason) {
            (Kind::Unsafe, None) => {
                assert!(found.docs.contains("# Safety"), "{} does not say what its implementation promises", found.key);
                "can't implement it: its `# Safety` section says what that promises"
            }
            (Kind::Sealed, None) => "can't implement it: it is sealed",
            (Kind::Open, Some(reason)) => reason,
            (Kind::Open, None) => {
                panic!("{}: make it unsafe or sealed, or say in public_traits.tsv why it is harmless", found.key)
            }
            _ => panic!("{} is not open, but public_traits.tsv has it", found.key),
        };
        let _ = writeln!(section, "| `{}` ({}) | {why} |", found.name, found.key.split(':').next().unwrap_or_default());
    }
    assert!(reasons.is_empty(), "public_traits.tsv has traits that are not there: {reasons:?}");
    section
}

#[test]
fn an_open_trait_needs_a_reason() {
    let of = |text: &str| traits("a.rs", text).into_iter().map(|found| (found.name, found.kind)).collect::<Vec<_>>();
    assert!(of("pub trait A<T>: Copy {}") == [("A".to_owned(), Kind::Open)]);
    assert!(of("    pub trait B: Sealed + 'static {") == [("B".to_owned(), Kind::Sealed)]);
    assert!(of("/// # Safety\npub unsafe trait C {") == [("C".to_owned(), Kind::Unsafe)]);
    assert!(of("pub trait $name {}\ntrait D {}").is_empty());
}
