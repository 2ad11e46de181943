from pathlib import Path


def pytest_addoption(parser):
    parser.addoption("--reference", type=Path, required=True, help="what the program in Rust has printed")
    parser.addoption("--edited", type=Path, help="where dalembert_trials is compiled with DALEMBERT_EDITED")
