//! A step with its derivatives beside CasADi's generated C: `docs/evidence/casadi.md`. Some minutes.

use std::path::Path;

use anyhow::Result;
use xshell::{Shell, cmd};

use super::{processor, version};
use crate::{project, python_environment};

const FLAGS: [&str; 3] = ["-std=c99", "-O3", "-march=native"];

/// Measures, and writes the page. Needs gcc and CasADi from PyPI.
pub fn run() -> Result<()> {
    let shell = project::shell()?;
    let target = project::root().join("target/casadi");
    shell.change_dir("measure/benches/casadi");
    let folder = shell.create_temp_dir()?;
    let work = folder.path();
    let python = python_environment::make(&shell, work, &["casadi"])?.join("python");
    cmd!(shell, "{python} models.py {work}").run()?;

    let build = cmd!(shell, "cargo build --release --quiet").env("RUSTFLAGS", "-C target-cpu=native");
    build.env("CARGO_TARGET_DIR", &target).run()?;
    let headers = target.join("release/headers");
    cmd!(shell, "{headers} {work}").run()?;
    let generated = shell.read_dir(work)?;
    let generated: Vec<_> =
        generated.iter().filter(|path| path.to_string_lossy().ends_with("_casadi.c")).collect();
    let include = format!("-I{}", work.display());
    let library = target.join("release/libbeside_casadi.a");
    let compile = |output: &str| cmd!(shell, "gcc {FLAGS...} {include} -o").arg(work.join(output));
    let libraries = |command: xshell::Cmd| command.arg(&library).args(["-lpthread", "-ldl", "-lm"]).run();
    libraries(compile("steps").arg("steps.c").args(&generated))?;
    for whose in ["OURS", "THEIRS"] {
        let of = compile(whose).args(["-ffunction-sections", "-Wl,--gc-sections"]).arg(format!("-D{whose}"));
        libraries(of.arg("size.c").arg(work.join("pendulum_midpoint_casadi.c")))?;
    }

    let version_of = "import casadi; print(casadi.__version__)";
    let casadi = cmd!(shell, "{python} -c {version_of}").quiet().read()?;
    let steps = work.join("steps");
    let tables = cmd!(shell, "{steps}").output()?.stdout;
    let ours = size(&shell, &work.join("OURS"), &["dalembert", "pendulum_midpoint", "beside_casadi"])?;
    let theirs = size(&shell, &work.join("THEIRS"), &["casadi"])?;
    let page = [
        shell.read_file("introduction.md")?,
        String::from_utf8(tables)?,
        format!(
            "\nThe functions of the double pendulum by the midpoint rule that a program links which calls the step with A \
             and B: dalembert {ours} bytes, CasADi {theirs}.\n"
        ),
        shell.read_file("reading.md")?,
        format!(
            "\nCasADi {casadi}, {}, {}, {}.\n",
            version(&shell, "gcc")?,
            version(&shell, "rustc")?,
            processor(&shell)?
        ),
    ];
    Ok(shell.write_file("../../../docs/evidence/casadi.md", page.concat())?)
}

/// The bytes of a program's functions that have one of these words in their names. Rust's standard library,
/// which a host links for its panics, is not asked for by a step.
fn size(shell: &Shell, program: &Path, words: &[&str]) -> Result<u64> {
    Ok(sum(&cmd!(shell, "nm -S -C {program}").quiet().read()?, words))
}

fn sum(names: &str, words: &[&str]) -> u64 {
    // Address, size, kind and name: what is not defined has no size.
    let sizes = names.lines().filter_map(|line| {
        let mut columns = line.split_whitespace();
        let size = u64::from_str_radix(columns.nth(1)?, 16).ok()?;
        let name = columns.skip(1).collect::<Vec<_>>().join(" ");
        words.iter().any(|word| name.contains(word)).then_some(size)
    });
    sizes.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_those_of_functions_by_name() {
        let names = "0000000000001000 0000000000000010 T casadi_f0\n                 U casadi_malloc\n\
                     0000000000001010 000000000000000a t <casadi::F as G>::step\n0000000000002000 00000000000000ff T main";
        assert_eq!(sum(names, &["casadi"]), 26);
        assert_eq!(sum(names, &["main"]), 255);
    }
}
