"""The friction of both joints of a double pendulum, fitted to noisy angles: Gauss–Newton steps by exact derivatives of the run.

The attribute of the system lists its parameters, `parameters = [c[0], c[1]]`, so that a run carries ∂(q, p)/∂c along, and
`scipy.optimize.least_squares` gets a Jacobian that is exact for the steps as they are taken. The motion is a regular one: from larger
angles it is chaotic, and the sum of squares has minima besides the one looked for.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from dalembert_scenes import DoublePendulum
from scipy.optimize import least_squares

plt.style.use(Path(__file__).with_name("gallery.mplstyle"))
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

TRUE, NOISE = np.array([0.05, 0.03]), 0.02
steps = {"h": 0.02, "steps": 500, "every": 5, "q": [0.6, 0.3], "p": [0.0, 0.0]}


def pendulum(c):
    return DoublePendulum(m=[1.0, 0.7], l=[1.0, 0.8], g=9.81, c=c)


random = np.random.default_rng(1)
truth = pendulum(TRUE).run(**steps)
measured = truth.q + NOISE * random.standard_normal(truth.q.shape)

last = {}


def residuals(c):
    run = last["run"] = pendulum(c).run(derivatives=True, **steps)
    return (run.q - measured).ravel() / NOISE


def jacobian(c):
    # least_squares asks for it where it has asked for the residuals.
    return last["run"].by_parameters[:, :2, :].reshape(-1, 2) / NOISE


guess = np.array([0.2, 0.2])
fit = least_squares(residuals, guess, jacobian, bounds=(0, np.inf))
spread = np.sqrt(np.diag(np.linalg.inv(fit.jac.T @ fit.jac)))
by_differences = least_squares(residuals, guess, bounds=(0, np.inf))
print(f"c = {fit.x[0]:.4f} ± {spread[0]:.4f}, {fit.x[1]:.4f} ± {spread[1]:.4f} N m s, made with {TRUE}")
print(f"{fit.nfev} runs; by differences {by_differences.nfev + 2 * by_differences.njev}")

figure, panels = plt.subplots(2, 1, sharex=True)
smooth = steps | {"every": 1}
before, fitted = pendulum(guess).run(**smooth), pendulum(fit.x).run(**smooth)
for angle, (panel, name) in enumerate(zip(panels, ["upper arm", "lower arm"])):
    panel.plot(truth.t, measured[:, angle], ".", color="black", markersize=3, linestyle="none", label=f"measured, ±{NOISE} rad")
    panel.plot(before.t, before.q[:, angle], color="#D55E00", linestyle="--", label="first guess, c = 0.2, 0.2 N m s")
    panel.plot(fitted.t, fitted.q[:, angle], color="#0072B2", linestyle="-", label=f"fitted, c = {fit.x[0]:.3f}, {fit.x[1]:.3f} N m s")
    panel.set(ylabel=f"angle of the {name} (rad)")
panels[0].set_title(f"Friction fitted to a double pendulum in {fit.nfev} runs, which carry their derivatives along")
panels[1].set_xlabel("time (s)")
figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
figure.savefig(FOLDER / "friction_fit.svg")

assert np.all(np.abs(fit.x - TRUE) < 3 * spread) and fit.success
assert np.allclose(fit.x, by_differences.x, atol=0.1 * spread.min())
