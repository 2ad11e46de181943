"""Events: when functions of the motion vanish."""

import math

import numpy as np
import pytest
from dalembert_scenes import DoublePendulum, Energy, Event, EventError, HenonHeiles, Plane, Ring, ShakenOscillator, Sphere

OSCILLATOR = ShakenOscillator(m=1.0, k=1.0, r=0.0, a=0.0, omega=1.0)
START = {"q": [0.0, -0.25], "v": [0.42, 0.0]}


def test_events_are_where_the_motion_is():
    # q = cos ωt with the midpoint rule's own frequency, tan(ωh/2) = h/2.
    h = 0.1
    omega = 2 / h * math.atan(h / 2)
    run = OSCILLATOR.run(h=h, steps=200, q=[1.0], v=[0.0], events=[Plane([1.0]), Plane([1.0], value=0.5, direction=-1)])
    zeros, half = run.events
    assert len(zeros) == 6 and zeros.t == pytest.approx((np.arange(6) + 0.5) * math.pi / omega, abs=1e-3)
    assert np.abs(zeros.q).max() < 1e-14
    assert half.t == pytest.approx((math.pi / 3 + 2 * math.pi * np.arange(len(half))) / omega, abs=1e-3)
    assert half.q == pytest.approx(0.5, abs=1e-14) and (half.v < 0).all()


@pytest.mark.parametrize("rule", HenonHeiles.RULES)
def test_a_plane_is_the_function_that_it_says(rule):
    def crossed(t, q, v):
        return q[0]

    crossed.direction = 1
    at = {"h": 0.1, "steps": 2000, "rule": rule, **START}
    alone = HenonHeiles().run(**at)
    plane = HenonHeiles().run(events=[Plane([1.0, 0.0], direction=1)], **at)
    given = HenonHeiles().run(events=[crossed], **at)
    assert np.array_equal(alone.q, plane.q) and np.array_equal(alone.q, given.q)
    assert len(plane.events[0]) > 25 and np.array_equal(plane.events[0].t, given.events[0].t)
    found = plane.events[0]
    assert np.abs(found.q[:, 0]).max() < 1e-13 and (found.v[:, 0] > 0).all() and np.array_equal(found.v, found.p)
    signs = np.sign(alone.q[:, 0])
    assert len(found) == ((signs[:-1] < 0) & (signs[1:] > 0)).sum() + (START["q"][0] < 0)


def test_a_terminal_event_ends_the_run_there():
    for rule in ("midpoint", "gauss_4"):
        pendulum = DoublePendulum([1, 1], [1, 1], 9.81, [0, 0])
        stop = Plane([1.0, 0.0], direction=-1, terminal=True)
        run = pendulum.run(h=0.05, steps=1000, every=7, q=[1.0, 0.5], v=[0, 0], rule=rule, events=[stop])
        (found,) = run.events
        assert len(found) == 1 and run.t[-1] == found.t[0] and np.array_equal(run.q[-1], found.q[0])
        assert abs(run.q[-1, 0]) < 1e-13 and run.steps < 1000 and (run.q[:-1, 0] > 0).all()
        assert run.energy[-1] == pytest.approx(run.energy[0], rel=1e-2)


def test_events_of_runs_to_an_error_and_at_a_time():
    fine = HenonHeiles().run(tolerance=1e-10, until=30.0, events=[Plane([1.0, 0.0])], **START)
    coarse = HenonHeiles().run(h=0.01, steps=3000, rule="gauss_8", events=[Plane([1.0, 0.0])], **START)
    assert fine.events[0].t == pytest.approx(coarse.events[0].t, abs=1e-9)
    run = OSCILLATOR.run(h=0.1, steps=50, q=[1.0], v=[0.0], t=3.0, events=[lambda t, q, v: t - 5.55])
    assert run.events[0].t == pytest.approx([5.55], abs=1e-12)


def found_alike(system, built_in, callable_, **at):
    """The events that a function of this module and a callable of the same value find."""
    one, other = system.run(events=[built_in, callable_], **at).events
    assert len(one) > 2 and one.t == pytest.approx(other.t, abs=1e-12) and one.q == pytest.approx(other.q, abs=1e-12)
    return one


@pytest.mark.parametrize("rule", ["midpoint", "gauss_4"])
def test_functions_without_python_are_those_that_they_say(rule):
    pendulum = DoublePendulum([1.0, 0.7], [1.0, 0.8], 9.81, [0.05, 0.03])
    at = {"h": 0.02, "until": 6.0, "q": [2.0, 1.0], "v": [0.0, 0.0], "rule": rule}
    found_alike(pendulum, Sphere([0.5, 0.0], 1.2), lambda t, q, v: (q[0] - 0.5) ** 2 + q[1] ** 2 - 1.44, **at)
    energy = pendulum.energy(q=[2.0, 1.0], v=[0, 0]) - 2.0
    found = pendulum.run(events=Energy(energy, direction=-1, terminal=True), **at)
    assert found.energy[-1] == pytest.approx(energy, abs=1e-12) and 0 < found.t[-1] < 6.0
    heights = lambda t, q, v: math.cos(q[0]) + 0.8 * math.cos(q[1])
    found_alike(pendulum, Event(0), heights, **at)
    in_line = found_alike(pendulum, Event(1), lambda t, q, v: math.sin(q[1] - q[0]), **at)
    assert np.sin(in_line.q[:, 1] - in_line.q[:, 0]) == pytest.approx(0.0, abs=1e-12)
    assert DoublePendulum.EVENTS == 2 and Ring.EVENTS == 0
    # Fields are read, and the time.
    short = DoublePendulum([1.0, 0.7], [0.3, 0.8], 9.81, [0.05, 0.03])
    assert len(short.run(events=Event(0), **at).events[0]) != len(pendulum.run(events=Event(0), **at).events[0])
    shaken = ShakenOscillator(m=1.3, k=2.0, r=0.1, a=0.5, omega=1.7)
    run = shaken.run(h=0.1, until=40.0, t=3.0, q=[1.0], v=[0.0], events=Event())
    period = 2 * math.pi / 1.7
    assert run.events[0].t == pytest.approx(period * np.arange(1, 11), abs=1e-12)


def test_members_end_by_functions_of_their_block(tmp_path):
    pendulum = DoublePendulum([1.0, 0.7], [1.0, 0.8], 9.81, [0.0, 0.0])
    q = np.random.default_rng(5).uniform(1.0, 2.0, (20, 2))
    lengths = np.column_stack([np.linspace(0.5, 1.5, 20), np.full(20, 0.8)])
    at = {"h": 0.02, "until": 4.0, "events": [Event(0, terminal=True), Energy(0.0)]}
    ends = pendulum.ensemble(q=q, v=[0, 0], fields={"l": lengths}, **at)
    for k in range(20):
        run = DoublePendulum([1.0, 0.7], lengths[k], 9.81, [0.0, 0.0]).run(q=q[k], v=[0, 0], **at)
        assert np.array_equal(ends.q[k], run.q[-1]) and ends.t[k] == run.t[-1]
    assert 5 < len(ends.events[0]) and (ends.t < 4.0).sum() == len(ends.events[0])
    parts = pendulum.ensemble(q=q, v=[0, 0], fields={"l": lengths}, folder=tmp_path, **at)
    assert parts.written == 1 and pendulum.ensemble(q=q, v=[0, 0], fields={"l": lengths}, folder=tmp_path, **at).found == 1
    for other in ([Event(1, terminal=True), Energy(0.0)], [Event(0, terminal=True), Energy(1.0)]):
        with pytest.raises(ValueError, match="another study's"):
            pendulum.ensemble(q=q, v=[0, 0], fields={"l": lengths}, folder=tmp_path, **at | {"events": other})


def test_what_an_event_function_raises_comes_out():
    def broken(t, q, v):
        if t > 3:
            raise KeyError("broken")
        return 1.0

    with pytest.raises(KeyError, match="broken"):
        Ring(0.0).run(h=0.1, steps=100, q=[0, 1], v=[0.3, 0.1], events=[broken])
    with pytest.raises(EventError, match="event function 0 is NaN"):
        Ring(0.0).run(h=0.1, steps=100, q=[0, 1], v=[0.3, 0.1], events=[lambda t, q, v: math.nan if t > 1 else 1.0])


@pytest.mark.parametrize(
    ("kind", "says", "arguments"),
    [
        (TypeError, "expected Plane, .* or functions", {"events": [1.0]}),
        (ValueError, r"events: q: expected the shape \(2,\), got \(1,\)", {"events": [Plane([1.0])]}),
        (ValueError, "at most 8 functions, got 9", {"events": [Plane([1.0, 0.0])] * 9}),
        (ValueError, "Ring states 0 event functions, there is none with the index 0", {"events": Event()}),
        (ValueError, r"events: center: expected the shape \(2,\)", {"events": Sphere([0.0], 1.0)}),
        (ValueError, "without derivatives", {"events": [Plane([1.0, 0.0])], "derivatives": True}),
    ],
)
def test_what_does_not_fit_is_said(kind, says, arguments):
    with pytest.raises(kind, match=says):
        Ring(0.0).run(**({"h": 0.1, "steps": 5, "q": [0, 1], "v": [0, 0]} | arguments))
