"""Reports of the checkers: what they say of systems whose symmetries and friction are known."""

import numpy as np
import pytest
from dalembert_scenes import CartPole, DoublePendulum, HenonHeiles, Ring

BOX = {"low": [-1, -1], "high": [1, 1], "reach": [0.1, 0.1]}


@pytest.mark.parametrize("rule", ["midpoint", "trapezoidal"])
def test_the_ring_is_symmetric_under_rotations_alone(rule):
    reports = {report.generator: report for report in Ring(k=0.0).symmetries(h=0.1, rule=rule, **BOX)}
    assert set(reports) == {"translation(0)", "translation(1)", "rotation(0, 1)"}
    rotation = reports["rotation(0, 1)"]
    assert rotation.is_conserved and rotation.is_symmetry_of_lagrangian and not rotation.force_does_work
    assert not reports["translation(0)"].is_conserved and not reports["translation(1)"].is_symmetry_of_lagrangian
    value, zero = rotation.defect
    assert abs(value) <= zero < 1e-10
    assert "J is conserved" in repr(rotation) and str(rotation) == rotation.text


def test_drag_does_work_along_a_rotation():
    rotation = Ring(k=0.1).symmetries(h=0.1, **BOX)[-1]
    assert rotation.is_symmetry_of_lagrangian and rotation.force_does_work and not rotation.is_conserved
    assert rotation.is_consistent


def test_generators_of_ones_own():
    # The cart may stand anywhere; its rail has friction or none.
    shift = {"along the rail": (np.zeros((2, 2)), [1.0, 0.0])}
    for friction, kept in ((0.0, True), (0.1, False)):
        cart = CartPole(1.0, 0.1, 0.25, [friction, 0.01])
        (report,) = cart.symmetries(h=0.01, generators=shift, u=[0.0], **BOX)
        assert report.generator == "along the rail" and report.is_symmetry_of_lagrangian and report.is_conserved == kept
    turned = {"both arms": ([[0, 0], [0, 0]], [1, 1])}
    (report,) = DoublePendulum([1, 1], [1, 1], 0.0, [0, 0.1]).symmetries(h=0.01, generators=turned, **BOX)
    assert report.is_conserved


def test_samples_that_prove_nothing_are_refused():
    with pytest.raises(ValueError, match="samples"):
        Ring(0.0).symmetries(h=0.1, low=[0, 0], high=[1, 1], reach=[0, 0])
    with pytest.raises(ValueError, match="midpoint, trapezoidal"):
        Ring(0.0).symmetries(h=0.1, rule="gauss_4", **BOX)


def test_the_ledger_adds_up():
    ring, at = Ring(k=0.05), {"h": 0.1, "steps": 500, "q": [0.0, 1.1], "v": [0.5, 0.0]}
    ledger, run = ring.energy_ledger(**at), ring.run(**at)
    assert ledger.change == pytest.approx(run.energy[-1] - run.energy[0], abs=1e-13)
    assert ledger.remainder == pytest.approx(ledger.change + ledger.dissipated - ledger.work, abs=1e-13)
    # By the rule's own quadrature: h k |v̄|².
    mean = np.diff(run.q, axis=0) / 0.1
    assert ledger.dissipated == pytest.approx(0.1 * 0.05 * (mean**2).sum(), rel=1e-12) and ledger.work == 0.0
    assert 0 < ledger.largest_remainder < 1e-2 and "friction took" in repr(ledger)
    free = HenonHeiles().energy_ledger(h=0.1, steps=10, q=[0.1, 0.0], v=[0, 0.1])
    assert free.dissipated == 0.0
