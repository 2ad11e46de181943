//! The .fmu file: a zip archive of the description and the library.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};
use std::{env, fs};

use dalembert_c::machine::Interface;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::Unit;

impl<I: Interface<N>, const N: usize> Unit<I, N> {
    /// Writes the unit to `file`, with the library of this crate that Cargo has built beside the running program.
    ///
    /// # Errors
    /// Where the library is not there, or `file` cannot be written; the message names either.
    pub fn pack(&self, file: impl AsRef<Path>) -> io::Result<()> {
        self.pack_library(&self.library_beside_the_program()?, file)
    }

    /// Writes the unit to `file`, with the library `library` of this machine's kind.
    ///
    /// # Errors
    /// Where the library cannot be read or `file` cannot be written; the message names either.
    pub fn pack_library(&self, library: &Path, file: impl AsRef<Path>) -> io::Result<()> {
        let binary = fs::read(library).map_err(|error| named(&error, library))?;
        let system = if OS == "macos" { "darwin" } else { OS };
        let place = format!("binaries/{ARCH}-{system}/{}{DLL_SUFFIX}", self.header.prefix);
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        // The same bytes from the same library: no time of day.
        let options = SimpleFileOptions::default();
        for (name, bytes) in [("modelDescription.xml", self.description().as_bytes()), (&*place, &*binary)] {
            archive.start_file(name, options)?;
            archive.write_all(bytes)?;
        }
        let file = file.as_ref();
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
