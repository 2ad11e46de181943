//! The chapter "As a functional mock-up unit" of `docs/embedding.md`, and the unit in FMPy, an importer of
//! PyPI.

use std::env;
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
    let programs = python.map_err(|error| NotChecked::new("UNIT", error))?;
    let python = programs.join("python");

    let commands = commands("docs/embedding.md", Some("As a functional mock-up unit"), 1)?.concat();
    ensure!(commands.lines().count() == 4, "the chapter has lost its commands");
    show(&commands);
    let units = ["examples/fmu/cart_pole.fmu", "examples/fmu/cart_pole_fmi2.fmu"];
    let motion = "examples/fmu/motion.csv";
    units.iter().chain([&motion]).try_for_each(|file| shell.remove_path(file))?;
    let path = env::join_paths([programs].into_iter().chain(env::split_paths(&shell.var("PATH")?)))?;
    script(&shell, &commands).env("PATH", path).run()?;
    let motion = shell.read_file(motion)?;
    let is_whole = motion.lines().last().is_some_and(|line| line.starts_with("3.0,"));
    ensure!(is_whole, "the run of the page does not come to its end:\n{motion}");

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
