//! Writes the headers into the folder named.

#[path = "lib.rs"]
mod systems;

use std::path::Path;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let folder = env::args().nth(1).expect("a folder for the headers");
    for header in [
        systems::pendulum_midpoint::HEADER,
        systems::pendulum_gauss::HEADER,
        systems::arm_midpoint::HEADER,
        systems::arm_gauss::HEADER,
    ] {
        fs::write(Path::new(&folder).join(header.prefix).with_extension("h"), header.to_string())?;
    }
    Ok(())
}
