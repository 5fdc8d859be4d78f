//! Limits that macros check before a type is known. A crate of macros can't take them from `limits` of the device crate, which
//! says what they are; the test `index` of `tests/macros` compares the two.

pub const MAX_PAYLOAD_TYPES: usize = 8;
pub const MAX_TRACE_DEPTH: u32 = 31;
pub const MAX_CALLABLE_DEPTH: u32 = 31;
