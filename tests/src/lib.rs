//! What the tests across crates and backends share.

pub mod devices;
pub mod meshes;
pub mod probe;
