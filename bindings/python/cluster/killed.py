"""What Dask costs, and what is lost when its workers die: nothing.

    python killed.py [MEMBERS]

The study of henon_heiles.py by two processes, by two workers of Dask, and by two workers one of which is killed three times on the way. All files have to be
the same, byte by byte. Prints the rows of docs/clusters.md.
"""

import multiprocessing
import os
import random
import signal
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from dask.distributed import Client
from henon_heiles import MEMBERS_PER_PART, part, parts, study


def files(folder):
    """All files: those of the parts, and one of what they have in common."""
    return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def alone(pool, members, folder):
    """Without Dask: two processes, each of which takes the next part."""
    list(pool.map(part, *zip(*parts(members)), [str(folder)] * len(parts(members))))


def timed(work, *arguments):
    begin = time.perf_counter()
    work(*arguments)
    return time.perf_counter() - begin


def main():
    members = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    processes = ProcessPoolExecutor(2, multiprocessing.get_context("spawn"))
    with (
        tempfile.TemporaryDirectory() as root,
        processes as pool,
        Client(n_workers=2, threads_per_worker=1) as client,
    ):
        folders = [str(Path(root, name)) for name in ("alone", "dask", "killed")]
        # Workers and processes have imported what they need before the clock starts.
        study(client, 4 * MEMBERS_PER_PART, Path(root, "first"))
        alone(pool, 4 * MEMBERS_PER_PART, Path(root, "second"))
        without = timed(alone, pool, members, folders[0])
        by_dask = timed(study, client, members, folders[1])

        chance, of_all = random.Random(7), len(parts(members))
        moments = sorted(chance.sample(range(1, of_all), 3))
        killed = []

        def kill(done, _):
            if moments and done >= moments[0]:
                moments.pop(0)
                # One that was killed just before may not be missed yet.
                while not (living := sorted(client.run(os.getpid, on_error="ignore").values())):
                    time.sleep(0.1)
                worker = chance.choice(living)
                os.kill(worker, signal.SIGKILL)
                killed.append(done)

        with_kills = timed(study, client, members, folders[2], kill)
        expected = files(folders[0])
        assert len(expected) == of_all + 1 and len(killed) == 3
        assert files(folders[1]) == expected and files(folders[2]) == expected
        # A control: files of another study are not the same.
        study(client, MEMBERS_PER_PART - 1, Path(root, "other"))
        assert not files(Path(root, "other")).items() <= expected.items()
    print(f"{members} members in {of_all} parts on two cores, the same bytes each time")
    print(f"two processes    {without:6.2f} s")
    print(f"two workers      {by_dask:6.2f} s, {100 * (by_dask / without - 1):+.1f} %")
    print(f"killed 3 times   {with_kills:6.2f} s, after {', '.join(map(str, killed))} parts")


if __name__ == "__main__":
    main()
