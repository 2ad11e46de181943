"""What is given and handed back: masks, whole numbers, pickles, errors of files."""

import errno
import pickle
import warnings

import numpy as np
import pytest
from dalembert_scenes import CartPole, HenonHeiles, Plane, Ring, StepError
from joblib import Parallel, delayed

AT = {"h": 0.1, "steps": 5}


def test_masked_entries_are_no_numbers():
    rest = np.ma.array([0.0, 1.0], mask=[False, False])
    assert np.array_equal(Ring(0.0).run(q=rest, v=[0, 0], **AT).q, Ring(0.0).run(q=[0, 1], v=[0, 0], **AT).q)
    rest.mask = [True, False]
    with pytest.raises(ValueError, match="q: entries are masked; fill them"):
        Ring(0.0).run(q=rest, v=[0, 0], **AT)
    k = np.ma.array([0.1, 0.2], mask=[False, True])
    with pytest.raises(ValueError, match="k: entries are masked"):
        Ring(0.0).ensemble(q=[0, 1], v=[0, 0], fields={"k": k}, **AT)


@pytest.mark.parametrize("listed", [list, tuple, lambda rows: np.array(rows).tolist() and [[*row] for row in rows]])
def test_masked_entries_in_lists_are_no_numbers(listed):
    rows = [np.ma.array([0.0, 1.0], mask=[False, False]), np.ma.array([0.5, 1.0], mask=[False, False])]
    same = Ring(0.0).ensemble(q=np.array(rows), v=[0, 0], **AT).q
    assert np.array_equal(Ring(0.0).ensemble(q=listed(rows), v=[0, 0], **AT).q, same)
    rows[1].mask = [False, True]
    with pytest.raises(ValueError, match="q: entries are masked; fill them"):
        Ring(0.0).ensemble(q=listed(rows), v=[0, 0], **AT)
    with pytest.raises(ValueError, match="q: entries are masked"):
        Ring(0.0).run(q=[0.0, np.ma.masked], v=[0, 0], **AT)
    with pytest.raises(ValueError, match="k: entries are masked"):
        Ring(0.0).ensemble(q=[0, 1], v=[0, 0], fields={"k": [0.1, np.ma.masked]}, **AT)


@pytest.mark.parametrize("dtype", [np.int64, np.uint64])
def test_whole_numbers_are_not_rounded(dtype):
    exact = np.array([2**53, 2**60], dtype)
    assert HenonHeiles().energy(q=np.zeros(2), v=exact) == 0.5 * (2.0**106 + 2.0**120)
    with pytest.raises(ValueError, match="v: 9007199254740993 is no float64, and would be rounded to 9007199254740992"):
        HenonHeiles().energy(q=np.zeros(2), v=exact + np.array([1, 0], dtype))
    with pytest.raises(ValueError, match="k: 9007199254740993 is no float64"):
        Ring(2**53 + 1)


def equal(left, right):
    """Whether two results have the same attributes, arrays of the same bits, and errors of the same words."""
    if type(left) is not type(right):
        return False
    if isinstance(left, np.ndarray):
        return np.array_equal(left, right, equal_nan=True) and left.dtype == right.dtype
    if isinstance(left, list):
        return len(left) == len(right) and all(map(equal, left, right))
    if isinstance(left, dict):
        return list(left) == list(right) and all(equal(left[key], right[key]) for key in left)
    if isinstance(left, Exception):
        return str(left) == str(right) and equal(vars(left), vars(right))
    names = [name for name in dir(left) if not name.startswith("_") and not callable(getattr(left, name))]
    if type(left).__module__.startswith("dalembert") and names:
        return all(equal(getattr(left, name), getattr(right, name)) for name in names)
    return left == right


def test_results_are_pickled(tmp_path):
    star, plane = HenonHeiles(), Plane([1.0, 0.0])
    q, v = np.array([[0.1, 0.0], [np.nan, 0.0], [0.0, 40.0]]), np.array([[0.3, 0.1], [0.0, 0.0], [0.0, 40.0]])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = [
            star.run(h=0.1, steps=50, every=10, q=q[0], v=v[0], events=[plane]),
            Ring(0.01).run(h=0.1, steps=20, q=[0, 1], v=[0.1, 0], derivatives=True),
            star.run(tolerance=1e-6, until=100.0, every=10**9, q=[0.0, -0.25], v=[0.42, 0.0]),
            star.ensemble(h=0.5, steps=200, q=q, v=v, rule="trapezoidal"),
            star.ensemble(h=0.5, steps=20, every=5, q=q[:1], v=v[:1], events=[plane]),
            Ring(0.01).linearization(h=0.1, q=[0, 1], v=[0.1, 0]),
            CartPole(1.0, 0.1, 0.5, [0.1, 0.1]).linearization(h=0.1, q=[0, 0.1], v=[0.1, 0], u=[0.2]),
            *star.symmetries(h=0.1, low=[-1, -1], high=[1, 1], reach=[0.1, 0.1]),
            star.energy_ledger(h=0.1, steps=20, q=q[0], v=v[0]),
            star.ensemble(h=0.5, steps=20, q=q, v=v, folder=tmp_path),
        ]
    assert results[2].breach is not None and isinstance(results[3].failures[2], StepError)
    for result in results:
        again = pickle.loads(pickle.dumps(result))
        assert repr(again) == repr(result) and equal(result, again)
    # Control: others are not equal.
    assert not equal(results[0], results[1]) and not equal(results[3], results[4])
    assert not equal(results[5], results[6]) and not equal(results[7], results[8])


def test_runs_come_from_the_workers_of_joblib():
    ring, starts = Ring(1e-3), [([0.0, 1.0 + 0.01 * k], [0.5, 0.0]) for k in range(4)]
    runs = Parallel(n_jobs=2)(delayed(ring.run)(h=0.1, until=2.0, q=q, v=v) for q, v in starts)
    assert all(equal(run, ring.run(h=0.1, until=2.0, q=q, v=v)) for run, (q, v) in zip(runs, starts, strict=True))


def test_an_error_of_a_file_has_its_number(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(NotADirectoryError) as raised:
        Ring(0.0).ensemble(q=[[0, 1]], v=[0, 0], folder=tmp_path / "file" / "folder", **AT)
    error = raised.value
    assert error.errno == errno.ENOTDIR and error.filename == str(tmp_path / "file" / "folder")
    assert "os error" not in str(error)
