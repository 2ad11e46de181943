//! A task that Slurm requeues while the one before lives on elsewhere, as on a node that was cut off.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use std::{fs, thread};

use anyhow::{Context, Result, ensure};
use xshell::{Shell, cmd};

use super::wait_until;

/// Members of the study: sixteen parts, some seconds by one thread.
const MEMBERS: &str = "0..262144";

/// Tries it so many times: the task runs under Slurm, the same command lives beside, and the task is requeued
/// at some moment. Both have to end well, with the files of a call that nothing happened to. A task that
/// Slurm does not launch again ("already killed, do not launch batch job") is no try.
pub fn run(shell: &Shell, home: &Path, program: &Path, tries: u64) -> Result<()> {
    let whole = home.join("whole");
    cmd!(shell, "{program} --members {MEMBERS} {whole}").quiet().ignore_stderr().ignore_stdout().run()?;
    let [mut left, mut beside, mut killed, mut dropped] = [0, 0, 0, 0];
    for number in 0..tries {
        let folder = home.join(format!("requeued-{number}"));
        let said = home.join(format!("said-{number}"));
        let task = format!(
            "echo begun >>{said}; RAYON_NUM_THREADS=1 {program} --members {MEMBERS} {folder} 2>/dev/null; echo $? >>{said}",
            said = said.display(),
            program = program.display(),
            folder = folder.display(),
        );
        let job =
            cmd!(shell, "sbatch --parsable --requeue --output=/dev/null --wrap {task}").quiet().read()?;
        wait_until(500, 20, || Ok(said.exists()))?;
        let mut living = Command::new(program);
        living.args(["--members", MEMBERS]).arg(&folder).env("RAYON_NUM_THREADS", "1");
        let mut living = living.stdout(Stdio::null()).stderr(Stdio::null()).spawn().context("the program")?;
        // Not always the same moment of either.
        thread::sleep(Duration::from_millis(37 * number % 400));
        // It waits for the task to begin again, however fast it would be done.
        let pid = living.id().to_string();
        cmd!(shell, "kill -STOP {pid}").quiet().run()?;
        cmd!(shell, "scontrol requeue {job}").quiet().ignore_status().ignore_stderr().run()?;
        // A node launches no task that it has killed a moment ago; and Slurm holds it back for two minutes.
        thread::sleep(Duration::from_millis(1200));
        let read = || fs::read_to_string(&said).unwrap_or_default();
        wait_until(600, 50, || {
            let now = cmd!(shell, "scontrol update JobId={job} StartTime=now");
            now.quiet().ignore_status().ignore_stderr().run()?;
            Ok(read().matches("begun").count() == 2)
        })?;
        let is_begun = read().matches("begun").count() == 2;
        dropped += u64::from(!is_begun);
        beside += u64::from(is_begun && living.try_wait()?.is_none());
        cmd!(shell, "kill -CONT {pid}").quiet().run()?;
        let is_well = living.wait()?.success();
        // Not by what Slurm lists: where it does not answer in time, nothing seems to be left.
        wait_until(2400, 50, || Ok(!is_begun || read().ends_with("begun\n0\n")))?;
        let text = read();
        killed += u64::from(is_begun && !text.starts_with("begun\n0\n"));
        let is_same =
            cmd!(shell, "diff -r {folder} {whole}").quiet().ignore_status().output()?.status.success();
        let is_ended = !is_begun || text.ends_with("begun\n0\n");
        if !(is_well && is_ended && is_same) {
            left += 1;
            eprintln!(
                "requeued {number}: the living one {is_well}, the task said {text:?}, the same files {is_same}"
            );
        }
        fs::remove_dir_all(&folder)?;
    }
    println!(
        "requeued beside a living one: {tries} tries, {left} left; killed {killed}, living then {beside}, not \
         launched again by Slurm {dropped}"
    );
    ensure!(left == 0 && (dropped == tries || killed > 0 && beside > 0), "{left} left of {tries}");
    Ok(())
}
