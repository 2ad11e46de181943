from pathlib import Path

import pytest


def pytest_addoption(parser):
    parser.addoption("--reference", type=Path, required=True, help="what the program in Rust has printed")
    parser.addoption("--edited", type=Path, help="where dalembert_trials is compiled with DALEMBERT_EDITED")


@pytest.fixture(scope="session")
def reference(request):
    """Runs of the same systems by a program in Rust that knows nothing of Python: name, t, q, v, p, energy as bits."""
    records = {}
    for line in request.config.getoption("reference").read_text().splitlines():
        name, *bits = line.split()
        records.setdefault(name, []).append(bits)
    return records
