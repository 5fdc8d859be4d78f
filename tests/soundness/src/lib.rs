//! Safe programs that try to break a promise of the CPU executor. They run in the ordinary tests, and under Miri, which sees what
//! an ordinary run gets away with:
//!
//! ```sh
//! tests/soundness/miri.sh
//! ```
#![forbid(unsafe_code)]
