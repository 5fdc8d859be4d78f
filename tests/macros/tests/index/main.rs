//! `docs/contracts.md`: which rule has which tests, made from the first lines of the cases in `ui`.
//!
//! `CONTRACTS=overwrite cargo test -p optix-macro-tests --test index` writes the page anew.

mod device_functions;
mod layers;
mod limits;
mod traits;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// A rule of `checklist.tsv`.
struct Rule {
    /// By which the cases name it.
    id: String,
    /// Where the guide has it; empty for a rule of this toolkit.
    guide: String,
    text: String,
    /// Why no test covers it; empty if one does.
    open: String,
}

/// A case that must not compile.
struct Case {
    name: String,
    ids: Vec<String>,
    what: String,
    /// The program that compiles and has the case put right.
    twin: String,
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Name and text of the Rust files of a folder, by name.
fn sources(folder: &Path) -> BTreeMap<String, String> {
    let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    let rust = files.filter(|path| path.extension().is_some_and(|e| e == "rs"));
    rust.map(|path| (path.file_stem().unwrap().to_str().unwrap().to_owned(), fs::read_to_string(&path).unwrap()))
        .collect()
}

/// The lines of a table, without comments.
fn table(name: &str) -> Vec<Vec<String>> {
    let text = fs::read_to_string(root().join(name)).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split('\t').map(str::to_owned).collect()).collect()
}

fn rules() -> Vec<Rule> {
    let rule = |line: Vec<String>| match <[String; 4]>::try_from(line) {
        Ok([id, guide, text, open]) => Rule { id, guide, text, open },
        Err(line) => panic!("four columns expected: {line:?}"),
    };
    table("checklist.tsv").into_iter().map(rule).collect()
}

fn cases() -> Vec<Case> {
    let pass = sources(&root().join("ui/pass"));
    let case = |(name, source): (String, String)| {
        let first = source.lines().next().unwrap_or_default();
        let (ids, what) = first
            .strip_prefix("// ")
            .and_then(|line| line.split_once(": "))
            .unwrap_or_else(|| panic!("ui/{name}.rs begins with `// H024, H022: what`, not with `{first}`"));
        let module = format!("\nmod {name} {{\n");
        let twin = pass.iter().find(|(_, text)| text.contains(&module));
        let twin =
            twin.unwrap_or_else(|| panic!("no program in ui/pass has `mod {name}`, the case put right")).0.clone();
        Case { ids: ids.split(", ").map(str::to_owned).collect(), what: what.to_owned(), twin, name }
    };
    sources(&root().join("ui")).into_iter().map(case).collect()
}

/// The page.
fn page(rules: &[Rule], cases: &[Case]) -> String {
    let mut page = format!(
        "# Contracts: what is wrong does not compile\n\n\
         Generated from the first lines of the cases in `tests/macros/ui` by `CONTRACTS=overwrite cargo test -p \
         optix-macro-tests --test index`; do not edit.\n\n\
         {} cases must fail, each with the message beside it (`.stderr`); each is put right in a module of the same name \
         in a program that must compile. Rules without a section of the OptiX guide are this toolkit's own.\n\n\
         ## Rules with tests\n\n| guide | what holds | does not compile | put right in |\n| --- | --- | --- | --- |\n",
        cases.len()
    );
    for rule in rules.iter().filter(|rule| rule.open.is_empty()) {
        let of_rule = cases.iter().filter(|case| case.ids.contains(&rule.id));
        let fails: Vec<_> =
            of_rule.clone().map(|case| format!("[{0}](../tests/macros/ui/{0}.rs)", case.name)).collect();
        let mut passes: Vec<_> =
            of_rule.map(|case| format!("[{0}](../tests/macros/ui/pass/{0}.rs)", case.twin)).collect();
        passes.sort();
        passes.dedup();
        let _ = writeln!(page, "| {} | {} | {} | {} |", rule.guide, rule.text, fails.join(", "), passes.join(", "));
    }
    page.push_str("\n## Cases\n\n| case | what holds | guide |\n| --- | --- | --- |\n");
    for case in cases {
        let mut guide: Vec<&str> = Vec::new();
        for rule in rules.iter().filter(|rule| case.ids.contains(&rule.id)) {
            guide.extend(rule.guide.split(", ").filter(|section| !section.is_empty()));
        }
        guide.sort_by_key(|section| section.split('.').map(|part| part.parse().unwrap_or(0)).collect::<Vec<u32>>());
        guide.dedup();
        let _ = writeln!(
            page,
            "| [{0}](../tests/macros/ui/{0}.stderr) | {1} | {2} |",
            case.name,
            case.what,
            guide.join(", ")
        );
    }
    page.push_str(&device_functions::section(&table("device_functions.tsv")));
    page.push_str(&traits::section(&root(), &table("public_traits.tsv")));
    page.push_str(
        "\n## Rules without a test of this kind\n\nWhat a compiler could check, and why no case covers it.\n\n\
         | guide | what holds | why not here |\n| --- | --- | --- |\n",
    );
    for rule in rules.iter().filter(|rule| !rule.open.is_empty()) {
        let _ = writeln!(page, "| {} | {} | {} |", rule.guide, rule.text, rule.open);
    }
    page
}

#[test]
fn contracts() {
    let (rules, cases) = (rules(), cases());
    for case in &cases {
        for id in &case.ids {
            let rule = rules.iter().find(|rule| rule.id == *id);
            let rule =
                rule.unwrap_or_else(|| panic!("ui/{}.rs names `{id}`, which checklist.tsv does not have", case.name));
            assert!(rule.open.is_empty(), "ui/{}.rs covers {id}: checklist.tsv says `{}`", case.name, rule.open);
        }
    }
    for rule in rules.iter().filter(|rule| rule.open.is_empty()) {
        let covered = cases.iter().any(|case| case.ids.contains(&rule.id));
        assert!(covered, "no case covers {}: write one, or say why not in checklist.tsv", rule.id);
    }
    let (path, page) = (root().join("../../docs/contracts.md"), page(&rules, &cases));
    if std::env::var("CONTRACTS").is_ok_and(|value| value == "overwrite") {
        fs::write(path, page).unwrap();
    } else {
        let stale = fs::read_to_string(path).unwrap_or_default() != page;
        assert!(!stale, "docs/contracts.md is stale: run this test with `CONTRACTS=overwrite`");
    }
}

/// Every message is checked in: without it trybuild would accept any.
#[test]
fn messages() {
    for case in cases() {
        let path = root().join(format!("ui/{}.stderr", case.name));
        assert!(
            path.exists(),
            "ui/{}.stderr is missing: `TRYBUILD=overwrite cargo test -p optix-macro-tests`",
            case.name
        );
    }
    for path in fs::read_dir(root().join("ui")).unwrap().map(|file| file.unwrap().path()) {
        let source = path.with_extension("rs");
        assert!(path.is_dir() || source.exists(), "{} belongs to no case", path.display());
    }
}

/// The programs that try every device function from every kind of program are those of the table.
#[test]
fn device_functions() {
    let functions = table("device_functions.tsv");
    let write = std::env::var("CONTRACTS").is_ok_and(|value| value == "overwrite");
    for (name, program) in device_functions::programs(&functions) {
        let path = root().join("ui").join(&name);
        if write {
            fs::write(path, program.text).unwrap();
            continue;
        }
        let stale = fs::read_to_string(&path).unwrap_or_default() != program.text;
        assert!(!stale, "{name} is stale: run this test with `CONTRACTS=overwrite`");
        // trybuild compares the messages; that none is missing is for us to see.
        let messages = fs::read_to_string(path.with_extension("stderr")).unwrap_or_default();
        let errors = messages.lines().filter(|line| line.starts_with("error")).count();
        assert_eq!(errors, program.refused.len(), "{name} has errors that are not about a device function");
        for line in program.refused {
            let at = format!("--> ui/{name}:{line}:");
            assert!(messages.contains(&at), "line {line} of {name} compiles, but the function is not allowed there");
        }
    }
}

/// The table says what the table of facts beside the repository says, where there is one.
#[test]
fn device_functions_are_those_of_the_guide() {
    let facts = root().join("../../../shared/facts/device_function_legality.tsv");
    let Ok(facts) = fs::read_to_string(facts) else { return };
    let mut ours: Vec<_> =
        table("device_functions.tsv").into_iter().map(|row| (row[0].clone(), row[1].clone())).collect();
    ours.dedup(); // one may have two calls
    let theirs: Vec<_> = facts.lines().skip(1).map(|line| line.split('\t').collect::<Vec<_>>()).collect();
    assert_eq!(ours, theirs.iter().map(|row| (row[0].to_owned(), row[1..9].concat())).collect::<Vec<_>>());
}

/// So does the table in the device crate that the contexts' methods are made from. Functions that are generic are written out there,
/// and only the programs above try them.
#[test]
fn device_functions_are_those_of_the_device_crate() {
    const WRITTEN_OUT: [&str; 6] = [
        "optixThrowException",
        "optixTrace",
        "optixGetAttribute_0...7",
        "optixIsTriangleHit",
        "optixReportIntersection",
        "optixGetExceptionDetail_0...7",
    ];
    let contexts = device_functions::contexts();
    let marks = |has: &[&str]| contexts.map(|context| if has.contains(&context) { '1' } else { '0' });
    let rows: BTreeMap<&str, String> =
        optix_device_rs::intrinsics::table().map(|row| (row.optix, marks(row.contexts).iter().collect())).collect();
    for row in table("device_functions.tsv") {
        let (name, kinds, call) = (row[0].as_str(), &row[1], &row[2]);
        if call.contains("at.") && !WRITTEN_OUT.contains(&name) {
            assert_eq!(rows.get(name), Some(kinds), "{name}");
        }
    }
    let known = table("device_functions.tsv");
    for name in rows.keys() {
        assert!(known.iter().any(|row| row[0] == *name), "device_functions.tsv does not have {name}");
    }
}
