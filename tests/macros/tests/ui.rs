//! What must not compile, with the message it gives, and what must.
//!
//! `TRYBUILD=overwrite cargo test -p optix-macro-tests --test ui` writes the messages anew; read each of them as someone who
//! has never seen this project.

#[test]
fn ui() {
    let cases = trybuild::TestCases::new();
    cases.pass("ui/pass/*.rs");
    cases.compile_fail("ui/*.rs");
}
