//! `docs/python.md` and `docs/clusters.md` in a fresh environment, what they say, and the figures of the
//! gallery.

use std::env;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use xshell::{Shell, cmd};

use super::{clusters, commands, move_home, script, show};
use crate::tools::NotChecked;
use crate::{project, python_environment};

const PACKAGES: [&str; 13] = [
    "asyncssh",
    "dask",
    "dask-jobqueue",
    "distributed",
    "joblib",
    "matplotlib",
    "mypy",
    "numpy",
    "pandas",
    "pyarrow",
    "pytest",
    "scipy",
    "xarray",
];

/// Runs the cells of a notebook, one after the other.
const RUN_NOTEBOOK: &str = "
import json, sys
cells = json.load(open(sys.argv[1]))['cells']
names = {}
for cell in cells:
    assert not cell.get('outputs'), 'a notebook is committed without outputs'
    if cell['cell_type'] == 'code':
        exec(''.join(cell['source']), names)
assert 'ends' in names, 'the notebook has lost its cells'
";

/// Follows both pages, and tests the package that they install.
pub fn run() -> Result<()> {
    let shell = project::shell()?;
    let work = shell.create_temp_dir()?;
    let work = work.path();
    let programs = environment(&shell, work).map_err(|error| NotChecked::new("PYTHON", error))?;
    shell.set_var("PYO3_PYTHON", programs.join("python"));
    let path = env::var_os("PATH").context("PATH is not set")?;
    shell.set_var("PATH", env::join_paths([programs].into_iter().chain(env::split_paths(&path)))?);
    shell.set_var("PIP_DISABLE_PIP_VERSION_CHECK", "1");
    shell.set_var("CARGO_TARGET_DIR", project::target());
    move_home(&shell, work)?;

    for block in commands("docs/python.md", None, 3)? {
        show(&block);
        script(&shell, &block).run()?;
    }
    cmd!(shell, "cargo fmt --manifest-path bindings/python/Cargo.toml --all --check").run()?;
    cmd!(shell, "cargo fmt --manifest-path examples/python/Cargo.toml --check").run()?;
    let clippy = cmd!(
        shell,
        "cargo clippy --release --manifest-path bindings/python/Cargo.toml --workspace --all-targets"
    );
    clippy.args(["--", "-D", "warnings"]).run()?;
    let reference = work.join("reference.txt");
    let printed =
        cmd!(shell, "cargo run --quiet --release -p dalembert-c --example python_reference").output()?;
    shell.write_file(&reference, printed.stdout)?;
    let edited = trials(&shell, work)?;
    let tests = cmd!(
        shell,
        "python -m pytest --quiet -p no:cacheprovider bindings/python/tests --reference {reference}"
    );
    tests.args(["--edited".as_ref(), edited.as_os_str()]).run()?;
    // Each kind of long call is interrupted once.
    cmd!(shell, "python bindings/python/tests/faults.py 11")
        .env("RUST_BACKTRACE", "0")
        .ignore_stderr()
        .run()?;

    of_clusters(&shell, work)?;
    for script in shell.read_dir("bindings/python/gallery")? {
        if script.extension().is_some_and(|extension| extension == "py") {
            cmd!(shell, "python {script} {work}").run()?;
        }
    }
    let notebook = "bindings/python/gallery/first_steps.ipynb";
    cmd!(shell, "python -c {RUN_NOTEBOOK} {notebook}").quiet().env("MPLBACKEND", "agg").run()?;
    let allowed = project::root().join("bindings/python/tests/stubtest.allowlist");
    shell.change_dir(work);
    cmd!(shell, "python -m mypy.stubtest dalembert_scenes --allowlist {allowed}").run()?;
    Ok(())
}

/// Installs the package of systems that misbehave; returns a folder with the same one edited.
fn trials(shell: &Shell, work: &Path) -> Result<PathBuf> {
    let edited = work.join("edited");
    cmd!(shell, "pip install --quiet ./bindings/python/trials").run()?;
    let anew = cmd!(shell, "pip install --quiet --no-deps --target {edited} ./bindings/python/trials");
    anew.env("DALEMBERT_EDITED", "1").run()?;
    Ok(edited)
}

fn environment(shell: &Shell, work: &Path) -> Result<PathBuf> {
    let is_new =
        cmd!(shell, "python3 -c").arg("import sys; sys.exit(sys.version_info < (3, 11))").quiet().run();
    ensure!(is_new.is_ok(), "python3 is older than 3.11, or is not there");
    python_environment::make(shell, work, &PACKAGES)
}

/// The page on clusters: its command, workers that are killed, and three kinds of cluster.
fn of_clusters(shell: &Shell, work: &Path) -> Result<()> {
    let _errors_alone = shell.push_env("DASK_LOGGING__DISTRIBUTED", "error");
    let commands = commands("docs/clusters.md", None, 1)?.concat();
    let commands: Vec<_> = commands.lines().filter(|line| line.starts_with("python")).collect();
    ensure!(commands.len() == 1, "the page on clusters has lost its command");
    show(commands[0]);
    script(shell, &commands[0].replace(" cloud ", &format!(" {}/cloud ", work.display()))).run()?;
    cmd!(shell, "python bindings/python/cluster/killed.py 200000").run()?;
    clusters::run(shell)
}
