//! The study, folders, and calls in processes of their own.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;
use std::time::Duration;

use dalembert::{Midpoint, State, StepError, rayleigh_system};
use dalembert_ensemble::Ensemble;
use dalembert_ensemble::parts::{PartsError, Written};

#[rayleigh_system]
pub fn pendulum(q: [f64; 1], v: [f64; 1], g: f64, r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + g * q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// A call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Call {
    pub p: f64,
    pub r: f64,
    pub steps: u64,
    pub of_part: u64,
    /// The first of them.
    pub from: u64,
    pub members: u64,
    /// The member whose g and r are so much more, if any is.
    pub odd: Option<(u64, [f64; 2])>,
    /// Whether r is a column.
    pub column: bool,
}

/// Members of a part.
pub const OF_PART: u64 = if cfg!(debug_assertions) { 10 } else { 40 };

/// Six parts, that take some milliseconds.
pub const PLAIN: Call = Call {
    p: 0.5,
    r: 0.0,
    steps: if cfg!(debug_assertions) { 4 } else { 400 },
    of_part: OF_PART,
    from: 0,
    members: 6 * OF_PART,
    odd: None,
    column: true,
};

impl Call {
    pub fn write(&self, folder: &Path) -> Result<Written, PartsError> {
        let Self { p, r, steps, of_part, from, members, odd, column } = *self;
        let member = |number: u64| -> Result<(Pendulum, State<f64, 1>), StepError> {
            let [more_g, more_r] = odd.filter(|(odd, _)| *odd == number).map_or([0.0; 2], |(_, more)| more);
            let start = State { q: [1e-3 * number as f64].into(), p: [p].into() };
            Ok((Pendulum { g: 1.0 + more_g, r: r + more_r }, start))
        };
        let study = Ensemble::new(member).by(Midpoint, 0.1).steps(steps);
        let parts = study.parts(folder).members_per_part(of_part);
        let numbers = from..members;
        if column { parts.column("r", |of| of.r).write(numbers) } else { parts.write(numbers) }
    }

    /// The files that the call writes where nothing happens.
    pub fn files(&self) -> Files {
        let folder = folder();
        self.write(&folder).unwrap();
        files(&folder)
    }

    fn read(text: &str) -> Option<Self> {
        let mut words = text.split_whitespace();
        let (p, r) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
        let mut next = || words.next()?.parse().ok();
        let (steps, of_part, from, members) = (next()?, next()?, next()?, next()?);
        Some(Self { p, r, steps, of_part, from, members, ..PLAIN })
    }
}

impl fmt::Display for Call {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { p, r, steps, of_part, from, members, .. } = self;
        write!(f, "{p} {r} {steps} {of_part} {from} {members}")
    }
}

/// The kind of an error.
pub fn kind(error: &PartsError) -> &'static str {
    match error {
        PartsError::Io { .. } => "Io",
        PartsError::Parquet { .. } => "Parquet",
        PartsError::AnotherStudy { .. } => "AnotherStudy",
        PartsError::Damaged { .. } => "Damaged",
        PartsError::Misplaced { .. } => "Misplaced",
        PartsError::Unequal { .. } => "Unequal",
        PartsError::Gone { .. } => "Gone",
        PartsError::Overlap { .. } => "Overlap",
        _ => "another error",
    }
}

pub type Files = BTreeMap<String, Vec<u8>>;

/// A folder that goes with its trial.
pub struct Folder(PathBuf);

impl Deref for Folder {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl AsRef<Path> for Folder {
    fn as_ref(&self) -> &Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
        let _ = fs::remove_dir(sign(&self.0));
    }
}

/// A folder beside, for which calls in this one wait.
pub fn sign(folder: &Path) -> PathBuf {
    folder.with_extension("go")
}

/// A folder of its own, that is not there yet.
pub fn folder() -> Folder {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let within = std::env::var_os("FAULTS_FOLDER").unwrap_or(env!("CARGO_TARGET_TMPDIR").into());
    let folder = Path::new(&within).join(format!("faults-{}-{count}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    Folder(folder)
}

/// All files, those that are hidden among them.
pub fn files(folder: &Path) -> Files {
    let entry =
        |entry: fs::DirEntry| Some((entry.file_name().into_string().ok()?, fs::read(entry.path()).ok()?));
    fs::read_dir(folder).into_iter().flatten().filter_map(|found| entry(found.ok()?)).collect()
}

/// A folder with these files.
pub fn folder_of(files: &Files) -> Folder {
    let folder = folder();
    fs::create_dir_all(&folder).unwrap();
    files.iter().for_each(|(name, bytes)| fs::write(folder.join(name), bytes).unwrap());
    folder
}

/// For the process: the call, its folder, and the file that it waits for.
const CALL: &str = "FAULTS_CALL";
const FOLDER: &str = "FAULTS_INTO";
const GO: &str = "FAULTS_GO";

/// The exit code of a call that fails is this, and the place of its kind.
const FAILED: i32 = 40;
const KINDS: [&str; 9] =
    ["Io", "Parquet", "AnotherStudy", "Damaged", "Misplaced", "Unequal", "Gone", "Overlap", "another error"];

/// The call that the environment says, if it does.
pub fn be_child() {
    let Some(call) = std::env::var(CALL).ok().and_then(|call| Call::read(&call)) else { return };
    let [folder, go] = [FOLDER, GO].map(|name| PathBuf::from(std::env::var_os(name).unwrap()));
    while !go.exists() {
        thread::sleep(Duration::from_micros(100));
    }
    if let Err(error) = call.write(&folder) {
        let place = KINDS.iter().position(|known| *known == kind(&error)).unwrap();
        std::process::exit(FAILED + place as i32);
    }
}

/// A call in a process of its own, which waits for `go`.
pub fn started(call: &Call, folder: &Path, go: &Path) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "child"])
        .envs([(CALL, call.to_string().as_ref()), (FOLDER, folder.as_os_str()), (GO, go.as_os_str())])
        .env("RAYON_NUM_THREADS", "1")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// How a process has ended: well, by an error, or killed.
pub fn ended(mut child: Child) -> &'static str {
    match child.wait().unwrap().code() {
        Some(0) => "ok",
        Some(code) => {
            usize::try_from(code - FAILED).ok().and_then(|place| KINDS.get(place)).unwrap_or(&"panic")
        }
        None => "killed",
    }
}
