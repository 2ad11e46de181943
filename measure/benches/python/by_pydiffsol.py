import numpy as np
import pydiffsol
from starts import END, GONE, OPENINGS

MOTION = f"""
in_i {{ x0 = 0, y0 = 0, vx0 = 0, vy0 = 0 }}
u_i {{ x = x0, y = y0, vx = vx0, vy = vy0 }}
F_i {{ vx, vy, -x - 2 * x * y, -y - x * x + y * y }}
stop_i {{ {", ".join(f"({a}) * x + ({b}) * y - {GONE}" for a, b in OPENINGS)} }}
"""


def escape_times(q, v, tolerance, threads):
    ode = pydiffsol.Ode(MOTION, ode_solver=pydiffsol.tsit45)
    ode.rtol = ode.atol = tolerance
    return np.array([ode.solve(start, END).ts[-1] for start in np.hstack([q, v])])
