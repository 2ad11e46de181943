"""Two double pendulums, released a millionth of a radian apart: how they part, and what the exact derivative of the run says beforehand.

`derivatives=True` carries ∂(q, p)/∂(q0, p0) along, the product of the derivatives of the steps. Times the first distance it is the distance of
the two, as long as that is small.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from dalembert_scenes import DoublePendulum

plt.style.use(Path(__file__).with_name("gallery.mplstyle"))
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

pendulum = DoublePendulum(m=[1.0, 0.7], l=[1.0, 0.8], g=9.81, c=[0.002, 0.002])
apart = 1e-6
steps = {"h": 0.01, "steps": 2500, "every": 5, "rule": "gauss_4"}
one = pendulum.run(q=[2.2, 2.5], p=[0, 0], derivatives=True, **steps)
other = pendulum.run(q=[2.2 + apart, 2.5], p=[0, 0], **steps)

distance = np.linalg.norm(other.q - one.q, axis=1)
foretold = apart * np.linalg.norm(one.by_start[:, :2, 0], axis=1)
small = (distance < 1e-2) & (one.t > 0)
parting = one.t[distance > 1].min()
print(f"separated by a radian after {parting:.1f} s; until then foretold within {np.abs(foretold / distance - 1)[small].max():.1%}")

figure, (above, below) = plt.subplots(2, 1, sharex=True)
for angle, name in enumerate(["upper arm", "lower arm"]):
    colour = ["#0072B2", "#D55E00"][angle]
    above.plot(one.t, one.q[:, angle], color=colour, linestyle="-", label=name)
    above.plot(other.t, other.q[:, angle], color=colour, linestyle=":", label=f"{name}, released 10⁻⁶ rad beside")
above.axvline(parting, color="gray", linestyle="-", linewidth=0.8)
above.set(ylabel="angle from below (rad)", title=f"Two double pendulums, released 10⁻⁶ rad beside each other, separate after {parting:.0f} s")
below.semilogy(one.t, distance, color="black", linestyle="-", label="distance of the two")
below.semilogy(one.t, foretold, color="#009E73", linestyle="--", label="10⁻⁶ rad times the exact derivative of the run")
below.axvline(parting, color="gray", linestyle="-", linewidth=0.8)
below.set(xlabel="time (s)", ylabel="distance of the angles (rad)", ylim=(1e-8, 1e4), title="The derivative of one run foretells the distance")
handles = [*above.get_legend_handles_labels()[0], *below.get_legend_handles_labels()[0]]
figure.legend(handles=handles, loc="outside lower center", ncols=2)
figure.savefig(FOLDER / "double_pendulum.svg")

assert np.abs(foretold / distance - 1)[small].max() < 0.2
