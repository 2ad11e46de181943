"""Members that panic, a model that was edited since its parts were written, two rods, a skate: of the package in ../trials."""

import os
import subprocess
import sys

import numpy as np
import pytest

trials = pytest.importorskip("dalembert_trials")

WRONG = [3, 17, 39]


@pytest.mark.parametrize("rule", trials.Cut.RULES)
@pytest.mark.parametrize("every", [None, 10])
@pytest.mark.parametrize("motion", ["v", "p"])
def test_members_that_panic_fail_with_their_numbers(rule, every, motion, tmp_path):
    """Where they are made, of a velocity, or in the lanes in which they are stepped, of a momentum."""
    pieces = np.arange(40) % 4 + 1
    pieces[WRONG] = 0
    q = np.linspace(0.1, 1.0, 40)[:, None]
    at = {"h": 0.1, "steps": 50, "q": q, motion: [0.0], "rule": rule, "every": every}
    ends = trials.Cut(1).ensemble(fields={"pieces": pieces}, **at)
    assert list(ends.failures) == WRONG and all(isinstance(e, RuntimeError) for e in ends.failures.values())
    for number in np.setdiff1d(np.arange(40), WRONG):
        run = trials.Cut(int(pieces[number])).run(h=0.1, steps=50, q=q[number], rule=rule, **{motion: [0.0]})
        assert np.array_equal(np.atleast_2d(ends.q[number])[-1], run.q[-1])
    parts = trials.Cut(1).ensemble(fields={"pieces": pieces}, folder=tmp_path, members_per_part=16, **at)
    assert (parts.written, parts.failed) == (3, len(WRONG))
    # Control: without them none fails.
    pieces[WRONG] = 1
    assert not trials.Cut(1).ensemble(fields={"pieces": pieces}, **at).failures


WRITE = """
import sys
import numpy as np
from dalembert_trials import Edited
folder, first = sys.argv[1], int(sys.argv[2])
at = dict(h=0.1, steps=5, q=np.linspace(0.0, 0.1, 8)[:, None], v=[0.1])
print(Edited(0.01).ensemble(**at).q.tobytes().hex())
print(Edited(0.01).ensemble(**at, folder=folder, first=first, members_per_part=4))
"""


def test_a_module_has_the_documentation_that_it_is_given():
    assert trials.__doc__ == "Systems that misbehave, for tests."


def test_an_edited_model_does_not_go_on(tmp_path, request):
    edited = request.config.getoption("edited")
    if edited is None:
        pytest.skip("there is no edited model: --edited")

    def write(first, path=None):
        environment = os.environ | ({} if path is None else {"PYTHONPATH": str(path)})
        command = [sys.executable, "-c", WRITE, str(tmp_path), str(first)]
        ran = subprocess.run(command, env=environment, capture_output=True, text=True)
        return ran.stdout.splitlines(), ran.stderr

    before = write(0)[0]
    for first in [0, 8]:
        ends, error = write(first, edited)
        # Control: no motion shows the edit.
        assert ends == before[:1]
        assert "is another study's: dalembert.model" in error
    assert write(0)[0] == [before[0], "Parts: 0 parts written, 2 were there; 0 members failed"]
    assert "2 parts written" in write(8)[0][1]


def test_reactions_follow_an_input_for_each_step():
    # Hanging at rest, the second bob is lifted more and more, until its rod pushes.
    rods = trials.Rods([1.0, 0.7])
    lift = np.arange(10.0)
    u = np.column_stack([np.zeros(10), lift])
    run = rods.run(h=0.01, steps=10, q=[0.0, -1.0, 0.0, -1.8], v=[0.0] * 4, u=u, reactions=True)
    expected = lift[:, None] - 9.81 * np.array([1.7, 0.7])
    assert run.reactions[1:] == pytest.approx(expected, abs=1e-11)
    assert np.array_equal(run.reactions[0], run.reactions[1])
    # Control: the input of the next step is another reaction.
    assert not np.allclose(run.reactions[:-1], expected)


def test_constraints_of_velocity_have_a_ledger_and_no_symmetries():
    skate = trials.Skate(1.7)
    box = {"low": [-1] * 3, "high": [1] * 3, "reach": [0.1] * 3}
    with pytest.raises(ValueError, match="symmetries: .* without constraints of velocity"):
        skate.symmetries(h=0.1, **box)
    ledger = skate.energy_ledger(h=0.01, steps=50, q=[0, 0, 0], v=[0, 0, 0.9])
    assert ledger.dissipated == 0.0 and abs(ledger.change) < 1e-4
    # Control: rods are asked, with both of which a turn about the pivot goes.
    turn = np.kron(np.eye(2), [[0, -1], [1, 0]])
    box = {"low": [-1] * 4, "high": [1] * 4, "reach": [0.1] * 4, "u": [0, 0]}
    (report,) = trials.Rods([1.0, 0.7]).symmetries(h=0.01, generators={"turn": (turn, np.zeros(4))}, **box)
    # Gravity is not.
    assert report.is_consistent and not report.is_symmetry_of_lagrangian


def test_a_coordinate_without_mass_has_the_velocity_that_friction_makes():
    """A spring and a dashpot in series: at t = 5 by the matrix exponential."""
    at = {"h": 0.1, "steps": 50, "q": [1, 0], "v": [0, 0], "rule": "gauss_4"}
    run = trials.Maxwell([1.0, 0.0], 4.0, 3.0).run(**at)
    assert run.q[-1] == pytest.approx([-0.0357155764308, -8.35575944877e-5], abs=1e-12)
    assert run.v[0] == pytest.approx([0.0, 4 / 3]) and run.v[-1][1] == pytest.approx(-0.0475093584484, abs=1e-12)
    with pytest.raises(trials.StepError, match="coordinate 1"):
        trials.Maxwell([1.0, 0.0], 4.0, 0.0).run(**at)
