//! The study of `docs/clusters.md` by three kinds of cluster, all on this machine: workers of its own,
//! workers started over SSH, and workers that are jobs of Slurm; and as a Slurm array without Dask. Their
//! files have to be the same, byte by byte.

use std::fs;

use anyhow::{Context, Result, ensure};
use xshell::{Shell, cmd};

use crate::one_machine::OneMachine;
use crate::{project, slurm, tools};

/// Runs all three. Needs root, and a `python` with dalembert_scenes, dask, distributed, asyncssh and
/// dask-jobqueue.
pub fn run(shell: &Shell) -> Result<()> {
    let shell = shell.clone();
    shell.change_dir(project::root());
    tools::require(&shell, &[("sshd", "openssh-server")])?;
    let machine = OneMachine::start(&shell)?;
    let home = machine.home();
    shell.set_var("home", home);
    serve_ssh(&shell, &machine)?;
    for cluster in ["here", "ssh", "slurm"] {
        let folder = home.join(cluster);
        let study =
            cmd!(shell, "timeout 60 python bindings/python/cluster/clusters.py {cluster} {folder} 200000");
        // SSHCluster reads the addresses of what it starts from their logs.
        let study = study.env_remove("DASK_LOGGING__DISTRIBUTED").ignore_status().output()?;
        print!("{}", String::from_utf8_lossy(&study.stdout));
        ensure!(study.status.success(), "by {cluster}: {}", String::from_utf8_lossy(&study.stderr));
    }
    let (array, log) = (home.join("array"), home.join("array-%a.log"));
    let script = "bindings/python/cluster/array.sbatch";
    let array = cmd!(shell, "timeout 120 sbatch --wait --array=0-3 --output={log} {script} {array} 200000");
    array.quiet().ignore_stdout().run()?;
    let here = home.join("here");
    for other in ["ssh", "slurm", "array"].map(|other| home.join(other)) {
        cmd!(shell, "diff -r {here} {other}").run()?;
    }
    let parts = slurm::parts(&here)?;
    println!("by workers here, over SSH, by Slurm and by its array: {parts} parts, the same bytes");
    Ok(())
}

/// Starts a server of SSH beside any that there is: another port, keys of its own, and one user's key that it
/// lets in. It is stopped with the Slurm.
fn serve_ssh(shell: &Shell, machine: &OneMachine) -> Result<()> {
    let home = machine.home();
    let (server, user, port) = (home.join("server"), home.join("user"), "36819");
    for key in [&server, &user] {
        cmd!(shell, "ssh-keygen -q -t ed25519 -N").args([""]).arg("-f").arg(key).run()?;
    }
    fs::create_dir_all("/run/sshd")?;
    let sshd = tools::path("sshd").context("sshd")?;
    let (keys, pid) = (format!("AuthorizedKeysFile={}.pub", user.display()), home.join("sshd.pid"));
    let pid = format!("PidFile={}", pid.display());
    let options = [&keys, &pid, "StrictModes=no", "ListenAddress=127.0.0.1"].into_iter();
    let options = options.flat_map(|option| ["-o", option]);
    cmd!(shell, "{sshd} -f /dev/null -p {port} -h {server}").args(options).run()?;
    shell.set_var("SSH_PORT", port);
    shell.set_var("SSH_KEY", user);
    Ok(())
}
