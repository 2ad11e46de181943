"""The study: stars of energy 1/5 in Hénon and Heiles' potential, and when they have left."""

import numpy as np

END = 100.0
# Which way the three openings lead; beyond the distance GONE along one, moving outwards, none of this energy turns back.
OPENINGS = np.array([[0.0, 1.0], [np.sqrt(0.75), -0.5], [-np.sqrt(0.75), -0.5]])
GONE, ENERGY = 1.1, 0.2


def potential(x, y):
    return 0.5 * (x * x + y * y) + x * x * y - y**3 / 3


def starts(members):
    """q and v of each: random positions between the openings that the energy allows, in random directions."""
    random = np.random.default_rng(1)
    q = np.empty((0, 2))
    while len(q) < members:
        drawn = random.uniform(-1.0, 1.0, (members, 2))
        inside = (potential(*drawn.T) < ENERGY) & ((drawn @ OPENINGS.T).max(axis=1) < 1.0)
        q = np.concatenate([q, drawn[inside]])
    q = q[:members]
    speed, angle = np.sqrt(2 * (ENERGY - potential(*q.T))), random.uniform(0, 2 * np.pi, members)
    return q, speed[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
