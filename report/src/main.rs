//! Speed against error: what a trajectory costs to given errors, by this project's methods and by others, in one run.
//!
//! `cargo speed-against-error` measures and writes `docs/speed-against-error.md`; `cargo speed-against-error page` writes the page again from the
//! figures measured last. Peers with a Python interface are run where the interpreter that `PYTHON` names has them.

mod frontier;
mod measure;
mod ours;
mod peers;
mod reference;
mod scenes;
mod study;

use std::path::{Path, PathBuf};

use anyhow::Result;

use peers::python::Python;
use scenes::{
    Chain2, Chain4, Chain8, Chain16, Chain32, DoublePendulum, HenonHeiles, Kepler, Pendulums, Ring,
};
use study::Record;

fn main() -> Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("docs").join("speed-against-error");
    std::fs::create_dir_all(&folder)?;
    let python = Python::start()?;
    for missing in &python.missing {
        eprintln!("not installed: {missing}");
    }
    let records = scenes(Some(&python))?;
    let mut file = csv::Writer::from_path(folder.join("scenes.csv"))?;
    for record in &records {
        file.serialize(record)?;
    }
    file.flush()?;
    Ok(())
}

/// Every scene, by the names that `references.txt` has.
fn scenes(python: Option<&Python>) -> Result<Vec<Record>> {
    let mut records = Vec::new();
    macro_rules! measure {
        ($($name:literal: $scene:expr, $n:literal;)*) => {$(
            eprintln!("{}", $name);
            records.extend(study::scene::<_, $n, { 2 * $n }>($name, &$scene, python)?);
        )*};
    }
    measure! {
        "ring": Ring { k: 1e-3 }, 2;
        "double pendulum": DoublePendulum::EXAMPLE, 2;
        "FPUT chain": Chain8::EXAMPLE, 8;
        "Hénon–Heiles": HenonHeiles, 2;
        "Kepler": Kepler { k: 1e-4 }, 2;
        "seven pendulums": Pendulums::EXAMPLE, 7;
        "FPUT chain, n = 2": Chain2::EXAMPLE, 2;
        "FPUT chain, n = 4": Chain4::EXAMPLE, 4;
        "FPUT chain, n = 8": Chain8::EXAMPLE, 8;
        "FPUT chain, n = 16": Chain16::EXAMPLE, 16;
        "FPUT chain, n = 32": Chain32::EXAMPLE, 32;
    }
    Ok(records)
}
