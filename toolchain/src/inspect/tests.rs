//! The same program as rustc and as nvcc write it.

use super::*;

const RUSTC: &str = include_str!("tests/rustc.ptx");
const NVCC: &str = include_str!("tests/nvcc.ptx");

fn only(ptx: &str) -> Program {
    let programs = programs(ptx);
    assert_eq!(programs.len(), 1);
    programs[0].clone()
}

fn classes(program: &Program) -> Vec<(Class, usize)> {
    program.classes.iter().map(|(class, count)| (*class, *count)).collect()
}

#[test]
fn rustcs_instructions_are_counted() {
    let program = only(RUSTC);
    assert_eq!(
        classes(&program),
        [
            (Class::Integer, 2),
            (Class::Float, 1),
            (Class::Special, 1),
            (Class::Convert, 1),
            (Class::Move, 1),
            (Class::Constant, 1),
            (Class::Global, 1),
            (Class::Generic, 3),
            (Class::Control, 2),
            (Class::Call, 2),
        ]
    );
    assert_eq!(program.instructions(), 15);
    assert_eq!(program.local_memory, 16);
    assert_eq!(program.parameters, Loads { count: 1, bytes: 8 });
    // What a pointer in the record points to is not the record.
    assert_eq!(program.record, Loads { count: 2, bytes: 16 });
    let calls: Vec<_> = program.calls.keys().map(String::as_str).collect();
    assert_eq!(calls, ["_optix_get_ray_tmax", "_optix_get_sbt_data_ptr_64"]);
}

#[test]
fn nvccs_instructions_are_counted() {
    let program = only(NVCC);
    assert_eq!(
        classes(&program),
        [
            (Class::Double, 1),
            (Class::Move, 1),
            (Class::Global, 1),
            (Class::Param, 1),
            (Class::Generic, 1),
            (Class::Control, 1),
            (Class::Call, 3),
        ]
    );
    assert_eq!(program.record, Loads { count: 2, bytes: 16 });
    assert_eq!(program.parameters, Loads::default());
    assert_eq!(program.calls.get("_Z4slowf"), Some(&1));
}

#[test]
fn programs_of_two_builds_pair_by_their_words() {
    let named = |names: &[&str]| -> Vec<Program> {
        names.iter().map(|name| Program { name: name.to_string(), ..only(RUSTC) }).collect()
    };
    let ours = named(&["__miss__T_sky_Radiance_1", "__raygen__T_camera_1", "__miss__T_dark_1", "__miss__same"]);
    let theirs = named(&["__miss__same", "__miss__sky", "__raygen__lens"]);
    let names =
        pairs(&ours, &theirs).into_iter().map(|(a, b)| [a, b].map(|one| one.map_or("", |one| one.name.as_str())));
    assert_eq!(
        names.collect::<Vec<_>>(),
        [
            ["__miss__T_sky_Radiance_1", "__miss__sky"],
            ["__raygen__T_camera_1", ""],
            ["__miss__T_dark_1", ""],
            ["__miss__same", "__miss__same"],
            ["", "__raygen__lens"],
        ]
    );
}

#[test]
fn source_lines_stand_above_their_instructions() {
    let text = with_source(RUSTC, |name| name.contains("lambert")).expect("lines are known");
    let second = text.find("nonexistent/src/lib.rs:8").expect("the line is named");
    assert!(text.find("ld.v2.b32").is_some_and(|at| at < second), "{text}");
    assert!(text.find("ld.const.b64").is_some_and(|at| at > second), "{text}");
    assert_eq!(with_source(NVCC, |_| true), None);
}
