//! A shader crate to PTX through the library.

mod common;

use std::fs;
use std::path::Path;

use optix_toolchain::{Built, Codegen, Error, Missing, Shaders, ptx};

fn compile(shaders: &Path) -> Result<Built, Error> {
    Shaders::new(shaders).compile_in(common::area())
}

#[test]
fn ptx_is_what_a_person_would_write() {
    if !common::can_compile("ptx_is_what_a_person_would_write") {
        return;
    }
    let dir = common::folder("ptx");
    let shaders = common::shader_crate(&dir);
    let files = || {
        let list = fs::read_dir(&shaders).expect("readable");
        let mut names: Vec<_> = list.flatten().map(|entry| entry.file_name()).collect();
        names.sort();
        (names, fs::read(shaders.join("Cargo.lock")).ok(), fs::read(shaders.join("Cargo.toml")).ok())
    };
    let before = files();
    let built = compile(&shaders).expect("it compiles");
    assert_eq!(files(), before, "the user's files are left alone");

    assert_eq!(built.name, "fixture_shaders");
    assert_eq!(built.entries, ["__raygen__camera"]);
    assert!(matches!(&built.functions[..], [slow] if slow.contains("reduce_large")), "{:?}", built.functions);
    let text = &built.text;
    assert!(text.contains(".target sm_75"));
    assert!(text.contains(".visible .const .align 8 .b8 params[16];"), "the symbol of the parameters");
    assert!(text.contains("[params+8]"), "a direct load of one field");
    assert_eq!(text.matches("rsqrt.approx.ftz.f32").count(), 1, "normalize is one square root, ours");
    assert_eq!(text.matches("rcp.rn.f32").count(), 1, "and one reciprocal");
    assert!(text.contains("fma.rn.f32"), "products and sums contract");
    assert!(text.contains("cvt.rmi.f32.f32"), "floor is an instruction");
    assert!(!text.contains(".f64"), "sine and cosine need no f64");

    let inputs = ["src/lib.rs", "Cargo.toml", "Cargo.lock"].map(|file| shaders.join(file));
    for input in inputs.into_iter().filter_map(|input| input.canonicalize().ok()) {
        assert!(built.inputs.contains(&input), "{} in {:?}", input.display(), built.inputs);
    }

    // A second time there is nothing to do ..
    let written = |built: &Built| fs::metadata(&built.ptx).and_then(|data| data.modified()).expect("it is there");
    let again = compile(&shaders).expect("it compiles again");
    assert_eq!(written(&again), written(&built));
    // .. unless the result is gone.
    fs::remove_file(&built.ptx).expect("removable");
    assert_eq!(compile(&shaders).expect("it compiles once more").text, built.text);

    let exact = Shaders::new(&shaders).fmad(false).line_info(true).compile_in(common::area()).expect("it compiles");
    let fused = |text: &str| text.matches("fma.rn.f32").count();
    assert!(fused(&exact.text) < fused(text), "only what asks for `fma` is fused");
    assert!(exact.text.contains("\t.loc\t"), "lines are known");

    let rough = Shaders::new(&shaders).ftz(true).prec_div(false).prec_sqrt(false);
    let rough = rough.compile_in(common::area()).expect("it compiles");
    for op in ["fma.rn.ftz.f32", "sqrt.approx.ftz.f32", "cvt.rmi.ftz.f32.f32"] {
        assert!(rough.text.contains(op), "{op}");
    }
    assert!(
        !rough.text.contains("sqrt.rn") && !rough.text.contains("0f5F800000") && !rough.text.contains("fma.rn.f32"),
        "nothing is left as it was"
    );
    assert!(!rough.text.contains("rcp.rn") && !rough.text.contains("div.rn"), "no exact division");
}

#[test]
fn libdevice_takes_the_place_of_our_functions() {
    if !common::can_compile("libdevice_takes_the_place_of_our_functions") {
        return;
    }
    let dir = common::folder("libdevice");
    let shaders = Shaders::new(common::shader_crate(&dir)).libdevice(true);
    let error = shaders.compile_in(common::area()).expect_err("rustc links none");
    assert!(error.to_string().contains("`--codegen nvvm`"), "{error}");

    let shaders = shaders.codegen(Codegen::Nvvm);
    let with = |on| shaders.clone().libdevice(on).compile_in(common::area());
    match with(true) {
        Ok(built) => {
            // Ours reduces large angles in a function.
            assert!(built.functions.is_empty() && !built.text.contains("reduce_large"), "{:?}", built.functions);
            // Neither takes the other's files.
            let ours = with(false).expect("it compiles").text;
            assert!(ours.contains("reduce_large"));
            assert_eq!(with(true).expect("it compiles").text, built.text);
            assert_eq!(with(false).expect("it compiles").text, ours);
        }
        Err(Error::NoNvvm(reason)) => println!("libdevice: not tried, no libNVVM: {reason}"),
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn what_the_device_lacks_is_an_error() {
    if !common::can_compile("what_the_device_lacks_is_an_error") {
        return;
    }
    let dir = common::folder("unresolved");
    let shaders = common::shader_crate(&dir);
    common::edit(&shaders, "direction(x, y, t);", "{ missing(); direction(x, y, t) };");
    common::edit(
        &shaders,
        "    #[unsafe(no_mangle)]",
        "    unsafe extern \"C\" { fn missing(); }\n    #[unsafe(no_mangle)]",
    );
    let error = compile(&shaders).expect_err("`missing` is defined nowhere");
    let Error::Missing(culprit) = &error else { panic!("{error}") };
    assert_eq!(culprit.what, Missing::Function("missing".into()));
    assert_eq!(culprit.at.function, "__raygen__camera");

    common::edit(&shaders, "#[unsafe(no_mangle)]", "");
    let error = compile(&shaders).expect_err("there is no entry");
    assert!(matches!(error, Error::Ptx { problem: ptx::Problem::NoEntry, .. }), "{error}");

    let error = Shaders::new(&shaders).arch("sm_1").compile_in(common::area()).expect_err("no such GPU");
    assert!(matches!(error, Error::UnknownArch { .. }), "{error}");
}

#[test]
fn a_folder_must_be_a_shader_crate() {
    let dir = common::folder("no-crate");
    for path in [dir.clone(), dir.join("missing")] {
        let error = compile(&path).expect_err("it holds no crate");
        assert!(matches!(error, Error::NotAShaderCrate { .. }), "{error}");
    }
}
