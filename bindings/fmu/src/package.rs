//! The .fmu file: a zip archive of the description and the library.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::io::{self, Cursor, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::{env, fs};

use dalembert_face::Interface;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::Unit;

impl<I: Interface<N>, const N: usize> Unit<I, N> {
    /// Writes the unit to `file`, with the library of this crate that Cargo has built beside the running
    /// program.
    ///
    /// # Errors
    /// Where the library is not there or `file` cannot be written; a [`NamingError`](crate::NamingError)
    /// within, where a line of the documentation cannot be followed.
    pub fn pack(&self, file: impl AsRef<Path>) -> io::Result<()> {
        let system = if OS == "macos" { "darwin" } else { OS };
        self.write(file.as_ref(), &self.description_fmi3()?, &format!("{ARCH}-{system}"))
    }

    /// As [`pack`](Self::pack), a unit of FMI 2.0.
    ///
    /// # Errors
    /// Those of [`pack`](Self::pack), and where FMI 2.0 has no type for a field or no name for this machine.
    pub fn pack_fmi2(&self, file: impl AsRef<Path>) -> io::Result<()> {
        let machine = match (ARCH, OS) {
            ("x86_64", "linux") => "linux64",
            ("x86_64", "windows") => "win64",
            ("x86_64", "macos") => "darwin64",
            _ => return Err(io::Error::new(ErrorKind::Unsupported, "FMI 2.0 has no name for this machine")),
        };
        self.write(file.as_ref(), &self.description_fmi2()?, machine)
    }

    fn write(&self, file: &Path, description: &str, machine: &str) -> io::Result<()> {
        let library = self.library_beside_the_program()?;
        let binary = fs::read(&library).map_err(|error| named(&error, &library))?;
        let place = format!("binaries/{machine}/{}{DLL_SUFFIX}", self.name);
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        // The same bytes from the same library: no time of day.
        let options = SimpleFileOptions::default();
        for (name, bytes) in [("modelDescription.xml", description.as_bytes()), (&*place, &*binary)] {
            archive.start_file(name, options)?;
            archive.write_all(bytes)?;
        }
        fs::write(file, archive.finish()?.into_inner()).map_err(|error| named(&error, file))
    }

    fn library_beside_the_program(&self) -> io::Result<PathBuf> {
        let program = env::current_exe()?;
        Ok(program.with_file_name(format!("{DLL_PREFIX}{}{DLL_SUFFIX}", self.library)))
    }
}

fn named(error: &io::Error, path: &Path) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}
