"""Systems with constraints: starts on them, runs, reactions, and what they are not asked."""

import pickle

import numpy as np
import pytest
from dalembert_scenes import Plane, Ring, SphericalPendulum, StepError
from test_run import of_rust

M, LENGTH, GRAVITY, DRAG = 1.3, 0.7, 9.81, 0.4
OFF = {"q": [0.0, 0.3, -0.4], "v": [0.5, 1.0, 1.0]}


@pytest.fixture
def bob():
    return SphericalPendulum(M, LENGTH, GRAVITY, DRAG)


@pytest.fixture
def start(bob):
    q, v = bob.nearest(**OFF)
    return {"q": q, "v": v}


def tension(run, mass=M):
    """λ of the motion: m q'' along the rod is −m v²/l."""
    along = run.q / LENGTH
    return mass * GRAVITY * along[:, 2] - mass * (run.v**2).sum(axis=1) / LENGTH


def test_classes_know_their_constraints(bob):
    assert SphericalPendulum.CONSTRAINTS == 1 and Ring.CONSTRAINTS == 0
    assert SphericalPendulum.RULES == ("midpoint", "trapezoidal")


def test_the_nearest_state_is_on_the_ray_from_the_origin(bob, start):
    # Of (1, 1) what is across (0.6, −0.8).
    assert start["q"] == pytest.approx([0.0, 0.42, -0.56], abs=1e-15)
    assert start["v"] == pytest.approx([0.5, 1.12, 0.84], abs=1e-15)
    many = {name: np.broadcast_to(OFF[name], (2, 5, 3)) * np.linspace(0.5, 1.5, 5)[:, None] for name in OFF}
    q, v = bob.nearest(**many)
    assert q.shape == v.shape == (2, 5, 3)
    assert q == pytest.approx(np.broadcast_to(start["q"], q.shape), abs=1e-15)
    assert v[1, 0] == pytest.approx(0.5 * start["v"], abs=1e-15)
    with pytest.raises(ValueError, match=r"v: expected the shape of q, \(3\), got \(2,\)"):
        bob.nearest(q=OFF["q"], v=[0.0, 1.0])
    with pytest.raises(TypeError, match="does not take the time"):
        bob.nearest(t=0.0, **OFF)
    with pytest.raises(TypeError, match="Ring has no constraints"):
        Ring(k=1e-3).nearest(q=[0, 1], v=[0, 0])


def test_a_run_on_constraints_is_that_of_rust_bit_by_bit(bob, start, reference):
    run = bob.run(h=0.01, steps=200, reactions=True, **start)
    records = np.column_stack([run.t, run.q, run.v, run.p, run.energy])
    assert np.array_equal(records.view(np.uint64), of_rust(reference, "spherical").view(np.uint64))
    lambdas = of_rust(reference, "spherical_reactions")
    assert np.array_equal(run.reactions[1:].view(np.uint64), lambdas.view(np.uint64))
    assert run.reactions[0] == run.reactions[1]
    other = bob.run(h=0.010001, steps=200, reactions=True, **start)
    assert not np.array_equal(other.reactions[1:], lambdas)
    # With or without them, by the step or every seventh.
    plain = bob.run(h=0.01, steps=200, **start)
    assert plain.reactions is None and plain.q == pytest.approx(run.q, abs=1e-13)
    assert np.linalg.norm(plain.q, axis=1) == pytest.approx(np.full(201, LENGTH), abs=2e-15)
    some = bob.run(h=0.01, steps=200, every=7, reactions=True, derivatives=True, **start)
    assert some.reactions[1:-1] == pytest.approx(run.reactions[7:200:7], abs=1e-12)
    assert some.by_start.shape == (30, 6, 6) and some.by_parameters.shape == (30, 6, 3)
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again.reactions, run.reactions)


@pytest.mark.parametrize("rule", SphericalPendulum.RULES)
def test_reactions_are_those_of_the_motion(bob, start, rule):
    # λ of a step is that at its beginning, to first order.
    off = []
    for steps in (500, 1000):
        run = bob.run(h=1.0 / steps, steps=steps, reactions=True, rule=rule, **start)
        off.append(np.abs(run.reactions[1:, 0] - tension(run)[:-1]).max())
    assert off[1] < 0.02 and off[0] / off[1] == pytest.approx(2.0, rel=0.05)
    # Control: a hundredth of the mass is seen.
    assert np.abs(run.reactions[1:, 0] - tension(run, mass=1.01 * M)[:-1]).max() > 0.1
    hanging = bob.run(h=0.01, steps=3, reactions=True, q=[0, 0, -LENGTH], v=[0, 0, 0])
    assert hanging.reactions == pytest.approx(np.full((4, 1), -M * GRAVITY), abs=1e-12)


def test_derivatives_are_those_of_differences(bob, start):
    at = {"h": 0.05, "q": start["q"]}
    p = M * start["v"]
    step = bob.linearization(p=p, **at)

    def end(q, p, length=LENGTH):
        # The step that is extended to states off the constraints by the nearest.
        moved = SphericalPendulum(M, length, GRAVITY, DRAG)
        q, v = moved.nearest(q=q, v=p / M)
        run = moved.run(h=0.05, steps=1, q=q, v=v)
        return np.concatenate([run.q[-1], run.p[-1]])

    d = 1e-5
    for k, e in enumerate(np.eye(6)):
        up, down = (end(start["q"] + s * d * e[:3], p + s * d * e[3:]) for s in (1, -1))
        assert step.a[:, k] == pytest.approx((up - down) / (2 * d), abs=1e-7)
    up, down = (end(start["q"], p, LENGTH + s * d) for s in (1, -1))
    assert step.by_parameters[:, 1] == pytest.approx((up - down) / (2 * d), abs=1e-6)
    assert np.abs(step.a).max() > 0.5 and np.abs(step.by_parameters[:, 1]).max() > 0.5


def test_states_off_the_constraints_are_refused_with_their_data(bob, start):
    for motion in ({"v": start["v"]}, {"p": M * start["v"]}):
        with pytest.raises(StepError, match="off constraint 0 by -2.000e-1; `nearest` gives") as raised:
            bob.run(h=0.01, steps=10, q=OFF["q"], **motion)
        assert raised.value.kind == "OffConstraint"
        assert raised.value.data == {"constraint": 0, "value": pytest.approx(-0.2)}
    with pytest.raises(StepError, match="leads off constraint 0") as raised:
        bob.linearization(h=0.01, q=start["q"], v=[0.0, 1.0, 0.0])
    assert raised.value.kind == "LeavesConstraint"
    assert raised.value.data == {"constraint": 0, "rate": pytest.approx(0.6)}
    ends = bob.ensemble(h=0.01, steps=10, q=np.array([start["q"], OFF["q"], start["q"]]), v=start["v"])
    assert [failure.kind for failure in ends.failures.values()] == ["OffConstraint"] and list(ends.failures) == [1]
    assert np.array_equal(ends.q[2], bob.run(h=0.01, steps=10, **start).q[-1])


def test_where_no_state_is_in_reach_nothing_is_made_up(bob):
    # At the origin no direction leads to the sphere; one of no length has no gradient where it is.
    for system, q in ((bob, [0.0] * 3), (SphericalPendulum(M, 0.0, GRAVITY, DRAG), OFF["q"])):
        with pytest.raises(StepError) as raised:
            system.nearest(q=q, v=OFF["v"])
        assert raised.value.kind == "NoDerivative" and list(raised.value.q) == q
        assert raised.value.data["function"] == "constraint 0"


def test_an_error_can_be_asked_for_on_constraints(bob, start):
    ends = [bob.run(tolerance=tolerance, until=1.0, **start).q[-1] for tolerance in (1e-6, 1e-9)]
    assert max(abs(ends[0] - ends[1])) < 1.1e-6
    assert abs(sum(ends[1] ** 2) ** 0.5 - 0.7) < 1e-14


def test_what_constraints_do_not_have_is_refused_by_name(bob, start):
    with pytest.raises(ValueError, match="rule: expected one of midpoint, trapezoidal, got blanes_moan_4"):
        bob.run(h=0.01, steps=1, rule="blanes_moan_4", **start)
    with pytest.raises(ValueError, match="events and times: .* without derivatives and reactions"):
        bob.run(h=0.01, steps=10, reactions=True, events=[Plane(q=[1, 0, 0])], **start)
    with pytest.raises(TypeError, match="Ring has no constraints"):
        Ring(k=1e-3).run(h=0.1, steps=1, q=[0, 1], v=[0, 0], reactions=True)


def test_symmetries_are_those_of_the_sphere(bob):
    box = {"h": 0.05, "low": [-1] * 3, "high": [1] * 3, "reach": [0.1] * 3}
    free = SphericalPendulum(M, LENGTH, GRAVITY, 0.0)
    for system, rule in ((bob, "midpoint"), (free, "midpoint"), (free, "trapezoidal")):
        reports = {report.generator: report for report in system.symmetries(rule=rule, **box)}
        # No translation stays on a sphere.
        assert list(reports) == ["rotation(0, 1)", "rotation(0, 2)", "rotation(1, 2)"]
        assert all(report.is_consistent for report in reports.values())
        vertical, level = reports["rotation(0, 1)"], reports["rotation(1, 2)"]
        assert vertical.is_symmetry_of_lagrangian and not level.is_symmetry_of_lagrangian
        assert vertical.force_does_work == (system is bob) and vertical.is_conserved == (system is free)
    along, turn = (np.zeros((3, 3)), [0, 1, 0]), (np.array([[0, -1, 0], [1, 0, 0], [0, 0, 0]]), np.zeros(3))
    (report,) = free.symmetries(generators={"turn": turn}, **box)
    assert report.is_conserved
    with pytest.raises(ValueError, match="generator 1 leaves the constraints at sample 0"):
        free.symmetries(generators={"turn": turn, "along y": along}, **box)


def test_energy_and_events_are_those_of_any_run(bob, start):
    ledger = bob.energy_ledger(h=0.01, steps=100, **start)
    run = bob.run(h=0.01, steps=100, events=[Plane(q=[0, 1, 0])], **start)
    assert ledger.change == pytest.approx(run.energy[-1] - run.energy[0], abs=1e-13)
    # Friction took ∫ c v² dt, to second order.
    assert ledger.dissipated == pytest.approx(np.trapezoid(DRAG * (run.v**2).sum(axis=1), run.t), rel=1e-3)
    assert abs(ledger.remainder) < 1e-3 * ledger.dissipated
    (crossings,) = run.events
    assert len(crossings) == 1 and crossings.q[0, 1] == pytest.approx(0.0, abs=1e-14)
    assert np.linalg.norm(crossings.q[0]) == pytest.approx(LENGTH, abs=1e-15)
