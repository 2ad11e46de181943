//! `slurm`: the Slurm array of `cluster.sbatch` on one machine, with a task that is requeued while it runs
//! and one that is killed. In the end every part is there once, with the bits of one process that nothing
//! happened to.

mod requeued;

use std::path::Path;
use std::time::Duration;
use std::{fs, thread};

use anyhow::{Context, Result, ensure};
use xshell::{Shell, cmd};

use crate::one_machine::OneMachine;
use crate::project;

const PARTS: usize = 16;

/// Tries of a task that is requeued, unless said.
const TRIES: u64 = 3;

/// Builds the program, starts a Slurm and submits the array twice; then a task is requeued so many times
/// beside one that lives. Needs root.
pub fn run(requeued: Option<&str>) -> Result<()> {
    let tries = requeued.map_or(Ok(TRIES), str::parse).context("how often a task is requeued")?;
    let shell = project::shell()?;
    cmd!(shell, "cargo build --release -p dalembert-ensemble --features parquet --example cluster").run()?;
    let program = project::target().join("release/examples/cluster");
    shell.set_var("PROGRAM", &program);
    let machine = OneMachine::start(&shell)?;
    let home = machine.home();
    let folder = home.join("parts");

    let job = submit(&shell, home, "task", &folder)?;
    // While the first tasks run: one is requeued, as after the loss of a node; another killed outright and
    // then submitted again.
    wait_until(200, 100, || Ok(!listed(&shell, &["-t", "R"], &job)?.is_empty()))?;
    thread::sleep(Duration::from_secs(2));
    cmd!(shell, "scontrol requeue {job}_0").run()?;
    // Slurm holds a requeued task back for two minutes.
    cmd!(shell, "scontrol update JobId={job}_0 StartTime=now").run()?;
    cmd!(shell, "scancel --signal=KILL {job}_1").ignore_status().ignore_stderr().run()?;
    thread::sleep(Duration::from_secs(1));
    cmd!(shell, "scancel {job}_1").ignore_status().ignore_stderr().run()?;
    wait_for_the_end(&shell, &job)?;
    println!("after the first submission: {} of {PARTS} parts", parts(&folder)?);

    let job = submit(&shell, home, "again", &folder)?;
    wait_for_the_end(&shell, &job)?;
    for task in 0..4 {
        let log = fs::read_to_string(home.join(format!("again-{task}.log"))).context("a task's log")?;
        println!("{}", log.lines().last().unwrap_or_default());
    }

    let alone = home.join("alone");
    cmd!(shell, "{program} --members 0..262144 {alone}").ignore_stderr().run()?;
    ensure!(parts(&folder)? == PARTS, "{} of {PARTS} parts", parts(&folder)?);
    cmd!(shell, "diff -r {folder} {alone}").run()?;
    println!("every part once, and the bits of one process: {PARTS} of {PARTS} parts");
    requeued::run(&shell, home, &program, tries)
}

/// Submits the array, and returns its number.
fn submit(shell: &Shell, home: &Path, logs: &str, folder: &Path) -> Result<String> {
    let log = home.join(format!("{logs}-%a.log"));
    let script = "ensemble/examples/cluster.sbatch";
    Ok(cmd!(shell, "sbatch --parsable --array=0-3 --output={log} {script} {folder}").read()?)
}

/// Waits until no task of the job is left, for five minutes at most.
fn wait_for_the_end(shell: &Shell, job: &str) -> Result<()> {
    wait_until(600, 500, || Ok(listed(shell, &[], job)?.is_empty()))
}

/// The tasks of the job that Slurm lists.
fn listed(shell: &Shell, states: &[&str], job: &str) -> Result<String> {
    // A job that is not there yet, or has been over for a while, is an error to squeue.
    let list = cmd!(shell, "squeue -h {states...} -j {job}");
    Ok(list.quiet().ignore_stderr().ignore_status().read()?)
}

fn wait_until(tries: usize, milliseconds: u64, is_so: impl Fn() -> Result<bool>) -> Result<()> {
    for _ in 0..tries {
        if is_so()? {
            break;
        }
        thread::sleep(Duration::from_millis(milliseconds));
    }
    Ok(())
}

/// The number of parts in a folder.
pub fn parts(folder: &Path) -> Result<usize> {
    let names = fs::read_dir(folder).context("the folder of parts")?.flatten().map(|entry| entry.file_name());
    Ok(names.filter(|name| name.to_string_lossy().starts_with("members-")).count())
}
