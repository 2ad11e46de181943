import numpy as np
from scipy.integrate import solve_ivp

from blocks import END, MU, C, M, Q, V, springs


def at_rest(tolerance):
    width = tolerance

    def rate(t, y):
        q, v = y[:3], y[3:]
        return [*v, *((springs(q) - MU * np.tanh(v / width) - C * v) / M)]

    run = solve_ivp(rate, (0, END), np.hstack([Q, V]), method="LSODA", rtol=tolerance, atol=tolerance)
    return run.y[:3, -1]
