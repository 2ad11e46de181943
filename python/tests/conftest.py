from pathlib import Path


def pytest_addoption(parser):
    parser.addoption("--reference", type=Path, required=True, help="what the program in Rust has printed")
