//! One compile for each diagnostic of the macro and of the runtime's traits: what is said, where, and that it is said once.
//!
//! The expected messages are those of the toolchain named in `rust-toolchain.toml`, or of the stable one where they were
//! written: `TRYBUILD=overwrite cargo test -p dalembert-tests --test ui` writes them anew. Read each one before committing.

#[test]
fn mistakes_are_explained_where_they_are_made() {
    trybuild::TestCases::new().compile_fail("ui/*.rs");
}
