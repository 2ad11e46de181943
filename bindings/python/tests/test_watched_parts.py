"""Events in parts: rows of their own, of members that are the same with arrays."""

import numpy as np
import pyarrow.parquet as parquet
import pytest
from dalembert_scenes import HenonHeiles, Plane, ShakenOscillator

RANDOM = np.random.default_rng(11)
STAR = HenonHeiles()
CROSSED, LEFT = Plane([1.0, 0.0], direction=1), Plane([0.0, 1.0], value=0.2, terminal=True)


def starts(members, scale=0.3):
    return RANDOM.uniform(-scale, scale, (members, 2)), RANDOM.uniform(-scale, scale, (members, 2))


def rows(folder, n=2):
    """The rows of all parts: member, event (−1 of none), t, q, p, energy, and whether there is an error."""
    table = parquet.read_table(folder).to_pydict()
    event = np.array([-1 if event is None else event for event in table["event"]])
    numbers = {name: np.array(table[name], float) for name in table if name not in ("member", "event", "error")}
    vectors = (np.column_stack([numbers[f"{of}{i}"] for i in range(n)]) for of in "qp")
    failed = np.array([error is not None for error in table["error"]])
    return np.array(table["member"]), event, numbers["t"], *vectors, numbers["energy"], failed


def assert_equal_rows(folder, ends, first=0):
    """Rows of parts are those of arrays: ends or records, and events."""
    member, event, t, q, p, energy, failed = rows(folder)
    plain = (event < 0) & ~failed
    is_there = np.isfinite(ends.t)
    assert np.array_equal(t[plain], ends.t[is_there]) and np.array_equal(energy[plain], ends.energy[is_there])
    assert np.array_equal(q[plain], ends.q[is_there]) and np.array_equal(p[plain], ends.p[is_there])
    for k, found in enumerate(ends.events):
        of = event == k
        assert np.array_equal(member[of], found.member) and np.array_equal(t[of], found.t)
        assert np.array_equal(q[of], found.q) and np.array_equal(p[of], found.p)
    assert sorted(member[failed]) == sorted(ends.failures)
    for number in np.unique(member):
        mine = member == number
        # In the order of time, the end last.
        assert (np.diff(t[mine]) >= 0).all() and event[mine][-1] < 0
    assert member.min() == first


@pytest.mark.parametrize("rule", HenonHeiles.RULES)
@pytest.mark.parametrize("every", [None, 10])
def test_rows_are_the_records_and_events_of_arrays(rule, every, tmp_path):
    q, v = starts(23)
    at = {"h": 0.1, "steps": 95, "rule": rule, "every": every, "q": q, "v": v}
    watched = STAR.ensemble(events=[CROSSED, LEFT], first=100, **at)
    parts = STAR.ensemble(events=[CROSSED, LEFT], first=100, folder=tmp_path / "watched", members_per_part=10, **at)
    assert (parts.written, parts.found, parts.failed) == (3, 0, 0)
    assert_equal_rows(tmp_path / "watched", watched, first=100)
    # A terminal event ends its member there.
    member, event, t, q_of, *_ = rows(tmp_path / "watched")
    ended = member[event == 1]
    assert 0 < len(ended) < 23 and len(watched.events[0]) > 0
    for number in ended:
        mine = np.flatnonzero(member == number)
        assert event[mine[-2]] == 1 and t[mine[-2]] == t[mine[-1]] and np.array_equal(q_of[mine[-2]], q_of[mine[-1]])
    # Controls: members that are not watched go on, and have no such column.
    STAR.ensemble(folder=tmp_path / "alone", members_per_part=10, **at)
    table = parquet.read_table(tmp_path / "alone")
    assert "event" not in table.column_names and max(table["t"].to_pylist()) > min(t[event == 1])


def test_parts_of_watched_members_are_their_own_checkpoint(tmp_path):
    q, v = starts(40, 0.1)
    q[13], q[30], v[30] = [np.nan, 0.0], [0.0, 40.0], [0.0, 40.0]

    def undefined(t, x, w):
        return np.nan if x[1] == q[2, 1] else x[0] + 2.0

    given = {"h": 0.5, "steps": 200, "q": q, "v": v, "rule": "trapezoidal", "events": [CROSSED, undefined]}
    in_parts = given | {"folder": tmp_path, "members_per_part": 10}
    ends, first = STAR.ensemble(**given), STAR.ensemble(**in_parts)
    assert set(ends.failures) == {2, 13, 30}
    assert (first.written, first.found, first.failed, first.failed_before) == (4, 0, 3, 0)
    assert_equal_rows(tmp_path, ends)
    there = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    # One is lost: it alone is computed again, and failures of the earlier call are counted.
    first.paths[1].unlink()
    second = STAR.ensemble(**in_parts | {"threads": 1})
    assert (second.written, second.found, second.failed, second.failed_before) == (1, 3, 3, 2)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == there
    # Other events are another study's; a function is told by its values at the starts.
    nearer = Plane([1.0, 0.0], value=1e-12, direction=1)
    others = [nearer, Plane([1.0, 0.0]), Plane([1.0, 0.0], direction=1, terminal=True), lambda t, x, w: x[0] + 0.5]
    for other in ([CROSSED, lambda t, x, w: x[0] + 2.5], *([other, undefined] for other in others), [CROSSED], []):
        with pytest.raises(ValueError, match="another study's"):
            STAR.ensemble(**in_parts | {"events": other})
    # Control: these again.
    assert STAR.ensemble(**in_parts).found == 4


def test_what_a_function_raises_leaves_no_part(tmp_path):
    q, v = starts(30)
    at = {"h": 0.1, "steps": 50, "q": q, "v": v, "folder": tmp_path, "members_per_part": 30}

    def broken(t, x, w):
        if t > 4.5 and x[1] > -10.0:
            raise KeyError("broken")
        return x[0] + 2.0

    with pytest.raises(KeyError, match="broken"):
        STAR.ensemble(events=[broken], **at)
    assert [path.name for path in tmp_path.iterdir()] == ["_study.parquet"]
    # Control: the same study, by a function that is whole.
    assert STAR.ensemble(events=[lambda t, x, w: x[0] + 2.0], **at).written == 1


def test_members_to_a_tolerance_and_at_a_time_have_events_in_parts_too(tmp_path):
    # Of chaos: of some more than one run is tried, and of some none keeps the error.
    q, v = np.array([[0.0, -0.25], [0.0, -0.2], [0.0, 0.1]]), np.array([[0.42, 0.0], [0.4, 0.1], [0.1, 0.1]])
    at = {"tolerance": 1e-6, "until": 100.0, "q": q, "v": v, "events": [CROSSED]}
    ends, parts = STAR.ensemble(**at), STAR.ensemble(folder=tmp_path / "to_error", **at)
    assert parts.failed == len(ends.failures) < 3 and len(ends.events[0]) > 10
    assert_equal_rows(tmp_path / "to_error", ends)
    shaken = ShakenOscillator(1, 2, 0.1, 0.5, 1.7)
    given = {"h": 0.1, "steps": 20, "q": q[:, :1], "p": v[:, :1], "t": 3.0, "events": [lambda t, x, w: t - 4.25]}
    ends, parts = shaken.ensemble(**given), shaken.ensemble(folder=tmp_path / "timed", **given)
    _, event, t, *_, energy, _ = rows(tmp_path / "timed", 1)
    # Times of rows count from the start.
    assert t[event == 0] + 3.0 == pytest.approx([4.25] * 3, abs=1e-12) and len(parts) == 1
    assert np.array_equal(energy[event < 0], ends.energy)
