//! What the macros cost: `cargo check` of a crate with 50 payloads, 50 records, 100 programs and a pipeline.
//!
//! `cargo bench -p optix-macro-tests` prints the median of five runs and fails if it is more than 5 s.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

const PAYLOADS: usize = 50;
const RECORDS: usize = 50;
/// A pipeline has eight ray types at most.
const RAYS: usize = 8;
/// One ray-generation program, a miss program for each ray type, a closest-hit program for each record; the rest any-hit.
const ANYHITS: usize = 100 - 1 - RAYS - RECORDS;
const RUNS: usize = 5;
const MOST: Duration = Duration::from_secs(5);

fn shaders() -> String {
    let mut text =
        "use optix_device_rs::prelude::*;\n#[launch_params]\npub struct Frame {\n    pub film: SliceMut2d<Vec4>,\n    \
                    pub world: Traversable,\n    #[bound]\n    pub depth: u32,\n}\n"
            .to_owned();
    for i in 0..PAYLOADS {
        // The first is shaded; the others look for occlusion, so that a material needs one closest-hit program.
        let shaded = if i == 0 { ", closesthit" } else { "" };
        let _ = write!(
            text,
            "#[derive(Payload)]\npub struct Payload{i} {{\n    #[payload(write(caller, miss{shaded}), read(caller))]\n    pub \
             light: Vec3,\n    #[payload(write(caller, miss{shaded}), read(closesthit, miss, anyhit, caller))]\n    pub seed: \
             u64,\n}}\n"
        );
    }
    for i in 0..RECORDS {
        let _ = write!(
            text,
            "#[derive(Clone, Copy, SbtRecord)]\n#[repr(C)]\npub struct Record{i} {{\n    pub albedo: Vec3,\n    pub normals: \
             Slice<Vec3>,\n}}\n#[closesthit]\npub fn shade{i}(hit: &ClosestHit<All, Triangles>, record: &Record{i}, ray: \
             Payload0AtClosestHit) -> Payload0FromClosestHit {{\n    let light = record.albedo * \
             record.normals.get(hit.primitive_index());\n    Payload0FromClosestHit {{ light, seed: ray.seed + 1 }}\n}}\n"
        );
    }
    for i in 0..ANYHITS {
        let _ = write!(
            text,
            "#[anyhit]\npub fn decide{i}(hit: &AnyHit<All, Triangles>, record: &Record{i}, ray: Payload0AtAnyHit) -> Decision \
             {{\n    if hit.barycentrics().x > record.albedo.x && ray.seed > 0 {{ Decision::Ignore }} else {{ Decision::Accept \
             }}\n}}\n"
        );
    }
    for i in 0..RAYS {
        let _ = write!(
            text,
            "#[miss]\npub fn sky{i}(ms: &Miss<All>, ray: Payload{i}AtMiss) -> Payload{i}FromMiss {{\n    Payload{i}FromMiss {{ \
             light: ms.world_ray_direction(), seed: ray.seed }}\n}}\n"
        );
    }
    text.push_str(
        "#[raygen]\npub fn camera(rg: &RayGen<All>) {\n    let start = Payload0FromCaller { light: Vec3::ZERO, seed: 7 };\n    let back = \
         rg.trace::<Payload0>(rg.params().world(), Ray::new(Vec3::ZERO, Vec3::X), start);\n    \
         rg.params().film().set(rg.launch_index().xy(), back.light.extend(1.0));\n}\n",
    );
    text.push_str(
        "pipeline! {\n    pub struct All {\n        params: Frame,\n        raygen: [camera],\n        rays: { ",
    );
    for i in 0..RAYS {
        let _ = write!(text, "Payload{i} {{ miss: sky{i} }}, ");
    }
    text.push_str("},\n        hitgroups: {\n");
    for i in 0..RECORDS {
        let anyhit = if i < ANYHITS { format!(", anyhit: decide{i}") } else { String::new() };
        let _ = write!(text, "            Record{i} on Triangles => {{ Payload0 {{ closesthit: shade{i}{anyhit} }}, ");
        for ray in 1..RAYS {
            let _ = write!(text, "Payload{ray} {{}}, ");
        }
        text.push_str("},\n");
    }
    text.push_str("        },\n    }\n}\n");
    text
}

fn check(folder: &Path) -> Duration {
    // As on a change: everything else is built.
    let source = folder.join("src/lib.rs");
    std::fs::write(&source, std::fs::read(&source).expect("read")).expect("written");
    let start = Instant::now();
    let status = Command::new(env!("CARGO"))
        .args(["check", "--quiet", "--offline", "-j2"])
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .env("CARGO_INCREMENTAL", "0")
        .status()
        .expect("cargo runs");
    assert!(status.success(), "the generated crate does not compile");
    start.elapsed()
}

fn main() {
    // `cargo test` runs benches too, without `--bench`: the crate's check takes longer than a test may.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("expansion");
    std::fs::create_dir_all(folder.join("src")).expect("folder");
    let device_crate = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../optix-device-rs");
    let manifest = format!(
        "[package]\nname = \"expansion\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
         optix-device-rs = {{ path = {device_crate:?} }}\n"
    );
    std::fs::write(folder.join("Cargo.toml"), manifest).expect("manifest");
    // The versions of the workspace, which are there offline.
    let lock = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../Cargo.lock");
    std::fs::copy(lock, folder.join("Cargo.lock")).expect("lock file");
    std::fs::write(folder.join("src/lib.rs"), shaders()).expect("source");
    check(&folder);
    let mut times: Vec<Duration> = (0..RUNS).map(|_| check(&folder)).collect();
    times.sort();
    let median = times[RUNS / 2];
    println!("{PAYLOADS} payloads, {RECORDS} records, 100 programs, a pipeline: {median:.2?} (of {RUNS}: {times:.2?})");
    assert!(median < MOST, "more than {MOST:?}");
}
