//! Limits of OptiX that concern device programs.

/// The most words a payload has in registers (guide 14).
pub const MAX_PAYLOAD_WORDS: usize = 32;
/// The most words an attribute set has (guide 13.4).
pub const MAX_ATTRIBUTE_WORDS: usize = 8;
/// The most payload types that a module declares, and so the most ray types of a pipeline (guide 14).
pub const MAX_PAYLOAD_TYPES: usize = 8;
/// The deepest nesting of trace calls (guide 6.7, 12).
pub const MAX_TRACE_DEPTH: u32 = 31;
/// The deepest nesting of callables that a pipeline may ask for. OptiX has no limit but the stack (guide 6.8); this one is ours,
/// so that the CPU's stack has room.
pub const MAX_CALLABLE_DEPTH: u32 = 31;
