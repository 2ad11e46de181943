"""Calls end soon after Ctrl-C, and members are run in processes that were forked, too."""

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pytest
from dalembert_scenes import HenonHeiles, Ring

STAR = "HenonHeiles()"
AT = "q=[0.1, 0.0], v=[0.3, 0.1]"
MEMBERS = "q=np.full((3, 2), 0.1), v=[0.3, 0.1]"
BOX = "low=[-1, -1], high=[1, 1], reach=[0.1, 0.1]"
GENERATORS = "{str(k): (np.eye(2), [k, 1.0]) for k in range(200)}"
PLANE = "events=[Plane([1.0, 0.0])]"
FOLDER = "tempfile.mkdtemp()"

# As long as a day, by the machine of today.
FOR_EVER = 10**12

LONG = {
    "run": f"{STAR}.run(h=0.1, steps={FOR_EVER}, every={FOR_EVER}, {AT})",
    "run to a tolerance": f"{STAR}.run(tolerance=1e-11, until=1e6, every={FOR_EVER}, {AT})",
    "run to a tolerance, with events": f"{STAR}.run(tolerance=1e-11, until=1e6, every={FOR_EVER}, {PLANE}, {AT})",
    # The choice alone takes half a second.
    "choice for a tolerance": f"Ring(0.0).run(tolerance=1e-5, until=1e7, every={FOR_EVER}, q=[0.0, 1.0], v=[0.1, 0.0])",
    "ledger": f"{STAR}.energy_ledger(h=0.1, steps={FOR_EVER}, {AT})",
    "symmetries": f"{STAR}.symmetries(h=0.1, {BOX}, samples=2 * 10**6, generators={GENERATORS})",
    "members": f"{STAR}.ensemble(h=0.1, steps={FOR_EVER}, {MEMBERS})",
    "members by Gauss": f"{STAR}.ensemble(h=0.1, steps={FOR_EVER}, rule='gauss_4', {MEMBERS})",
    "members to a tolerance": f"{STAR}.ensemble(tolerance=1e-11, until=1e6, {MEMBERS})",
    "members with events": f"{STAR}.ensemble(h=0.1, steps={FOR_EVER}, {PLANE}, {MEMBERS})",
    "members with events, in parts": f"{STAR}.ensemble(h=0.1, steps={FOR_EVER}, folder={FOLDER}, {PLANE}, {MEMBERS})",
    "members to a tolerance, with events": f"{STAR}.ensemble(tolerance=1e-11, until=1e6, {PLANE}, {MEMBERS})",
}


PROGRAM = (
    "import signal, tempfile\n"
    "import numpy as np\n"
    "from dalembert_scenes import HenonHeiles, Plane, Ring\n"
    # A shell starts what runs in the background with Ctrl-C switched off.
    "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    "print('begun', flush=True)\n"
    "try:\n"
    "    {}\n"
    "except KeyboardInterrupt:\n"
    "    print('interrupted', flush=True)\n"
)


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_ends_every_call():
    for name, call in LONG.items():
        with subprocess.Popen([sys.executable, "-c", PROGRAM.format(call)], stdout=subprocess.PIPE, text=True) as run:
            too_long = threading.Timer(20, run.kill)
            too_long.start()
            assert run.stdout.readline() == "begun\n", name
            time.sleep(0.1)
            # Control: it has not ended by itself.
            assert run.poll() is None, name
            sent = time.perf_counter()
            run.send_signal(signal.SIGINT)
            assert run.stdout.readline() == "interrupted\n", name
            assert time.perf_counter() - sent < 1.0, name
            assert run.wait(10) == 0, name
            too_long.cancel()


def ends(seed):
    q = np.random.default_rng(seed).uniform(-0.1, 0.1, (300, 2))
    return HenonHeiles().ensemble(h=0.1, steps=50, q=q, v=[0.0, 0.1]).q


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="there is no fork")
def test_members_are_run_in_a_process_that_was_forked():
    """The threads of an ensemble are not there in a process forked after it."""
    here = [ends(seed) for seed in range(4)]
    with warnings.catch_warnings():
        # Python 3.12 and later warn of every fork of a process with threads.
        warnings.simplefilter("ignore", DeprecationWarning)
        with multiprocessing.get_context("fork").Pool(2) as pool:
            there = pool.map_async(ends, range(4)).get(timeout=20)
    assert all(np.array_equal(a, b) for a, b in zip(here, there, strict=True))
    # The process that was forked from has its threads as before.
    assert np.array_equal(ends(0), here[0])


@pytest.mark.skipif(not os.path.isdir("/proc/self/task"), reason="threads are counted by Linux")
def test_no_more_threads_are_started_than_there_are_cores():
    most = [0]

    def count(done, of):
        most[0] = max(most[0], len(os.listdir("/proc/self/task")))

    q = np.random.default_rng(1).uniform(-0.1, 0.1, (5000, 2))
    at = {"h": 0.1, "steps": 200, "q": q, "v": [0.0, 0.1], "rule": "gauss_4"}
    before = len(os.listdir("/proc/self/task"))
    many = HenonHeiles().ensemble(threads=10**6, progress=count, **at)
    assert before < most[0] <= before + os.cpu_count() + 2
    assert np.array_equal(many.q, HenonHeiles().ensemble(threads=1, **at).q)
    with pytest.raises(ValueError, match="threads: expected a whole number from 1 .*, got 0"):
        Ring(0.0).ensemble(threads=0, **at | {"rule": None})
