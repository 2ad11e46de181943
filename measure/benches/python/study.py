"""The study by each library on one core, as a table.

    python study.py                              the table
    python study.py LIBRARY SETTING MEMBERS      one run: seconds, and the growth of memory in MB
"""

import importlib
import json
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from starts import END, starts

MEMBERS, ERROR = 100_000, 1e-9
# What is tried, from coarse to fine: step sizes of ours, tolerances of the others; and how many members are run for the time.
TOLERANCES = [10.0 ** (-k / 2) for k in range(14, 29)]
LIBRARIES = {
    "dalembert": ([1 / k for k in range(4, 41)], MEMBERS),
    "heyoka": (TOLERANCES, MEMBERS),
    "pydiffsol": (TOLERANCES, MEMBERS),
    "scipy": (TOLERANCES, 1000),
}
MODEL = Path(__file__).parent / "../../../bindings/python/src/henon_heiles.rs"


def times(library, setting, members):
    q, v = starts(MEMBERS)
    return importlib.import_module(f"by_{library}").escape_times(q[:members], v[:members], setting, 1)


def lines(path):
    code = (line.strip() for line in path.read_text().splitlines())
    return sum(1 for line in code if line and not line.startswith(("//", "#", '"""')) or line.startswith("#["))


def one_run(library, setting, members):
    q, v = starts(MEMBERS)
    escape_times = importlib.import_module(f"by_{library}").escape_times
    # What is compiled, imported and started is not what is measured.
    escape_times(q[:8], v[:8], setting, 1)
    # From here on the largest memory is counted anew.
    Path("/proc/self/clear_refs").write_text("5")
    before = largest_memory()
    began = time.perf_counter()
    escape_times(q[:members], v[:members], setting, 1)
    took = time.perf_counter() - began
    print(json.dumps([took, largest_memory() - before]))


def largest_memory():
    status = Path("/proc/self/status").read_text()
    return int(re.search(r"VmHWM:\s*(\d+) kB", status)[1]) / 1024


def table():
    reference = times("heyoka", 1e-16, 1000)
    from dalembert_scenes import HenonHeiles

    from by_dalembert import openings

    q, v = starts(MEMBERS)
    fine = HenonHeiles().ensemble(
        q=q[:1000], v=v[:1000], h=0.02, steps=round(END / 0.02), rule="gauss_8", events=openings()
    ).t
    apart = np.abs(fine - reference)
    sys.stdout.reconfigure(line_buffering=True)
    print(f"Of the first 1000 stars {np.mean(reference < END):.1%} leave before t = {END:.0f}. The reference is heyoka's, by the")
    print(f"tolerance 1e-16; half of its times are within {np.median(apart):.0e} of those by `gauss_8` and h = 0.02, nine of ten within")
    print(f"{np.quantile(apart, 0.9):.0e}.\n")
    print("| | lines | set to | half of the times within | nine of ten within | µs a star | ratio | memory, MB |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|")
    ours = None
    for library, (settings, members) in LIBRARIES.items():
        for setting in settings:
            errors = np.abs(times(library, setting, 1000) - reference)
            if np.median(errors) <= ERROR:
                break
        else:
            sys.exit(f"{library} does not come to {ERROR}")
        run = [sys.executable, __file__, library, repr(setting), str(members)]
        runs = []
        while len(runs) < 3 and sum(took for took, _ in runs) < 60:
            runs.append(json.loads(subprocess.run(run, check=True, capture_output=True, text=True).stdout))
        (took, _), memory = min(runs), max(grown for _, grown in runs)
        each = 1e6 * took / members
        ours = ours or each
        code = lines(Path(__file__).parent / f"by_{library}.py") + (lines(MODEL) if library == "dalembert" else 0)
        print(
            f"| {library} | {code} | {setting:.3g} | {np.median(errors):.0e} | {np.quantile(errors, 0.9):.0e}"
            f" | {each:.0f} | {each / ours:.1f} | {memory:.0f}{'' if members == MEMBERS else ' (1000 stars)'} |"
        )


if __name__ == "__main__":
    if len(sys.argv) == 4:
        one_run(sys.argv[1], float(sys.argv[2]), int(sys.argv[3]))
    else:
        table()
