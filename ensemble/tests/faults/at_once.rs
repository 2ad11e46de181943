//! Calls at once in one folder, each in a process of its own.

use std::fs;
use std::path::Path;
use std::process::Child;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::study::{Call, Files, OF_PART, PLAIN, ended, files, folder, folder_of, sign, started};
use crate::trials::Trials;

/// Starts processes that wait, and lets them go.
fn begun(calls: &[Call], folder: &Path) -> Vec<Child> {
    let go = sign(folder);
    let _ = fs::remove_dir(&go);
    let children: Vec<Child> = calls.iter().map(|call| started(call, folder, &go)).collect();
    thread::sleep(Duration::from_millis(10));
    fs::create_dir_all(&go).unwrap();
    children
}

/// What is wrong with the files of a folder after calls that said this: exactly one is to be well, and the
/// files are to be its own.
fn wrong_with_one(said: &[&str], own: &[&Files], there: &Files) -> Option<String> {
    let well: Vec<usize> = (0..said.len()).filter(|&k| said[k] == "ok").collect();
    match well[..] {
        [one] if own[one] == there => None,
        [_] => Some(format!("{said:?}, and the files are not those of the one")),
        _ => Some(format!("{said:?}")),
    }
}

/// Two calls of which one is to be refused; control: files of both, which one says are its own.
fn one_of(tries: u32, pairs: &[[Call; 2]]) -> Trials {
    let own: Vec<[Files; 2]> = pairs.iter().map(|pair| pair.map(|call| call.files())).collect();
    let mut trials = Trials::default();
    for k in 0..tries {
        let (pair, own) = (&pairs[k as usize % pairs.len()], &own[k as usize % pairs.len()]);
        let folder = folder();
        let said: Vec<_> = begun(pair, &folder).into_iter().map(ended).collect();
        said.iter().for_each(|said| trials.hear(said));
        trials.add(wrong_with_one(&said, &[&own[0], &own[1]], &files(&folder)));

        // All of the one's, but a part of the other's.
        let mut mixed = own[0].clone();
        let part = |(name, bytes): (&String, &Vec<u8>)| (name.clone(), bytes.clone());
        mixed.extend(own[1].iter().filter(|(name, _)| name.starts_with("members")).nth(1).map(part));
        trials.add_control(wrong_with_one(&["ok", "Io"], &[&own[0], &own[1]], &mixed).is_some());
    }
    trials
}

/// Of other starts, of other fields, by another method.
pub fn two_studies(tries: u32) -> Trials {
    let others = [
        Call { p: -0.5, ..PLAIN },
        Call { r: 0.1, ..PLAIN },
        Call { steps: 12, ..PLAIN },
        Call { p: -0.5, steps: 9, ..PLAIN },
    ];
    one_of(tries, &others.map(|other| [PLAIN, other]))
}

/// Of members of their own, by equal metadata: of two studies one at least is refused, and both of the same
/// end well. Control: files of both, of which a call over all says that they are of two.
pub fn two_studies_apart(tries: u32) -> Trials {
    let half = Call { members: 3 * OF_PART, ..PLAIN };
    let rest = Call { from: 3 * OF_PART, ..PLAIN };
    let others = [Call { p: -0.5, ..rest }, Call { r: 0.1, ..rest }];
    let (own, whole) = (half.files(), PLAIN.files());
    let mut trials = Trials::default();
    for k in 0..tries {
        let other = others[k as usize % 2];
        let folder = folder();
        let said: Vec<_> = begun(&[half, other], &folder).into_iter().map(ended).collect();
        said.iter().for_each(|said| trials.hear(said));
        let is_well =
            said.contains(&"AnotherStudy") && said.iter().all(|said| ["ok", "AnotherStudy"].contains(said));
        trials.add((!is_well).then(|| format!("{said:?}")));

        let mut both = own.clone();
        both.extend(other.files());
        trials.add_control(PLAIN.write(&folder_of(&both)).is_err());
        if k % 4 == 0 {
            let folder = crate::study::folder();
            let said: Vec<_> = begun(&[half, rest], &folder).into_iter().map(ended).collect();
            let is_well = said == ["ok", "ok"] && files(&folder) == whole;
            trials.add((!is_well).then(|| format!("of one study: {said:?}")));
        }
    }
    trials
}

pub fn two_sizes(tries: u32) -> Trials {
    let of = |of_part: u64| Call { of_part, members: 1200, steps: PLAIN.steps.div_ceil(10), ..PLAIN };
    one_of(tries, &[[of(250), of(600)], [of(600), of(250)]])
}

/// To the middle of the last part and to its end: one may end well, or the other, and both together never. A
/// call that is refused leaves none of its parts beside the other's.
pub fn two_ends(tries: u32) -> Trials {
    let calls = [Call { members: PLAIN.members - OF_PART / 2, ..PLAIN }, PLAIN];
    let own = calls.map(|call| call.files());
    let last = own.each_ref().map(|own| own.keys().rfind(|name| name.starts_with("members")).unwrap());
    let both = |there: &Files| last.iter().all(|&name| there.contains_key(name));
    let mut trials = Trials::default();
    for _ in 0..tries {
        let folder = folder();
        let said: Vec<_> = begun(&calls, &folder).into_iter().map(ended).collect();
        said.iter().for_each(|said| trials.hear(said));
        let is_wrong = said == ["ok", "ok"] || both(&files(&folder)) || said.contains(&"Io");
        trials.add(is_wrong.then(|| format!("{said:?}")));
        // The other's part, put beside by hand.
        let mut there = own[0].clone();
        there.extend(own[1].clone());
        trials.add_control(both(&there));
    }
    trials
}

/// What is wrong after calls that are all to be well.
fn wrong_with_all(said: &[&str], own: &Files, there: &Files) -> Option<String> {
    let is_well = said.iter().all(|said| *said == "ok") && own == there;
    (!is_well).then(|| format!("{said:?}, {} files of {}", there.len(), own.len()))
}

/// A task that is requeued while it runs; control: drafts of living writers are removed, as they come.
pub fn the_same(tries: u32) -> Trials {
    let mut random = StdRng::seed_from_u64(2);
    let own = PLAIN.files();
    let mut trials = Trials::default();
    for k in 0..tries {
        let folder = folder();
        let mut children = begun(&[PLAIN; 2], &folder);
        thread::sleep(Duration::from_micros(random.random_range(0..20_000)));
        children.extend(begun(&[PLAIN], &folder));
        let said: Vec<_> = children.into_iter().map(ended).collect();
        said.iter().for_each(|said| trials.hear(said));
        trials.add(wrong_with_all(&said, &own, &files(&folder)));
        if k % 10 == 0 {
            let said = one_whose_drafts_go();
            trials.add_control(wrong_with_all(&[said], &own, &own).is_some());
        }
    }
    trials
}

/// What a call says whose drafts somebody removes all the time.
fn one_whose_drafts_go() -> &'static str {
    let folder = folder();
    let is_over = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            while !is_over.load(Ordering::Relaxed) {
                let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
                let drafts = entries.filter(|entry| entry.file_name().to_string_lossy().starts_with('.'));
                drafts.for_each(|draft| drop(fs::remove_file(draft.path())));
            }
        });
        let said = ended(begun(&[PLAIN], &folder).remove(0));
        is_over.store(true, Ordering::Relaxed);
        said
    })
}

/// One of three is killed at a random moment, and the same call once more ends with the same files. Control:
/// without that call some parts are missing.
pub fn one_is_killed(tries: u32) -> Trials {
    let mut random = StdRng::seed_from_u64(3);
    let own = PLAIN.files();
    let mut trials = Trials::default();
    for k in 0..tries {
        let folder = folder();
        let mut children = begun(&[PLAIN; 3], &folder);
        // By what is written, not by time: other programs may take the processor.
        let enough = random.random_range(0..7);
        while fs::read_dir(&folder).map_or(0, Iterator::count) < enough {
            thread::sleep(Duration::from_micros(100));
        }
        thread::sleep(Duration::from_micros(random.random_range(0..1000)));
        let mut killed = children.swap_remove(random.random_range(0..3));
        killed.kill().unwrap();
        trials.hear(ended(killed));
        let mut said: Vec<_> = children.into_iter().map(ended).collect();
        said.extend(begun(&[PLAIN], &folder).into_iter().map(ended));
        said.iter().for_each(|said| trials.hear(said));
        trials.add(wrong_with_all(&said, &own, &files(&folder)));

        if k % 10 == 0 {
            let folder = crate::study::folder();
            let mut children = begun(&[PLAIN], &folder);
            while !folder.join("_study.parquet").exists() {
                thread::sleep(Duration::from_micros(100));
            }
            children[0].kill().unwrap();
            let said = ended(children.remove(0));
            trials.add_control(wrong_with_all(&[said], &own, &files(&folder)).is_some());
        }
    }
    trials
}
