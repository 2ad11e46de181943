"""Fields that are curves: what points are refused, the bits of runs, members of their own."""

import pickle
import re

import numpy as np
import pytest
from dalembert_scenes import Ring, Rocket, Table
from scipy.interpolate import CubicSpline, PchipInterpolator
from test_run import of_rust

KINDS = ["linear", "spline", "monotone", "periodic"]
THRUST = ([0.0, 0.25, 2.0, 2.25], [0.0, 60.0, 45.0, 0.0])
DRAG = ([0.0, 10.0, 20.0, 35.0, 50.0, 80.0], [0.0, 4.0, 15.0, 40.0, 45.0, 0.0])


def rocket(kind="linear", mass=2.0, **keywords):
    of = getattr(Table, kind)
    return Rocket(mass=mass, thrust=of(*THRUST, **keywords), drag=Table.linear(*DRAG, straight_beyond=True))


@pytest.mark.parametrize("kind", KINDS)
def test_runs_have_the_bits_of_rust(reference, kind):
    of, beyond = getattr(Table, kind), {} if kind == "periodic" else {"straight_beyond": True}
    system = Rocket(mass=2.0, thrust=of(*THRUST), drag=of(*DRAG, **beyond))
    run = system.run(h=0.05, steps=100, q=[0.0], v=[5.0], t=0.25)
    records = np.column_stack([run.t, run.q, run.v, run.p, run.energy])
    assert np.array_equal(records.view(np.uint64), of_rust(reference, f"rocket_{kind}").view(np.uint64))
    # The control: another kind is another run.
    system.thrust = getattr(Table, KINDS[KINDS.index(kind) - 1])(*THRUST)
    assert not np.array_equal(system.run(h=0.05, steps=100, q=[0.0], v=[5.0], t=0.25).q, run.q)


def test_values_are_scipys():
    random = np.random.default_rng(1)
    for count in range(4, 30):
        x, y = np.cumsum(random.uniform(0.1, 1.0, count)), random.normal(size=count)
        closed = np.append(y[:-1], y[0])
        place = random.uniform(x[0], x[-1], (3, 20))
        for made, expected in [
            (Table.linear(x, y), np.interp(place, x, y)),
            (Table.spline(x, y), CubicSpline(x, y)(place)),
            (Table.monotone(x, y), PchipInterpolator(x, y)(place)),
            (Table.periodic(x, closed), CubicSpline(x, closed, bc_type="periodic")(place)),
        ]:
            assert np.allclose(made(place), expected, rtol=0, atol=1e-11 * (1 + np.abs(expected).max()))
            assert made(place).shape == (3, 20) and isinstance(made(float(x[1])), float)
            assert not np.allclose(made(place + 1e-3), expected, rtol=0, atol=1e-11)


def test_points_that_are_none_are_refused_at_their_place():
    random = np.random.default_rng(2)
    for _ in range(200):
        kind, count = KINDS[random.integers(4)], int(random.integers(3, 12))
        of = getattr(Table, kind)
        x, y = np.cumsum(random.uniform(0.1, 1.0, count)), random.normal(size=count)
        y[-1] = y[0]
        of(x, y)
        at = int(random.integers(1, count))
        wrong = x.copy()
        wrong[at] = wrong[at - 1] - random.integers(2)
        with pytest.raises(ValueError, match=re.escape(f"`Table.{kind}`: x[{at}] = ") + ".* is not above"):
            of(wrong, y)
        wrong[at] = [np.nan, np.inf][random.integers(2)]
        with pytest.raises(ValueError, match=re.escape(f"`Table.{kind}`: x[{at}] is NaN, infinite")):
            of(wrong, y)
        wrong = y.copy()
        wrong[at] = -np.inf
        with pytest.raises(ValueError, match=re.escape(f"`Table.{kind}`: y[{at}] is NaN or infinite")):
            of(x, wrong)
    with pytest.raises(ValueError, match="the last y is 0.5 and the first 0"):
        Table.periodic([0, 1, 2], [0, 1, 0.5])
    with pytest.raises(ValueError, match=r"y: expected the shape \(3,\), got \(2,\)"):
        Table.linear([0, 1, 2], [0, 1])
    with pytest.raises(ValueError, match=r"x: expected the shape \(points,\), got \(1, 2\)"):
        Table.linear([[0, 1]], [[0, 1]])
    with pytest.raises(ValueError, match="1 points are too few"):
        Table.spline([0], [1])


def test_a_field_takes_tables_of_its_points_alone():
    system = rocket()
    with pytest.raises(TypeError, match=r"thrust: expected a Table of 4 points, such as Table.linear\(x, y\), got \[0.0"):
        system.thrust = [0.0, 1.0, 2.0, 3.0]
    with pytest.raises(ValueError, match="thrust: expected a Table of 4 points, got one of 6"):
        system.thrust = Table.linear(*DRAG)
    assert system == rocket()
    system.thrust = Table.spline(*THRUST)
    assert system != rocket() and system == rocket("spline")
    assert rocket("spline", straight_beyond=True) != rocket("spline")
    assert system.thrust == Table.spline(*THRUST) and system.thrust.interpolation == "spline"
    assert system.thrust.x.tolist() == THRUST[0] and system.thrust.y.tolist() == THRUST[1]
    assert system.drag.straight_beyond and not system.thrust.straight_beyond
    assert repr(system.drag) == f"Table.linear({DRAG[0]}, {DRAG[1]}, straight_beyond=True)"
    assert eval(repr(system)) == system
    for made in (system, system.drag, system.thrust):
        assert pickle.loads(pickle.dumps(made)) == made
    assert "thrust : Table of 4 points\n    Thrust in N over the time in s." in Rocket.__doc__


def tables(random, count):
    x, y = np.cumsum(random.uniform(0.1, 1.0, (count, 4)), axis=1), random.uniform(0.0, 60.0, (count, 4))
    return [getattr(Table, KINDS[k % 3])(x[k], y[k]) for k in range(count)]


@pytest.mark.parametrize("rule", ["midpoint", "gauss_4"])
def test_members_have_tables_of_their_own(rule):
    random, system = np.random.default_rng(3), rocket()
    thrusts, masses = tables(random, 40), random.uniform(1.0, 3.0, 40)
    start = {"h": 0.05, "steps": 60, "q": [0.0], "v": [1.0], "rule": rule}
    ends = system.ensemble(fields={"thrust": thrusts, "mass": masses}, **start)
    for k, (thrust, mass) in enumerate(zip(thrusts, masses)):
        own = Rocket(mass=mass, thrust=thrust, drag=system.drag).run(**start)
        assert ends.q[k] == own.q[-1] and ends.p[k] == own.p[-1]
    assert len(np.unique(ends.q)) == 40
    alike = system.ensemble(fields={"mass": masses}, **start)
    assert not np.any(alike.q == ends.q)


def test_tables_of_members_are_refused_by_name(tmp_path):
    system, thrusts = rocket(), tables(np.random.default_rng(4), 3)
    start = {"h": 0.05, "steps": 10, "q": [[0.0]] * 3, "v": [1.0]}
    with pytest.raises(TypeError, match="thrust: expected a list of Tables"):
        system.ensemble(fields={"thrust": thrusts[0]}, **start)
    with pytest.raises(TypeError, match="thrust: expected a Table of 4 points"):
        system.ensemble(fields={"thrust": [*thrusts[:2], 1.0]}, **start)
    with pytest.raises(ValueError, match="thrust: expected a row for each of 3 members, got 2"):
        system.ensemble(fields={"thrust": thrusts[:2]}, **start)
    counts = system.ensemble(fields={"thrust": thrusts}, folder=tmp_path, **start)
    assert (counts.written, counts.found) == (1, 0)
    # Parts of members with other tables are not theirs.
    with pytest.raises(ValueError, match="another study's"):
        system.ensemble(fields={"thrust": thrusts[::-1]}, folder=tmp_path, **start)
    assert system.ensemble(fields={"thrust": thrusts}, folder=tmp_path, **start).found == 1


def test_a_ring_has_no_table():
    with pytest.raises(TypeError, match="k: expected"):
        Ring(Table.linear([0, 1], [0, 1]))
