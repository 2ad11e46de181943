//! The chapter "As a functional mock-up unit" of `docs/embedding.md`, and the unit in FMPy, an importer of
//! PyPI.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};

use anyhow::{Result, ensure};
use xshell::cmd;

use super::{commands, script, show};
use crate::tools::NotChecked;
use crate::{project, python_environment};

/// Follows the chapter, and holds the units against the run in Rust.
pub fn run() -> Result<()> {
    let shell = project::shell()?;
    let work = shell.create_temp_dir()?;
    let python = python_environment::make(&shell, work.path(), &["fmpy"]);
    let python = python.map_err(|error| NotChecked::new("UNIT", error))?.join("python");

    let commands = commands("docs/embedding.md", Some("As a functional mock-up unit"), 1)?.concat();
    ensure!(commands.lines().count() == 2, "the chapter has lost its commands");
    show(&commands);
    let units = ["examples/fmu/cart_pole.fmu", "examples/fmu/cart_pole_fmi2.fmu"];
    units.iter().try_for_each(|unit| shell.remove_path(unit))?;
    script(&shell, &commands).run()?;

    let reference = work.path().join("reference.txt");
    let printed = cmd!(shell, "cargo run --quiet --release -p dalembert-fmu --example reference").output()?;
    shell.write_file(&reference, printed.stdout)?;
    let descriptions = work.path();
    cmd!(shell, "cargo build --quiet --release -p dalembert-fmu --example constrained").run()?;
    cmd!(
        shell,
        "cargo run --quiet --release -p dalembert-fmu --example constrained_description {descriptions}"
    )
    .run()?;
    let library = project::target().join(format!("release/examples/{DLL_PREFIX}constrained{DLL_SUFFIX}"));
    cmd!(shell, "{python} bindings/fmu/tests/importer.py {units...} {reference} {library} {descriptions}")
        .run()?;
    Ok(())
}
