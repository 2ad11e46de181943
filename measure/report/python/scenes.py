"""The scenes of the report, as accelerations: written once, over whatever numbers a `functions` module knows.

Numbers are floats' exact values in every arithmetic, so that all integrators see the same system.
"""

from dataclasses import dataclass
from typing import Callable


@dataclass(frozen=True)
class Scene:
    """A system as q″ = a(q, q′), with where and when it starts and ends."""

    acceleration: Callable  # (functions, q, v) -> list of n
    q: list
    v: list
    end: float

    @property
    def n(self):
        return len(self.q)


def ring(k):
    """Particle in the potential s(s − 1)², s = |q|², with drag k."""

    def acceleration(_, q, v):
        s = q[0] * q[0] + q[1] * q[1]
        slope = 2.0 * (s - 1.0) * (3.0 * s - 1.0)
        return [-slope * q[0] - k * v[0], -slope * q[1] - k * v[1]]

    return acceleration


def double_pendulum(f, q, v):
    """Point masses, absolute angles, friction in both joints."""
    m1, m2, l1, l2, g, c1, c2 = 1.0, 0.7, 1.0, 0.8, 9.81, 0.05, 0.03
    a, b, d = (m1 + m2) * l1 * l1, m2 * l2 * l2, m2 * l1 * l2
    sine, cosine = f.sin(q[0] - q[1]), f.cos(q[0] - q[1])
    coupling, relative = d * cosine, c2 * (v[1] - v[0])
    x = -d * sine * v[1] * v[1] - (m1 + m2) * g * l1 * f.sin(q[0]) - c1 * v[0] + relative
    y = d * sine * v[0] * v[0] - m2 * g * l2 * f.sin(q[1]) - relative
    determinant = a * b - coupling * coupling
    return [(b * x - coupling * y) / determinant, (a * y - coupling * x) / determinant]


def chain(_, q, v):
    """Fermi–Pasta–Ulam–Tsingou β-chain between walls, with drag on every mass."""
    beta, drag = 0.7, 1e-3
    springs = []
    for i in range(len(q) + 1):
        if i == 0:
            stretch = q[0]
        elif i == len(q):
            stretch = -q[i - 1]
        else:
            stretch = q[i] - q[i - 1]
        springs.append(stretch + beta * (stretch * stretch * stretch))
    return [springs[i + 1] - springs[i] - drag * v[i] for i in range(len(q))]


def henon_heiles(_, q, v):
    """Hénon–Heiles, no dissipation."""
    x, y = q
    return [-x - 2.0 * (x * y), -y - x * x + y * y]


def kepler(k):
    """Unit mass about a unit centre, with drag k."""

    def acceleration(f, q, v):
        square = q[0] * q[0] + q[1] * q[1]
        cube = square * f.sqrt(square)
        return [-q[0] / cube - k * v[0], -q[1] / cube - k * v[1]]

    return acceleration


def pendulums(f, q, v):
    """A chain of n pendulums of unit masses and lengths, absolute angles, friction in every joint."""
    n, g, c = len(q), 9.81, 0.05
    sines, cosines = [f.sin(x) for x in q], [f.cos(x) for x in q]
    mass = [[None] * n for _ in range(n)]
    right = []
    for i in range(n):
        total = -float(n - i) * g * sines[i]
        for j in range(n):
            carried = float(n - max(i, j))
            if i == j:
                mass[i][j] = carried
            else:
                mass[i][j] = carried * (cosines[i] * cosines[j] + sines[i] * sines[j])
                total = total - carried * (sines[i] * cosines[j] - cosines[i] * sines[j]) * (v[j] * v[j])
        total = total - c * (v[i] - v[i - 1] if i > 0 else v[i])
        if i + 1 < n:
            total = total + c * (v[i + 1] - v[i])
        right.append(total)
    # From the last pendulum up: the first pivot is then 1, and no constant is rounded when a library folds a division by it.
    return solve([row[::-1] for row in mass[::-1]], right[::-1])[::-1]


def solve(mass, right):
    """mass⁻¹ right by LDLᵀ, for any numbers."""
    n = len(right)
    lower, pivots = [[None] * n for _ in range(n)], []
    for j in range(n):
        pivot = mass[j][j]
        for k in range(j):
            pivot = pivot - lower[j][k] * lower[j][k] * pivots[k]
        pivots.append(pivot)
        for i in range(j + 1, n):
            entry = mass[i][j]
            for k in range(j):
                entry = entry - lower[i][k] * lower[j][k] * pivots[k]
            lower[i][j] = entry / pivot
    forward = []
    for i in range(n):
        entry = right[i]
        for k in range(i):
            entry = entry - lower[i][k] * forward[k]
        forward.append(entry)
    solution = [None] * n
    for i in reversed(range(n)):
        entry = forward[i] / pivots[i]
        for k in range(i + 1, n):
            entry = entry - lower[k][i] * solution[k]
        solution[i] = entry
    return solution


def first_mode(n):
    """The chain's first mode at amplitude 1, in two decimals: the same numbers on every machine."""
    from math import pi, sin

    return [round(sin(pi * (i + 1) / (n + 1)), 2) for i in range(n)]


SCENES = {
    "ring": Scene(ring(1e-3), [0.0, 1.15549918674982], [0.5, 0.0], 100.0),
    "double pendulum": Scene(double_pendulum, [0.8, -0.4], [0.0, 0.5], 20.0),
    "FPUT chain": Scene(chain, first_mode(8), [0.0] * 8, 100.0),
    "Hénon–Heiles": Scene(henon_heiles, [0.0, 0.1], [0.3, 0.1], 100.0),
    "Kepler": Scene(kepler(1e-4), [0.4, 0.0], [0.0, 2.0], 100.0),
    # From the far side of orbits of unit semi-major axis, in some ten rounds to the far side again.
    "Kepler, e = 0.99": Scene(kepler(0.0), [1.99, 0.0], [0.0, 0.0708881205008336], 62.0),
    "Kepler, e = 0.999": Scene(kepler(1e-4), [1.999, 0.0], [0.0, 0.02236627204212922], 62.0),
    "seven pendulums": Scene(pendulums, [0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.0], [0.0] * 7, 10.0),
}

# The cost of more coordinates: the same chain, longer.
SCENES |= {f"FPUT chain, n = {n}": Scene(chain, first_mode(n), [0.0] * n, 50.0) for n in (2, 4, 8, 16, 32)}

# The section x = 0 of Hénon and Heiles' problem: to the number next to its 157th crossing from below.
SCENES |= {"section": Scene(henon_heiles, [0.0, 0.1], [0.3, 0.1], 995.5304064784201)}

# The long run, whose energy is watched.
LONG_RUN = Scene(ring(1e-5), [0.0, 1.15549918674982], [0.5, 0.0], 20000.0)
LONG_RUN_SAMPLES = 200
