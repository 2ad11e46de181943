import numpy as np
from scipy.integrate import solve_ivp

from blocks import END, MU, C, M, Q, V, springs


def motion(slides):
    """Blocks slide forwards or backwards (1, −1), or stand (0)."""

    def rate(t, y):
        q, v = y[:3], y[3:]
        return [*v, *np.where(slides, (springs(q) - MU * slides - C * v) / M, 0)]

    return rate


def events(slides):
    def stops(i):
        return lambda t, y: y[3 + i]

    def breaks_loose(i):
        return lambda t, y: abs(springs(y[:3])[i]) - MU[i]

    found = [stops(i) if slides[i] else breaks_loose(i) for i in range(3)]
    for i, event in enumerate(found):
        event.terminal, event.direction = True, -slides[i] if slides[i] else 1
    return found


def at_rest(tolerance):
    t, y, changes = 0.0, np.hstack([Q, V]), 0
    pull = springs(Q)
    slides = np.where(abs(pull) > MU, np.sign(pull), 0)
    while t < END:
        # At a coarse tolerance a block that breaks loose may stop at once, for ever.
        changes += 1
        if changes > 1000:
            return np.full(3, np.nan)
        run = solve_ivp(
            motion(slides), (t, END), y, method="DOP853", rtol=tolerance, atol=tolerance, events=events(slides)
        )
        t, y = run.t[-1], run.y[:, -1]
        for i in range(3):
            if len(run.t_events[i]):
                y[3 + i] = 0
                pull = springs(y[:3])[i]
                # Of a block that has stopped the force tells whether it stands; one that breaks loose goes with it.
                slides[i] = np.sign(pull) if slides[i] == 0 or abs(pull) > MU[i] else 0
        if not slides.any():
            return y[:3]
    return y[:3]
