"""The study of henon_heiles.py by the clusters of docs/clusters.md, each on this machine: what `run` beside this compares.

    python clusters.py here|ssh|slurm FOLDER MEMBERS
"""

import os
import sys

from dask.distributed import Client, LocalCluster, SSHCluster
from henon_heiles import study


def here():
    return LocalCluster(n_workers=2, threads_per_worker=1)


def ssh():
    """A scheduler and two workers, each started through a server of SSH at a port of its own."""
    by_key = {"port": int(os.environ["SSH_PORT"]), "client_keys": [os.environ["SSH_KEY"]], "known_hosts": None}
    options = {"nthreads": 1, "n_workers": 1}
    return SSHCluster(["127.0.0.1"] * 3, connect_options=by_key, worker_options=options, remote_python=sys.executable)


def slurm():
    """Two jobs of one worker each. `--mem=0`: the Slurm of the test does not count memory."""
    from dask_jobqueue import SLURMCluster

    cluster = SLURMCluster(
        cores=1, processes=1, memory="1GB", walltime="00:10:00", log_directory=os.environ["home"], job_extra_directives=["--mem=0"]
    )
    cluster.scale(jobs=2)
    return cluster


def main():
    kind, folder, members = sys.argv[1:]
    with {"here": here, "ssh": ssh, "slurm": slurm}[kind]() as cluster, Client(cluster) as client:
        client.wait_for_workers(2)
        # Workers elsewhere have Python's packages, but not the study beside this file.
        client.upload_file(os.path.join(os.path.dirname(os.path.abspath(__file__)), "henon_heiles.py"))
        paths = study(client, int(members), folder)
    print(f"{kind}: {len(paths)} parts")


if __name__ == "__main__":
    main()
