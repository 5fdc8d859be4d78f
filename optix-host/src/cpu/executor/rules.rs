//! `docs/checked.md`: what launches end for.

use optix_device_rs::host::{Checked, Rule};
use std::fmt::Write as _;

/// What else the guide leaves undefined, and why no program gets there.
const ELSEWHERE: &[(&str, &str, &str)] = &[
    (
        "5, 5.6, 5.7",
        "a child structure that is freed, moved or updated",
        "structures own their children; nothing is moved or updated",
    ),
    ("5.1", "an index of a primitive's record that is not there", "refused when the structure is built"),
    ("5.4", "any-hit both enforced and disabled on an instance", "refused when the structure is built"),
    (
        "5.5, 13.9, 13.12",
        "triangles or instances read by number without the build flag, or out of range",
        "only structures that are built for it give the table, whose indices are checked in either mode",
    ),
    (
        "5.9, 6.3, 13.11",
        "a graph or a kind of primitive that the pipeline's options leave out",
        "the options follow from the scene, and a launch refuses structures that they don't cover",
    ),
    (
        "6.2",
        "what launch indices see of each other's writes",
        "nothing to trap: each order that the CPU's threads make is one that a GPU may",
    ),
    (
        "6.5, 10",
        "launch parameters of another type or size",
        "a launch takes the pipeline's type, whose layout is compared with the PTX",
    ),
    ("6.5.1", "another value than the bound one", "refused by the launch"),
    (
        "7.2, 7.4",
        "a record of another type, or data that is not there",
        "`pipeline!` ties programs to the records of their materials",
    ),
    ("13.4, 13.9", "triangle queries about other primitives", "the methods are there for hits on triangles only"),
    ("13.11", "a structure that is written during a launch", "nothing writes one"),
    ("13.14", "details of another exception than the one thrown", "`raised()` decodes them by the code"),
    ("5.10, 5.11, 5.12, 8, 9", "motion, micromaps, clusters, hit objects, curves and spheres", "not there yet"),
];

fn document() -> String {
    let mut text = String::from(
        "# What ends a launch on the CPU\n\n\
         Generated from the executor's rules by `CHECKED=overwrite cargo test -p optix-host --lib rules`; do not edit.\n\n\
         A launch on `Device::cpu_checked()` ends at each of these, with an error that names the launch index, the program and \
         the rule. On `Device::cpu()` it ends only at those that the executor could not go on from.\n\n\
         | guide | what a program does | `cpu_checked()` | `cpu()` |\n| --- | --- | --- | --- |\n",
    );
    for rule in Rule::ALL {
        let unchecked = if rule.checked() == Checked::Always { "ends" } else { "" };
        writeln!(text, "| {} | {} | ends | {unchecked} |", rule.guide(), rule.what()).unwrap();
    }
    text.push_str(
        "\nWhat else the guide leaves undefined, of what this toolkit has, is not for a program to do:\n\n\
         | guide | what is undefined | why it does not happen |\n| --- | --- | --- |\n",
    );
    for (section, what, why) in ELSEWHERE {
        writeln!(text, "| {section} | {what} | {why} |").unwrap();
    }
    text
}

#[test]
fn the_document_is_of_these_rules() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/checked.md");
    let expected = document();
    if std::env::var_os("CHECKED").is_some_and(|v| v == "overwrite") {
        std::fs::write(path, &expected).unwrap();
    }
    // As it was when this was compiled: the tests run on machines without the sources, too.
    assert!(
        include_str!("../../../../docs/checked.md") == expected,
        "{path} is of other rules: run `CHECKED=overwrite cargo test -p optix-host --lib rules`"
    );
}

/// `tests.rs` has a program that breaks each rule, but for those that have their tests elsewhere.
#[test]
fn each_rule_has_a_test() {
    // A view that was kept and a context that was lent in `tests/soundness`, the bounds of a stack in `stack`.
    let elsewhere = [Rule::View, Rule::Context, Rule::OtherStack];
    let tests = include_str!("tests.rs");
    let is_tested = |rule: &Rule| tests.contains(&format!("Rule::{rule:?}")) || elsewhere.contains(rule);
    let untested: Vec<_> = Rule::ALL.iter().filter(|rule| !is_tested(rule)).collect();
    assert!(untested.is_empty(), "{untested:?}");
}
