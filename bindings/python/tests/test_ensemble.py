"""Ensembles: members are their own runs, failures stand in the result, parts are their own checkpoint."""

import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pyarrow.parquet as parquet
import pytest
from dalembert_scenes import (
    CartPole,
    DoublePendulum,
    Ends,
    EventError,
    HenonHeiles,
    Plane,
    Ring,
    ShakenOscillator,
    StepError,
    ToleranceError,
)

RANDOM = np.random.default_rng(7)


def starts(members, scale=0.3):
    return RANDOM.uniform(-scale, scale, (members, 2)), RANDOM.uniform(-scale, scale, (members, 2))


@pytest.mark.parametrize("rule", Ring.RULES)
def test_a_member_is_its_own_run_bit_by_bit(rule):
    q, v = starts(37)
    q += [0.0, 1.0]
    k = RANDOM.uniform(0, 0.1, 37)
    ends = Ring(k=0.0).ensemble(h=0.1, steps=50, q=q, v=v, fields={"k": k}, rule=rule)
    for member in range(37):
        run = Ring(k[member]).run(h=0.1, steps=50, every=50, q=q[member], v=v[member], rule=rule)
        assert np.array_equal(ends.q[member], run.q[-1]) and np.array_equal(ends.p[member], run.p[-1])
        assert np.array_equal(ends.v[member], run.v[-1]) and ends.energy[member] == run.energy[-1]
        assert ends.t[member] == run.t[-1]
    assert not ends.failures and len(ends) == 37


def test_members_of_all_kinds_are_their_own_runs():
    q, v = starts(5)
    to_error = HenonHeiles().ensemble(tolerance=1e-7, until=5.0, q=q, v=v)
    c = RANDOM.uniform(0, 0.1, (5, 2))
    of_arrays = DoublePendulum([1, 1], [1, 1], 9.81, [0, 0]).ensemble(h=0.01, steps=20, q=q, v=v, fields={"c": c})
    u = RANDOM.uniform(-1, 1, (5, 1))
    driven = CartPole(1.0, 0.1, 0.25, [0.1, 0.0]).ensemble(h=0.01, steps=20, q=[0, 0.1], p=[0, 0], u=u)
    shaken = ShakenOscillator(1, 2, 0.1, 0.5, 1.7).ensemble(h=0.1, steps=20, q=q[:, :1], v=[0.0], t=3.0)
    for k in range(5):
        run = HenonHeiles().run(tolerance=1e-7, until=5.0, q=q[k], v=v[k])
        assert np.array_equal(to_error.q[k], run.q[-1])
        run = DoublePendulum([1, 1], [1, 1], 9.81, c[k]).run(h=0.01, steps=20, q=q[k], v=v[k])
        assert np.array_equal(of_arrays.q[k], run.q[-1])
        run = CartPole(1.0, 0.1, 0.25, [0.1, 0.0]).run(h=0.01, steps=20, q=[0, 0.1], p=[0, 0], u=u[k])
        assert np.array_equal(driven.q[k], run.q[-1])
        run = ShakenOscillator(1, 2, 0.1, 0.5, 1.7).run(h=0.1, steps=20, q=q[k, :1], v=[0.0], t=3.0)
        assert np.array_equal(shaken.q[k], run.q[-1]) and shaken.t[k] == run.t[-1]


def test_records_on_the_way_are_those_of_the_run():
    q, v = starts(11)
    ends = Ring(0.01).ensemble(h=0.1, steps=10, every=4, q=q, v=v, rule="blanes_moan_4")
    assert ends.q.shape == (11, 4, 2) and ends.energy.shape == ends.t.shape == (11, 4)
    run = Ring(0.01).run(h=0.1, steps=10, every=4, q=q[3], v=v[3], rule="blanes_moan_4")
    assert np.array_equal(ends.q[3], run.q) and np.array_equal(ends.t[3], run.t)


def test_a_member_that_fails_does_not_stop_the_others():
    q, v = starts(100, 0.1)
    q[13] = [np.nan, 0.0]
    q[50], v[50] = [0.0, 40.0], [0.0, 40.0]
    star = HenonHeiles()
    ends = star.ensemble(h=0.5, steps=200, q=q, v=v, rule="trapezoidal")
    assert set(ends.failures) == {13, 50}
    assert np.isnan(ends.q[[13, 50]]).all() and np.isnan(ends.t[50])
    assert np.isfinite(np.delete(ends.q, [13, 50], axis=0)).all()
    without_start, on_the_way = ends.failures[13], ends.failures[50]
    assert isinstance(without_start, StepError) and without_start.kind == "NonFinite" and without_start.q is None
    with pytest.raises(StepError) as raised:
        star.run(h=0.5, steps=200, q=q[50], v=v[50], rule="trapezoidal")
    assert on_the_way.kind == raised.value.kind and np.array_equal(on_the_way.q, raised.value.q)
    assert on_the_way.t == raised.value.t and on_the_way.step is None and "member 50" in str(on_the_way)
    out_of_reach = star.ensemble(tolerance=1e-30, until=1.0, q=q[:2], v=v[:2])
    assert isinstance(out_of_reach.failures[0], ToleranceError)


@pytest.mark.parametrize("rule", HenonHeiles.RULES)
def test_events_of_members_are_those_of_their_runs(rule):
    q, v = starts(23)
    events = [Plane([1.0, 0.0], direction=1), Plane([0.0, 1.0], value=0.2, terminal=True)]
    at = {"h": 0.1, "steps": 95, "rule": rule, "events": events}
    ends = HenonHeiles().ensemble(q=q, v=v, first=100, **at)
    on_the_way = HenonHeiles().ensemble(q=q, v=v, every=10, threads=1, **at)
    ended_early = 0
    for k in range(23):
        run = HenonHeiles().run(q=q[k], v=v[k], every=10, **at)
        assert ends.t[k] == run.t[-1] and ends.energy[k] == run.energy[-1]
        assert np.array_equal(ends.q[k], run.q[-1]) and np.array_equal(ends.v[k], run.v[-1])
        rows = len(run)
        assert np.array_equal(on_the_way.p[k, :rows], run.p) and np.isnan(on_the_way.p[k, rows:]).all()
        for found, alone in zip(ends.events, run.events, strict=True):
            mine = found.member == 100 + k
            assert np.array_equal(found.t[mine], alone.t) and np.array_equal(found.q[mine], alone.q)
            assert np.array_equal(found.v[mine], alone.v) and np.array_equal(found.p[mine], alone.p)
        ended_early += len(run.events[1])
    assert on_the_way.q.shape == (23, 11, 2) and 0 < ended_early < 23 and len(ends.events[0]) > 0
    assert not ends.failures and ends.events[0].member.dtype == np.int64


def test_events_of_members_of_all_kinds():
    q, v = starts(5)
    c, plane = RANDOM.uniform(0, 0.1, (5, 2)), Plane([1.0, 0.0])
    pendulum = DoublePendulum([1, 1], [1, 1], 9.81, [0, 0])
    of_fields = pendulum.ensemble(h=0.01, steps=200, q=q, v=v, fields={"c": c}, events=[plane])
    to_error = HenonHeiles().ensemble(tolerance=1e-7, until=5.0, q=q, v=v, events=[plane])
    shaken = ShakenOscillator(1, 2, 0.1, 0.5, 1.7)
    timed = shaken.ensemble(h=0.1, steps=20, q=q[:, :1], v=[0.0], t=3.0, events=[lambda t, q, v: t - 4.25])
    for k in range(5):
        run = DoublePendulum([1, 1], [1, 1], 9.81, c[k]).run(h=0.01, steps=200, q=q[k], v=v[k], events=[plane])
        assert np.array_equal(of_fields.q[k], run.q[-1])
        assert np.array_equal(of_fields.events[0].t[of_fields.events[0].member == k], run.events[0].t)
        run = HenonHeiles().run(tolerance=1e-7, until=5.0, q=q[k], v=v[k], events=[plane])
        assert np.array_equal(to_error.events[0].t[to_error.events[0].member == k], run.events[0].t)
    assert timed.events[0].t == pytest.approx([4.25] * 5, abs=1e-12) and list(timed.events[0].member) == [0, 1, 2, 3, 4]


def test_members_to_a_tolerance_try_as_many_runs_whether_they_are_watched_or_not():
    # Chaos: a run may pass its error on the way, and another one is tried.
    star, plane = HenonHeiles(), Plane([1.0, 0.0])
    q, v = np.array([[0.0, -0.25], [0.0, -0.2], [0.0, 0.1]]), np.array([[0.42, 0.0], [0.4, 0.1], [0.1, 0.1]])
    at = {"tolerance": 1e-6, "until": 100.0}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        alone = [star.run(q=q[k], v=v[k], every=10**9, events=[plane], **at) for k in range(3)]
    assert any(run.breach is not None for run in alone)
    ends, watched = star.ensemble(q=q, v=v, **at), star.ensemble(q=q, v=v, events=[plane], **at)
    assert list(ends.failures) == list(watched.failures) and len(ends.failures) < 3
    assert np.array_equal(ends.q, watched.q, equal_nan=True) and np.array_equal(ends.p, watched.p, equal_nan=True)
    for k, run in enumerate(alone):
        mine = watched.events[0].member == k
        # Of the run that was taken alone: as many as of the first, not one after the other.
        assert k in ends.failures or abs(mine.sum() - len(run.events[0])) <= 1
        assert (np.diff(watched.events[0].t[mine]) > 0).all()
    out_of_reach = star.ensemble(tolerance=1e-30, until=1.0, q=q, v=v, events=[plane])
    assert all(isinstance(out_of_reach.failures[k], ToleranceError) for k in range(3))


def test_members_that_failed_are_counted_where_they_are_found(tmp_path):
    q, v = starts(30, 0.1)
    q[[3, 13, 25]] = np.nan
    given = {"h": 0.1, "steps": 5, "q": q, "v": v, "folder": tmp_path, "members_per_part": 10}
    first, second = HenonHeiles().ensemble(**given), HenonHeiles().ensemble(**given)
    assert (first.written, first.found, first.failed) == (3, 0, 3)
    assert (second.written, second.found, second.failed) == (0, 3, 3) and "3 members failed" in repr(second)
    assert (first.failed_before, second.failed_before, second.spared) == (0, 3, 0)
    # A bit of a part, and a part under the name of another.
    part = bytearray(second.paths[1].read_bytes())
    part[len(part) // 3] ^= 1
    second.paths[1].write_bytes(part)
    with pytest.raises(ValueError, match="is damaged"):
        HenonHeiles().ensemble(**given)
    second.paths[0].replace(second.paths[1])
    with pytest.raises(ValueError, match="it has been renamed"):
        HenonHeiles().ensemble(**given)


def test_members_that_are_watched_fail_alone():
    q, v = starts(40, 0.1)
    q[13] = [np.nan, 0.0]
    q[30], v[30] = [0.0, 40.0], [0.0, 40.0]
    star, at = HenonHeiles(), {"h": 0.5, "steps": 200, "rule": "trapezoidal"}
    watched = star.ensemble(q=q, v=v, events=[Plane([1.0, 0.0])], **at)
    alone = star.ensemble(q=q, v=v, **at)
    assert set(watched.failures) == set(alone.failures) == {13, 30}
    assert np.array_equal(watched.q, alone.q, equal_nan=True) and np.array_equal(watched.t, alone.t, equal_nan=True)
    for number, failure in alone.failures.items():
        same = watched.failures[number]
        assert str(same) == str(failure) and same.kind == failure.kind and same.t == failure.t
        assert (same.q is None) == (failure.q is None) and (failure.q is None or np.array_equal(same.q, failure.q))
    # A function that one member takes to where it is not defined.
    q, v = starts(6, 0.1)
    at = {"h": 0.1, "steps": 30}
    ends = star.ensemble(q=q, v=v, events=[lambda t, x, w: np.nan if x[1] == q[2, 1] else 1.0], **at)
    assert set(ends.failures) == {2} and isinstance(ends.failures[2], EventError) and "member 2" in str(ends.failures[2])
    assert np.isnan(ends.q[2]).all() and np.isfinite(np.delete(ends.q, 2, axis=0)).all()

    def broken(t, q, v):
        raise KeyError("broken")

    with pytest.raises(KeyError, match="broken"):
        star.ensemble(q=q, v=v, events=[broken], **at)
    with pytest.raises(ValueError, match="rule: expected one of"):
        star.ensemble(q=q, v=v, events=[Plane([1.0, 0.0])], **at | {"rule": "euler"})


def test_watched_members_are_many_and_can_be_stopped():
    q, v = starts(40_000)
    told = []
    at = {"h": 0.1, "steps": 100, "q": q, "v": v, "rule": "trapezoidal", "events": [Plane([1.0, 0.0])]}
    ends = HenonHeiles().ensemble(progress=lambda done, of: told.append((done, of)), **at)
    assert told[-1] == (40_000, 40_000) and told == sorted(told)
    assert (np.diff(ends.events[0].member) >= 0).all() and ends.events[0].member[-1] > 39_000

    def stop(done, of):
        raise RuntimeError("enough")

    began = time.perf_counter()
    with pytest.raises(RuntimeError, match="enough"):
        HenonHeiles().ensemble(progress=stop, **at | {"steps": 10**6})
    assert time.perf_counter() - began < 20


def test_the_number_of_threads_changes_no_bit():
    q, v = starts(3000)
    one, two = (Ring(0.01).ensemble(h=0.1, steps=20, q=q, v=v, threads=threads) for threads in (1, 2))
    assert np.array_equal(one.q, two.q) and np.array_equal(one.energy, two.energy)


def test_parts_are_files_and_those_that_are_there_are_not_computed_again(tmp_path):
    q, v = starts(250)
    given = {"h": 0.1, "steps": 30, "q": q, "v": v, "rule": "blanes_moan_4"}
    ring = Ring(0.01)
    parts = ring.ensemble(folder=tmp_path / "whole", members_per_part=100, **given)
    assert (parts.written, parts.found, parts.failed, len(parts.paths)) == (3, 0, 0, 3)
    table = parquet.read_table(tmp_path / "whole").to_pydict()
    ends = ring.ensemble(**given)
    assert table["member"] == list(range(250)) and table["error"] == [None] * 250
    assert np.array_equal(np.column_stack([table["q0"], table["q1"]]), ends.q)
    assert np.array_equal(table["energy"], ends.energy)
    names = [path.name for path in parts.paths]
    written = {path.name: path.read_bytes() for path in (tmp_path / "whole").iterdir()}
    assert sorted(written) == ["_study.parquet", *names]
    # One is lost; the others stay as they are.
    parts.paths[1].unlink()
    again = ring.ensemble(folder=tmp_path / "whole", members_per_part=100, **given)
    assert (again.written, again.found) == (1, 2)
    # Each part by itself, as the workers of a cluster do, in any order.
    for first in (200, 0, 100):
        rows = {name: given[name][first : first + 100] for name in ("q", "v")}
        one = ring.ensemble(folder=str(tmp_path / "one"), members_per_part=100, first=first, **(given | rows))
        assert one.written == 1 and [path.name for path in one.paths] == [names[first // 100]]
    # A field that differs is a column.
    k = RANDOM.uniform(0.0, 0.1, 250)
    ring.ensemble(folder=tmp_path / "fields", fields={"k": k}, **given)
    assert np.array_equal(parquet.read_table(tmp_path / "fields")["k"], k)
    for folder in ("whole", "one"):
        assert {path.name: path.read_bytes() for path in (tmp_path / folder).iterdir()} == written
    # Others are another study's.
    for other in ({"steps": 31}, {"q": q + 1e-16 + 1e-9}, {"rule": "blanes_moan_6"}):
        with pytest.raises(ValueError, match="another study's"):
            ring.ensemble(folder=tmp_path / "whole", members_per_part=100, **(given | other))
    with pytest.raises(ValueError, match="another study's"):
        Ring(0.011).ensemble(folder=tmp_path / "whole", members_per_part=100, **given)
    with pytest.raises(ValueError, match="members_per_part"):
        ring.ensemble(folder=tmp_path / "whole", members_per_part=50, **given)
    with pytest.raises(ValueError, match="do not start with a part"):
        ring.ensemble(folder=tmp_path / "whole", members_per_part=100, first=30, **given)
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        ring.ensemble(folder=tmp_path / "file" / "folder", members_per_part=100, **given)


@pytest.mark.parametrize(
    ("kind", "says", "arguments"),
    [
        (ValueError, "members: expected a row for each", {"q": [0, 1], "v": [0, 0]}),
        (ValueError, "v: expected a row for each of 4 members, got 3 rows", {"v": np.zeros((3, 2))}),
        (ValueError, r"q: expected the shape \(2,\) or \(members, 2\), got \(4, 3\)", {"q": np.zeros((4, 3))}),
        (ValueError, "k: expected a row for each of 4 members, got 5 rows", {"fields": {"k": np.zeros(5)}}),
        (ValueError, r"k: expected the shape \(members,\), got \(4, 2\)", {"fields": {"k": np.zeros((4, 2))}}),
        (TypeError, "Ring has no field drag; it has k", {"fields": {"drag": np.zeros(4)}}),
        (ValueError, "rule: expected one of", {"rule": "euler"}),
        (MemoryError, "memory", {"steps": 10**13, "every": 1}),
    ],
)
def test_what_does_not_fit_is_said(kind, says, arguments):
    with pytest.raises(kind, match=says):
        Ring(0.0).ensemble(**({"h": 0.1, "steps": 5, "q": np.ones((4, 2)), "v": np.zeros((4, 2))} | arguments))


def test_no_members_are_no_rows():
    ends = Ring(0.0).ensemble(h=0.1, steps=5, q=np.zeros((0, 2)), v=[0, 0])
    assert isinstance(ends, Ends) and len(ends) == 0 and ends.q.shape == (0, 2)


def test_fields_of_all_shapes_are_columns(tmp_path):
    c, g = RANDOM.uniform(0, 0.1, (6, 2)), RANDOM.uniform(9, 10, 6)
    pendulum = DoublePendulum([1, 1], [1, 1], 9.81, [0, 0])
    at = {"h": 0.1, "steps": 4, "every": 2, "q": [1, 0], "v": [0, 0], "fields": {"c": c, "g": g}, "first": 30}
    pendulum.ensemble(folder=tmp_path, members_per_part=3, **at)
    table = parquet.read_table(tmp_path)
    assert table.column_names == ["member", "c0", "c1", "g", "t", "q0", "q1", "p0", "p1", "energy", "error"]
    member = np.array(table["member"]) - 30
    assert len(member) == 18 and np.array_equal(table["c1"], c[member, 1]) and np.array_equal(table["g"], g[member])
    ends = pendulum.ensemble(**at)
    assert np.array_equal(np.array(table["q1"]).reshape(6, 3), ends.q[..., 1])


def test_members_take_whole_steps():
    at = {"q": [[0, 1]], "v": [0.1, 0]}
    assert np.array_equal(Ring(0.0).ensemble(h=0.1, until=0.3, **at).q, Ring(0.0).ensemble(h=0.1, steps=3, **at).q)
    with pytest.raises(ValueError, match="until: members take whole steps; .* h = 0.0875 fits"):
        Ring(0.0).ensemble(h=0.09, until=0.35, **at)


def test_progress_is_told_and_its_exception_ends_the_ensemble():
    q, v = starts(20_000)
    told = []
    Ring(0.01).ensemble(h=0.1, steps=300, q=q, v=v, progress=lambda done, of: told.append((done, of)))
    assert told[-1] == (20_000, 20_000) and len(told) > 1 and told == sorted(told)

    def stop(done, of):
        raise RuntimeError("enough")

    began = time.perf_counter()
    with pytest.raises(RuntimeError, match="enough"):
        Ring(0.01).ensemble(h=0.1, steps=30_000, q=q, v=v, progress=stop)
    assert time.perf_counter() - began < 20


def test_ctrl_c_ends_an_ensemble(tmp_path):
    program = (
        "import signal\n"
        "import numpy as np\n"
        "from dalembert_scenes import Ring\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "q = np.random.default_rng(1).uniform(-1, 1, (100_000, 2))\n"
        "print('begun', flush=True)\n"
        "try:\n"
        f"    Ring(k=1e-3).ensemble(h=0.1, steps=30_000, q=q, v=[0, 0], folder={str(tmp_path)!r})\n"
        "except KeyboardInterrupt:\n"
        "    print('interrupted', flush=True)\n"
    )
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as run:
        too_long = threading.Timer(60, run.kill)
        too_long.start()
        assert run.stdout.readline() == "begun\n"
        time.sleep(0.5)
        run.send_signal(signal.SIGINT)
        assert run.stdout.readline() == "interrupted\n"
        assert run.wait(10) == 0
        too_long.cancel()
    assert [path.name for path in tmp_path.iterdir()] == ["_study.parquet"]
