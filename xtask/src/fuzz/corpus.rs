//! A corpus of inputs: a file each for the fuzzer, and a line each in hexadecimal digits where they are kept.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};

/// Writes the inputs of a page into files of a folder, by the numbers of their lines.
pub fn unpack(page: &str, folder: &Path) -> Result<()> {
    for (index, line) in page.lines().enumerate() {
        let input = bytes(line).with_context(|| format!("line {}", index + 1))?;
        fs::write(folder.join((index + 1).to_string()), input)?;
    }
    Ok(())
}

/// The page of the files in a folder: the shortest of them, up to so many bytes together.
pub fn pack(folder: &Path, most: usize) -> Result<String> {
    let mut inputs = Vec::new();
    for file in fs::read_dir(folder)? {
        inputs.push(fs::read(file?.path())?);
    }
    inputs.sort_by_key(|input| (input.len(), input.clone()));
    let (mut page, mut bytes) = (String::new(), 0);
    for input in inputs {
        bytes += input.len();
        if bytes > most {
            break;
        }
        for byte in input {
            write!(page, "{byte:02x}")?;
        }
        page.push('\n');
    }
    Ok(page)
}

fn bytes(line: &str) -> Result<Vec<u8>> {
    ensure!(line.is_ascii() && line.len().is_multiple_of(2), "an odd number of digits");
    (0..line.len()).step_by(2).map(|at| Ok(u8::from_str_radix(&line[at..at + 2], 16)?)).collect()
}

#[cfg(test)]
mod tests {
    use xshell::Shell;

    use super::*;

    #[test]
    fn inputs_are_packed_as_they_were_unpacked() {
        let folder = Shell::new().unwrap().create_temp_dir().unwrap();
        let page = "\n07\nff00\n010203\n";
        unpack(page, folder.path()).unwrap();
        assert_eq!(fs::read(folder.path().join("3")).unwrap(), [255, 0]);
        assert_eq!(pack(folder.path(), 6).unwrap(), page);
        assert_eq!(pack(folder.path(), 5).unwrap(), "\n07\nff00\n");
        assert!(unpack("0", folder.path()).is_err() && unpack("0g", folder.path()).is_err());
    }
}
