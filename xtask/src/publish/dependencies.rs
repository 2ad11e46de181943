//! Licences, sources, duplicates and vulnerabilities of the dependencies; the citation.

use std::collections::BTreeSet;

use anyhow::Result;
use xshell::cmd;

use super::{PUBLISHED, Publication, packages_of, step, text};

const CARGO_DENY: &str = "0.20.2";

/// Asks cargo-deny; of vulnerabilities only with `all`.
pub fn check(of: &mut Publication, all: bool) -> Result<()> {
    step("licences, sources and duplicates of the dependencies: cargo-deny");
    let shell = of.shell.clone();
    let install = cmd!(shell, "cargo install --locked --debug cargo-deny@{CARGO_DENY}");
    if !of.has(cmd!(shell, "cargo deny --version"), install) {
        return Ok(());
    }
    of.succeeds(cmd!(shell, "cargo deny --workspace check licenses sources"));
    let metadata = of.metadata(&shell.current_dir(), &["--no-deps", "--locked"])?;
    let names: BTreeSet<_> = packages_of(&metadata).iter().map(|package| text(package, "name")).collect();
    let others = names.into_iter().filter(|name| !PUBLISHED.contains(name));
    let bans = cmd!(shell, "cargo deny --workspace").args(others.flat_map(|name| ["--exclude", name]));
    of.succeeds(bans.args(["check", "bans"]));
    if !all {
        return Ok(());
    }
    if cmd!(shell, "cargo deny fetch db").quiet().ignore_stdout().ignore_stderr().run().is_ok() {
        of.succeeds(cmd!(shell, "cargo deny --workspace check advisories"));
    } else {
        let why = "known vulnerabilities: the database of advisories cannot be fetched";
        of.skipped.push(why.to_owned());
    }
    Ok(())
}

/// Sees that CITATION.cff is valid.
pub fn check_citation(of: &mut Publication) -> Result<()> {
    step("CITATION.cff");
    let shell = of.shell.clone();
    let python = of.target.join("python");
    let script = "python3 -m venv \"$0\" && \"$0\"/bin/pip install --quiet cffconvert==2.0.0";
    let convert = python.join("bin/cffconvert");
    if of.has(cmd!(shell, "{convert} --version"), cmd!(shell, "sh -c {script} {python}")) {
        of.succeeds(cmd!(shell, "{convert} --validate --infile CITATION.cff"));
    }
    Ok(())
}
