"""Ends of the scenes to 30 digits, by two integrators that share nothing but the equations.

    python3 measure/report/python/references.py > measure/report/references.txt

One is heyoka's Taylor method in quadruple precision, the other Gragg–Bulirsch–Stoer extrapolation in mpmath, here. They have
to agree to 1e-24, or the script ends there. The energies of the long run are held against SciPy's DOP853 at its finest
tolerance, to 1e-10. Mechanisms are computed in their coordinates without constraints; after a long time by the Taylor method in
extended precision, which agrees with quadruple to 1e-13 after a short time, and with DOP853 to 1e-5 after the long one. Needs heyoka, mpmath
and SciPy; with gmpy2 it takes minutes, not hours.
"""

import sys

import heyoka as hy
import numpy as np
from mpmath import mp, mpf
from scipy.integrate import ode

from constrained import G, HORIZONS, MECHANISMS, start
from scenes import LONG_RUN, LONG_RUN_SAMPLES, SCENES, Scene

AGREEMENT = 1e-24
AGREEMENT_OF_LONG_RUN = 1e-10
# Of extended precision with quadruple after the short time, and with DOP853, whose own error has grown, after the long one.
AGREEMENT_OF_EXTENDED = 1e-13
AGREEMENT_OF_LONG_MOTION = 1e-5


def by_taylor(scene, times, number=hy.real128, tolerance="1e-32", compact=False):
    """(q, v) at `times`, by heyoka in quadruple precision or another; compiled in compact mode where all else takes minutes."""
    n = scene.n
    names = [f"q{i}" for i in range(n)] + [f"v{i}" for i in range(n)]
    variables = [hy.make_vars(name) for name in names]
    q, v = variables[:n], variables[n:]
    rates = list(zip(q, v)) + list(zip(v, scene.acceleration(hy, q, v)))
    start = np.array([number(x) for x in scene.q + scene.v])
    integrator = hy.taylor_adaptive(rates, start, fp_type=number, tol=number(tolerance), compact_mode=compact or n > 2)
    ends = []
    for time in times:
        integrator.propagate_until(number(time))
        ends.append([mpf(str(x)) for x in integrator.state])
    return ends


def by_extrapolation(scene, times, tolerance, columns):
    """(q, v) at `times`, by extrapolation of the midpoint sequence 2, 4, …, 2·columns with steps chosen by the last
    difference in the tableau."""
    n = scene.n

    def rate(y):
        return y[n:] + scene.acceleration(mp, y[:n], y[n:])

    def modified_midpoint(y, f, h, substeps):
        h /= substeps
        before, here = y, [a + h * b for a, b in zip(y, f)]
        for _ in range(substeps - 1):
            f_here = rate(here)
            before, here = here, [a + 2 * h * b for a, b in zip(before, f_here)]
        f_here = rate(here)
        return [(a + b + h * c) / 2 for a, b, c in zip(before, here, f_here)]

    def step(y, h):
        f, rows = rate(y), []
        for k in range(1, columns + 1):
            row = [modified_midpoint(y, f, h, 2 * k)]
            for j, above in enumerate(rows[-1] if rows else []):
                ratio = mpf(k * k) / ((k - j - 1) ** 2) - 1
                row.append([a + (a - b) / ratio for a, b in zip(row[j], above)])
            rows.append(row)
        error = max(abs(a - b) for a, b in zip(rows[-1][-1], rows[-1][-2]))
        return rows[-1][-1], error

    y, time, h, ends = [mpf(x) for x in scene.q + scene.v], mpf(0), mpf("0.05"), []
    for end in map(mpf, times):
        while time < end:
            last = time + h >= end
            taken = end - time if last else h
            after, error = step(y, taken)
            grown = taken * min(mpf(4), max(mpf("0.2"), mpf("0.8") * (tolerance / (error + mpf("1e-60"))) ** (mpf(1) / (2 * columns - 1))))
            if error <= tolerance:
                y, time = after, end if last else time + taken
                h = max(h, grown) if last else grown
            else:
                h = grown
        ends.append(list(y))
    return ends


def by_runge_kutta(scene, times):
    """(q, v) at `times`, by DOP853 in double precision."""
    n = scene.n
    y = [hy.make_vars(f"y{i}") for i in range(2 * n)]
    rate = hy.cfunc(y[n:] + scene.acceleration(hy, y[:n], y[n:]), vars=y)
    solver = ode(lambda _, y: rate(y)).set_integrator("dop853", rtol=1e-14, atol=1e-14, nsteps=10**8)
    solver.set_initial_value(scene.q + scene.v, 0.0)
    return [[mpf(float(x)) for x in solver.integrate(time)] for time in times]


def ring_energy(y):
    s = y[0] ** 2 + y[1] ** 2
    return (y[2] ** 2 + y[3] ** 2) / 2 + s * (s - 1) ** 2


def mechanism_energy(mechanism, q, v):
    kinetic = sum(m * w * w / 2 for m, w in zip(mechanism.mass, v))
    return kinetic + mpf(G) * sum(mechanism.mass[i] * q[i] for i in mechanism.heights)


def mechanisms():
    """The mechanisms over each time, with their energies at the ends of its parts."""
    for name, mechanism in MECHANISMS.items():
        scene, n = Scene(mechanism.free, mechanism.x, mechanism.dx, max(HORIZONS)), len(mechanism.x)
        short, long = [[end * (i + 1) / count for i in range(count)] for end, count in HORIZONS.items()]
        [first] = by_extrapolation(scene, short[:1], mpf("1e-30"), 14)
        [last] = by_runge_kutta(scene, long[-1:])
        exact = by_taylor(scene, short, compact=True)
        check(name, max(abs(a - b) for a, b in zip(exact[0], first)), AGREEMENT)
        extended = by_taylor(scene, long, np.longdouble, "1e-19", compact=True)
        check(f"{name}, extended", max(abs(a - b) for a, b in zip(extended[0], exact[-1])), AGREEMENT_OF_EXTENDED)
        check(f"{name}, long", max(abs(a - b) for a, b in zip(extended[-1], last)), AGREEMENT_OF_LONG_MOTION)
        for times, ends in ((short, exact), (long, extended)):
            states = [mechanism.place(mp, y[:n], y[n:]) for y in ends]
            begin = [" ".join([word, *map(repr, half)]) for word, half in zip(["q0", "v0"], start(mechanism))]
            after = [line(word, half) for word, half in zip(["q1", "v1"], states[-1])]
            energies = [line("energy", [mpf(t), mechanism_energy(mechanism, *y)]) for t, y in zip(times, states)]
            print("", f"scene {name}, T = {times[-1]:g}", *begin, f"time {times[-1]}", *after, *energies, sep="\n", flush=True)


def line(word, numbers):
    return f"{word} " + " ".join(mp.nstr(x, 30, strip_zeros=False) for x in numbers)


def check(name, difference, agreement):
    print(f"{name}: the two integrators differ by {mp.nstr(difference, 2)}", file=sys.stderr, flush=True)
    if not difference < agreement:
        sys.exit(f"{name}: the references disagree")


def main():
    mp.dps = 40
    print("# Ends of the scenes; written by measure/report/python/references.py, which says how they are checked.")
    for name, scene in SCENES.items():
        [taylor] = by_taylor(scene, [scene.end])
        [extrapolated] = by_extrapolation(scene, [scene.end], mpf("1e-30"), 14)
        check(name, max(abs(a - b) for a, b in zip(taylor, extrapolated)), AGREEMENT)
        start = [" ".join([word, *map(repr, values)]) for word, values in [("q0", scene.q), ("v0", scene.v)]]
        ends = [line("q1", taylor[: scene.n]), line("v1", taylor[scene.n :])]
        print("", f"scene {name}", *start, f"time {scene.end}", *ends, sep="\n", flush=True)

    times = [LONG_RUN.end * (i + 1) / LONG_RUN_SAMPLES for i in range(LONG_RUN_SAMPLES)]
    taylor, by_other = ([ring_energy(y) for y in by(LONG_RUN, times)] for by in (by_taylor, by_runge_kutta))
    check("long run, energy", max(abs(a - b) for a, b in zip(taylor, by_other)), AGREEMENT_OF_LONG_RUN)
    samples = [line("energy", [mpf(time), energy]) for time, energy in zip(times, taylor)]
    print("", "scene long run", *samples, sep="\n")
    mechanisms()


main()
