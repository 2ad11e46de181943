"""Poincaré sections of Hénon and Heiles' potential: where orbits cross x = 0 upwards, at three energies.

A plane is an event that the run looks for by itself: 24 orbits an energy, each one call. Regular orbits draw curves, chaotic ones fill areas.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from dalembert_scenes import HenonHeiles, Plane

plt.style.use(Path(__file__).with_name("gallery.mplstyle"))
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

star, section = HenonHeiles(), Plane(q=[1.0, 0.0], direction=1)
energies = {1 / 12: "regular", 1 / 8: "regular and chaotic", 0.165: "chaotic almost everywhere"}
random = np.random.default_rng(3)

figure, panels = plt.subplots(1, 3, figsize=(12, 4.6), sharex=True, sharey=True)
for panel, (energy, nature) in zip(panels, energies.items()):
    crossings = 0
    for orbit in range(24):
        # A start on the section: y and its velocity at random where the energy allows, x from what is left of it.
        while True:
            y, vy = random.uniform(-0.5, 1.0), random.uniform(-0.6, 0.6)
            left = 2 * (energy - 0.5 * y**2 + y**3 / 3) - vy**2
            if left > 0 and y < 1:
                break
        run = star.run(h=0.1, steps=15_000, every=15_000, rule="blanes_moan_6", q=[0, y], v=[left**0.5, vy], events=[section])
        (found,) = run.events
        crossings += len(found)
        assert abs(run.energy[-1] - energy) < 1e-6 and np.abs(found.q[:, 0]).max() < 1e-13
        panel.plot(found.q[:, 1], found.v[:, 1], ".", markersize=1.6, markeredgewidth=0, linestyle="none", color=plt.get_cmap("viridis")(orbit / 26))
    panel.set(title=f"E = {energy:.4f}: {nature}", xlabel="y (dimensionless)")
    print(f"E = {energy:.4f}: {crossings} crossings, to rounding")
panels[0].set_ylabel("velocity of y (dimensionless)")
figure.suptitle("Where orbits of Hénon and Heiles' potential cross x = 0, one colour an orbit", x=0.01, ha="left")
# As dots of a picture: ten thousand crossings are many elements of an SVG.
figure.savefig(FOLDER / "poincare.png", dpi=110)
