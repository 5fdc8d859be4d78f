//! What must not compile, with the message it gives, and what must.
//!
//! `TRYBUILD=overwrite cargo test -p optix-macro-tests --test ui` writes the messages anew; read each of them as someone who
//! has never seen this project.

use std::path::PathBuf;

#[test]
fn ui() {
    let cases = trybuild::TestCases::new();
    cases.pass("ui/pass/*.rs");
    cases.pass(long_types());
    cases.compile_fail("ui/*.rs");
}

/// Types with hundreds of fields and thousands of variants: what is derived does not nest as deep as they are long.
fn long_types() -> PathBuf {
    let rows = |count: usize, row: fn(usize) -> String| (0..count).map(row).collect::<String>();
    let field = |i| format!("    pub f{i}: u32,\n");
    let source = format!(
        "use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {{
{}}}

#[derive(Clone, Copy, Words)]
pub struct Long {{
{fields}}}

#[derive(Payload)]
#[payload(transport = pointer)]
pub struct Ray {{
{}}}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Material {{
{fields}}}

#[launch_params]
pub struct Frame {{
{fields}}}

fn main() {{}}
",
        rows(4000, |i| format!("    V{i} {{ a: u32 }},\n")),
        rows(600, |i| format!("    #[payload(write(caller, miss), read(caller))]\n    pub f{i}: u32,\n")),
        fields = rows(600, field),
    );
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("long_types.rs");
    std::fs::write(&path, source).expect("the folder for tests' files");
    path
}
