"""The ring potential with weak drag: the midpoint rule against the Runge–Kutta method of order 4, both with h = 0.2.

Friction takes four fifths of the energy in 10 000 steps. What a method adds or takes besides is its own doing: the midpoint rule's error stays
bounded, and vanishes with the motion; that of Runge–Kutta grows for a thousand time units.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from dalembert_scenes import Ring

plt.style.use(Path(__file__).with_name("gallery.mplstyle"))
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

ring, h, steps, every = Ring(k=1e-3), 0.2, 10_000, 5
start = {"q": [0.0, 1.15549918674982], "v": [0.5, 0.0]}

midpoint = ring.run(h=h, steps=steps, every=every, **start)
motion = ring.run(h=h, steps=steps, every=every, rule="gauss_8", **start)


def rate(state):
    """d(q, v)/dt, as one would write it for any solver."""
    q, v = state[:2], state[2:]
    s = q @ q
    return np.concatenate([v, -2 * (s - 1) * (3 * s - 1) * q - ring.k * v])


states = [np.concatenate([start["q"], start["v"]])]
for _ in range(steps):
    y = states[-1]
    a = rate(y)
    b = rate(y + 0.5 * h * a)
    c = rate(y + 0.5 * h * b)
    d = rate(y + h * c)
    states.append(y + h / 6 * (a + 2 * b + 2 * c + d))
runge_kutta = np.array(states)[::every]
energies = {
    "Runge–Kutta, order 4": ring.energy(q=runge_kutta[:, :2], v=runge_kutta[:, 2:]),
    "midpoint rule": midpoint.energy,
}

true = motion.energy
figure, (above, below) = plt.subplots(2, 1, sharex=True, height_ratios=[2, 3])
above.plot(motion.t, motion.energy, color="black", linestyle="-")
above.set(ylabel="energy (dimensionless)", title="Friction takes the energy of a particle in the ring potential, drag k = 0.001")
for (name, energy), style in zip(energies.items(), [{"color": "#D55E00", "linestyle": "-"}, {"color": "#0072B2", "linestyle": "-"}]):
    below.plot(midpoint.t, energy - true, label=name, linewidth=0.7, **style)
    print(f"{name}: the energy errs by up to {np.abs(energy - true).max():.1e}")
below.set(
    xlabel="time (dimensionless)",
    ylabel="error of the energy",
    title="What each method adds or takes besides, with steps of 0.2",
)
figure.legend(*below.get_legend_handles_labels(), loc="outside lower center", ncols=2)
figure.savefig(FOLDER / "ring.svg")

assert np.abs(energies["midpoint rule"] - true).max() < 0.2 * np.abs(energies["Runge–Kutta, order 4"] - true).max()
