"""The same systems and the same discrete equations in CasADi, written out as C.

CasADi's user writes what dalembert's macro does: the equations of the step, a rootfinder for them, and the derivatives of its
solution. Two ways are written: `linearized`, CasADi's own derivatives of a rootfinder, and `implicit`, the implicit function theorem
as one expression, which is faster.
"""

import sys
from pathlib import Path

import casadi as ca
import numpy as np

STEP_SIZE = {"pendulum": 0.01, "arm": 0.01}


def pendulum(q, v):
    m, length, g, c = [1.0, 0.7], [1.0, 0.8], 9.81, [0.05, 0.03]
    kinetic = (
        0.5 * (m[0] + m[1]) * (length[0] * v[0]) ** 2
        + 0.5 * m[1] * (length[1] * v[1]) ** 2
        + m[1] * length[0] * length[1] * v[0] * v[1] * ca.cos(q[0] - q[1])
    )
    lagrangian = kinetic + g * ((m[0] + m[1]) * length[0] * ca.cos(q[0]) + m[1] * length[1] * ca.cos(q[1]))
    return lagrangian, 0.5 * c[0] * v[0] ** 2 + 0.5 * c[1] * (v[1] - v[0]) ** 2


def arm(q, v):
    base, m, length, payload, g, c = 0.4, [2.0, 1.5], [0.5, 0.4], 0.8, 9.81, [0.5, 0.4, 0.3]
    r1, z1 = length[0] * ca.cos(q[1]), length[0] * ca.sin(q[1])
    elbow = ca.vertcat(-z1 * v[1], r1 * v[1], r1 * v[0])
    sine, cosine = ca.sin(q[1] + q[2]), ca.cos(q[1] + q[2])
    r2, z2 = r1 + length[1] * cosine, z1 + length[1] * sine
    turning = v[1] + v[2]
    tip = ca.vertcat(elbow[0] - length[1] * sine * turning, elbow[1] + length[1] * cosine * turning, r2 * v[0])

    def rod(mass, a, b):
        return mass / 6 * (ca.dot(a, a) + ca.dot(a, b) + ca.dot(b, b))

    kinetic = (
        0.5 * base * v[0] ** 2
        + rod(m[0], ca.SX.zeros(3), elbow)
        + rod(m[1], elbow, tip)
        + 0.5 * payload * ca.dot(tip, tip)
    )
    potential = g * (m[0] * 0.5 * z1 + m[1] * 0.5 * (z1 + z2) + payload * z2)
    return kinetic - potential, 0.5 * (c[0] * v[0] ** 2 + c[1] * v[1] ** 2 + c[2] * v[2] ** 2)


def gauss(stages):
    """Nodes, weights and coefficients of the Gauss method."""
    nodes = np.array(ca.collocation_points(stages, "legendre"))
    powers = np.vander(nodes, increasing=True)
    integrals = np.array([[c ** (k + 1) / (k + 1) for k in range(stages)] for c in nodes])
    coefficients = integrals @ np.linalg.inv(powers)
    weights = np.array([1 / (k + 1) for k in range(stages)]) @ np.linalg.inv(powers)
    return weights, coefficients


def step(system, n, stages, h):
    """The equations of the step g(z; q, p, u) = 0 and its end, z being the velocities at the stages."""
    q, p, u, z = ca.SX.sym("q", n), ca.SX.sym("p", n), ca.SX.sym("u", n), ca.SX.sym("z", n * stages)
    at, v = ca.SX.sym("at", n), ca.SX.sym("v", n)
    lagrangian, rayleigh = system(at, v)
    momentum = ca.Function("momentum", [at, v], [ca.gradient(lagrangian, v)])
    rate = ca.Function("rate", [at, v], [ca.gradient(lagrangian, at) - ca.gradient(rayleigh, v)])
    velocities = [z[i * n : (i + 1) * n] for i in range(stages)]
    # The midpoint rule is the Gauss method of one stage.
    weights, a = gauss(stages)
    places = [q + h * sum(a[i, j] * velocities[j] for j in range(stages)) for i in range(stages)]
    rates = [rate(places[i], velocities[i]) + u for i in range(stages)]
    residual = [
        momentum(places[i], velocities[i]) - p - h * sum(a[i, j] * rates[j] for j in range(stages))
        for i in range(stages)
    ]
    q1 = q + h * sum(weights[j] * velocities[j] for j in range(stages))
    p1 = p + h * sum(weights[j] * rates[j] for j in range(stages))
    return [q, p, u, z], ca.cse(ca.vertcat(*residual)), ca.vertcat(q1, p1)


def write(folder, name, system, n, stages, h):
    [q, p, u, z], residual, end = step(system, n, stages, h)
    given = ca.vertcat(q, p, u)
    solve = ca.rootfinder(
        "solve",
        "fast_newton",
        {"x": z, "p": given, "g": residual},
        {"abstol": 1e-13, "abstolStep": 1e-13, "max_iter": 20},
    )
    state, inputs = ca.vertcat(q, p), u
    # dz = −(∂g/∂z)⁻¹ ∂g/∂(q, p, u), and the end follows z and (q, p, u).
    by_given = ca.solve(ca.jacobian(residual, z), -ca.jacobian(residual, given))
    whole = ca.jacobian(end, given) + ca.mtimes(ca.jacobian(end, z), by_given)
    finish = ca.Function("finish", [q, p, u, z], ca.cse([end]))
    both = ca.Function("both", [q, p, u, z], ca.cse([end, ca.densify(whole[:, : 2 * n]), ca.densify(whole[:, 2 * n :])]))

    Q, P, U, guess = (ca.MX.sym(s, k) for s, k in [("Q", n), ("P", n), ("U", n), ("guess", n * stages)])
    root = solve(guess, ca.vertcat(Q, P, U))
    ended = finish(Q, P, U, root)
    arguments = [Q, P, U, guess]
    functions = [
        ca.Function(f"{name}_step", arguments, [ended, root]),
        ca.Function(
            f"{name}_linearized",
            arguments,
            [
                ended,
                root,
                ca.densify(ca.horzcat(ca.jacobian(ended, Q), ca.jacobian(ended, P))),
                ca.densify(ca.jacobian(ended, U)),
            ],
        ),
        ca.Function(f"{name}_implicit", arguments, [(e := both(Q, P, U, root))[0], root, e[1], e[2]]),
    ]
    generator = ca.CodeGenerator(f"{name}.c", {"with_header": True})
    for function in functions:
        generator.add(function)
    generator.generate(str(folder) + "/")


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    for system, n in [(pendulum, 2), (arm, 3)]:
        for rule, stages in [("midpoint", 1), ("gauss", 3)]:
            write(folder, f"{system.__name__}_{rule}_casadi", system, n, stages, STEP_SIZE[system.__name__])
