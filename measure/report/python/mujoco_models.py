"""The mechanisms of `constrained.py` in MuJoCo: as bodies that equality constraints hold, and in joints.

The bodies start where the motion does, since MuJoCo's constraints hold what a model's first configuration is. Constraints are as
stiff as MuJoCo recommends or allows: an impedance of 0.9999, and a time constant of two steps, which it asks for and sets by itself
below that, or of one step by the Runge–Kutta method, which is stable there, without that guard.
"""

import math
from functools import cache
from time import thread_time

from constrained import G, MECHANISMS, start

SLIDE = '<joint type="slide" axis="{} {} {}" damping="{}"/>'
HINGE = '<joint type="hinge" axis="0 -1 0" {}/>'
LENGTHS, BARS, GROUND = [0.3, 0.9, 0.7], ["crank", "coupler", "rocker"], 1.0
# The inertia of a point; MuJoCo takes no less than 1e-15.
POINT = 1e-14
FRICTION = {"four-bar, friction": 5e-6}
DRAG = {"spherical pendulum, drag": 1e-3}
AGAIN = "four-bar, nine constraints"


def model(world, constraints, h, integrator, constants):
    guard = "disable" if constants < 2 else "enable"
    stiff = f'solref="{constants * h!r} 1" solimp="0.9999 0.9999 0.001"'
    return f"""<mujoco><compiler angle="radian"/>
<option gravity="0 0 {-G}" timestep="{h!r}" integrator="{integrator}" tolerance="1e-15">
<flag contact="disable" autoreset="disable" refsafe="{guard}"/></option>
<default><equality {stiff}/></default><worldbody>{world}</worldbody>{constraints}</mujoco>"""


def body(name, mass, inertia, place, inner):
    x, y, z = place
    return f"""<body name="{name}" pos="{x!r} {y!r} {z!r}">{inner}
<inertial pos="0 0 0" mass="{mass!r}" diaginertia="{inertia!r} {inertia!r} {inertia!r}"/><site name="{name}"/></body>"""


def rods(pairs):
    """A tendon for each rod, of the length that it has at first."""
    spatial = [f'<spatial name="{a}{b}"><site site="{a}"/><site site="{b}"/></spatial>' for a, b in pairs]
    equal = [f'<tendon tendon1="{a}{b}" polycoef="0 0 0 0 0"/>' for a, b in pairs]
    return f'<tendon>{"".join(spatial)}</tendon><equality>{"".join(equal)}</equality>'


def mechanism(name):
    return MECHANISMS[name.replace(AGAIN, "four-bar")]


def along(length, angle):
    return f"{length * math.cos(angle)!r} 0 {length * math.sin(angle)!r}"


def friction(name, turns):
    """Friction of the joints, whose angles are these sums."""
    if name not in FRICTION:
        return ""
    sums = ("".join(f'<joint joint="{bar}" coef="{sign}"/>' for bar, sign in turn) for turn in turns)
    return "<tendon>" + "".join(f'<fixed damping="{FRICTION[name]!r}">{turn}</fixed>' for turn in sums) + "</tendon>"


def bodies(name):
    """The mechanism as bodies that move freely but for constraints."""
    q, v = start(mechanism(name))
    mass, origin = mechanism(name).mass, '<site name="o"/>'
    slides = SLIDE.format(1, 0, 0, DRAG.get(name, 0.0)) + SLIDE.format(0, 0, 1, DRAG.get(name, 0.0))
    if len(q) == 3:
        slides = "".join(SLIDE.format(*axis, DRAG.get(name, 0.0)) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
        world, constraints = origin + body("a", mass[0], 1.0, q, slides), rods([("o", "a")])
    elif len(q) == 4:
        places = [(q[0], 0.0, q[1]), (q[2], 0.0, q[3])]
        world = origin + "".join(body(n, m, 1.0, at, slides) for n, m, at in zip("ab", mass[::2], places))
        constraints = rods([("o", "a"), ("a", "b")])
    else:
        world = "".join(
            body(bar, mass[3 * i], mass[3 * i + 2], (q[3 * i], 0.0, q[3 * i + 1]), slides + HINGE.format(f'name="{bar}"'))
            for i, bar in enumerate(BARS)
        )
        ends = [(0, -1, None), (0, 1, 1), (1, 1, 2), (2, -1, None)]
        if name == AGAIN:
            # The joint of coupler and rocker once more, from the other side.
            ends.append((2, 1, 1))
        constraints = "<equality>"
        for a, sign, b in ends:
            other = "" if b is None else f'body2="{BARS[b]}"'
            constraints += f'<connect body1="{BARS[a]}" {other} anchor="{along(sign * LENGTHS[a] / 2, q[3 * a + 2])}"/>'
        constraints += "</equality>" + friction(
            name, [[("crank", 1)], [("coupler", 1), ("crank", -1)], [("rocker", 1), ("coupler", -1)], [("rocker", 1)]]
        )

    def read(x, dx):
        return [a + b for a, b in zip(q, x)], list(dx)

    return world, constraints, [0.0] * len(q), v, read


def joints(name):
    """The mechanism in angles of its joints, MuJoCo's own coordinates; a constraint closes the loop of the linkage."""
    moved = mechanism(name)
    q, v = start(moved)
    if name in DRAG:
        raise ValueError("drag has no such form")
    if len(q) == 3:
        hinges = "".join(f'<joint type="hinge" axis="{axis}"/>' for axis in ("0 0 1", "0 -1 0"))
        world = f'<body>{hinges}<inertial pos="0 0 -1" mass="1" diaginertia="{POINT} {POINT} {POINT}"/></body>'
        return world, "", moved.x[::-1], moved.dx[::-1], lambda x, dx: moved.place(math, x[::-1], dx[::-1])
    if len(q) == 4:
        world = chain(
            [("a", along(1.0, moved.x[0] - math.pi / 2), 1.0, moved.mass[0], POINT),
             ("b", along(0.8, moved.x[1] - math.pi / 2), 1.0, moved.mass[2], POINT)]
        )  # fmt: skip

        def angles(x, dx):
            return moved.place(math, [moved.x[0] + x[0], moved.x[1] + x[0] + x[1]], [dx[0], dx[0] + dx[1]])

        return world, "", [0.0] * 2, [moved.dx[0], moved.dx[1] - moved.dx[0]], angles
    signs = [1.0, 1.0, -1.0]
    world = chain(
        (bar, along(signs[i] * LENGTHS[i], q[3 * i + 2]), 0.5, moved.mass[3 * i], moved.mass[3 * i + 2])
        for i, bar in enumerate(BARS)
    )
    end = along(-LENGTHS[2], q[8])
    constraints = f'<equality>{2 * f"""<connect body1="rocker" anchor="{end}"/>""" if name == AGAIN else f"""<connect body1="rocker" anchor="{end}"/>"""}</equality>'
    constraints += friction(name, [[("crank", 1)], [("coupler", 1)], [("rocker", 1)], [(bar, 1) for bar in BARS]])

    def read(x, dx):
        places, rates, at, speed = [], [], [0.0, 0.0], [0.0, 0.0]
        for i in range(3):
            angle, rate = q[3 * i + 2] + sum(x[: i + 1]), sum(dx[: i + 1])
            arm = [signs[i] * LENGTHS[i] / 2 * math.cos(angle), signs[i] * LENGTHS[i] / 2 * math.sin(angle)]
            turn = [-arm[1] * rate, arm[0] * rate]
            places += [at[0] + arm[0], at[1] + arm[1], angle]
            rates += [speed[0] + turn[0], speed[1] + turn[1], rate]
            at = [a + 2 * b for a, b in zip(at, arm)]
            speed = [a + 2 * b for a, b in zip(speed, turn)]
        return places, rates

    return world, constraints, [0.0] * 3, [v[2], v[5] - v[2], v[8] - v[5]], read


def chain(links):
    """Bodies that hang one on the other: their names, from hinge to hinge, where on that the mass is, mass and inertia."""
    world, at, closed = "", "0 0 0", ""
    for name, along, share, mass, inertia in links:
        centre = " ".join(repr(share * float(x)) for x in along.split())
        world += f"""<body name="{name}" pos="{at}">{HINGE.format(f'name="{name}"')}
<inertial pos="{centre}" mass="{mass!r}" diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>"""
        at, closed = along, closed + "</body>"
    return world + closed


def run(build):
    """Times `mj_step`, many steps a call, on the model that `build` makes of a mechanism, step size and time."""
    import mujoco

    mujoco.set_mju_user_warning(lambda _: None)

    @cache
    def made(scene, h):
        name, end, _ = scene.rsplit(", ", 2)
        text, x, dx, read = build(name, h)
        compiled = mujoco.MjModel.from_xml_string(text)
        return compiled, mujoco.MjData(compiled), x, dx, read, float(end.removeprefix("T = "))

    def integrate(scene, h, repeats, samples):
        compiled, data, x, dx, read, end = made(scene, h)
        steps = round(end / samples / h)
        begin = thread_time()
        for _ in range(repeats):
            mujoco.mj_resetData(compiled, data)
            data.qpos[:], data.qvel[:] = x, dx
            states = []
            for _ in range(samples):
                mujoco.mj_step(compiled, data, steps)
                states.append((data.qpos.copy(), data.qvel.copy()))
        seconds = (thread_time() - begin) / repeats
        return seconds, [sum(map(list, read(*state)), []) for state in states]

    return integrate


def by(form, integrator, constants):
    """A form of the mechanism on constraints of so many steps' time constant."""

    def build(name, h):
        world, constraints, x, dx, read = form(name)
        return model(world, constraints, h, integrator, constants), x, dx, read

    return run(build)


def methods():
    try:
        import mujoco
    except ImportError:
        print("missing MuJoCo (Python package mujoco)")
        return {}
    print(f"version MuJoCo {mujoco.__version__}")
    return {
        "MuJoCo, implicitfast": by(bodies, "implicitfast", 2.0),
        "MuJoCo, RK4": by(bodies, "RK4", 1.0),
        "MuJoCo in joints, RK4": by(joints, "RK4", 1.0),
    }
