//! Host and device name programs alike, wherever their sources are.

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;

use optix_toolchain::Shaders;

/// A pipeline with one program.
fn pipeline(name: &str) -> String {
    format!(
        "#[launch_params]\npub struct {name}Frame {{ pub out: SliceMut<u32> }}\n\n\
         #[raygen]\nfn {lower}(rg: &RayGen<{name}>) {{ rg.params().out().set(0, 1) }}\n\n\
         pipeline! {{ pub struct {name} {{ params: {name}Frame, raygen: [{lower}], rays: {{}}, hitgroups: {{}} }} }}\n",
        lower = name.to_lowercase()
    )
}

const PRELUDE: &str = "use optix_device_rs::prelude::*;\n\n";

const MAIN: &str = "use optix_device_rs::pipeline::Pipeline;\n\nfn main() {\n    use beside::{Root, elsewhere::Elsewhere, \
                    included::Included, inner::Inner, made::Made, again, once_more};\n    let all = [Root::DESCRIPTION, Elsewhere::DESCRIPTION, \
                    Included::DESCRIPTION, Inner::DESCRIPTION, Made::DESCRIPTION, again::Root::DESCRIPTION, once_more::Root::DESCRIPTION];\n    all.iter().for_each(|pipeline| \
                    println!(\"{}\", pipeline.raygen[0].entry.name));\n}\n";

const BUILD: &str = "fn main() {\n    let out = std::env::var(\"OUT_DIR\").unwrap();\n    std::fs::copy(\"made.txt\", \
                     format!(\"{out}/made.rs\")).unwrap();\n}\n";

/// The crate's root lies beside its manifest, which is that of a workspace: the host's rustc is told `lib.rs`, the device's the
/// whole path. Other sources lie deeper, in another folder, are included, or written by a build script; three pipelines of one file have one name.
#[test]
fn programs_have_one_name() {
    if !common::can_compile("programs_have_one_name") {
        return;
    }
    let dir = common::folder("symbols");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace");
    let package = dir.join("beside");
    let manifest = format!(
        "[package]\nname = \"beside\"\nversion = \"1.0.0\"\nedition = \"2024\"\nbuild = \"build.rs\"\n\n[workspace]\n\n\
         [lib]\npath = \"lib.rs\"\n\n[[bin]]\nname = \"names\"\npath = \"main.rs\"\n\n\
         [dependencies]\noptix-device-rs = {{ path = {:?} }}\n",
        root.join("optix-device-rs")
    );
    let library = format!(
        "#![cfg_attr(target_arch = \"nvptx64\", no_std)]\n\n{PRELUDE}pub mod inner;\n#[path = \"../common/elsewhere.rs\"]\n\
         pub mod elsewhere;\npub mod included {{\n    include!(\"included.rs\");\n}}\npub mod made {{\n    \
         include!(concat!(env!(\"OUT_DIR\"), \"/made.rs\"));\n}}\n\n{root}\n\
         pub mod again {{\n    {PRELUDE}{root}}}\npub mod once_more {{\n    {PRELUDE}{root}}}\n",
        root = pipeline("Root")
    );
    let source = |name: &str| format!("{PRELUDE}{}", pipeline(name));
    for (file, text) in [
        ("beside/Cargo.toml", manifest),
        ("beside/lib.rs", library),
        ("beside/main.rs", MAIN.into()),
        ("beside/build.rs", BUILD.into()),
        ("beside/inner/mod.rs", source("Inner")),
        ("beside/included.rs", source("Included")),
        ("beside/made.txt", source("Made")),
        ("common/elsewhere.rs", source("Elsewhere")),
    ] {
        let file = dir.join(file);
        fs::create_dir_all(file.parent().expect("a folder")).expect("writable");
        fs::write(file, text).expect("writable");
    }
    // The workspace's versions.
    fs::copy(root.join("Cargo.lock"), package.join("Cargo.lock")).expect("writable");

    let mut command = Command::new(env!("CARGO"));
    command.args(["run", "--offline", "--bin", "names"]).current_dir(&package);
    let output = command.env("CARGO_TARGET_DIR", common::projects()).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut host: Vec<String> = String::from_utf8_lossy(&output.stdout).lines().map(str::to_string).collect();
    let mut device = Shaders::new(&package).compile_in(common::area()).expect("it compiles").entries;
    host.sort_unstable();
    device.sort_unstable();
    assert_eq!(host, device);
    assert_eq!(host.len(), 7);

    // Code that moves keeps its names.
    let file = package.join("lib.rs");
    let text = fs::read_to_string(&file).expect("it was written");
    fs::write(&file, text.replacen(PRELUDE, &format!("{PRELUDE}// A line.\n\n    "), 1)).expect("writable");
    let mut moved = Shaders::new(&package).compile_in(common::area()).expect("it compiles").entries;
    moved.sort_unstable();
    assert_eq!(moved, device);
}
