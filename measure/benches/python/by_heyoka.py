import heyoka as hy
import numpy as np
from starts import END, GONE, OPENINGS

PIECE = 1000


def escape_times(q, v, tolerance, threads):
    hy.set_nthreads(threads)
    x, y, vx, vy = hy.make_vars("x", "y", "vx", "vy")
    motion = [(x, vx), (y, vy), (vx, -x - 2 * x * y), (vy, -y - x * x + y * y)]
    gone = [
        hy.t_event(a * x + b * y - GONE, direction=hy.event_direction.positive) for a, b in OPENINGS
    ]
    starts = np.hstack([q, v])
    integrator = hy.taylor_adaptive(motion, starts[0], tol=tolerance, t_events=gone)

    times = []
    # Each member is a copy of the integrator: in pieces they stay few.
    for piece in np.split(starts, range(PIECE, len(starts), PIECE)):

        def member(integrator, index, piece=piece):
            integrator.time = 0.0
            integrator.state[:] = piece[index]
            integrator.reset_cooldowns()
            return integrator

        done = hy.ensemble_propagate_until(integrator, END, len(piece), member)
        times += [one[0].time for one in done]
    return np.array(times)
