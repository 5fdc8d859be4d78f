//! The limits that the macros check are the device crate's.

use std::collections::BTreeMap;
use std::fs;

/// Constants of a file, with type and value.
fn constants(text: &str) -> BTreeMap<&str, &str> {
    text.lines().filter_map(|line| line.strip_prefix("pub const ")?.split_once(": ")).collect()
}

/// The names of `some` that `all` does not have, or with another type or value.
fn different<'t>(some: &'t str, all: &str) -> Vec<&'t str> {
    let all = constants(all);
    constants(some).into_iter().filter(|(name, value)| all.get(name) != Some(value)).map(|(name, _)| name).collect()
}

#[test]
fn limits_of_the_macros_are_those_of_the_device_crate() {
    let read = |name: &str| fs::read_to_string(super::root().join("../..").join(name).join("src/limits.rs")).unwrap();
    let macros = read("optix-macros");
    assert_ne!(constants(&macros).len(), 0);
    assert_eq!(different(&macros, &read("optix-device-rs")), [""; 0]);
    assert_eq!(different("pub const A: u8 = 1;\npub const B: u8 = 2;", "/// B.\npub const B: u8 = 3;"), ["A", "B"]);
}
