//! Full disks, paths that cannot be written, runs that are killed: nothing computed is lost, and no file is
//! broken.

mod at_random;
mod edited;

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;
use std::{env, fs, process, thread};

use dalembert::nalgebra::vector;
use dalembert::{Midpoint, State, rayleigh_system};
use dalembert_examples::results;
use dalembert_examples::saved_run::{SavedRun, Schedule};

#[rayleigh_system]
fn double_pendulum(q: [f64; 2], v: [f64; 2]) -> f64 {
    let kinetic = v[0] * v[0] + 0.5 * v[1] * v[1] + v[0] * v[1] * (q[0] - q[1]).cos();
    kinetic + 2.0 * q[0].cos() + q[1].cos()
}

/// An empty folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = env::temp_dir().join(format!("dalembert-faults-{}-{name}", process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// In which folder a child of this program is to do something.
const CHILD: &str = "DALEMBERT_FAULTS_FOLDER";

/// This program again, running one of the `child_…` functions in `folder`; a shell runs `before` first.
fn child(name: &str, folder: &Path, before: &str) -> Command {
    let mut command = Command::new("sh");
    command
        .args(["-c", &format!("{before} exec \"$0\" \"$@\""), env::current_exe().unwrap().to_str().unwrap()])
        .args(["--exact", name, "--nocapture", "--test-threads=1"])
        .env(CHILD, folder)
        .env("TMPDIR", folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

fn text(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned()).concat()
}

const SCHEDULE: Schedule =
    Schedule { row: 50, rows_to_checkpoint: 10, end: if cfg!(debug_assertions) { 80_000 } else { 200_000 } };

const START: State<f64, 2> = State { q: vector![2.5, 1.5], p: vector![0.1, -0.2] };

fn run(folder: &Path, end: u64) -> anyhow::Result<State<f64, 2>> {
    run_from(START, folder, end)
}

fn run_from(start: State<f64, 2>, folder: &Path, end: u64) -> anyhow::Result<State<f64, 2>> {
    let row = |time: f64, state: &State<f64, 2>| format!("{time},{},{}", state.q[0], state.q[1]);
    SavedRun::in_folder(folder).run(
        (&DoublePendulum {}, Midpoint),
        (0.05, start),
        Schedule { end, ..SCHEDULE },
        row,
    )
}

#[test]
fn child_that_runs() {
    if let Some(folder) = env::var_os(CHILD) {
        run(Path::new(&folder), SCHEDULE.end).unwrap();
    }
}

/// Every row is whole, and the time of the k-th is that of k rows.
fn readable_rows(folder: &Path) -> usize {
    let text = fs::read_to_string(folder.join("rows.csv")).unwrap_or_default();
    assert!(text.is_empty() || text.ends_with('\n'), "a torn row: {:?}", text.lines().last());
    for (count, line) in text.lines().enumerate() {
        let numbers: Vec<f64> = line.split(',').map(|entry| entry.parse().unwrap()).collect();
        assert_eq!(numbers.len(), 3, "{line}");
        assert!((numbers[0] - 0.05 * (SCHEDULE.row * (count as u64 + 1)) as f64).abs() < 1e-9, "{line}");
    }
    text.lines().count()
}

/// SIGKILL, many times, at moments that differ from run to run; at the end all bits are those of the run that
/// was left alone.
#[test]
#[cfg(unix)]
fn a_killed_run_goes_on_bit_by_bit() {
    let (alone, killed) = (folder("alone"), folder("killed"));
    let end = run(&alone, SCHEDULE.end).unwrap();
    // From the clock: no two runs of this test kill at the same moments.
    let mut wait = u64::from(process::id()) ^ 0x9e37;
    let mut kills = 0;
    loop {
        let mut child: Child = child("child_that_runs", &killed, "").spawn().unwrap();
        wait = wait.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let limit = Duration::from_micros(5_000 + (wait >> 33) % (20_000 * (kills + 1)));
        thread::sleep(limit);
        if let Some(status) = child.try_wait().unwrap() {
            assert!(status.success(), "{}", text(&child.wait_with_output().unwrap()));
            break;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
        readable_rows(&killed);
        if let Ok(checkpoint) = fs::read_to_string(killed.join("checkpoint.json")) {
            assert!(checkpoint.starts_with('{') && checkpoint.ends_with('}'), "{checkpoint}");
        }
    }
    println!("killed {kills} times");
    assert!(kills > 0, "the run ended before it was killed: lengthen it");
    assert_eq!(readable_rows(&killed) as u64, SCHEDULE.end / SCHEDULE.row);
    for file in ["rows.csv", "checkpoint.json"] {
        assert!(fs::read(alone.join(file)).unwrap() == fs::read(killed.join(file)).unwrap(), "{file}");
    }
    // The control: a run from a start that differs in the last place ends in other bits.
    let (other, start) = (folder("other"), State { q: [2.5_f64.next_up(), 1.5].into(), ..START });
    assert!(run_from(start, &other, SCHEDULE.end).unwrap() != end);
    for folder in [alone, killed, other] {
        fs::remove_dir_all(folder).unwrap();
    }
}

#[test]
fn a_broken_or_foreign_checkpoint_is_refused() {
    let folder = folder("foreign");
    run(&folder, 1_000).unwrap();
    let path = folder.join("checkpoint.json");
    let saved = fs::read_to_string(&path).unwrap();
    fs::write(&path, &saved[..saved.len() / 2]).unwrap();
    let error = format!("{:#}", run(&folder, 2_000).unwrap_err());
    let broken = "is no checkpoint of this run, or broken; remove the folder";
    assert!(error.contains(broken), "{error}");
    fs::write(&path, saved.replace("\"step_size\":0.05", "\"step_size\":0.06")).unwrap();
    let error = format!("{:#}", run(&folder, 2_000).unwrap_err());
    assert!(error.contains(broken), "{error}");
    fs::write(&path, &saved).unwrap();
    let start = State { p: vector![0.1, -0.3], ..START };
    let error = format!("{:#}", run_from(start, &folder, 2_000).unwrap_err());
    assert!(error.contains("holds another run") && error.contains("p = [0.1, -0.3]"), "{error}");
    // A run that went further than asked for.
    let error = format!("{:#}", run(&folder, 500).unwrap_err());
    assert!(error.contains("up to step 1000, beyond its end at 500"), "{error}");
    // The control.
    run(&folder, 2_000).unwrap();
    fs::remove_dir_all(folder).unwrap();
}

/// Files may be no longer than 64 blocks of 512 or 1024 bytes: what the kernel says then is what it says of a
/// full disk.
const LITTLE_ROOM: &str = "trap '' XFSZ; ulimit -f 64 || exit 99;";

/// A disk that fills up in the middle: a clear error, whole rows but perhaps for the last, and the run goes
/// on when there is room.
#[test]
#[cfg(unix)]
fn a_disk_that_fills_up() {
    let (alone, full) = (folder("roomy"), folder("full"));
    run(&alone, SCHEDULE.end).unwrap();
    let output = child("child_that_runs", &full, LITTLE_ROOM).output().unwrap();
    if output.status.code() == Some(99) {
        println!("skipped: this shell sets no limit to the length of files");
        return;
    }
    let said = text(&output);
    assert!(!output.status.success(), "there was room enough: {said}");
    assert!(said.contains("rows.csv: make room; the run is kept up to step "), "{said}");
    // With room again, it ends as the other did.
    run(&full, SCHEDULE.end).unwrap();
    for file in ["rows.csv", "checkpoint.json"] {
        assert!(fs::read(alone.join(file)).unwrap() == fs::read(full.join(file)).unwrap(), "{file}");
    }
    for folder in [alone, full] {
        fs::remove_dir_all(folder).unwrap();
    }
}

/// 200 kB of text, too long for the room there is.
fn long_text() -> String {
    (0..20_000).map(|i| format!("{i:9}\n")).collect()
}

#[test]
fn child_that_saves() {
    if let Some(folder) = env::var_os(CHILD)
        && let Err(error) = results::save(&Path::new(&folder).join("result.csv"), &long_text())
    {
        eprintln!("{error:#}");
        process::exit(3);
    }
}

/// No room for the file: the old one stands as it was, no half file lies about, and the text goes to standard
/// output.
#[test]
#[cfg(unix)]
fn no_room_for_a_result() {
    let folder = folder("result");
    fs::write(folder.join("result.csv"), "from before").unwrap();
    let output = child("child_that_saves", &folder, LITTLE_ROOM).output().unwrap();
    if output.status.code() == Some(99) {
        println!("skipped: this shell sets no limit to the length of files");
        return;
    }
    let said = text(&output);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(
        said.contains("result.csv; nothing is lost: it stands above, on standard output"),
        "{}",
        &said[said.len() - 400..]
    );
    assert!(String::from_utf8_lossy(&output.stdout).contains(&long_text()));
    assert_eq!(fs::read_to_string(folder.join("result.csv")).unwrap(), "from before");
    assert_eq!(files(&folder), ["result.csv"]);
    // The control: with room it is written.
    assert!(child("child_that_saves", &folder, "").status().unwrap().success());
    assert_eq!(fs::read_to_string(folder.join("result.csv")).unwrap(), long_text());
    assert_eq!(files(&folder), ["result.csv"]);
    fs::remove_dir_all(folder).unwrap();
}

/// A path below a file, and a full device: the error names it, says why, and where the text is.
#[test]
fn paths_that_cannot_be_written() {
    let folder = folder("paths");
    fs::write(folder.join("file"), "a file").unwrap();
    let mut paths = vec![folder.join("file").join("result.csv"), folder.clone()];
    if Path::new("/dev/full").exists() {
        paths.push("/dev/full".into());
    } else {
        println!("/dev/full does not exist here and is left out");
    }
    for path in paths {
        let error = format!("{:#}", results::save(&path, "computed").unwrap_err());
        assert!(error.starts_with(&format!("cannot write {}", path.display())), "{error}");
        let (_, kept) = error.split_once("nothing is lost: it is in ").expect(&error);
        let (kept, why) = kept.split_once(". What helps: ").expect(&error);
        assert_eq!(why.starts_with("make room"), path.starts_with("/dev"), "{error}");
        assert_eq!(fs::read_to_string(kept).unwrap(), "computed");
        fs::remove_file(kept).unwrap();
    }
    assert_eq!(fs::read_to_string(folder.join("file")).unwrap(), "a file");
    fs::remove_dir_all(folder).unwrap();
}

/// Devices and pipes are written to, not replaced; of a link, what it points to.
#[test]
#[cfg(unix)]
fn what_is_no_file_stays_what_it_is() {
    results::save(Path::new("/dev/null"), "computed").unwrap();
    use std::os::unix::fs::FileTypeExt;
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    let folder = folder("link");
    fs::write(folder.join("there"), "before").unwrap();
    std::os::unix::fs::symlink(folder.join("there"), folder.join("link")).unwrap();
    results::save(&folder.join("link"), "after").unwrap();
    assert!(fs::symlink_metadata(folder.join("link")).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(folder.join("there")).unwrap(), "after");
    fs::remove_dir_all(folder).unwrap();
}
