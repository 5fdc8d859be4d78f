//! Tests of the macros; nothing to use.
