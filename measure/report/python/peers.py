"""Times methods that have a Python interface, one run at a request, so that another program can take turns with it.

Says which methods there are, which find events and which are for mechanisms, then answers a line `method<TAB>scene<TAB>tolerance<TAB>repeats<TAB>samples` with `end`, the
seconds of one trajectory and (q, v) at so many equal intervals, of a batch of all its trajectories, or with what went wrong. The time is this thread's processor time,
taken here, around the integration alone.
"""

import sys
from functools import cache
from time import thread_time

import mujoco_models
from constrained import REDUCED
from scenes import LONG_RUN, SCENES

ALL = SCENES | REDUCED | {"long run": LONG_RUN}
BATCH = 8
# Numbers of coordinates where compiling every operation on its own takes minutes; heyoka's compact mode is for these.
LARGE, LARGE_BATCH = 16, 7
# Those of mechanisms without their multipliers, which take a minute for each tolerance, and in compact mode three times as long to run.
UNCOMPILED = 9


def motion(hy, scene):
    """The scene's equations as heyoka's expressions, and its start."""
    names = [f"q{i}" for i in range(scene.n)] + [f"v{i}" for i in range(scene.n)]
    y = [hy.make_vars(name) for name in names]
    q, v = y[: scene.n], y[scene.n :]
    return y, list(zip(y, v + scene.acceleration(hy, q, v))), scene.q + scene.v


def heyoka_methods(hy):
    import numpy as np

    @cache
    def scalar(name, tolerance):
        if ALL[name].n >= UNCOMPILED and name in REDUCED:
            raise RuntimeError("takes a minute to compile")
        _, rates, start = motion(hy, ALL[name])
        return hy.taylor_adaptive(rates, start, tol=tolerance, compact_mode=ALL[name].n >= LARGE)

    @cache
    def batch(name, tolerance):
        _, rates, start = motion(hy, ALL[name])
        starts = np.tile(np.array(start)[:, None], (1, BATCH))
        starts[0] += 1e-3 * np.arange(BATCH)  # eight trajectories, not eight times one
        integrator = hy.taylor_adaptive_batch(rates, starts, tol=tolerance, compact_mode=ALL[name].n >= LARGE_BATCH)
        return integrator, starts

    def run_scalar(name, tolerance, repeats, samples):
        integrator, scene = scalar(name, tolerance), ALL[name]
        start = np.array(scene.q + scene.v)
        times = [scene.end * (i + 1) / samples for i in range(samples)]
        begin = thread_time()
        for _ in range(repeats):
            integrator.time = 0.0
            integrator.state[:] = start
            states = []
            for time in times:
                outcome = integrator.propagate_until(time)[0]
                states.append(integrator.state.copy())
        seconds = (thread_time() - begin) / repeats
        if outcome != hy.taylor_outcome.time_limit:
            raise RuntimeError(f"heyoka stopped with {outcome}")
        return seconds, states

    def run_batch(name, tolerance, repeats, samples):
        (integrator, starts), scene = batch(name, tolerance), ALL[name]
        times = [scene.end * (i + 1) / samples for i in range(samples)]
        begin = thread_time()
        for _ in range(repeats):
            integrator.set_time(0.0)
            integrator.state[:] = starts
            states = []
            for time in times:
                integrator.propagate_until(time)
                states.extend(integrator.state.T.copy())
        seconds = (thread_time() - begin) / repeats / BATCH
        if any(result[0] != hy.taylor_outcome.time_limit for result in integrator.propagate_res):
            raise RuntimeError("heyoka stopped early")
        return seconds, states

    return {"heyoka": run_scalar, "heyoka, batch of 8": run_batch}


def heyoka_events(hy):
    """Crossings of q0 = 0 from below: of the last one its time, q1 and v1, and how many there were."""
    import numpy as np

    @cache
    def integrator(name, tolerance, states):
        y, rates, start = motion(hy, ALL[name])
        found = []

        def callback(at, time, _):
            if states:
                at.update_d_output(time)
                found.append((time, *at.d_output[[1, 3]]))
            else:
                found.append(time)

        event = hy.nt_event(y[0], callback=callback, direction=hy.event_direction.positive)
        return hy.taylor_adaptive(rates, start, tol=tolerance, nt_events=[event]), found

    def run(name, tolerance, repeats, states):
        (taken, found), scene = integrator(name, tolerance, states), ALL[name]
        start = np.array(scene.q + scene.v)
        begin = thread_time()
        for _ in range(repeats):
            found.clear()
            taken.time = 0.0
            taken.state[:] = start
            taken.propagate_until(scene.end + 0.5)
        return (thread_time() - begin) / repeats, [after for after in found if (after[0] if states else after) > 1e-6]

    def times(name, tolerance, repeats, _):
        # y and v_y by a run that is not timed.
        seconds, found = run(name, tolerance, repeats, False)
        _, [*_, last] = run(name, tolerance, 1, True)
        return seconds, [[found[-1], last[1], last[2], len(found)]]

    def with_states(name, tolerance, repeats, _):
        seconds, found = run(name, tolerance, repeats, True)
        return seconds, [[*found[-1], len(found)]]

    return {"heyoka, times alone": times, "heyoka, with states": with_states}


def scipy_methods(hy):
    """SciPy's compiled DOP853, its right-hand side compiled by heyoka."""
    import numpy as np
    from scipy.integrate import ode

    @cache
    def rate(name):
        y, rates, _ = motion(hy, ALL[name])
        function = hy.cfunc([right for _, right in rates], vars=y)
        return lambda _, y: function(y)

    def run(name, tolerance, repeats, samples):
        scene, function = ALL[name], rate(name)
        start = np.array(scene.q + scene.v)
        times = [scene.end * (i + 1) / samples for i in range(samples)]
        begin = thread_time()
        for _ in range(repeats):
            solver = ode(function).set_integrator("dop853", rtol=tolerance, atol=tolerance, nsteps=10**8)
            solver.set_initial_value(start, 0.0)
            states = [solver.integrate(time) for time in times]
        seconds = (thread_time() - begin) / repeats
        if not solver.successful():
            raise RuntimeError(f"scipy stopped with {solver.get_return_code()}")
        return seconds, states

    return {"scipy dop853": run}


def implicit_methods(hy):
    """SciPy's Radau, which is Python but for its linear algebra; its right-hand side is compiled by heyoka."""
    import numpy as np
    from scipy.integrate import solve_ivp

    @cache
    def rate(name):
        y, rates, _ = motion(hy, ALL[name])
        function = hy.cfunc([right for _, right in rates], vars=y)
        return lambda _, y: function(np.ascontiguousarray(y))

    def run(name, tolerance, repeats, samples):
        scene, function = ALL[name], rate(name)
        if scene.end > 100.0:
            raise RuntimeError("a long motion takes minutes")
        apart = scene.end / samples
        begin = thread_time()
        for _ in range(repeats):
            y, states = np.array(scene.q + scene.v), []
            for _ in range(samples):
                solution = solve_ivp(function, (0.0, apart), y, method="Radau", rtol=tolerance, atol=tolerance)
                y = solution.y[:, -1]
                states.append(y)
        return (thread_time() - begin) / repeats, states

    return {"scipy Radau": run}


def available():
    """The methods whose libraries are installed; says what is and what is not."""
    methods = {}
    try:
        import heyoka as hy
    except ImportError:
        print("missing heyoka (Python package heyoka)")
        print("missing scipy dop853 (Python packages scipy and, for its right-hand side, heyoka)")
        return methods
    print(f"version heyoka {hy.__version__}")
    methods |= heyoka_methods(hy)
    try:
        import scipy
    except ImportError:
        print("missing scipy dop853 (Python package scipy)")
        return methods
    print(f"version scipy {scipy.__version__}")
    return methods | scipy_methods(hy)


def main():
    methods = available()
    for name in methods:
        print(f"method {name}")
    if methods:
        import heyoka

        events = heyoka_events(heyoka)
        for name in events:
            print(f"events {name}")
        # Of mechanisms on constraints without their multipliers.
        reduced = {"heyoka": methods["heyoka"]}
        if "scipy dop853" in methods:
            reduced |= {"scipy dop853": methods["scipy dop853"]} | implicit_methods(heyoka)
        for name in reduced:
            print(f"reduced {name}")
        methods |= events | {name: run for name, run in reduced.items() if name not in methods}
    stepped = mujoco_models.methods()
    for name in stepped:
        print(f"stepped {name}")
    methods |= stepped
    print("ready", flush=True)
    for line in sys.stdin:
        method, scene, tolerance, repeats, samples = line.rstrip("\n").split("\t")
        try:
            seconds, states = methods[method](scene, float(tolerance), int(repeats), int(samples))
            print("end", repr(seconds), *(repr(float(x)) for state in states for x in state), flush=True)
        except Exception as error:  # the other side reports it and goes on
            print(f"{type(error).__name__}: {error}".replace("\n", " "), flush=True)


main()
