//! Faults drawn at random: whatever is done to the files of a run, before or while it runs, it ends in the
//! bits of the run that was left alone, or with an error that is true.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Output;
use std::time::Duration;
use std::{env, process, thread};

use dalembert::nalgebra::vector;
use dalembert::{Discrete, Gauss, Midpoint, State, rayleigh_system};
use dalembert_examples::saved_run::{SavedRun, Schedule};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::{CHILD, child, files, folder, text};

/// Two coupled oscillators that are not linear.
#[rayleigh_system(rule = [midpoint, gauss])]
fn coupled(q: [f64; 2], v: [f64; 2], k: f64) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) + q[0].cos() + q[1].cos() - 0.5 * k * (q[0] - q[1]).powi(2)
}

/// No whole number of rows, nor of checkpoints.
const SCHEDULE: Schedule = Schedule { row: 100, rows_to_checkpoint: 20, end: 20_130 };

/// The run in question, and runs that others might take for it.
#[derive(Clone, Copy)]
struct Variant {
    k: f64,
    h: f64,
    q: f64,
    is_gauss: bool,
    schedule: Schedule,
    digits: usize,
}

const RUN: Variant = Variant { k: 0.3, h: 0.05, q: 1.2, is_gauss: false, schedule: SCHEDULE, digits: 12 };

fn others() -> Vec<Variant> {
    let schedule = Schedule { row: 200, rows_to_checkpoint: 10, ..SCHEDULE };
    let others = vec![
        Variant { k: 0.300_000_1, ..RUN },
        Variant { h: 0.050_001, ..RUN },
        Variant { q: 1.2_f64.next_up(), ..RUN },
        Variant { is_gauss: true, ..RUN },
        Variant { schedule, ..RUN },
        Variant { digits: 11, ..RUN },
    ];
    others
        .into_iter()
        .map(|other| Variant { schedule: Schedule { end: 10_000, ..other.schedule }, ..other })
        .collect()
}

impl Variant {
    fn run(self, folder: &Path) -> anyhow::Result<State<f64, 2>> {
        self.run_while(folder, &|| {})
    }

    /// The run, with what happens whenever it writes a row.
    fn run_while(self, folder: &Path, happens: &dyn Fn()) -> anyhow::Result<State<f64, 2>> {
        fn by<R: Copy>(
            rule: R,
            of: Variant,
            folder: &Path,
            happens: &dyn Fn(),
        ) -> anyhow::Result<State<f64, 2>>
        where
            Coupled: Discrete<R, 2, Scalar = f64>,
        {
            let start = State { q: vector![of.q, -0.4], p: vector![0.0, 0.3] };
            let row = |time: f64, state: &State<f64, 2>| {
                happens();
                format!("{time:.6},{:.*},{:.*}", of.digits, state.q[0], of.digits, state.q[1])
            };
            SavedRun::in_folder(folder).run((&Coupled { k: of.k }, rule), (of.h, start), of.schedule, row)
        }
        if self.is_gauss {
            by(Gauss::<2>, self, folder, happens)
        } else {
            by(Midpoint, self, folder, happens)
        }
    }
}

fn end_in_words(end: &State<f64, 2>) -> String {
    format!("end {:x?}", end.q.iter().chain(&end.p).map(|entry| entry.to_bits()).collect::<Vec<_>>())
}

#[test]
fn child_of_random_faults() {
    if let Some(folder) = env::var_os(CHILD) {
        let folder = Path::new(&folder);
        // Harm while it runs, at the row and with the draws that the parent gives.
        let harm = env::var(HARM).ok().and_then(|harm| harm.parse::<u64>().ok());
        let rows = Cell::new(0);
        let happens = || {
            if let Some(seed) = harm {
                let mut random = StdRng::seed_from_u64(seed);
                if rows.get() == random.random_range(0..=202) {
                    let how = [Fault::Truncate, Fault::Delete, Fault::Alter, Fault::Append];
                    let how = how[random.random_range(0..how.len())];
                    damage(&folder.join(if random.random() { ROWS } else { CHECKPOINT }), how, &mut random);
                }
                rows.set(rows.get() + 1);
            }
        };
        match RUN.run_while(folder, &happens) {
            Ok(end) => println!("{}", end_in_words(&end)),
            Err(error) => {
                eprintln!("said: {error:#}");
                process::exit(3);
            }
        }
    }
}

/// Which harm a child is to do to its own files.
const HARM: &str = "DALEMBERT_FAULTS_HARM";

const ROWS: &str = "rows.csv";
const CHECKPOINT: &str = "checkpoint.json";

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Fault {
    Kill,
    Truncate,
    Delete,
    Alter,
    Append,
    Swap,
    OfAnother,
    Older,
    Temporary,
    FolderInTheWay,
    NoRoom,
    ReadOnly,
    WhileRunning,
}

const FAULTS: [Fault; 13] = [
    Fault::Kill,
    Fault::Truncate,
    Fault::Delete,
    Fault::Alter,
    Fault::Append,
    Fault::Swap,
    Fault::OfAnother,
    Fault::Older,
    Fault::Temporary,
    Fault::FolderInTheWay,
    Fault::NoRoom,
    Fault::ReadOnly,
    Fault::WhileRunning,
];

/// Damages one file, if it is there.
fn damage(path: &Path, fault: Fault, random: &mut StdRng) {
    let Ok(mut bytes) = fs::read(path) else { return };
    match fault {
        Fault::Truncate => bytes.truncate(random.random_range(0..=bytes.len())),
        Fault::Delete => return drop(fs::remove_file(path)),
        Fault::Alter => {
            if !bytes.is_empty() {
                let at = random.random_range(0..bytes.len());
                bytes[at] ^= 1 << random.random_range(0..8);
            }
        }
        _ => bytes.extend((0..random.random_range(1..500)).map(|_| random.random::<u8>())),
    }
    let _ = fs::write(path, bytes);
}

struct Trial<'a> {
    folder: &'a Path,
    others: &'a [std::path::PathBuf],
    older: &'a [std::path::PathBuf],
    random: StdRng,
}

impl Trial<'_> {
    fn one_of_the_files(&mut self) -> std::path::PathBuf {
        self.folder.join(if self.random.random() { ROWS } else { CHECKPOINT })
    }

    /// Copies one or both files of another folder here.
    fn copy_from(&mut self, folders: &[std::path::PathBuf]) {
        let from = &folders[self.random.random_range(0..folders.len())];
        let both = self.random.random_range(0..3);
        for (index, name) in [ROWS, CHECKPOINT].into_iter().enumerate() {
            if both != index {
                fs::copy(from.join(name), self.folder.join(name)).unwrap();
            }
        }
    }

    /// A run that is killed after some time.
    fn killed(&mut self) {
        let mut running = child("at_random::child_of_random_faults", self.folder, "").spawn().unwrap();
        thread::sleep(Duration::from_micros(self.random.random_range(0..40_000)));
        running.kill().unwrap();
        running.wait().unwrap();
    }

    /// Does the harm, and runs: to the end, if nothing is in the way.
    fn run(&mut self, fault: Fault) -> Output {
        let (mut before, mut harm) = (String::new(), String::new());
        match fault {
            Fault::Kill => self.killed(),
            Fault::WhileRunning => harm = self.random.random::<u64>().to_string(),
            Fault::Truncate | Fault::Delete | Fault::Alter | Fault::Append => {
                let file = self.one_of_the_files();
                damage(&file, fault, &mut self.random);
            }
            Fault::Swap => {
                let [rows, checkpoint, between] =
                    [ROWS, CHECKPOINT, "between"].map(|name| self.folder.join(name));
                let _ = fs::rename(&rows, &between);
                let _ = fs::rename(&checkpoint, &rows);
                let _ = fs::rename(&between, &checkpoint);
            }
            Fault::OfAnother => self.copy_from(self.others),
            Fault::Older => self.copy_from(self.older),
            Fault::Temporary => {
                fs::write(self.folder.join(format!(".{CHECKPOINT}.aB3x9Z")), "half a").unwrap()
            }
            Fault::FolderInTheWay => {
                let file = self.one_of_the_files();
                let _ = fs::remove_file(&file);
                fs::create_dir(&file).unwrap();
            }
            // Blocks of 512 or 1024 bytes.
            Fault::NoRoom => before = format!("trap '' XFSZ; ulimit -f {};", self.random.random_range(0..8)),
            Fault::ReadOnly => before = READ_ONLY.to_owned(),
        }
        child("at_random::child_of_random_faults", self.folder, &before).env(HARM, harm).output().unwrap()
    }
}

/// A folder that this user may not write to. Where everything is permitted, another user runs the child.
const READ_ONLY: &str = "chmod -R a-w \"$DALEMBERT_FAULTS_FOLDER\"; \
    [ \"$(id -u)\" != 0 ] || exec setpriv --reuid=65534 --regid=65534 --clear-groups \"$0\" \"$@\";";

/// What an error may say after a fault, if it is to be true.
fn is_true_of(fault: Fault, said: &str) -> bool {
    let broken = said.contains("is no checkpoint of this run, or broken; remove the folder");
    let unlike = said.contains("it was changed, or is another run's; remove the folder");
    match fault {
        Fault::Truncate | Fault::Delete | Fault::Alter | Fault::Swap => broken || unlike,
        Fault::Append => broken,
        Fault::Older => unlike,
        Fault::OfAnother => said.contains("holds another run; remove it") || unlike,
        Fault::FolderInTheWay => said.contains("cannot write") || said.contains("cannot read"),
        Fault::NoRoom => said.contains(": make room; "),
        Fault::ReadOnly => said.contains("permit writing there") && !said.contains("make room"),
        Fault::WhileRunning => {
            broken || unlike || said.contains("was changed while the run went on; remove the folder")
        }
        Fault::Kill | Fault::Temporary => false,
    }
}

/// The end and the rows of the run that was left alone.
fn is_right(folder: &Path, said: &str, end: &str, rows: &[u8]) -> bool {
    said.contains(end) && fs::read(folder.join(ROWS)).is_ok_and(|found| found == rows)
}

/// As many as `FAULTS` says, or some.
#[test]
#[cfg(unix)]
fn any_fault_ends_in_the_same_bits_or_in_a_true_error() {
    let count: usize = env::var("FAULTS")
        .map_or(if cfg!(debug_assertions) { 40 } else { 130 }, |count| count.parse().unwrap());
    let seed = env::var("FAULTS_SEED").map_or(13, |seed| seed.parse().unwrap());
    let alone = folder("random-alone");
    let end = end_in_words(&RUN.run(&alone).unwrap());
    let rows = fs::read(alone.join(ROWS)).unwrap();
    // Exactly its end: 201 rows of 100 steps and one of 30.
    assert_eq!(rows.iter().filter(|byte| **byte == b'\n').count(), 202);
    assert!(String::from_utf8_lossy(&rows).lines().last().unwrap().starts_with("1006.500000,"));
    let kept_at = |name: &str, variant: Variant| {
        let folder = folder(name);
        variant.run(&folder).unwrap();
        folder
    };
    let of_others: Vec<_> = others()
        .into_iter()
        .enumerate()
        .map(|(k, other)| kept_at(&format!("random-other-{k}"), other))
        .collect();
    let earlier = [2_000, 4_000, 8_000, 16_000];
    let older: Vec<_> = earlier
        .map(|end| {
            kept_at(&format!("random-{end}"), Variant { schedule: Schedule { end, ..SCHEDULE }, ..RUN })
        })
        .to_vec();

    // For each fault: how often the run went on rightly, and how often it said why not.
    let mut tally: BTreeMap<Fault, [u32; 2]> = BTreeMap::new();
    let tried = folder("random");
    let random = StdRng::seed_from_u64(seed);
    let mut trial = Trial { folder: &tried, others: &of_others, older: &older, random };
    for k in 0..count {
        let fault = FAULTS[k % FAULTS.len()];
        // From a fresh folder, from somewhere on the way, or from what the fault before has left.
        match trial.random.random_range(0..3) {
            0 => renew(&tried),
            1 => {
                renew(&tried);
                let from = &older[trial.random.random_range(0..older.len())];
                for name in [ROWS, CHECKPOINT] {
                    fs::copy(from.join(name), tried.join(name)).unwrap();
                }
            }
            _ => {}
        }
        let output = trial.run(fault);
        let said = text(&output);
        let seen = tally.entry(fault).or_default();
        if output.status.success() {
            seen[0] += 1;
            assert!(is_right(&tried, &said, &end, &rows), "{fault:?} goes on wrongly: {said}");
            let left = files(&tried);
            assert!(!left.iter().any(|name| name.starts_with('.')), "{fault:?} leaves {left:?}");
        } else if output.status.code() == Some(126) || said.contains("setpriv:") {
            println!("{fault:?} is left out: no other user can run this here");
        } else {
            seen[1] += 1;
            let said = said.lines().find(|line| line.starts_with("said: ")).unwrap_or(&said);
            assert!(output.status.code() == Some(3) && is_true_of(fault, said), "{fault:?}: {said}");
        }
        let _ = process::Command::new("chmod").args(["-R", "u+w"]).arg(&tried).status();
        // Without the fault it goes on rightly, from whatever was left, or refuses it; from nothing it is
        // right.
        let again = child("at_random::child_of_random_faults", &tried, "").output().unwrap();
        if again.status.success() {
            assert!(is_right(&tried, &text(&again), &end, &rows), "after {fault:?}: {}", text(&again));
        } else {
            assert!(text(&again).contains("said: "), "{}", text(&again));
            renew(&tried);
        }
    }
    println!(
        "{count} faults, of each how many runs went on to the same bits, and how many ended in a true error: {tally:?}"
    );
    for fault in [Fault::Kill, Fault::Temporary] {
        assert!(tally[&fault][0] > 0 && tally[&fault][1] == 0, "{fault:?}");
    }
    for fault in [Fault::Alter, Fault::Swap, Fault::OfAnother, Fault::NoRoom, Fault::FolderInTheWay] {
        assert!(tally[&fault][1] > 0, "{fault:?} is not noticed");
    }
    // The control: one digit of one row, and one bit of the end.
    let mut altered = rows.clone();
    let last = altered.len() - 2;
    altered[last] ^= 1;
    fs::write(alone.join(ROWS), &altered).unwrap();
    assert!(
        !is_right(&alone, &end, &end, &rows)
            && !is_true_of(Fault::ReadOnly, "cannot write rows.csv: make room; ")
    );
    for folder in of_others.iter().chain(&older).chain([&alone, &tried]) {
        fs::remove_dir_all(folder).unwrap();
    }
}

fn renew(folder: &Path) {
    fs::remove_dir_all(folder).unwrap();
    fs::create_dir_all(folder).unwrap();
}
