"""Three blocks in a row between two walls, joined by springs, on a floor: masses, springs, friction and start. SI units."""

import numpy as np

M = np.array([1.0, 2.0, 1.5])
K = np.array([40.0, 60.0, 30.0, 50.0])
MU = np.array([1.0, 2.0, 0.8])
C = 0.1
Q, V = np.array([0.8, -0.5, 0.6]), np.zeros(3)
END = 30.0


def springs(q):
    pull = K * np.diff([0, *q, 0])
    return pull[1:] - pull[:-1]
