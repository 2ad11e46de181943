//! Parts are there whole or not at all, and are the same bits whatever happened on the way.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use dalembert::{Midpoint, State, StepError, rayleigh_system};
use dalembert_ensemble::Ensemble;
use dalembert_ensemble::parts::{PartsError, Written};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

#[rayleigh_system]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

fn member(number: u64) -> Result<(Pendulum, State<f64, 1>), StepError> {
    if number == 11 {
        return Err(StepError::StepSize { h: 0.0 });
    }
    let system = Pendulum { r: 1e-3 * number as f64 };
    let speed = if number == 13 { f64::NAN } else { 1.0 };
    let start = State { q: [0.0].into(), p: [speed].into() };
    Ok((system, start))
}

/// A folder of this test, empty.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    folder
}

/// All files.
fn bytes(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entry =
        |entry: fs::DirEntry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap());
    fs::read_dir(folder).unwrap().map(|found| entry(found.unwrap())).collect()
}

macro_rules! study {
    () => {
        Ensemble::new(member).by(Midpoint, 0.1).steps(10)
    };
}

#[test]
fn what_is_there_is_done_and_the_bits_are_the_same() {
    let (whole, parted) = (folder("whole"), folder("parted"));
    let study = study!();
    let of = |folder: &Path| study.parts(folder).members_per_part(100).column("r", |of| of.r);
    let none = Written::default();
    assert_eq!(of(&whole).write(0..450).unwrap(), Written { written: 5, failed: 2, ..none });
    // From two places, one of which lost a part.
    of(&parted).write(300..450).unwrap();
    of(&parted).write(0..300).unwrap();
    fs::remove_file(parted.join("members-000000000100-000000000200.parquet")).unwrap();
    // Those that failed are in a part that is there.
    let found = Written { failed: 2, failed_before: 2, ..none };
    let again = of(&parted).write(0..450).unwrap();
    assert_eq!(again, Written { written: 1, found: 4, ..found });
    assert_eq!(
        again.to_string(),
        "1 parts written, 4 were there; 2 members failed, 2 of them in parts that were there"
    );
    assert_eq!(of(&parted).write(0..450).unwrap(), Written { found: 5, ..found });
    assert_eq!(of(&parted).write(100..450).unwrap(), Written { found: 4, ..none });
    assert_eq!(bytes(&whole), bytes(&parted));
    // And what they have in common.
    assert_eq!(bytes(&whole).len(), 5 + 1);
}

#[test]
fn rows_are_the_members() {
    let folder = folder("rows");
    study!().every(4).parts(&folder).members_per_part(20).column("r", |of| of.r).write(0..20).unwrap();
    let path = folder.join("members-000000000000-000000000020.parquet");
    let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    let names: Vec<_> = reader
        .metadata()
        .file_metadata()
        .schema()
        .get_fields()
        .iter()
        .map(|of| of.name().to_owned())
        .collect();
    assert_eq!(names, ["member", "r", "t", "q0", "p0", "energy", "error"]);
    let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    // Steps 0, 4, 8 and 10 of 18 members, one row of each that fails.
    assert_eq!(rows.len(), 18 * 4 + 2);
    for row in &rows {
        let number = row.get_ulong(0).unwrap();
        match number {
            11 => {
                assert!(row.get_double(1).is_err() && row.get_double(2).is_err() && row.get_string(6).is_ok())
            }
            13 => {
                assert!(row.get_double(3).unwrap() == 0.0 && row.get_string(6).unwrap().contains("momentum"))
            }
            _ => {
                assert!(row.get_string(6).is_err());
                let (system, start) = member(number).unwrap();
                let steps = (row.get_double(2).unwrap() * 10.0).round() as usize;
                let mut run = dalembert::Discretise::by(&system, Midpoint, 0.1).run(start);
                let state = run.by_ref().take(steps).last().map_or(start, |step| step.unwrap().state);
                assert_eq!(row.get_double(1).unwrap(), system.r);
                assert_eq!(
                    (row.get_double(2).unwrap(), row.get_double(3).unwrap()),
                    (run.time(), state.q[0])
                );
                assert_eq!(row.get_double(5).unwrap(), state.energy(&system).unwrap());
            }
        }
    }
}

struct Growing;

#[rayleigh_system]
impl Growing {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * (2.0 + t) * v[0] * v[0]
    }
}

/// p stays, and so E = p²/2m falls as the mass m = 2 + t grows, t from 1 on.
#[test]
fn the_energy_of_a_row_is_that_of_its_time() {
    let folder = folder("timed");
    let start =
        |number: u64| Ok((Growing.at_time(1.0), State { q: [0.0].into(), p: [number as f64].into() }));
    let study = Ensemble::new(start).by(Midpoint, 0.1).steps(20).every(5);
    study.parts(&folder).members_per_part(4).write(0..4).unwrap();
    let energies = study.reduce(
        0..4,
        |_| Vec::new(),
        |energies, record| {
            let m = 3.0 + record.time;
            assert!((record.velocity().unwrap()[0] - record.number as f64 / m).abs() < 1e-15);
            energies.push(record.energy().unwrap());
        },
        Vec::new(),
        |all, mut outcome| all.append(&mut outcome.value),
    );
    let path = folder.join("members-000000000000-000000000004.parquet");
    let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 4 * 5);
    for (row, energy) in rows.iter().zip(energies.unwrap()) {
        let (t, p, found) =
            (row.get_double(1).unwrap(), row.get_double(3).unwrap(), row.get_double(4).unwrap());
        assert!((found - 0.5 * p * p / (3.0 + t)).abs() < 1e-14 && found == energy);
        assert!(p == 0.0 || t == 0.0 || found < 0.9 * p * p / 6.0);
    }
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let folder = folder("refused");
    study!().parts(&folder).members_per_part(100).metadata("seed", 1).write(0..200).unwrap();
    let there = bytes(&folder);

    let other_steps = Ensemble::new(member).by(Midpoint, 0.1).steps(11);
    let error =
        other_steps.parts(&folder).members_per_part(100).metadata("seed", 1).write(0..200).unwrap_err();
    assert!(matches!(&error, PartsError::AnotherStudy { key, .. } if key == "dalembert.method"), "{error}");
    let error = study!().parts(&folder).members_per_part(100).metadata("seed", 2).write(0..200).unwrap_err();
    assert!(matches!(&error, PartsError::AnotherStudy { key, .. } if key == "seed"), "{error}");
    let error = study!().parts(&folder).members_per_part(100).write(0..200).unwrap_err();
    assert!(matches!(&error, PartsError::AnotherStudy { expected: None, .. }), "{error}");
    let error = study!().parts(&folder).members_per_part(50).metadata("seed", 1).write(100..200).unwrap_err();
    assert!(error.to_string().contains("members_per_part is 100 there and 50 here"), "{error}");
    let error =
        study!().parts(&folder).members_per_part(100).metadata("seed", 1).write(100..150).unwrap_err();
    assert!(matches!(&error, PartsError::Overlap { .. }), "{error}");
    let error = study!().parts(&folder).members_per_part(100).write(150..200).unwrap_err();
    assert!(matches!(&error, PartsError::Unaligned { start: 150, members: 100 }), "{error}");
    // Nothing of what was there has changed.
    assert_eq!(bytes(&folder), there);

    fs::write(folder.join("members-000000000200-000000000300.parquet"), "no part").unwrap();
    let error = study!().parts(&folder).members_per_part(100).metadata("seed", 1).write(0..300).unwrap_err();
    assert!(
        matches!(&error, PartsError::Damaged { .. }) && error.to_string().contains("remove it"),
        "{error}"
    );
    let file = folder.join("members-000000000000-000000000100.parquet");
    assert!(matches!(study!().parts(&file).write(0..10), Err(PartsError::Io { .. })));
}

/// Set for the process that is killed: its folder.
const CHILD: &str = "DALEMBERT_TEST_PARTS";

fn long(folder: &Path) -> Written {
    // About a second, of which a process takes little to begin.
    let steps = if cfg!(debug_assertions) { 120 } else { 6000 };
    let study = Ensemble::new(member).by(Midpoint, 0.1).steps(steps);
    study.parts(folder).members_per_part(50).write(0..2000).unwrap()
}

/// No test of its own: what `killed_at_random_moments_…` starts and kills.
#[test]
fn child() {
    if let Some(folder) = std::env::var_os(CHILD) {
        long(Path::new(&folder));
    }
}

#[test]
fn killed_at_random_moments_it_ends_with_the_same_bits() {
    let (whole, killed) = (folder("never_killed"), folder("killed"));
    let started = Instant::now();
    long(&whole);
    let time = started.elapsed();
    let mut random = StdRng::seed_from_u64(8);
    let (mut kills, mut parts) = (0, Vec::new());
    let there = || fs::read_dir(&killed).map_or(0, Iterator::count);
    for _ in 0..20 {
        // By what it has written, not by time: other programs may take the processor.
        let enough = there() + random.random_range(0..6);
        let mut process = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "child"])
            .env(CHILD, &killed)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        while there() < enough && process.try_wait().unwrap().is_none() {
            thread::sleep(Duration::from_millis(1));
        }
        thread::sleep(time.mul_f64(random.random_range(0.0..0.03)));
        kills += u32::from(process.try_wait().unwrap().is_none());
        process.kill().unwrap();
        process.wait().unwrap();
        parts.push(there());
    }
    let written = long(&killed);
    assert_eq!(bytes(&killed), bytes(&whole));
    // It was killed on the way, not before or after.
    assert!(
        kills >= 3 && parts.iter().any(|&there| there > 0 && there < 40),
        "{kills} {parts:?} {written:?}"
    );
}
