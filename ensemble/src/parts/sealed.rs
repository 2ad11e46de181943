//! Files with a digest of their own bytes.
//!
//! The digest stands in the footer, as the last of its metadata, and is of all bytes of the file, the footer
//! and the length behind it among them: where it stands itself it is of as many zeros.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::ops::Range;

use twox_hash::XxHash3_128;

use super::metadata;

/// The key of the digest.
pub(super) const KEY: &str = "dalembert.digest";

/// The digest of a file that has none yet.
pub(super) const BLANK: &str = "00000000000000000000000000000000";

/// Between the end of the key and the digest, in Thrift's compact protocol: the next field is text, of so
/// many bytes.
const BETWEEN: [u8; 2] = [0x18, BLANK.len() as u8];

/// The end of a Parquet file.
const MAGIC: &[u8; 4] = b"PAR1";

/// Bytes that are read at a time.
const BLOCK: usize = 1 << 16;

/// Writes the digest in place of the [`BLANK`] one, and returns it.
pub(super) fn seal(file: &mut File) -> io::Result<String> {
    let Some(place) = place(file)? else { return Err(io::ErrorKind::InvalidData.into()) };
    let digest = digest(file, &place)?;
    file.seek(SeekFrom::Start(place.start))?;
    file.write_all(digest.as_bytes())?;
    Ok(digest)
}

/// The digest of a file, if it is of the bytes that are there.
pub(super) fn intact(file: &mut File) -> io::Result<Option<String>> {
    let Some(place) = place(file)? else { return Ok(None) };
    let mut written = [0; BLANK.len()];
    file.seek(SeekFrom::Start(place.start))?;
    file.read_exact(&mut written)?;
    Ok(Some(digest(file, &place)?).filter(|digest| digest.as_bytes() == written))
}

/// The bytes of the digest in a file, if there is one.
fn place(file: &mut File) -> io::Result<Option<Range<u64>>> {
    let end = file.seek(SeekFrom::End(0))?;
    let Some(length_at) = end.checked_sub(8) else { return Ok(None) };
    let mut last = [0; 8];
    file.seek(SeekFrom::Start(length_at))?;
    file.read_exact(&mut last)?;
    let [length @ .., _, _, _, _] = last;
    let Some(from) =
        length_at.checked_sub(u32::from_le_bytes([length[0], length[1], length[2], length[3]]).into())
    else {
        return Ok(None);
    };
    if &last[4..] != MAGIC {
        return Ok(None);
    }
    let mut footer = Vec::new();
    file.seek(SeekFrom::Start(from))?;
    file.take(length_at - from).read_to_end(&mut footer)?;
    // The last: what the user wrote before may look the same.
    let sought = [KEY.as_bytes(), &BETWEEN].concat();
    let found = footer.windows(sought.len() + BLANK.len()).rposition(|there| there.starts_with(&sought));
    Ok(found.map(|at| {
        let start = from + (at + sought.len()) as u64;
        start..start + BLANK.len() as u64
    }))
}

/// The digest of all bytes, those of `place` as if they were [`BLANK`].
fn digest(file: &mut File, place: &Range<u64>) -> io::Result<String> {
    let mut hash = XxHash3_128::new();
    file.seek(SeekFrom::Start(0))?;
    add(&mut hash, &mut file.take(place.start))?;
    hash.write(BLANK.as_bytes());
    file.seek(SeekFrom::Start(place.end))?;
    add(&mut hash, file)?;
    Ok(metadata::digits(hash.finish_128()))
}

fn add(hash: &mut XxHash3_128, bytes: &mut impl Read) -> io::Result<()> {
    let mut block = vec![0; BLOCK];
    loop {
        match bytes.read(&mut block) {
            Ok(0) => return Ok(()),
            Ok(read) => hash.write(&block[..read]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}
