//! Sources of `core`, of the very compiler in use, for targets whose `core` rustup has not: from Debian's
//! package rust-src, fetched once.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use xshell::{Shell, cmd};

use crate::{project, tools};

const COMPILER: &str = "1.95.0";
const CHECKSUM: &str = "7b76db5b880a77f9e52975d2baa6209d2f76d2c9c2789515c3088cb960e2c83b";

/// The folder of what is built with a `core` of its own, from the workspace of the firmware. proc-macro2 asks
/// for the variable that allows it: in one folder with the rest all that uses the macros would be built anew.
pub const BUILT: &str = "target/device";

/// That folder, from anywhere.
pub fn built() -> PathBuf {
    project::root().join("firmware").join(BUILT)
}

/// Lets the commands of the shell build `core`. Where its sources cannot be had the error says why.
pub fn provide(shell: &Shell) -> Result<()> {
    shell.set_var("__CARGO_TESTS_ONLY_SRC_ROOT", library(shell)?);
    shell.set_var("CARGO_TARGET_DIR", built());
    shell.set_var("RUSTC_BOOTSTRAP", "1");
    Ok(())
}

/// The folder with the sources.
fn library(shell: &Shell) -> Result<PathBuf> {
    let version = cmd!(shell, "rustc --version").quiet().read()?;
    let is_the_one = version.starts_with(&format!("rustc {COMPILER} "));
    ensure!(is_the_one, "the sources of core fetched here are those of rustc {COMPILER}");
    let folder = project::root().join(format!("firmware/target/rust-src-{COMPILER}"));
    let library = folder.join("library");
    if !library.join("core").is_dir() {
        fetch(shell, &folder)?;
    }
    Ok(library)
}

fn fetch(shell: &Shell, folder: &std::path::Path) -> Result<()> {
    for tool in ["apt-get", "dpkg-deb", "curl", "sha256sum"] {
        ensure!(tools::is_there(tool), "no {tool} to fetch the sources of core with");
    }
    let package = format!("rust-src_{COMPILER}+dfsg1-2~bpo13+1_all.deb");
    fs::create_dir_all(folder)?;
    let file = folder.join("package.deb");
    let format = "$(SITE)";
    let sites = cmd!(shell, "apt-get indextargets --format {format}").quiet().read()?;
    let mut sites: Vec<_> = sites.lines().collect();
    sites.sort_unstable();
    sites.dedup();
    let fetched = sites.into_iter().any(|site| {
        let address = format!("{site}/pool/main/r/rustc/{package}");
        cmd!(shell, "curl -fsSL --retry 2 {address} -o {file}").quiet().ignore_stderr().run().is_ok()
    });
    let sum = format!("{CHECKSUM}  {}\n", file.display());
    let is_expected =
        cmd!(shell, "sha256sum --check --status").quiet().ignore_stderr().stdin(sum).run().is_ok();
    ensure!(fetched && is_expected, "{package} is on none of apt's sites, or is not the package expected");
    // Unpacked beside, and renamed: it is there whole or not at all.
    let unpacked = folder.join("unpacked");
    cmd!(shell, "dpkg-deb --extract {file} {unpacked}").quiet().run()?;
    let sources = unpacked.join(format!("usr/src/rustc-{COMPILER}/library"));
    fs::rename(&sources, folder.join("library")).with_context(|| sources.display().to_string())?;
    Ok(fs::remove_dir_all(unpacked)?)
}
