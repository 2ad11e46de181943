"""What a run does to the interpreter: other threads go on, Ctrl-C ends it, memory does not grow."""

import os
import resource
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from dalembert_scenes import Ring

START = {"q": [0.0, 1.15549918674982], "v": [0.5, 0.0]}
LONG = {"h": 0.2, "steps": 10**12, "every": 10**12, **START}


def test_the_interpreter_goes_on_while_a_run_takes_its_steps():
    """A thread of Python counts beside a run: it gets nowhere where the run holds the interpreter's lock."""
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1

    beside = threading.Thread(target=count)
    beside.start()
    try:
        time.sleep(0.05)
        before = counted[0]
        began = time.perf_counter()
        Ring(k=1e-3).run(h=0.2, steps=1_000_000, every=10**9, **START)
        taken, alone = time.perf_counter() - began, counted[0] - before
    finally:
        done.set()
        beside.join()
    # With the lock held it would get a turn each 50 ms at most, when the run looks for signals.
    assert alone > 10_000 * taken


def test_two_runs_overlap():
    overlap, running = [0], [0]
    lock = threading.Lock()

    def go():
        def progress(done, of):
            with lock:
                overlap[0] = max(overlap[0], running[0])

        with lock:
            running[0] += 1
        Ring(k=1e-3).run(h=0.2, steps=2_000_000, every=10**9, progress=progress, **START)
        with lock:
            running[0] -= 1

    threads = [threading.Thread(target=go) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert overlap[0] == 2


def test_a_field_may_change_while_another_thread_runs():
    ring = Ring(k=1e-3)
    alone = ring.run(h=0.2, steps=300_000, every=10**9, **START)
    changed = threading.Timer(0.02, lambda: setattr(ring, "k", 5.0))
    changed.start()
    beside = ring.run(h=0.2, steps=300_000, every=10**9, **START)
    changed.join()
    assert np.array_equal(alone.q, beside.q) and ring.k == 5.0


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_ends_a_run():
    program = (
        "import signal\n"
        "from dalembert_scenes import Ring\n"
        # A shell starts what runs in the background with Ctrl-C switched off.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "print('begun', flush=True)\n"
        "try:\n"
        f"    Ring(k=1e-3).run(**{LONG!r})\n"
        "except KeyboardInterrupt:\n"
        "    print('interrupted', flush=True)\n"
    )
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as run:
        too_long = threading.Timer(30, run.kill)
        too_long.start()
        assert run.stdout.readline() == "begun\n"
        time.sleep(0.3)
        assert run.poll() is None
        sent = time.perf_counter()
        run.send_signal(signal.SIGINT)
        assert run.stdout.readline() == "interrupted\n"
        assert time.perf_counter() - sent < 5.0
        assert run.wait(10) == 0
        too_long.cancel()


def test_progress_is_told_and_its_exception_ends_the_run():
    told = []
    Ring(k=1e-3).run(h=0.2, steps=1000, progress=lambda done, of: told.append((done, of)), **START)
    assert told[-1] == (1000, 1000)

    class Enough(Exception):
        pass

    def stop(done, of):
        raise Enough

    with pytest.raises(Enough):
        Ring(k=1e-3).run(progress=stop, **LONG)


def test_memory_is_given_back():
    """Thirty runs of 26 MB each: if they leaked, 770 MB would be left."""
    ring = Ring(k=1e-3)
    for _ in range(3):
        ring.run(h=0.2, steps=400_000, rule="blanes_moan_4", **START)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(30):
        ring.run(h=0.2, steps=400_000, rule="blanes_moan_4", **START)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 60_000


def test_arrays_outlive_their_run():
    run = Ring(k=1e-3).run(h=0.2, steps=1000, **START)
    q, copy = run.q, run.q.copy()
    del run
    for _ in range(10):
        Ring(k=1e-3).run(h=0.3, steps=1000, **START)
    assert np.array_equal(q, copy)
