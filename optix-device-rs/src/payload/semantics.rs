//! Who may read and write a payload word: `OptixPayloadSemantics` bits, two per party, read is the low one (guide 14).

/// The caller of trace receives the value.
pub const CALLER_READ: u32 = 1;
/// The caller of trace supplies the value.
pub const CALLER_WRITE: u32 = 2;
/// Closest-hit programs may get the value.
pub const CLOSESTHIT_READ: u32 = 4;
/// Closest-hit programs set the value.
pub const CLOSESTHIT_WRITE: u32 = 8;
/// Miss programs may get the value.
pub const MISS_READ: u32 = 16;
/// Miss programs set the value.
pub const MISS_WRITE: u32 = 32;
/// Any-hit programs may get the value.
pub const ANYHIT_READ: u32 = 64;
/// Any-hit programs set the value.
pub const ANYHIT_WRITE: u32 = 128;
/// Intersection programs may get the value.
pub const INTERSECTION_READ: u32 = 256;
/// Intersection programs set the value.
pub const INTERSECTION_WRITE: u32 = 512;

/// The semantics where a ray is traversed without running its closest-hit or miss program (`optixTraverse`, guide 8.4.2.1).
///
/// What closest-hit or miss programs read has to come back to the caller, who carries it to the call that runs them. The
/// functions that traverse and invoke are not there yet; their arguments and results will follow from these constants.
///
/// ```
/// use optix_device_rs::payload::semantics::*;
/// assert_eq!(at_traverse([CALLER_WRITE | MISS_READ]), [CALLER_WRITE | MISS_READ | CALLER_READ]);
/// assert_eq!(at_traverse([CLOSESTHIT_WRITE | MISS_WRITE]), [CLOSESTHIT_WRITE | MISS_WRITE]);
/// ```
pub const fn at_traverse<const N: usize>(words: [u32; N]) -> [u32; N] {
    widened(words, CLOSESTHIT_READ | MISS_READ, CALLER_READ)
}

/// The semantics where the closest-hit or miss program of a traversed ray is run (`optixInvoke`, guide 8.4.2.1).
///
/// What any-hit programs wrote came back to the caller, who passes it on; so does what intersection programs wrote, of which
/// the guide does not speak.
///
/// ```
/// use optix_device_rs::payload::semantics::*;
/// assert_eq!(at_invoke([ANYHIT_WRITE | MISS_READ]), [ANYHIT_WRITE | MISS_READ | CALLER_WRITE]);
/// ```
pub const fn at_invoke<const N: usize>(words: [u32; N]) -> [u32; N] {
    widened(words, ANYHIT_WRITE | INTERSECTION_WRITE, CALLER_WRITE)
}

/// With `more` on the words that have any of `these`.
const fn widened<const N: usize>(mut words: [u32; N], these: u32, more: u32) -> [u32; N] {
    let mut i = 0;
    while i < N {
        if words[i] & these != 0 {
            words[i] |= more;
        }
        i += 1;
    }
    words
}
