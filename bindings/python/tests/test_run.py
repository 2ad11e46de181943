"""Runs: their bits, their arrays, their errors."""

import copy
import math
import pickle
import sys
import warnings

import dalembert_scenes
import numpy as np
import pytest
from dalembert_scenes import (
    BreachWarning,
    CartPole,
    DoublePendulum,
    HenonHeiles,
    Plane,
    Ring,
    ShakenOscillator,
    SphericalPendulum,
    StepError,
    ToleranceError,
)

START = {"q": [0.0, 1.15549918674982], "v": [0.5, 0.0]}


@pytest.fixture
def ring():
    return Ring(k=1e-3)


@pytest.fixture
def pendulum():
    return DoublePendulum(m=[1.0, 0.7], l=[1.0, 0.8], g=9.81, c=[0.05, 0.03])


def of_rust(reference, name):
    """The records of a run that the program in Rust printed, bit by bit."""
    return np.array(
        [[np.array(int(bits, 16), np.uint64).view(np.float64) for bits in line] for line in reference[name]]
    )


@pytest.mark.parametrize("rule", Ring.RULES)
def test_a_run_is_that_of_rust_bit_by_bit(ring, reference, rule):
    run = ring.run(h=0.2, steps=1000, every=7, rule=rule, **START)
    records = np.column_stack([run.t, run.q, run.v, run.p, run.energy])
    assert np.array_equal(records.view(np.uint64), of_rust(reference, rule).view(np.uint64))
    other = ring.run(h=0.2000001, steps=1000, every=7, rule=rule, **START)
    assert not np.array_equal(other.q[1:], run.q[1:])


def test_runs_of_other_kinds_are_those_of_rust(ring, reference):
    run = ring.run(tolerance=1e-9, until=50.0, every=3, **START)
    records = np.column_stack([run.t, run.q, run.v, run.p, run.energy])
    assert np.array_equal(records.view(np.uint64), of_rust(reference, "to_error").view(np.uint64))
    shaken = ShakenOscillator(m=1.3, k=2.0, r=0.1, a=0.5, omega=1.7)
    run = shaken.run(h=0.1, steps=200, q=[1.0], v=[0.0], t=3.0)
    records = np.column_stack([run.t, run.q, run.v, run.p, run.energy])
    assert np.array_equal(records.view(np.uint64), of_rust(reference, "shaken").view(np.uint64))
    inputs = np.sin(0.1 * np.arange(200.0))[:, None]
    run = CartPole(1.0, 0.1, 0.25, [0.1, 0.002]).run(h=0.01, steps=200, q=[0, 0.1], v=[0, 0], u=inputs)
    records = np.column_stack([run.t, run.q, run.v, run.p, run.energy])
    assert np.array_equal(records.view(np.uint64), of_rust(reference, "driven").view(np.uint64))


def test_arrays_are_contiguous_and_of_the_shapes_said(ring):
    run = ring.run(h=0.1, steps=10, every=3, **START)
    # Start, 3, 6, 9 and the last one.
    assert len(run) == 5 and np.allclose(run.t, [0.0, 0.3, 0.6, 0.9, 1.0])
    for array, shape in [(run.t, (5,)), (run.q, (5, 2)), (run.v, (5, 2)), (run.p, (5, 2)), (run.energy, (5,))]:
        assert array.dtype == np.float64 and array.shape == shape
        assert array.flags.c_contiguous and array.flags.writeable
    assert run.by_start is None and run.by_parameters is None and run.expected is None
    assert ring.run(h=-0.1, steps=10, q=run.q[-1], p=run.p[-1]).q[-1] == pytest.approx(START["q"], abs=1e-13)


def test_energy_is_that_of_the_formula(ring):
    run = ring.run(h=0.1, steps=100, **START)
    s = (run.q**2).sum(axis=1)
    expected = 0.5 * (run.v**2).sum(axis=1) + s * (s - 1) ** 2
    assert run.energy == pytest.approx(expected, abs=1e-14)
    assert np.array_equal(ring.energy(q=run.q, v=run.v), run.energy)
    assert ring.energy(q=run.q, p=run.p) == pytest.approx(expected, abs=1e-14)
    assert isinstance(ring.energy(**START), float) and ring.energy(**START) == pytest.approx(0.275)
    assert ring.energy(q=np.zeros((3, 4, 2)), v=np.zeros((3, 4, 2))).shape == (3, 4)


def test_energy_is_asked_at_the_time_of_the_states(ring):
    shaken = ShakenOscillator(m=1.3, k=2.0, r=0.1, a=0.5, omega=1.7)
    run = shaken.run(h=0.1, steps=50, q=[0.3], v=[0.0], t=3.0)
    states = {"q": run.q, "v": run.v}
    assert np.array_equal(shaken.energy(t=run.t, **states), run.energy)
    assert shaken.energy(q=run.q[7], p=run.p[7], t=run.t[7]) == run.energy[7]
    at_one_time = shaken.energy(t=3.0, **states)
    assert at_one_time.shape == run.t.shape and at_one_time[0] == run.energy[0]
    with pytest.raises(TypeError, match="ShakenOscillator takes the time: give t"):
        shaken.energy(**states)
    for given in (1.0, run.t):
        with pytest.raises(TypeError, match="Ring does not take the time: leave t out"):
            ring.energy(t=given, **START)
    with pytest.raises(ValueError, match="t: expected the shape one for all, or one for each state"):
        shaken.energy(t=run.t[1:], **states)
    with pytest.raises(ValueError, match="finite time"):
        shaken.energy(t=np.nan, **states)


@pytest.mark.parametrize("rule", ["midpoint", "gauss_4"])
def test_derivatives_are_those_of_differences(pendulum, rule):
    start, h, steps = np.array([0.7, -0.4, 0.3, 0.2]), 0.05, 40

    def end(state, c):
        moved = DoublePendulum(pendulum.m, pendulum.l, pendulum.g, c)
        run = moved.run(h=h, steps=steps, q=state[:2], p=state[2:], rule=rule)
        return np.concatenate([run.q[-1], run.p[-1]])

    c = np.array(pendulum.c)
    run = pendulum.run(h=h, steps=steps, q=start[:2], p=start[2:], rule=rule, derivatives=True, every=steps)
    d = 1e-6
    by_start = [(end(start + d * e, c) - end(start - d * e, c)) / (2 * d) for e in np.eye(4)]
    by_c = [(end(start, c + d * e) - end(start, c - d * e)) / (2 * d) for e in np.eye(2)]
    assert run.by_start.shape == (2, 4, 4) and run.by_parameters.shape == (2, 4, 2)
    assert np.array_equal(run.by_start[0], np.eye(4)) and not run.by_parameters[0].any()
    scale = np.abs(run.by_start[-1]).max()
    assert run.by_start[-1] == pytest.approx(np.column_stack(by_start), abs=1e-7 * scale)
    assert run.by_parameters[-1] == pytest.approx(np.column_stack(by_c), abs=1e-7 * scale)


@pytest.mark.parametrize("rule", ["midpoint", "blanes_moan_6"])
def test_a_linearised_step_has_the_determinant_of_its_friction(ring, rule):
    step = ring.linearization(h=0.1, rule=rule, **START)
    # Phase volume: the splitting's is exact, e^{−2hk}; the midpoint rule's is that to O(h³).
    assert np.linalg.det(step.a) == pytest.approx(np.exp(-2 * 0.1 * 1e-3), abs=1e-13 if rule != "midpoint" else 1e-5)
    run = ring.run(h=0.1, steps=1, rule=rule, **START)
    assert step.q == pytest.approx(run.q[-1], abs=1e-15) and step.p == pytest.approx(run.p[-1], abs=1e-15)
    assert step.b is None and step.by_parameters is None


def test_the_derivative_by_an_input_is_that_of_differences():
    cart = CartPole(1.0, 0.1, 0.25, [0.1, 0.002])
    at = {"h": 0.01, "q": [0.0, 0.3], "v": [0.1, -0.2]}
    step = cart.linearization(u=[0.5], **at)
    ends = [cart.run(steps=1, u=[0.5 + d], **at) for d in (1e-4, -1e-4)]
    difference = [np.concatenate([end.q[-1], end.p[-1]]) for end in ends]
    assert step.b[:, 0] == pytest.approx((difference[0] - difference[1]) / 2e-4, rel=1e-8, abs=1e-12)


def test_a_run_to_an_error_keeps_it_or_says_so(ring):
    run = ring.run(tolerance=1e-8, until=20.0, every=10**9, **START)
    exact = ring.run(h=0.01, steps=2000, every=2000, rule="gauss_8", **START)
    assert run.t[-1] == pytest.approx(20.0) and run.breach is None and run.expected <= 1e-8
    assert np.abs(run.q[-1] - exact.q[-1]).max() < 1e-8
    assert "order" in run.rule and run.h > 0
    with pytest.raises(ToleranceError, match="reach"):
        ring.run(tolerance=1e-30, until=20.0, **START)


def test_an_error_that_was_passed_is_warned_of():
    # Chaos: errors grow by more than the start shows.
    star = HenonHeiles()
    at = {"q": [0.0, -0.25], "v": [0.42, 0.0]}
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        run = star.run(tolerance=1e-6, until=1000.0, every=10**9, **at)
    assert (run.breach is not None) == any(issubclass(one.category, BreachWarning) for one in seen)
    assert run.breach is not None and run.breach.tolerance == 1e-6 and run.breach.instead < 1e-6
    assert run.breach.expected > 1e-6 and 0 < run.breach.t < 1000


def test_a_run_ends_at_its_time_as_that_of_rust_does(ring, reference):
    run = ring.run(h=0.2, until=1.5, **START)
    records = np.column_stack([run.t, run.q, run.v, run.p, run.energy])
    assert np.array_equal(records.view(np.uint64), of_rust(reference, "until").view(np.uint64))
    assert run.t[-1] == 1.5 and run.steps == 8
    # A multiple of h but for rounding takes no step of its own.
    same = ring.run(h=0.1, until=0.3, **START)
    assert same.steps == 3 and same.t[-1] == 0.3 and np.array_equal(same.q, ring.run(h=0.1, steps=3, **START).q)
    back = ring.run(h=-0.2, until=-1.5, **START)
    assert back.t[-1] == -1.5 and back.steps == 8
    # The time is that of the system's clock.
    shaken = ShakenOscillator(m=1.3, k=2.0, r=0.1, a=0.5, omega=1.7)
    for given in ({"h": 0.1}, {"tolerance": 1e-9}):
        assert shaken.run(until=4.25, t=3.0, q=[1.0], v=[0.0], **given).t[-1] == pytest.approx(4.25, abs=1e-15)
    with pytest.raises(ToleranceError, match="Allow more by `max_steps`"):
        ring.run(tolerance=1e-9, until=1000.0, max_steps=10, **START)


@pytest.mark.parametrize("rule", ["midpoint", "gauss_4", "gauss_8", "blanes_moan_6"])
def test_dense_output_is_the_state_of_a_shorter_last_step(ring, reference, rule):
    times = [0.0, 0.05, 0.4, 0.41, 0.41, 1.1]
    run = ring.run(h=0.2, times=times, rule=rule, **START)
    assert np.array_equal(run.t, times) and run.steps == 6
    for k, time in enumerate(times[1:], 1):
        alone = ring.run(h=0.2, until=time, rule=rule, **START)
        assert run.q[k] == pytest.approx(alone.q[-1], abs=1e-14) and run.p[k] == pytest.approx(alone.p[-1], abs=1e-14)
        assert run.energy[k] == pytest.approx(alone.energy[-1], abs=1e-14)
    assert np.array_equal(run.q[0], START["q"])
    if rule == "midpoint":
        records = np.column_stack([run.t, run.q, run.v, run.p, run.energy])
        assert np.array_equal(records.view(np.uint64), of_rust(reference, "times").view(np.uint64))


def test_dense_output_keeps_the_tolerance_and_ends_with_events(ring):
    times = np.linspace(0.0, 20.0, 333)
    exact = ring.run(h=0.005, times=times, rule="gauss_8", **START)
    run = ring.run(tolerance=1e-8, times=times, **START)
    assert np.abs(run.q - exact.q).max() < 1e-8 and run.h > times[1] and run.expected < 1e-8
    # Control: a straight line between the steps is far away.
    coarse = ring.run(tolerance=1e-8, until=20.0, **START)
    between = np.column_stack([np.interp(times, coarse.t, q) for q in coarse.q.T])
    assert np.abs(between - exact.q).max() > 1e-3
    # Up to a terminal event, which may come before the last time.
    stop = Plane([1.0, 0.0], value=0.2, terminal=True)
    ended = ring.run(tolerance=1e-8, times=times, events=stop, **START)
    end = ended.events[0].t[0]
    assert np.array_equal(ended.t, times[times <= end]) and np.array_equal(ended.q, run.q[: len(ended)])
    back = ring.run(h=-0.2, times=-times, **START)
    assert np.array_equal(back.t, -times)
    shaken = ShakenOscillator(m=1.3, k=2.0, r=0.1, a=0.5, omega=1.7)
    late = shaken.run(h=0.1, until=1e6 + 1.0, t=1e6, times=[1e6, 1e6 + 0.1, 1e6 + 1.0], q=[1.0], v=[0.0])
    assert len(late) == 3 and np.array_equal(late.q[[0, -1]], shaken.run(h=0.1, until=1e6 + 1.0, t=1e6, q=[1.0], v=[0.0]).q[[0, -1]])


def test_a_run_hands_its_records_to_other_packages(ring, monkeypatch):
    bob = SphericalPendulum(m=1.3, l=0.7, g=9.81, c=0.4)
    q, v = bob.nearest(q=[0, 0.3, -0.4], v=[0.5, 1, 1])
    run = bob.run(h=0.01, steps=20, q=q, v=v, reactions=True, derivatives=True)
    frame = run.to_pandas()
    assert list(frame.columns) == [*(f"{name}{i}" for name in "qvp" for i in range(3)), "energy", "reaction0"]
    assert frame.index.name == "t" and np.array_equal(frame.index, run.t) and np.array_equal(frame.q2, run.q[:, 2])
    data = run.to_xarray()
    assert np.array_equal(data.q, run.q) and data.by_start.dims == ("t", "state", "start") and data.attrs["h"] == 0.01
    assert data.energy.sel(t=run.t[7]) == run.energy[7] and data.reactions.shape == (21, 1)
    figure = run.plot()
    above, below = figure.axes
    assert np.array_equal(above.lines[2].get_ydata(), run.q[:, 2]) and below.get_xlabel() == "t"
    shown = repr(run).splitlines()
    assert shown[0] == f"Run: 20 steps of 0.01 by midpoint, {run.iterations} iterations"
    assert "  t              (21,)  0 to 0.2" in shown and "  by_start       (21, 6, 6)" in shown
    for package in ("pandas", "xarray", "matplotlib.pyplot"):
        monkeypatch.setitem(sys.modules, package, None)
    for method in (run.to_pandas, run.to_xarray, run.plot):
        with pytest.raises(ImportError, match="pandas|xarray|matplotlib"):
            method()


def test_a_module_says_what_it_is():
    assert dalembert_scenes.__version__.count(".") == 2
    assert "SphericalPendulum" in dalembert_scenes.__doc__ and "NumPy" in dalembert_scenes.__doc__


def test_a_failed_step_has_the_data_of_its_error(ring):
    with pytest.raises(StepError, match="step 0.*no|derivative|singular|NaN") as raised:
        ring.run(h=1e200, steps=5, q=[1.0, 0.0], v=[0.0, 1.0])
    error = raised.value
    assert error.kind in ("Overflow", "NonFinite", "NoRealSolution", "SingularNewtonMatrix")
    assert error.step == 0 and error.t == 0.0 and list(error.q) == [1.0, 0.0] and list(error.p) == [0.0, 1.0]
    assert error.partial["q"].shape == (1, 2)
    again = pickle.loads(pickle.dumps(error))
    assert again.kind == error.kind and again.data == error.data and str(again) == str(error)
    with pytest.raises(ArithmeticError):
        ring.linearization(h=1e200, **START)


def test_a_run_that_fails_late_leaves_what_it_had():
    # Beyond the energy of escape the star falls down the potential, ever faster.
    with pytest.raises(StepError) as raised:
        HenonHeiles().run(h=0.1, steps=10_000, q=[0.0, 1.0], v=[0.0, 1.0], rule="trapezoidal")
    error = raised.value
    assert error.step > 10 and len(error.partial["t"]) == error.step + 1
    assert np.array_equal(error.partial["q"][-1], error.q) and error.t == pytest.approx(0.1 * error.step)


@pytest.mark.parametrize(
    ("kind", "says", "arguments"),
    [
        (ValueError, r"q: expected the shape \(2,\), got \(3,\)", {"q": [0, 1, 2]}),
        (ValueError, r"v: expected the shape \(2,\), got \(1, 2\)", {"v": [[0, 1]]}),
        (TypeError, r"q: expected numbers of dtype float64, .* got complex128", {"q": [0, 1j]}),
        (TypeError, r"q: expected numbers of dtype float64, .* got <U1", {"q": ["0", "1"]}),
        (ValueError, "q: expected finite numbers, got NaN at index 1", {"q": [0, math.nan]}),
        (ValueError, "q: expected rows of numbers, of one length", {"q": [[0], [1, 2]]}),
        (TypeError, r"q: expected numbers, got None \(NoneType\)", {"q": None}),
        (TypeError, "v and p: give one of them", {"p": [0.0, 0.0]}),
        (TypeError, "v or p has to be given beside q", {"v": None}),
        (TypeError, "takes no input u", {"u": [0.0]}),
        (TypeError, "does not take the time", {"t": 1.0}),
        (TypeError, "h and tolerance: give one of them", {"tolerance": 1e-9}),
        (TypeError, "h or tolerance has to be given", {"h": None}),
        (TypeError, "steps, until .* has to be given beside h", {"steps": None}),
        (TypeError, "steps: to a tolerance .* is chosen", {"h": None, "tolerance": 1e-9, "until": 1.0}),
        (TypeError, "until .* has to be given beside tolerance", {"h": None, "steps": None, "tolerance": 1e-9}),
        (TypeError, "steps and until: with h give one of them", {"until": 1.0}),
        (ValueError, "h: expected a finite step size other than 0, got 0", {"h": 0}),
        (TypeError, r"h: expected a number, got '0.1' \(str\)", {"h": "0.1"}),
        (ValueError, "until: .* goes forwards; expected a time after that, got -1", {"steps": None, "until": -1}),
        (ValueError, "until: .* goes backwards, as h < 0", {"h": -0.1, "steps": None, "until": 1}),
        (ValueError, "until: expected a finite time, got inf", {"steps": None, "until": math.inf}),
        (ValueError, "tolerance: expected a number above 0", {"h": None, "steps": None, "tolerance": 0, "until": 1}),
        (ValueError, "max_steps: the run takes 5 steps, more than 4", {"max_steps": 4}),
        (ValueError, "steps: expected a whole number from 0 .*, got -3", {"steps": -3}),
        (TypeError, r"steps: expected a whole number, got 2.5 \(float\)", {"steps": 2.5}),
        (ValueError, "every: expected a whole number from 1", {"every": 0}),
        (TypeError, "times and every: give one of them", {"times": [0.1], "every": 1}),
        (ValueError, "times: expected them in the order of the run, got 0.1 after 0.2", {"times": [0.2, 0.1]}),
        (ValueError, "times: the run ends at t = 0.5, before 0.6", {"times": [0.6]}),
        (ValueError, "times: .* expected a time after that, got -0.1", {"times": [-0.1]}),
        (ValueError, r"times: expected the shape \(records,\), got \(\)", {"times": 0.1}),
        (ValueError, "events and times: .* without derivatives", {"times": [0.1], "derivatives": True}),
        (ValueError, "until: .* whole steps; .* h = 0.1375 fits", {"steps": None, "until": 0.55, "h": 0.14, "derivatives": True}),
        (TypeError, r"rule: expected a text, got 4 \(int\)", {"rule": 4}),
        (TypeError, "progress: expected a function", {"progress": 1}),
        (ValueError, "rule: expected one of midpoint, .*, got euler", {"rule": "euler"}),
        (ValueError, "derivatives are those of rules", {"rule": "blanes_moan_4", "derivatives": True}),
        (MemoryError, "larger `every`", {"steps": 10**15}),
    ],
)
def test_what_does_not_fit_is_said(ring, kind, says, arguments):
    with pytest.raises(kind, match=says):
        ring.run(**({"h": 0.1, "steps": 5} | START | arguments))


def test_inputs_are_asked_for():
    cart = CartPole(1.0, 0.1, 0.25, [0.1, 0.002])
    at = {"h": 0.01, "steps": 3, "q": [0, 0], "v": [0, 0]}
    with pytest.raises(TypeError, match="CartPole takes an input: give u, 1 numbers"):
        cart.run(**at)
    with pytest.raises(ValueError, match=r"u: expected the shape \(1,\) or \(3, 1\), got \(4, 1\)"):
        cart.run(u=np.zeros((4, 1)), **at)


def test_numbers_that_are_no_float64_may_be_given(ring):
    exact = ring.run(h=0.1, steps=10, q=[0.0, 1.0], v=[1.0, 0.0])
    for q in ([0, 1], (0, 1), np.array([0, 1], np.float32), np.array([[0, 9], [1, 9]])[:, 0], np.array([0, 1], np.int8)):
        assert np.array_equal(ring.run(h=0.1, steps=10, q=q, v=[1, 0]).q, exact.q)


def test_fields_are_attributes(pendulum):
    assert pendulum.g == 9.81 and np.array_equal(pendulum.m, [1.0, 0.7])
    before = pendulum.run(h=0.1, steps=5, q=[1, 0], v=[0, 0])
    pendulum.c = [0.5, 0.3]
    assert np.array_equal(pendulum.c, [0.5, 0.3])
    assert not np.array_equal(pendulum.run(h=0.1, steps=5, q=[1, 0], v=[0, 0]).q, before.q)
    with pytest.raises(ValueError, match="read-only"):
        pendulum.c[0] = 1.0
    with pytest.raises(ValueError, match=r"c: expected the shape \(2,\), got \(3,\)"):
        pendulum.c = [1, 2, 3]
    with pytest.raises(AttributeError):
        pendulum.friction = 1.0
    assert np.array_equal(pendulum.c, [0.5, 0.3])
    with pytest.raises(TypeError, match="Ring has no field drag; it has k"):
        Ring(drag=1.0)
    with pytest.raises(TypeError, match="DoublePendulum: l, c has to be given"):
        DoublePendulum(m=[1, 1], g=9.81)
    assert "Friction of the joints" in type(pendulum).c.__doc__ and "N m s" in DoublePendulum.__doc__


def test_a_system_prints_compares_and_is_pickled(pendulum):
    assert repr(Ring(k=0.5)) == "Ring(k=0.5)"
    assert eval(repr(pendulum), {"DoublePendulum": DoublePendulum}) == pendulum
    assert pickle.loads(pickle.dumps(pendulum)) == pendulum == copy.copy(pendulum)
    assert Ring(k=0.5) != Ring(k=0.6) and Ring(k=0.5) != pendulum
    assert repr(Ring(0.5).run(h=0.1, steps=2, **START)).startswith("Run: 2 steps of 0.1 by midpoint")


def test_a_class_says_what_it_is():
    assert (CartPole.COORDINATES, CartPole.INPUTS, CartPole.TAKES_TIME) == (2, 1, False)
    assert ShakenOscillator.TAKES_TIME and ShakenOscillator.PARAMETERS == ("m", "k", "r")
    assert DoublePendulum.PARAMETERS == ("c[0]", "c[1]")
    assert CartPole.RULES == ("midpoint",) and HenonHeiles.RULES[0] == "trapezoidal"
    assert Ring.STRUCTURE["separable_lagrangian"] and Ring.STRUCTURE["damping"] == "linear"
    assert not DoublePendulum.STRUCTURE["constant_mass_matrix"]
    assert {"rule": "Trapezoidal", "constant": True, "bandwidth": 0} in Ring.STRUCTURE["newton_matrices"]


def test_the_stub_is_that_of_the_module(request):
    assert (request.config.rootpath / "dalembert_scenes.pyi").read_text() == dalembert_scenes.stub()
