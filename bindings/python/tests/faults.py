"""How often faults of calls are tried, and how many are left: the table of docs/parts.md.

    python bindings/python/tests/faults.py [TRIES]

A trial is left where a call does not end, or says that all is well and it is not. Every trial has a control, in which what is looked for is there.
"""

import errno
import multiprocessing
import os
import pickle
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from dalembert_scenes import HenonHeiles, Plane, Ring
from dalembert_trials import Cut
from dalembert_trials import Plane as PlaneOfCut
from test_given import equal
from test_stop import LONG, PROGRAM, ends

AT = {"h": 0.1, "steps": 20}


def interrupted(chance, trial):
    """Ctrl-C at some moment of a call that takes as long as a day. Control: it has not ended by itself."""
    kind = list(LONG)[trial % len(LONG)]
    command = [sys.executable, "-c", PROGRAM.format(LONG[kind])]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as run:
        too_long = threading.Timer(20, run.kill)
        too_long.start()
        begun = run.stdout.readline() == "begun\n"
        time.sleep(chance.uniform(0.0, 0.5))
        lives = run.poll() is None
        sent = time.perf_counter()
        run.send_signal(signal.SIGINT)
        is_well = run.stdout.readline() == "interrupted\n" and time.perf_counter() - sent < 1.0
        is_well = run.wait(20) == 0 and is_well
        too_long.cancel()
    return begun and is_well, lives


def forked(chance, _):
    """An ensemble in a process that was forked after one. Control: a thread of another pool is not there."""
    seed = chance.randrange(10**6)
    here = ends(seed)
    with ThreadPoolExecutor(1) as threads, multiprocessing.get_context("fork").Pool(1) as pool:
        threads.submit(int).result()
        is_well = np.array_equal(pool.apply_async(ends, [seed]).get(20), here)
        fork = multiprocessing.get_context("fork").Process(target=lambda: threads.submit(int).result())
        fork.start()
        fork.join(0.1)
        waits = fork.is_alive()
        fork.kill()
        fork.join()
    return is_well, waits


def panicking(chance, _):
    """Members that panic, in lanes, one by one, with events and as parts. Control: without them none fails."""
    members = chance.randrange(2, 60)
    wrong = sorted(chance.sample(range(members), chance.randrange(1, members)))
    pieces = np.array([chance.randrange(1, 5) for _ in range(members)])
    q = np.array([[chance.uniform(-1.0, 1.0)] for _ in range(members)])
    # A velocity is asked of L before there is a step, a momentum is not.
    at = {"q": q, chance.choice("vp"): [0.0], "rule": chance.choice(Cut.RULES), "every": chance.choice([None, 7])} | AT
    events = [PlaneOfCut([1.0])] if chance.random() < 0.3 else None
    sound = Cut(1).ensemble(fields={"pieces": pieces}, events=events, **at)
    broken = pieces.copy()
    broken[wrong] = 0
    found = Cut(1).ensemble(fields={"pieces": broken}, events=events, **at)
    others = np.setdiff1d(np.arange(members), wrong)
    is_well = sorted(found.failures) == wrong and all(isinstance(e, RuntimeError) for e in found.failures.values())
    is_well &= np.array_equal(found.q[others], sound.q[others])
    with tempfile.TemporaryDirectory() as folder:
        parts = Cut(1).ensemble(fields={"pieces": broken}, folder=folder, members_per_part=16, **at)
        is_well &= parts.failed == len(wrong)
    return is_well, not sound.failures


def many_threads(chance, _):
    """Threads far beyond the cores. Control: some are started."""
    most, before = [0], len(os.listdir("/proc/self/task"))

    def count(done, of):
        most[0] = max(most[0], len(os.listdir("/proc/self/task")))

    q = np.random.default_rng(chance.randrange(10**6)).uniform(-0.1, 0.1, (1000, 2))
    HenonHeiles().ensemble(
        threads=chance.randrange(10**3, 10**6), progress=count, q=q, v=[0, 0.1], rule="gauss_4", h=0.1, steps=300
    )
    return most[0] <= before + os.cpu_count() + 2, most[0] > before


def pickled(chance, trial):
    """Results of all classes. Control: another is not equal."""
    star, at = HenonHeiles(), {"q": [chance.uniform(-0.1, 0.1), 0.0], "v": [0.3, chance.uniform(-0.1, 0.1)]}
    with tempfile.TemporaryDirectory() as folder:
        results = [
            lambda: star.run(**AT, **at, events=[Plane([1.0, 0.0])]),
            lambda: star.ensemble(**AT, q=[at["q"]], v=at["v"], every=3),
            lambda: star.linearization(h=0.1, **at),
            lambda: star.energy_ledger(**AT, **at),
            lambda: star.symmetries(h=0.1, low=at["q"], high=[1, 1], reach=[0.1, 0.1])[0],
            lambda: star.ensemble(**AT, q=[at["q"]], v=at["v"], folder=folder),
        ]
        result = results[trial % len(results)]()
        other = results[(trial + 1) % len(results)]()
    again = pickle.loads(pickle.dumps(result))
    return equal(result, again) and repr(result) == repr(again), not equal(other, again)


def without_folder(chance, _):
    """A folder that cannot be. Control: one that can."""
    with tempfile.TemporaryDirectory() as root:
        file = Path(root, f"file-{chance.randrange(100)}")
        file.write_text("")
        at = {"q": [[0.0, 1.0]], "v": [chance.random(), 0.0]} | AT
        try:
            Ring(0.0).ensemble(folder=file / "folder", **at)
            is_well = False
        except NotADirectoryError as error:
            is_well = error.errno == errno.ENOTDIR and error.filename == str(file / "folder")
        return is_well, Ring(0.0).ensemble(folder=Path(root, "folder"), **at).written == 1


def refused(call):
    try:
        call()
    except ValueError as error:
        return str(error)
    return ""


def masked(chance, _):
    """A masked entry anywhere, in arrays and lists of them. Control: without the mask."""
    members = chance.randrange(1, 9)
    rows = np.ma.array(np.random.default_rng(chance.randrange(10**6)).uniform(0.5, 1.0, (members, 2)))
    given = chance.choice([np.ma.array, list, tuple, lambda rows: [[*row] for row in rows]])
    clean = refused(lambda: Ring(0.0).ensemble(q=given(rows), v=[0, 0], **AT))
    rows[chance.randrange(members), chance.randrange(2)] = np.ma.masked
    return "entries are masked" in refused(lambda: Ring(0.0).ensemble(q=given(rows), v=[0, 0], **AT)), not clean


def rounded(chance, _):
    """A whole number that no float64 is. Control: one beside it, that is one."""
    whole = 2 * chance.randrange(2**53, 2**61) + 1
    exact = whole - 1 & ~0x1FF
    call = lambda v: refused(lambda: HenonHeiles().energy(q=np.zeros(2), v=np.array([v, 0])))
    return "is no float64" in call(whole), not call(exact)


ROWS = {
    "Ctrl-C at any moment of a long call, of eleven kinds": interrupted,
    "an ensemble in a process forked after another": forked,
    "members that panic": panicking,
    "10³ to 10⁶ threads are asked for": many_threads,
    "a result of any class is pickled": pickled,
    "a folder that cannot be": without_folder,
    "an entry is masked": masked,
    "an integer beyond 2⁵³ would be rounded": rounded,
}


def main():
    tries = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    warnings.simplefilter("ignore")
    left_in_all = 0
    print("| fault | tries | left | control |\n|---|--:|--:|--:|")
    for fault, trial in ROWS.items():
        chance, left, seen = random.Random(fault), 0, 0
        for number in range(tries):
            is_well, is_seen = trial(chance, number)
            left, seen = left + (not is_well), seen + is_seen
        print(f"| {fault} | {tries} | {left} | {seen} of {tries} |", flush=True)
        assert seen > 0, f"{fault}: no control was seen"
        left_in_all += left
    sys.exit(left_in_all > 0)


if __name__ == "__main__":
    main()
