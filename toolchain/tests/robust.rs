//! What other crates do to a device build: it works, or the error says which crate, where and why.

mod common;

use std::fs;
use std::path::PathBuf;

use optix_toolchain::{Built, Error, Missing, Shaders};

const SHADERS: &str = r#"#![no_std]

#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn __raygen__camera() {
    let x: u32;
    unsafe { core::arch::asm!("call ({}), _optix_get_launch_index_x, ();", out(reg32) x) };
    let value = compute(x);
    unsafe { core::arch::asm!("call _optix_set_payload, ({}, {});", in(reg32) 0, in(reg32) value) };
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}
"#;

/// A crate of the name and source, which uses the crates beside it.
fn write(dir: PathBuf, source: &str, uses: &[&str]) -> PathBuf {
    let name = dir.file_name().expect("it has a name").to_string_lossy().into_owned();
    let uses: String = uses.iter().map(|name| format!("{name} = {{ path = \"../{name}\" }}\n")).collect();
    let features = "[features]\ndefault = [\"std\"]\nstd = []\n";
    let manifest = format!(
        "[package]\nname = \"{name}\"\nversion = \"1.2.3\"\nedition = \"2024\"\n\n[dependencies]\n{uses}\n{features}\n[workspace]\n"
    );
    fs::create_dir_all(dir.join("src")).expect("writable");
    fs::write(dir.join("Cargo.toml"), manifest).expect("writable");
    fs::write(dir.join("src/lib.rs"), source).expect("writable");
    dir
}

/// A crate's name and source, and what it uses.
type Beside<'a> = (&'a str, &'a str, &'a [&'a str]);

/// Shaders with `fn compute(x: u32) -> u32`, which use the first of the crates beside them. None: this machine can't compile
/// them, and the test `name` does not run.
fn shaders(name: &str, compute: &str, beside: &[Beside<'_>]) -> Option<Shaders> {
    let dir = common::can_compile(name).then(|| common::folder(&format!("robust-{name}")))?;
    for (name, source, uses) in beside {
        write(dir.join(name), source, uses);
    }
    let uses: Vec<&str> = beside.iter().take(1).map(|(name, ..)| *name).collect();
    Some(Shaders::new(write(dir.join("my-shaders"), &format!("{SHADERS}\n{compute}"), &uses)))
}

fn compile(shaders: &Shaders) -> Result<Built, Error> {
    shaders.compile_in(common::area())
}

#[test]
fn a_panic_is_a_trap_and_nothing_else() {
    let compute = r#"
fn compute(x: u32) -> u32 {
    let table = [1, 5, 2, 8];
    assert!(x < 100, "{x} is too much, {:?}", Some(x));
    let some: Result<u32, core::fmt::Error> = if x > 3 { Ok(table[x as usize]) } else { Err(core::fmt::Error) };
    match some.expect("more than three") {
        7 => panic!("seven: {x:#?}"),
        other => 10 / (other + x),
    }
}"#;
    let Some(shaders) = shaders("panics", compute, &[]) else { return };
    let built = compile(&shaders).expect("it compiles");
    assert!(built.text.contains("trap;"));
    assert!(built.functions.is_empty(), "no panics, no formatting: {:?}", built.functions);
    assert!(built.text.matches(".global").count() <= 1, "the table, and no messages: {}", built.text);
}

#[test]
fn overflow_and_debug_assertions_follow_the_profile() {
    let compute = "fn compute(x: u32) -> u32 { debug_assert!(x != 77); x + 3 }";
    let Some(shaders) = shaders("checks", compute, &[]) else { return };
    let text = |shaders: Shaders| compile(&shaders).expect("it compiles").text;
    let (without, with) = (text(shaders.clone()), text(shaders.checks(true)));
    assert!(!without.contains("trap;"), "{without}");
    assert!(with.contains("trap;") && with.contains(", 77;"), "{with}");
}

#[test]
fn slices_compare() {
    let compute = "fn compute(x: u32) -> u32 { let word = [\"red\", \"green\", \"blue\"][(x % 3) as usize]; (word == \"green\").into() }";
    let Some(shaders) = shaders("slices", compute, &[]) else { return };
    assert_eq!(compile(&shaders).expect("it compiles").functions, ["memcmp"]);
}

#[test]
fn alloc_is_there_and_the_heap_is_not() {
    let list = "#![no_std]\nextern crate alloc;\n\n\
                pub fn list(n: u32) -> alloc::vec::Vec<u32> {\n    (0..n).map(|i| i * i).collect()\n}\n\
                pub fn half(n: u32) -> u32 {\n    *alloc::boxed::Box::new(n) / 2\n}\n";
    let folded = "fn compute(x: u32) -> u32 { list::half(x) }";
    let Some(shaders) = shaders("heap-folded", folded, &[("list", list, &[])]) else { return };
    compile(&shaders).expect("what is never allocated needs no heap");
    let used = "fn compute(x: u32) -> u32 {\n    list::list(x).iter().sum()\n}";
    let Some(shaders) = self::shaders("heap", used, &[("list", list, &[])]) else { return };
    let error = compile(&shaders).expect_err("there is no heap");
    let Error::Missing(culprit) = &error else { panic!("{error}") };
    assert_eq!(culprit.what, Missing::Heap);
    assert_eq!(culprit.at.package, "list 1.2.3", "{error}");
    let from = culprit.from.as_ref().expect("the shader crate calls it");
    assert_eq!((from.function.as_str(), from.package.as_str()), ("compute", "my-shaders 1.2.3"), "{error}");
    assert_eq!(from.line as usize, SHADERS.lines().count() + 3, "{error}");
}

#[test]
fn a_crate_that_needs_std_is_named() {
    let files = "pub fn same(x: u32) -> u32 { x }\npub fn read() -> String { String::new() }\n";
    let beside: [Beside; 2] = [("between", "#![no_std]\npub use files::same;\n", &["files"]), ("files", files, &[])];
    let Some(shaders) = shaders("std", "fn compute(x: u32) -> u32 { between::same(x) }", &beside) else { return };
    let error = compile(&shaders).expect_err("there is no std");
    let Error::NeedsStd(needs_std) = &error else { panic!("{error}") };
    assert_eq!(needs_std.package, "files 1.2.3");
    assert_eq!(needs_std.way, ["my-shaders", "between", "files"]);
    assert_eq!(needs_std.feature.as_deref(), Some("std"));
    assert!(error.to_string().contains("take `between` with `default-features = false`"), "{error}");
}

#[test]
fn what_is_of_the_standard_library_has_something_in_its_place() {
    for (folder, used, name, instead) in [
        ("println", "{ println!(\"{x}\"); x }", "println!", "SliceMut"),
        ("vec", "{ let all = vec![x]; all[0] }", "vec!", "an array of a fixed length"),
        ("string", "{ String::new().len() as u32 + x }", "String", "UserException"),
    ] {
        let Some(shaders) = shaders(folder, &format!("fn compute(x: u32) -> u32 {used}"), &[]) else { return };
        let error = compile(&shaders).expect_err("there is no std");
        let Error::OfStd { package, of_std } = &error else { panic!("{error}") };
        assert_eq!((package.as_str(), of_std.name), ("my-shaders", name));
        assert!(error.to_string().contains(instead), "{error}");
    }
}

#[test]
fn what_optix_does_not_run_is_named() {
    let pointers = "fn compute(x: u32) -> u32 { [|x| x + 1, |x| x * x, |x: u32| x / 3][(x % 3) as usize](x) }";
    let recursion = "
        #[inline(never)]
        fn compute(x: u32) -> u32 {
            let y: u32;
            unsafe { core::arch::asm!(\"call ({}), _optix_get_launch_index_y, ();\", out(reg32) y) };
            if x < 2 { y } else { compute(x / 2) + compute(x / 3) }
        }";
    for (name, compute, is_expected) in [
        ("pointers", pointers, (|what| matches!(what, Missing::Pointers)) as fn(&Missing) -> bool),
        ("recursion", recursion, |what| matches!(what, Missing::Recursion)),
    ] {
        let Some(shaders) = shaders(name, compute, &[]) else { return };
        let error = compile(&shaders).expect_err(name);
        let Error::Missing(culprit) = &error else { panic!("{error}") };
        assert!(is_expected(&culprit.what) && culprit.at.function == "compute", "{error}");
    }
}

#[test]
fn what_the_code_generator_can_not_do_is_named() {
    let compute = "fn compute(x: u32) -> u32 { ((x as u128) << 60) as f32 as u32 }";
    let Some(shaders) = shaders("wide", compute, &[]) else { return };
    let error = compile(&shaders).expect_err("LLVM has no such conversion for the device");
    let Error::Missing(culprit) = &error else { panic!("{error}") };
    assert_eq!((&culprit.what, culprit.at.function.as_str()), (&Missing::WideConversion, "compute"), "{error}");
}

#[test]
fn a_crate_may_be_named_like_what_is_in_it() {
    if !common::can_compile("names") {
        return;
    }
    let names = "pub fn compute(x: u32) -> u32 { x }\npub fn camera() {}\npub mod heap {}\npub mod core {}\npub fn optix() {}\n";
    let source = format!("{}\n{names}", SHADERS.replace("core::", "::core::"));
    for name in ["camera", "heap", "compute", "r-type"] {
        let dir = common::folder(&format!("robust-names-{name}"));
        compile(&Shaders::new(write(dir.join(name), &source, &[]))).expect(name);
    }
}
