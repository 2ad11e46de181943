//! Writes the descriptions of the unit of `constrained.rs` into a folder, of FMI 3.0 and of FMI 2.0.

#[path = "constrained.rs"]
mod constrained;

use std::path::PathBuf;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let folder = PathBuf::from(env::args_os().nth(1).expect("a folder"));
    fs::write(folder.join("3.xml"), constrained::UNIT.description())?;
    fs::write(folder.join("2.xml"), constrained::UNIT.description_fmi2()?)
}
