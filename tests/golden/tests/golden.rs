//! Nothing is paid at run time: typed programs beside their twins, instruction by instruction.
//!
//! `OPTIX_GOLDEN=write cargo test -p optix-golden-tests` writes `expected/` anew.

use optix_golden_tests::{multiset, normalised};
use optix_ptx::Module;
use optix_toolchain::{Built, DeviceCompiler, Shaders};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// The programs, by the last part of the raw entry's name.
const PROGRAMS: [&str; 12] = [
    "__raygen__index",
    "__raygen__words",
    "__raygen__bytes",
    "__raygen__wide",
    "__raygen__caller",
    "__closesthit__shade",
    "__anyhit__cut_out",
    "__closesthit__corners",
    "__intersection__ball",
    "__closesthit__ball_shade",
    "__miss__sky",
    "__direct_callable__blend",
];

/// Those whose instructions are in one order too. The others may differ in the order of instructions that do not depend
/// on each other: that depends on symbol names, which hold a hash of where the checkout is.
const IN_ORDER: [&str; 2] = ["__raygen__bytes", "__anyhit__cut_out"];

/// Both crates and the compiler that made them; `None`, said on standard error, without a device compiler.
fn compiled(test: &str) -> Option<(DeviceCompiler, Built, Built)> {
    let compiler = match DeviceCompiler::find() {
        Ok(compiler) => compiler,
        Err(error) => {
            eprintln!("{test}: not run: {error}");
            return None;
        }
    };
    let compile = |name: &str| shaders(name).compile_in(area()).expect("it compiles");
    Some((compiler, compile("typed"), compile("raw")))
}

fn shaders(name: &str) -> Shaders {
    Shaders::new(Path::new(env!("CARGO_MANIFEST_DIR")).join(name))
}

fn area() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("optix")
}

fn typed(built: &Built, program: &str) -> Vec<String> {
    // `__raygen__index` is `__raygen__Golden_index_..`.
    let begin = program.rfind("__").expect("an entry's name") + 2;
    let prefix = format!("{}Golden_{}_", &program[..begin], &program[begin..]);
    only(built, |name| name.starts_with(&prefix), &prefix)
}

fn raw(built: &Built, program: &str) -> Vec<String> {
    only(built, |name| name == program, program)
}

/// The code of the only entry with such a name: `ball` is the beginning of `ball_shade` too, but that is of another kind.
fn only(built: &Built, is_it: impl Fn(&str) -> bool, what: &str) -> Vec<String> {
    let text = optix_ptx::plain(&built.text);
    let module = Module::read(&text);
    let found: Vec<_> = module.entries().filter(|entry| is_it(entry.name)).collect();
    assert_eq!(found.len(), 1, "{what}");
    let params = module.variables.iter().find(|variable| variable.space == "const").expect("parameters");
    normalised(found[0], params.name)
}

#[test]
fn typed_programs_are_what_one_would_write_by_hand() {
    let Some((_, typed_crate, raw_crate)) = compiled("typed_programs_are_what_one_would_write_by_hand") else {
        return;
    };
    assert_eq!(typed_crate.entries.len(), PROGRAMS.len(), "{:?}", typed_crate.entries);
    let mut differences = String::new();
    for program in PROGRAMS {
        let (typed, raw) = (typed(&typed_crate, program), raw(&raw_crate, program));
        let same = if IN_ORDER.contains(&program) { typed == raw } else { multiset(&typed) == multiset(&raw) };
        if !same {
            let _ = writeln!(differences, "{program}: typed {}, raw {}", typed.len(), raw.len());
            for i in 0..typed.len().max(raw.len()) {
                let line = |of: &[String]| of.get(i).cloned().unwrap_or_default();
                let mark = if typed.get(i) == raw.get(i) { ' ' } else { '|' };
                let _ = writeln!(differences, "    {:60} {mark} {}", line(&typed), line(&raw));
            }
        }
    }
    assert!(differences.is_empty(), "typed programs differ from their twins:\n{differences}");
}

#[test]
fn typed_programs_stay_in_registers_where_overflow_is_checked() {
    if compiled("typed_programs_stay_in_registers_where_overflow_is_checked").is_none() {
        return;
    }
    let built = shaders("typed").checks(true).compile_in(area()).expect("it compiles");
    assert!(!built.text.contains(".local"), "{}", built.ptx.display());
}

#[test]
fn typed_programs_are_as_expected() {
    let Some((compiler, typed_crate, _)) = compiled("typed_programs_are_as_expected") else { return };
    let header = format!("// rustc {}, LLVM {}, {}", release(&compiler), compiler.llvm, optix_toolchain::DEFAULT_ARCH);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("expected");
    let write = std::env::var_os("OPTIX_GOLDEN").is_some_and(|value| value == "write");
    for program in PROGRAMS {
        let file = folder.join(format!("{}.ptx", program.trim_start_matches('_').replace("__", "-")));
        let lines = typed(&typed_crate, program);
        let text = format!("{header}\n{}\n", lines.join("\n"));
        if write {
            fs::write(&file, &text).expect("writable");
            continue;
        }
        let expected = fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let of = expected.lines().next().unwrap_or_default();
        if of != header {
            eprintln!(
                "typed_programs_are_as_expected: not compared: expected/ is of \"{of}\", the compiler here is \"{header}\""
            );
            return;
        }
        let expected: Vec<String> = expected.lines().skip(1).map(String::from).collect();
        assert!(multiset(&lines) == multiset(&expected), "{} differs; now it is:\n{text}", file.display());
    }
}

/// `1.96.0` in what `rustc -vV` prints.
fn release(compiler: &DeviceCompiler) -> &str {
    compiler.version.lines().find_map(|line| line.strip_prefix("release: ")).unwrap_or("unknown")
}
