"""A million starts of Hénon and Heiles' potential by the workers of a Dask cluster: one file for each part of the members.

    python henon_heiles.py FOLDER [MEMBERS]      two workers on this machine

A task is a part, and returns the path of its file; the states go to the disk where they are computed, and never through Dask. A part
that is there is not computed again, so that the same command goes on where the last one ended. On other clusters `study` is
the same, the `Client` alone differs: see docs/clusters.md.
"""

import sys

import numpy as np
from dalembert_scenes import HenonHeiles

SEED, MEMBERS_PER_PART = 1, 16_384
STEPS = {"h": 0.25, "steps": 4000, "rule": "blanes_moan_6"}


def part(first, last, folder, threads=1):
    """The file of the members from `first` to before `last`. Their starts are a function of `first` alone: any worker makes the same."""
    q, v = np.random.default_rng([SEED, first]).uniform(-0.3, 0.3, (2, last - first, 2))
    written = HenonHeiles().ensemble(
        q=q, v=v, first=first, folder=folder, members_per_part=MEMBERS_PER_PART, threads=threads, **STEPS
    )
    return written.paths


def parts(members):
    """The first member of each part, and the first behind it."""
    return [(first, min(first + MEMBERS_PER_PART, members)) for first in range(0, members, MEMBERS_PER_PART)]


def study(client, members, folder, progress=None):
    """Computes what is missing; the paths of all parts, in order."""
    from dask.distributed import as_completed

    tasks = client.map(part, *zip(*parts(members)), folder=str(folder), pure=False)
    for done, _ in enumerate(as_completed(tasks), start=1):
        if progress:
            progress(done, len(tasks))
    return [path for paths in client.gather(tasks) for path in paths]


if __name__ == "__main__":
    from dask.distributed import Client

    folder, members = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 1_000_000
    with Client(n_workers=2, threads_per_worker=1) as client:
        print(f"dashboard: {client.dashboard_link}")
        paths = study(client, members, folder, lambda done, of: print(f"\r{done} of {of} parts", end=""))
    print(f"\n{len(paths)} files in {folder}")
