"""Three blocks brought to rest by dry friction, as users of each library write it: what an error of their places costs.

    python study.py        the table
"""

import time
from pathlib import Path

import numpy as np
from by_dalembert import at_rest as by_dalembert
from by_events import at_rest as by_events
from by_tanh import at_rest as by_tanh

ERRORS = [1e-2, 1e-3]
# Step sizes and tolerances, from coarse to fine; the last with the width of the regularised jump.
METHODS = {
    "dalembert, `proximal`": (by_dalembert, "by_dalembert.py", [0.4 / 2 ** (k / 2) for k in range(20)]),
    "SciPy, DOP853 with events": (by_events, "by_events.py", [10.0 ** (-k / 2) for k in range(2, 27)]),
    # Below 1e-6 the steps of one run fill the memory.
    "SciPy, LSODA on tanh(v/ε)": (by_tanh, "by_tanh.py", [10.0 ** (-k / 2) for k in range(2, 13)]),
}
MODEL = Path(__file__).parent / "../../../../bindings/python/src/blocks.rs"


def lines(path):
    code = (line.strip() for line in path.read_text().splitlines())
    return sum(1 for line in code if line and not line.startswith(("//", "#", '"""')) or line.startswith("#["))


def least_time(run, setting):
    took = []
    while len(took) < 3 or sum(took) < 0.5 and len(took) < 1000:
        began = time.process_time()
        run(setting)
        took.append(time.process_time() - began)
    return min(took)


def digits(number):
    """Two of them, without an exponent."""
    return f"{float(f'{number:.2g}'):g}"


def table():
    reference = by_events(1e-13)
    check = by_dalembert(1 / 4096)
    print(f"At rest the blocks are at {', '.join(f'{x:.6f}' for x in reference)} m: SciPy with events to 1e-13, by `proximal` with")
    print(f"h = 1/4096 s to {max(abs(check - reference)):.0e} m.\n")
    print("| | lines | " + " | ".join(f"within {error:g} m: set to | error | ms | ratio" for error in ERRORS) + " |")
    print("|---|--:" + "|--:|--:|--:|--:" * len(ERRORS) + "|")
    ours = {}
    for name, (run, file, settings) in METHODS.items():
        cells = []
        for error in ERRORS:
            # The coarsest setting that, with all finer ones tried, stays within the error.
            found = [max(abs(run(setting) - reference)) for setting in settings]
            last = max((k for k, e in enumerate(found) if not e <= error), default=-1)
            if last + 1 == len(settings):
                cells += ["–"] * 4
                continue
            setting = settings[last + 1]
            ms = 1e3 * least_time(run, setting)
            ours.setdefault(error, ms)
            cells += [f"{setting:.2g}", f"{found[last + 1]:.0e}", digits(ms), digits(ms / ours[error])]
        code = lines(Path(__file__).parent / file) + (lines(MODEL) if name.startswith("dalembert") else 0)
        print(f"| {name} | {code} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    table()
