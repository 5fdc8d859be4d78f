//! What the tests across crates and backends share.

pub mod devices;
pub mod meshes;
pub mod probe;
pub mod spawn;

/// The README's example, which is to compile and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

/// The example of a library of shaders, likewise.
#[cfg(doctest)]
#[doc = include_str!("../../docs/libraries.md")]
struct Libraries;
