//! Tests across crates; nothing to use.
