"""The optimum of optimal_control.rs by direct optimisation, with a plant of its own. Needs SciPy; prints u and q."""

import numpy as np
from scipy.optimize import brentq, minimize

R, R3, WEIGHT, H, STEPS = 0.3, 0.1, 4.0, 0.2, 12
Q0, P0 = 1.2, 0.5


def step(q0, p0, u):
    def force(q1):
        v, mean = (q1 - q0) / H, (q0 + q1) / 2
        return v, -np.sin(mean) - R * v - R3 * v**3 + u

    def missed(q1):
        v, f = force(q1)
        return v - H / 2 * f - p0

    q1 = brentq(missed, q0 - 5, q0 + 5, xtol=1e-15, rtol=1e-15)
    v, f = force(q1)
    return q1, v + H / 2 * f


def run(inputs):
    q, p = Q0, P0
    yield q
    for u in inputs:
        q, p = step(q, p, u)
        yield q


def cost(inputs):
    q = np.array(list(run(inputs)))
    return H * np.sum(0.5 * WEIGHT * ((q[1:] + q[:-1]) / 2) ** 2 + 0.5 * inputs**2)


def gradient(inputs, e=1e-4):
    def along(i):
        at = lambda k: cost(inputs + k * e * np.eye(STEPS)[i])
        return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * e)

    return np.array([along(i) for i in range(STEPS)])


found = minimize(cost, np.zeros(STEPS), jac=gradient, method="BFGS", options={"gtol": 1e-10})
print("u", *(f"{u:.8f}" for u in found.x))
print("q", *(f"{q:.10f}" for q in run(found.x)))
print("largest component of the gradient", np.abs(found.jac).max())
