//! Parts that are not as they were written.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use dalembert::{Midpoint, State};
use dalembert_ensemble::Ensemble;
use parquet::file::reader::{FileReader, SerializedFileReader};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::study::{OF_PART, PLAIN, Pendulum, folder, folder_of, kind};
use crate::trials::Trials;

/// The part k.
fn name(k: u64) -> String {
    format!("members-{:012}-{:012}.parquet", OF_PART * k, OF_PART * (k + 1))
}

/// A call on the files of a folder of which one is changed, that of the study or a part. Control: whether the
/// check of the footer alone, of its metadata, lets it pass.
fn changed(tries: u32, seed: u64, change: impl Fn(&mut StdRng, &mut Vec<u8>)) -> Trials {
    let mut random = StdRng::seed_from_u64(seed);
    let whole = PLAIN.files();
    let mut trials = Trials::default();
    while trials.tries() < tries {
        let mut there = whole.clone();
        let Some((name, file)) = there.iter_mut().nth(random.random_range(0..whole.len())) else { continue };
        change(&mut random, file);
        if *file == whole[name] {
            continue;
        }
        let name = name.clone();
        let folder = folder_of(&there);
        let result = PLAIN.write(&folder);
        trials.hear(result.as_ref().map_or_else(kind, |_| "ok"));
        trials.add(result.ok().map(|written| format!("{name}: {written}")));
        trials.add_control(metadata(&folder.join(&name)) == metadata(&folder_of(&whole).join(&name)));
    }
    trials
}

pub fn flipped(tries: u32) -> Trials {
    changed(tries, 4, |random, part| {
        let at = random.random_range(0..part.len());
        part[at] ^= 1 << random.random_range(0..8);
    })
}

pub fn overwritten(tries: u32) -> Trials {
    changed(tries, 5, |random, part| {
        let at = random.random_range(0..part.len());
        if random.random_range(0..4) == 0 {
            part.truncate(at);
        } else {
            let end = part.len().min(at + random.random_range(1..512));
            part[at..end].fill(0);
        }
    })
}

/// Control: the metadata of a part that has another's name are those of the study, but for its members.
pub fn misplaced(tries: u32) -> Trials {
    let mut random = StdRng::seed_from_u64(6);
    let whole = PLAIN.files();
    let mut trials = Trials::default();
    for k in 0..tries {
        if k % 2 == 0 {
            let one = random.random_range(0..6);
            let other = (one + random.random_range(1..6)) % 6;
            let folder = folder_of(&whole);
            let of_study = |k: u64| {
                let all = metadata(&folder.join(name(k))).into_iter().flatten();
                all.filter(|(key, _)| !["members", "starts", "digest"].iter().any(|own| key.ends_with(own)))
                    .collect::<Vec<_>>()
            };
            trials.add_control(!of_study(one).is_empty() && of_study(one) == of_study(other));
            fs::rename(folder.join(name(one)), folder.join(name(other))).unwrap();
            let result = PLAIN.write(&folder);
            trials.hear(result.as_ref().map_or_else(kind, |_| "ok"));
            trials.add(result.ok().map(|written| format!("{one} over {other}: {written}")));
        } else {
            let (part, kept) = (random.random_range(0..3), random.random_range(0..3));
            let said = of_call_with_deletion(Some(part));
            trials.hear(said);
            trials.add((said != "Gone").then(|| format!("part {part} deleted: {said}")));
            trials.add_control(of_call_with_deletion(Some(part + kept + 6)) == "ok");
        }
    }
    trials
}

/// What a call says while which a part is deleted that it has written.
fn of_call_with_deletion(part: Option<u64>) -> &'static str {
    let folder = folder();
    let path = part.map(|part| folder.join(name(part)));
    let is_deleted = AtomicBool::new(false);
    let member = |number: u64| {
        Ok((Pendulum { g: 1.0, r: 0.0 }, State { q: [1e-3 * number as f64].into(), p: [0.5].into() }))
    };
    let study = Ensemble::new(member).by(Midpoint, 0.1).steps(PLAIN.steps).on_progress(|progress| {
        let is_written = progress.done >= 5 * OF_PART;
        if is_written && path.as_ref().is_some_and(|path| fs::remove_file(path).is_ok()) {
            is_deleted.store(true, Ordering::Relaxed);
        }
        ControlFlow::Continue(())
    });
    let result = study.parts(&folder).members_per_part(OF_PART).write(0..PLAIN.members);
    result.as_ref().map_or_else(kind, |_| if is_deleted.load(Ordering::Relaxed) { "deleted" } else { "ok" })
}

/// The metadata that a reader finds, where it finds a Parquet file.
fn metadata(path: &Path) -> Option<Vec<(String, Option<String>)>> {
    let reader = SerializedFileReader::new(fs::File::open(path).ok()?).ok()?;
    let entries = reader.metadata().file_metadata().key_value_metadata()?;
    Some(entries.iter().map(|entry| (entry.key.clone(), entry.value.clone())).collect())
}
