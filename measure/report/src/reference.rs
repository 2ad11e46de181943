//! Where the scenes start and end, to 30 digits: `references.txt`, made by `python/references.py`.

use anyhow::{Context, Result, bail, ensure};

/// A scene's start and, computed to 30 digits, its end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    pub start_q: Vec<f64>,
    pub start_v: Vec<f64>,
    pub time: f64,
    pub end_q: Vec<f64>,
    pub end_v: Vec<f64>,
    /// (time, energy) along the way, where the file has them.
    pub energies: Vec<(f64, f64)>,
}

/// The reference of the scene of that name.
///
/// # Errors
/// The file does not hold it, or not as numbers.
pub fn of(name: &str) -> Result<Reference> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/references.txt");
    find(&std::fs::read_to_string(path).with_context(|| path)?, name)
}

fn find(text: &str, name: &str) -> Result<Reference> {
    let mut lines = text.lines().skip_while(|line| line.strip_prefix("scene ") != Some(name));
    ensure!(
        lines.next().is_some(),
        "references.txt has no scene {name:?}; add it to python/scenes.py and run references.py"
    );
    let mut reference = Reference::default();
    for line in lines.take_while(|line| !line.starts_with("scene ")).filter(|line| !line.is_empty()) {
        let (word, rest) = line.split_once(' ').context("a line of one word")?;
        let numbers: Vec<f64> = rest
            .split(' ')
            .map(str::parse)
            .collect::<Result<_, _>>()
            .with_context(|| format!("scene {name}, line {line:?}"))?;
        match (word, numbers.as_slice()) {
            ("q0", _) => reference.start_q = numbers,
            ("v0", _) => reference.start_v = numbers,
            ("q1", _) => reference.end_q = numbers,
            ("v1", _) => reference.end_v = numbers,
            ("time", &[time]) => reference.time = time,
            ("energy", &[time, energy]) => reference.energies.push((time, energy)),
            _ => bail!(
                "scene {name}: the line {line:?} is none of q0, v0, q1, v1, time, energy with their numbers"
            ),
        }
    }
    Ok(reference)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# a comment\n\nscene a b\nq0 1.0 -2e-3\nv0 0.5 0.25\ntime 10.0\nq1 1.5 2.5\nv1 3.5 4.5\n\nscene c\nenergy 1.0 0.5\nenergy 2.0 0.25\n";

    #[test]
    fn a_scene_ends_where_the_next_begins() -> Result<()> {
        let scene = find(TEXT, "a b")?;
        assert_eq!((scene.start_q, scene.end_v, scene.time), (vec![1.0, -2e-3], vec![3.5, 4.5], 10.0));
        assert!(scene.energies.is_empty());
        assert_eq!(find(TEXT, "c")?.energies, [(1.0, 0.5), (2.0, 0.25)]);
        Ok(())
    }

    #[test]
    fn what_is_not_there_is_named() {
        assert!(find(TEXT, "a").unwrap_err().to_string().contains("no scene \"a\""));
        assert!(find("scene x\nwhat 1.0\n", "x").is_err());
        assert!(find("scene x\nq0 one\n", "x").is_err());
    }
}
