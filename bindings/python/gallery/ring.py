"""The ring potential with weak drag: a splitting against the Runge–Kutta method of order 4, at equal cost.

Friction takes four fifths of the energy in 2000 time units. Besides, a method adds or takes some by its own error. Both methods are of order 4 and
evaluate the force twenty times in a time unit: Runge–Kutta four times in steps of 0.2, the splitting six times in steps of 0.3.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from dalembert_scenes import Ring

plt.style.use(Path(__file__).with_name("gallery.mplstyle"))
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

ring, end = Ring(k=1e-3), 2000.0
start = {"q": [0.0, 1.15549918674982], "v": [0.5, 0.0]}
splitting = ring.run(h=0.3, until=end, every=2, rule="blanes_moan_4", **start)


def rate(state):
    """d(q, v)/dt, as one would write it for any solver."""
    q, v = state[:2], state[2:]
    s = q @ q
    return np.concatenate([v, -2 * (s - 1) * (3 * s - 1) * q - ring.k * v])


h, states = 0.2, [np.concatenate([start["q"], start["v"]])]
for _ in range(round(end / h)):
    y = states[-1]
    a = rate(y)
    b = rate(y + 0.5 * h * a)
    c = rate(y + 0.5 * h * b)
    d = rate(y + h * c)
    states.append(y + h / 6 * (a + 2 * b + 2 * c + d))
runge_kutta = np.array(states)


def largest(t, energy, width=20.0):
    """The largest error of the energy in each span of time: from turn to turn errors swing."""
    errors = np.abs(energy - ring.run(h=0.2, times=t, rule="gauss_8", **start).energy)
    spans = np.arange(0.0, end, width)
    return spans + width / 2, np.array([errors[(t >= span) & (t < span + width)].max() for span in spans])


figure, (above, below) = plt.subplots(2, 1, sharex=True, height_ratios=[2, 3])
motion = ring.run(h=0.2, times=np.linspace(0.0, end, 500), rule="gauss_8", **start)
above.plot(motion.t, motion.energy, color="black", linestyle="-")
above.set(ylabel="energy\n(dimensionless)", title="Friction takes the energy of a particle in the ring potential, drag k = 0.001")
worst = {}
for name, t, energy, style in [
    ("Runge–Kutta, order 4", h * np.arange(len(states)), ring.energy(q=runge_kutta[:, :2], v=runge_kutta[:, 2:]), ["#D55E00", "-"]),
    ("Blanes and Moan's splitting, order 4", splitting.t, splitting.energy, ["#0072B2", "--"]),
]:
    spans, errors = largest(t, energy)
    worst[name] = errors.max()
    below.semilogy(spans, errors, label=name, color=style[0], linestyle=style[1])
    print(f"{name}: the energy errs by up to {worst[name]:.1e}")
ratio = worst["Runge–Kutta, order 4"] / worst["Blanes and Moan's splitting, order 4"]
below.set(
    xlabel="time (dimensionless)",
    ylabel="largest error of the\nenergy (dimensionless)",
    title=f"With twenty evaluations of the force a time unit each, the splitting errs {ratio:.0f} times less",
)
figure.legend(*below.get_legend_handles_labels(), loc="outside lower center", ncols=2)
figure.savefig(FOLDER / "ring.svg")

assert ratio > 3
