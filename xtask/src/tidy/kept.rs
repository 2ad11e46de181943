//! Results of checks that take seconds, kept for as long as neither the files nor the checks change.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};

use anyhow::{Context, Result};

use crate::project;

/// The result of the check `name` of these texts: the one kept, or that of `find`.
pub fn of(name: &str, texts: impl Hash, find: impl FnOnce() -> Result<Vec<String>>) -> Result<Vec<String>> {
    // Tests are to see the check.
    if cfg!(test) {
        return find();
    }
    let key = key(texts)?;
    let file = project::root().join("target/xtask/kept").join(name.replace('/', "-")).with_extension("json");
    let kept =
        fs::read_to_string(&file).ok().and_then(|text| serde_json::from_str::<Vec<String>>(&text).ok());
    if let Some((_, found)) = kept.as_deref().and_then(<[_]>::split_first).filter(|(of, _)| **of == key) {
        return Ok(found.to_vec());
    }
    let found = find()?;
    let kept: Vec<_> = [&key].into_iter().chain(&found).collect();
    fs::create_dir_all(file.parent().context("a folder")?)?;
    fs::write(&file, serde_json::to_string(&kept)?).with_context(|| file.display().to_string())?;
    Ok(found)
}

/// A number for the texts and for the sources of the checks.
fn key(texts: impl Hash) -> Result<String> {
    let checks = project::root().join("xtask/src/tidy");
    let mut hasher = DefaultHasher::new();
    (project::sources(&checks, &checks)?, texts).hash(&mut hasher);
    Ok(hasher.finish().to_string())
}
