//! Studies by dalembert and by libraries of Python, each as its users would write it:
//! `docs/evidence/escape-times.md`, of some twenty minutes, most of them heyoka's and the module's building,
//! and `docs/evidence/friction-beside-scipy.md`.

use anyhow::{Context, Result};
use xshell::cmd;

use super::{processor, version};
use crate::{project, python_environment};

/// The packages whose versions the page names.
const NAMED: [&str; 4] = ["heyoka", "numpy", "pydiffsol", "scipy"];

/// Measures escape times, and writes their page. Needs Python 3.11.
pub fn run() -> Result<()> {
    page("", &["heyoka", "pydiffsol", "scipy"], "escape-times")
}

/// Measures blocks that dry friction brings to rest, and writes their page. Needs Python 3.11.
pub fn friction() -> Result<()> {
    page("friction", &["numpy", "scipy"], "friction-beside-scipy")
}

/// The page of the study of that folder of `measure/benches/python`, beside these packages.
fn page(folder: &str, beside: &[&str], name: &str) -> Result<()> {
    let shell = project::shell()?;
    let module = project::root().join("bindings/python");
    let evidence = project::root().join("docs/evidence").join(name).with_extension("md");
    shell.change_dir(project::root().join("measure/benches/python").join(folder));
    let work = shell.create_temp_dir()?;
    let packages = [beside, &[module.to_str().context("a path")?]].concat();
    let programs = python_environment::make(&shell, work.path(), &packages)?;
    let (python, pip) = (programs.join("python"), programs.join("pip"));
    let tables = cmd!(shell, "{python} study.py").output()?.stdout;
    let versions = versions(&cmd!(shell, "{pip} list --format=freeze").quiet().read()?);
    let python = version(&shell, python.to_str().context("a path")?)?;
    let page = [
        shell.read_file("introduction.md")?,
        String::from_utf8(tables)?,
        shell.read_file("reading.md")?,
        format!("\n{versions}; {python}, {}.\n", processor(&shell)?),
    ];
    Ok(shell.write_file(evidence, page.concat())?)
}

/// The versions that the page names, of a list of `name==version`.
fn versions(list: &str) -> String {
    let named =
        list.lines().filter_map(|line| line.split_once("==")).filter(|(name, _)| NAMED.contains(name));
    named.map(|(name, version)| format!("{name} {version}")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::versions;

    #[test]
    fn versions_are_those_of_the_named_packages() {
        assert_eq!(versions("heyoka==7.0\nnumpydoc==1\npip==25\nscipy==1.16.3"), "heyoka 7.0, scipy 1.16.3");
    }
}
