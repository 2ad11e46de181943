//! One study by dalembert, heyoka, pydiffsol and scipy, each as its users would write it:
//! `docs/evidence/escape-times.md`. Some twenty minutes, most of them heyoka's and the module's building.

use anyhow::{Context, Result};
use xshell::cmd;

use super::{processor, version};
use crate::{project, python_environment};

/// The packages whose versions the page names.
const NAMED: [&str; 4] = ["heyoka", "numpy", "pydiffsol", "scipy"];

/// Measures, and writes the page. Needs Python 3.11.
pub fn run() -> Result<()> {
    let shell = project::shell()?;
    shell.change_dir("measure/benches/python");
    let work = shell.create_temp_dir()?;
    let packages = ["heyoka", "pydiffsol", "scipy", "../../../bindings/python"];
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
    Ok(shell.write_file("../../../docs/evidence/escape-times.md", page.concat())?)
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
