"""Mechanisms on constraints: once with their multipliers solved for, q″ = a(q, q′), once in coordinates without constraints.

Written over whatever numbers a `functions` module knows, as the scenes beside this file are.
"""

import math
from dataclasses import dataclass
from typing import Callable

from scenes import Scene, solve

G = 9.81


@dataclass(frozen=True)
class Mechanism:
    """A diagonal mass, forces and constraints in coordinates q, and the same motion in coordinates x without constraints."""

    mass: list
    heights: list  # the indices of coordinates that gravity acts along
    forces: Callable  # (q, v) -> list of n
    constraints: Callable  # (functions, q, v) -> list of (g, {i: ∂g/∂qᵢ}, v·(∂²g/∂q²)·v)
    free: Callable  # (functions, x, x′) -> x″
    place: Callable  # (functions, x, x′) -> (q, v)
    x: list
    dx: list


def on_constraints(mechanism, alpha, at, end):
    """With g″ + 2α g′ + α² g = 0 for the multipliers: α = 0 reduces the index and no more, α > 0 is Baumgarte's stabilisation."""

    def acceleration(f, q, v):
        rows = mechanism.constraints(f, q, v)
        forces = mechanism.forces(q, v)
        gradients = [row for _, row, _ in rows]
        right = []
        for value, row, curvature in rows:
            rate = total(d * v[i] for i, d in row.items())
            wanted = curvature + total(d * (forces[i] / mechanism.mass[i]) for i, d in row.items())
            if alpha:
                wanted = wanted + 2.0 * alpha * rate + alpha * alpha * value
            right.append(wanted)
        products = [
            [total(a[i] * b[i] / mechanism.mass[i] for i in a if i in b) for b in gradients] for a in gradients
        ]
        multipliers = solve(products, right)
        for row, multiplier in zip(gradients, multipliers):
            for i, d in row.items():
                forces[i] = forces[i] - d * multiplier
        return [force / mass for force, mass in zip(forces, mechanism.mass)]

    return Scene(acceleration, *at, end)


def total(terms):
    """The sum, 0.0 of none: no number of another kind is added to the first."""
    terms = list(terms)
    if not terms:
        return 0.0
    sum_ = terms[0]
    for term in terms[1:]:
        sum_ = sum_ + term
    return sum_


def spherical(drag):
    """A unit mass on a rod of unit length about the origin, in space, with drag."""

    def free(f, x, dx):
        # From the vertical, and around it.
        sine, cosine = f.sin(x[0]), f.cos(x[0])
        return [
            sine * cosine * dx[1] * dx[1] - G * sine - drag * dx[0],
            -2.0 * cosine / sine * dx[0] * dx[1] - drag * dx[1],
        ]

    def place(f, x, dx):
        (sa, ca), (sb, cb) = [(f.sin(a), f.cos(a)) for a in x]
        q = [sa * cb, sa * sb, -ca]
        v = [ca * cb * dx[0] - sa * sb * dx[1], ca * sb * dx[0] + sa * cb * dx[1], sa * dx[0]]
        return q, v

    return Mechanism(
        mass=[1.0] * 3,
        heights=[2],
        forces=lambda q, v: [-drag * v[0], -drag * v[1], -G - drag * v[2]],
        constraints=lambda f, q, v: [
            (0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1.0), dict(enumerate(q)), v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        ],
        free=free,
        place=place,
        x=[1.1, 0.2],
        dx=[0.4, 1.5],
    )


def two_rods():
    """Two masses on two rods without mass, in a plane."""
    m, l = [1.0, 0.7], [1.0, 0.8]

    def constraints(f, q, v):
        x, y, dx, dy = q[2] - q[0], q[3] - q[1], v[2] - v[0], v[3] - v[1]
        first = 0.5 * (q[0] * q[0] + q[1] * q[1] - l[0] * l[0])
        second = 0.5 * (x * x + y * y - l[1] * l[1])
        return [
            (first, {0: q[0], 1: q[1]}, v[0] * v[0] + v[1] * v[1]),
            (second, {0: -1.0 * x, 1: -1.0 * y, 2: x, 3: y}, dx * dx + dy * dy),
        ]

    def free(f, x, dx):
        a, b, d = (m[0] + m[1]) * l[0] * l[0], m[1] * l[1] * l[1], m[1] * l[0] * l[1]
        sine, cosine = f.sin(x[0] - x[1]), f.cos(x[0] - x[1])
        coupling = d * cosine
        first = -d * sine * dx[1] * dx[1] - (m[0] + m[1]) * G * l[0] * f.sin(x[0])
        second = d * sine * dx[0] * dx[0] - m[1] * G * l[1] * f.sin(x[1])
        determinant = a * b - coupling * coupling
        return [(b * first - coupling * second) / determinant, (a * second - coupling * first) / determinant]

    def place(f, x, dx):
        q, v = [0.0, 0.0], [0.0, 0.0]
        for length, angle, rate in zip(l, x, dx):
            sine, cosine = length * f.sin(angle), length * f.cos(angle)
            q += [q[-2] + sine, q[-1] - cosine]
            v += [v[-2] + cosine * rate, v[-1] + sine * rate]
        return q[2:], v[2:]

    return Mechanism(
        mass=[m[0], m[0], m[1], m[1]],
        heights=[1, 3],
        forces=lambda q, v: [0.0, -m[0] * G, 0.0, -m[1] * G],
        constraints=constraints,
        free=free,
        place=place,
        x=[0.7, 0.3],
        dx=[0.0, 0.5],
    )


def four_bar(friction):
    """The linkage of `scenes/src/four_bar.rs`: centre and angle of each bar, friction in its joints."""
    lengths, masses, ground = [0.3, 0.9, 0.7], [0.5, 0.9, 0.6], 1.0
    inertias = [m * l * l / 12.0 for m, l in zip(masses, lengths)]

    def torques(w):
        """Of the joints' friction on the bars."""
        joints = [w[0], w[1] - w[0], w[2] - w[1]]
        return [friction * (joints[1] - joints[0]), friction * (joints[2] - joints[1]), friction * (-1.0 * joints[2] - w[2])]

    def forces(q, v):
        turned = torques([v[2], v[5], v[8]])
        return [x for bar in range(3) for x in (0.0, -masses[bar] * G, turned[bar])]

    def constraints(f, q, v):
        ends = {}
        for bar in range(3):
            half = 0.5 * lengths[bar]
            along, up = half * f.cos(q[3 * bar + 2]), half * f.sin(q[3 * bar + 2])
            square = v[3 * bar + 2] * v[3 * bar + 2]
            for sign in (-1.0, 1.0):
                # Place, gradient, and the acceleration that turning alone makes.
                ends[bar, sign] = [
                    (q[3 * bar] + sign * along, {3 * bar: 1.0, 3 * bar + 2: -sign * up}, -sign * along * square),
                    (q[3 * bar + 1] + sign * up, {3 * bar + 1: 1.0, 3 * bar + 2: sign * along}, -sign * up * square),
                ]

        def apart(a, b):
            return [
                (one - other, row | {i: -1.0 * d for i, d in minus.items()}, turn - less)
                for (one, row, turn), (other, minus, less) in zip(a, b)
            ]

        fixed = [[(x, {}, 0.0), (0.0, {}, 0.0)] for x in (0.0, ground)]
        return [
            *apart(ends[0, -1.0], fixed[0]),
            *apart(ends[0, 1.0], ends[1, -1.0]),
            *apart(ends[1, 1.0], ends[2, 1.0]),
            *apart(ends[2, -1.0], fixed[1]),
        ]

    def turned(f, crank):
        """Angles of all bars, their rates by the crank's angle, and those of these."""
        r, second, third = lengths
        end = [r * f.cos(crank), r * f.sin(crank)]
        to = [ground - end[0], -1.0 * end[1]]
        square = to[0] * to[0] + to[1] * to[1]
        across = f.sqrt(square)
        inner = f.acos((second * second + square - third * third) / (2.0 * second * across))
        coupler = f.atan2(to[1], to[0]) + inner
        joint = [end[0] + second * f.cos(coupler), end[1] + second * f.sin(coupler)]
        rocker = f.atan2(joint[1], joint[0] - ground)
        angles = [crank, coupler, rocker]
        # r e^(iθ) + second e^(iβ) = ground + third e^(iγ), differentiated once and twice, along and across.
        sine = f.sin(coupler - rocker)
        b = -r * f.sin(crank - rocker) / (second * sine)
        c = r * f.sin(coupler - crank) / (third * sine)
        bb = (-r * f.cos(crank - rocker) - second * b * b * f.cos(coupler - rocker) + third * c * c) / (second * sine)
        cc = (-r * f.cos(crank - coupler) - second * b * b + third * c * c * f.cos(coupler - rocker)) / (third * sine)
        return angles, [1.0, b, c], [0.0, bb, cc]

    def moved(f, x):
        """Places of all coordinates, their rates by the crank's angle, and those of these."""
        angles, rates, second = turned(f, x)
        turns = [(0.5 * l * f.cos(a), 0.5 * l * f.sin(a)) for l, a in zip(lengths, angles)]
        first = [(-1.0 * up * rate, along * rate) for (along, up), rate in zip(turns, rates)]
        then = [
            (-1.0 * along * rate * rate - up * bend, -1.0 * up * rate * rate + along * bend)
            for (along, up), rate, bend in zip(turns, rates, second)
        ]
        all_of = []
        for offset, of, third in ((0.0, angles, turns), (0.0, rates, first), (0.0, second, then)):
            base = ground if of is angles else 0.0
            all_of.append([
                third[0][0], third[0][1], of[0],
                2.0 * third[0][0] + third[1][0], 2.0 * third[0][1] + third[1][1], of[1],
                base + third[2][0], third[2][1], of[2],
            ])
        return all_of

    mass = [x for m, inertia in zip(masses, inertias) for x in (m, m, inertia)]

    def free(f, x, dx):
        _, first, second = moved(f, x[0])
        pushed = forces(None, [d * dx[0] for d in first])
        inertia = total(m * d * d for m, d in zip(mass, first))
        growth = total(m * d * b for m, d, b in zip(mass, first, second))
        return [(total(d * force for d, force in zip(first, pushed)) - growth * dx[0] * dx[0]) / inertia]

    def place(f, x, dx):
        q, first, _ = moved(f, x[0])
        return q, [d * dx[0] for d in first]

    return Mechanism(
        mass=mass,
        heights=[1, 4, 7],
        forces=forces,
        constraints=constraints,
        free=free,
        place=place,
        x=[0.5],
        dx=[15.0],
    )


MECHANISMS = {
    "spherical pendulum": spherical(0.0),
    "spherical pendulum, drag": spherical(1e-3),
    "two rods": two_rods(),
    "four-bar": four_bar(0.0),
    "four-bar, friction": four_bar(5e-6),
}
HORIZONS = {10.0: 10, 1000.0: 100}
ALPHAS = [0.0, 5.0]


def start(mechanism):
    """(q, v), as the nearest numbers that floats have."""
    q, v = mechanism.place(math, mechanism.x, mechanism.dx)
    return [[float(value) for value in half] for half in (q, v)]


REDUCED = {
    f"{name}, T = {end:g}, α = {alpha:g}": on_constraints(mechanism, alpha, start(mechanism), end)
    for name, mechanism in MECHANISMS.items()
    for end in HORIZONS
    for alpha in ALPHAS
}
