"""A pole held upright on a cart: a linear-quadratic regulator from the exact A and B of the step.

The regulator is that of the discrete system which the loop steps, not of a continuous one sampled afterwards: its states are (q, p), and A and B are
what `linearization` says at rest.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from dalembert_scenes import CartPole
from scipy.linalg import solve_discrete_are

plt.style.use(Path(__file__).with_name("gallery.mplstyle"))
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

cart, period, limit = CartPole(cart=1.0, rod=0.1, half_length=0.25, friction=[0.1, 0.002]), 0.01, 10.0
at_rest = cart.linearization(h=period, q=[0, 0], p=[0, 0], u=[0])
a, b = at_rest.a, at_rest.b
weights, effort = np.diag([10.0, 10.0, 0.1, 0.1]), np.array([[0.1]])
cost = solve_discrete_are(a, b, weights, effort)
gain = np.linalg.solve(effort + b.T @ cost @ b, b.T @ cost @ a)
print("growth a period, alone:", np.abs(np.linalg.eigvals(a)).max().round(4))
print("growth a period, held: ", np.abs(np.linalg.eigvals(a - b @ gain)).max().round(4))


def loop(is_held):
    q, p, rows = np.array([0.0, 0.4]), np.zeros(2), []
    for k in range(600):
        u = np.clip(-gain @ np.concatenate([q, p]), -limit, limit) if is_held else np.zeros(1)
        rows.append([k * period, *q, *u])
        step = cart.run(h=period, steps=1, q=q, p=p, u=u)
        q, p = step.q[-1], step.p[-1]
    return np.array(rows).T


held, alone = loop(True), loop(False)
# The pole that is left alone leaves the picture for good when it lies.
alone = alone[:, : np.argmax(np.abs(alone[2]) > np.pi / 2)]
figure, (angle, place, force) = plt.subplots(3, 1, sharex=True, figsize=(8, 6.5))
for name, (t, x, theta, u), style in [("held", held, ["#0072B2", "-"]), ("left alone, until it lies", alone, ["#D55E00", "--"])]:
    look = {"color": style[0], "linestyle": style[1], "label": name}
    angle.plot(t, theta, **look)
    place.plot(t, x, **look)
    force.plot(t, u, **look)
angle.set(ylabel="from upright (rad)", title="A pole released at 0.4 rad is brought upright by a regulator from A and B of the step")
place.set(ylabel="cart (m)")
force.set(ylabel="force (N)", xlabel="time (s)")
figure.legend(*angle.get_legend_handles_labels(), loc="outside lower center", ncols=2)
figure.savefig(FOLDER / "closed_loop.svg")

assert np.abs(held[1:3, -1]).max() < 0.01 < alone[2, -1]
