"""Holds the template's unit against what an importer of others makes of it: FMPy reads, validates and simulates it.

    importer.py cart_pole.fmu cart_pole_fmi2.fmu reference.txt libconstrained.so descriptions/

The last two are of a unit on constraints, which is packed here.

Every check has a control: the same check of something that is wrong, which has to fail.
"""

import ctypes
import shutil
import struct
import sys
import tempfile
import zipfile
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi3 import FMU3Slave, fmi3Discard, fmi3Error, fmi3LogMessageCallback, fmi3OK
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.validation import validate_fmu

unit, unit_of_two, reference, library_on_constraints, descriptions = map(Path, sys.argv[1:6])
passed = 0


def check(holds, what):
    global passed
    if not holds:
        sys.exit(f"importer.py: {what}")
    passed += 1


def fails(check_of, what):
    """That a check can fail."""
    try:
        check_of()
    except AssertionError:
        return check(True, what)
    check(False, f"control: {what}")


def same(one, other):
    """Bit by bit."""
    one, other = np.asarray(one, dtype=np.float64), np.asarray(other, dtype=np.float64)
    assert one.shape == other.shape and (one.view(np.uint64) == other.view(np.uint64)).all()


def close(one, other, tolerance):
    one, other = np.asarray(one), np.asarray(other)
    assert (abs(one - other) <= tolerance * (1.0 + abs(other))).all(), (one, other)


def holds(check_of, what):
    try:
        check_of()
    except AssertionError as error:
        check(False, f"{what} {error}")
    check(True, what)


# --- the description ---------------------------------------------------------------------------------------------------

description = fmpy.read_model_description(unit)
names = [variable.name for variable in description.modelVariables]
of = {variable.name: variable for variable in description.modelVariables}
vr = {name: of[name].valueReference for name in names}
parameters = ["cart", "rod", "half_length", "friction[0]", "friction[1]"]
motion = ["q[0]", "q[1]", "v[0]", "v[1]", "p[0]", "p[1]", "energy"]

check(validate_fmu(str(unit)) == [], f"validates: {validate_fmu(str(unit))}")
check(names == ["time", "step_size", *parameters, "u[0]", *motion, "tip", "height"], f"the variables: {names}")
check([of[name].unit for name in parameters] == ["kg", "kg", "m", "N.s/m", "N.m.s"], "units from the documentation")
check([of[name].unit for name in ["u[0]", "q[0]", "q[1]", "v[0]", "v[1]", "p[0]"]] == ["N", "m", "rad", "m/s", "rad/s", "N.s"], "units")
check(of["q[1]"].description == "angle of the rod from upright." and of["p[1]"].unit is None, "what the documentation tells")
check(description.description == "A rod hinged to a cart on a rail.", f"the rest of it: {description.description}")
check([of[name].unit for name in ["tip", "height"]] == ["m", "m"] and of["tip"].causality == "output", "outputs")
check(of["height"].description == "of the rod's end over the hinge.", "an output from the documentation of its function")
check(of["rod"].description == "Mass of the rod.", "descriptions from the documentation")
check(of["u[0]"].causality == "input" and of["energy"].causality == "output", "inputs and outputs")

with tempfile.TemporaryDirectory() as folder:
    broken = Path(folder, "broken.fmu")
    with zipfile.ZipFile(unit) as old, zipfile.ZipFile(broken, "w") as new:
        xml = old.read("modelDescription.xml").decode()
        new.writestr("modelDescription.xml", xml.replace('name="rod"', 'name="cart"').replace('start="0.1"', ""))
    check(len(validate_fmu(str(broken))) >= 2, "control: a name twice and a start that lacks are found")

# --- simulation --------------------------------------------------------------------------------------------------------

runs = {}
for line in reference.read_text().splitlines():
    name, *numbers = line.split()
    runs.setdefault(name, []).append([struct.unpack(">d", bytes.fromhex(bits))[0] for bits in numbers])
runs = {name: np.array(rows) for name, rows in runs.items()}


def columns(result):
    return np.column_stack([result[name] for name in motion])


result = fmpy.simulate_fmu(str(unit), stop_time=3.0, output=motion)
holds(lambda: same(columns(result), runs["stated"][:, 1:]), "a simulation is the run in Rust, bit by bit")
off = runs["stated"][:, 1:].copy()
off[-1, 3] = np.nextafter(off[-1, 3], 1e9)
fails(lambda: same(columns(result), off), "a last place is seen")

# Outputs of the block, from the motion by hand; of the same names in FMI 2.0, below.
def tip(result, half_length=0.25):
    x, angle = result["q[0]"], result["q[1]"]
    return np.column_stack([x + 2 * half_length * np.sin(angle), 2 * half_length * np.cos(angle)])


def outputs(result):
    return np.column_stack([result[name] for name in ["tip", "height"]])


result = fmpy.simulate_fmu(str(unit), stop_time=3.0, output=[*motion, "tip", "height"])
holds(lambda: close(outputs(result), tip(result), 1e-15), "outputs are those of the motion, at the start too")
fails(lambda: close(outputs(result), tip(result, half_length=0.2501), 1e-5), "a length is seen in the outputs")
fails(lambda: close(outputs(result)[1:], tip(result)[:-1], 1e-5), "the time is seen in the outputs")

# Other parameters, another start, another step size, and an input at each communication point.
start = {"cart": 2.5, "friction[1]": 0.05, "step_size": 0.005, "q[0]": 0.3, "q[1]": -2.0, "v[0]": 0.1, "v[1]": 4.0}
times = 0.005 * np.arange(301)
signal = np.array(list(zip(times, runs["other"][:, 0])), dtype=[("time", float), ("u[0]", float)])
other = {"output": motion, "output_interval": 0.005, "stop_time": 1.5}
result = fmpy.simulate_fmu(str(unit), start_values=start, input=signal, **other)
holds(lambda: same(columns(result), runs["other"][:, 1:]), "parameters, start, step size and input arrive")
for name in ["cart", "friction[1]", "v[1]"]:
    less = {key: value for key, value in start.items() if key != name}
    result = fmpy.simulate_fmu(str(unit), start_values=less, input=signal, **other)
    fails(lambda: same(columns(result), runs["other"][:, 1:]), f"{name} matters")
result = fmpy.simulate_fmu(str(unit), start_values=start, **other)
fails(lambda: same(columns(result), runs["other"][:, 1:]), "the input matters")

# --- call by call ------------------------------------------------------------------------------------------------------

folder = fmpy.extract(str(unit))
said = []


@fmi3LogMessageCallback
def log(_environment, status, category, message):
    said.append((status, category.decode(), message.decode()))


def instance(start_values=(), initialize=True, token=description.instantiationToken):
    made = FMU3Slave(guid=token, unzipDirectory=folder, modelIdentifier="cart_pole", instanceName="one")
    made.instantiate(loggingOn=True, logMessage=log)
    for name, value in dict(start_values).items():
        made.setFloat64([vr[name]], [value])
    if initialize:
        made.enterInitializationMode(startTime=0.0)
        made.exitInitializationMode()
    return made


def get(of_instance, *wanted):
    return np.array(of_instance.getFloat64([vr[name] for name in wanted]))


def put(of_instance, name, value):
    of_instance.setFloat64([vr[name]], [value])


def refused(call, status, *words):
    """That a call fails with this status, and says so with these words."""
    said.clear()
    try:
        call()
    except FMICallException as error:
        found = error.status == status and len(said) == 1 and said[0][0] == status
        return check(found and all(word in said[0][2] for word in words), f"{status} {words}: {error} {said}")
    check(False, f"not refused: {words}")


one = instance()
check(list(one.doStep(0.0, 0.05)[:3]) == [False] * 3, "a step over five times h")
holds(lambda: same(get(one, *motion), runs["stated"][5, 1:]), "five steps are five steps")
check(abs(get(one, "time")[0] - 0.05) < 1e-15, "the time")

# A communication step that is none, and one from elsewhere: refused, and nothing changed.
refused(lambda: one.doStep(0.05, 0.0), fmi3Discard, "0", "not positive")
refused(lambda: one.doStep(0.05, -0.01), fmi3Discard, "-0.01", "not positive")
refused(lambda: one.doStep(0.05, float("nan")), fmi3Discard, "not positive")
refused(lambda: one.doStep(0.06, 0.01), fmi3Error, "0.06", "0.05")
check(one.doStep(0.05, 0.01 * (1 + 1e-9))[3] == 0.06, "rounding of the importer's clock is none of these")
holds(lambda: same(get(one, *motion), runs["stated"][6, 1:]), "what was refused has changed nothing")

# A step that fails reports the error's text, and leaves the unit where it was.
# A pole without length has no mass, and is sound as long as the hinge has friction.
put(one, "half_length", 0.0)
put(one, "friction[1]", 0.0)
refused(lambda: one.doStep(0.06, 0.02), fmi3Error, "at time 0.06", "singular")
put(one, "half_length", 0.25)
put(one, "friction[1]", 0.002)
one.doStep(0.06, 0.02)
# The parameter has changed in between, so the guess was forgotten: equal within rounding.
holds(lambda: close(get(one, *motion), runs["stated"][8, 1:], 1e-14), "it goes on from there")
refused(lambda: instance({"v[0]": 1e300, "step_size": 1e300}).doStep(0.0, 1e300), fmi3Error, "at time 0")
one.setDebugLogging(False, [])
said.clear()
try:
    one.doStep(0.08, 0.0)
except FMICallException:
    check(said == [], "a log that is off says nothing")
one.setDebugLogging(True, ["logStatusDiscard"])
refused(lambda: one.doStep(0.08, 0.0), fmi3Discard, "not positive")
one.setDebugLogging(True, [])

# What may be set when.
refused(lambda: put(one, "q[0]", 1.0), fmi3Error, "q[0]", "step mode")
refused(lambda: put(one, "step_size", 0.1), fmi3Error, "step_size")
refused(lambda: put(one, "energy", 1.0), fmi3Error, "energy")
refused(lambda: put(one, "tip", 1.0), fmi3Error, "tip")
refused(lambda: put(one, "u[0]", float("inf")), fmi3Error, "u[0]", "finite")
refused(lambda: put(one, "rod", float("nan")), fmi3Error, "rod")
refused(lambda: one.setFloat64([99], [1.0]), fmi3Error, "99")
refused(lambda: one.getFloat32([vr["rod"]]), fmi3Error, "Float64")
refused(lambda: one.getInt32([vr["rod"]]), fmi3Error, "Float64")
refused(lambda: one.getBoolean([vr["rod"]]), fmi3Error, "Boolean")
refused(lambda: one.exitInitializationMode(), fmi3Error, "step mode")
refused(lambda: one.enterEventMode(), fmi3Error, "fmi3EnterEventMode")
refused(lambda: put(instance(initialize=False), "step_size", -0.1), fmi3Error, "-0.1")
refused(lambda: put(instance(initialize=False), "v[0]", float("nan")), fmi3Error, "v[0]")
refused(lambda: instance(initialize=False).doStep(0.0, 0.01), fmi3Error, "not initialized")
refused(lambda: instance({"half_length": 0.0, "friction[1]": 0.0}), fmi3Error, "singular")
one.terminate()
refused(lambda: one.doStep(0.08, 0.01), fmi3Error, "terminated")

# Reset.
one.reset()
check(get(one, "rod", "step_size")[1] == 0.01, "start values again")
one.enterInitializationMode(startTime=0.0)
one.exitInitializationMode()
one.doStep(0.0, 0.1)
holds(lambda: same(get(one, *motion), runs["stated"][10, 1:]), "a reset unit is a new one, bit by bit")

# A communication step that is no multiple of h ends with a shorter step: those of a unit with that h.
parted = instance()
parted.doStep(0.0, 0.035)
check(abs(get(parted, "time")[0] - 0.035) < 1e-15, "the run ends at the time asked for")
whole, short = instance(), instance({"step_size": 0.005})
whole.doStep(0.0, 0.03)
state = dict(zip(["q[0]", "q[1]", "v[0]", "v[1]"], get(whole, "q[0]", "q[1]", "v[0]", "v[1]")))
short = instance({**state, "step_size": 0.005})
short.doStep(0.0, 0.005)
holds(lambda: close(get(parted, *motion), get(short, *motion), 1e-14), "the shorter step is that of its length")
fails(lambda: close(get(parted, *motion), get(whole, *motion), 1e-14), "without it the run is elsewhere")
parted.doStep(0.035, 0.03)
check(abs(get(parted, "time")[0] - 0.065) < 1e-15, "h is as before")
again = instance({**dict(zip(["q[0]", "q[1]", "v[0]", "v[1]"], get(short, "q[0]", "q[1]", "v[0]", "v[1]")))})
again.doStep(0.0, 0.03)
holds(lambda: close(get(parted, *motion), get(again, *motion), 1e-13), "the next ones are of h again")
tiny = instance()
tiny.doStep(0.0, 1e-4)
check(abs(get(tiny, "time")[0] - 1e-4) < 1e-18, "a communication step may be shorter than h")

# Another build's description.
said.clear()
try:
    instance(token="another")
    check(False, "another token is refused")
except Exception:
    check("another" in said[0][2] and description.instantiationToken in said[0][2], "another token is refused")

# --- states ------------------------------------------------------------------------------------------------------------

put(one, "u[0]", 0.7)
saved = one.getFMUState()
one.doStep(0.1, 0.2)
there = get(one, *motion)
put(one, "rod", 0.4)
put(one, "u[0]", -3.0)
one.doStep(0.3, 0.1)
one.setFMUState(saved)
check(get(one, "rod", "u[0]", "time").tolist() == [0.1, 0.7, 0.1], "parameters, inputs and time are of the state")
one.doStep(0.1, 0.2)
holds(lambda: same(get(one, *motion), there), "a state that is set goes on bit by bit")
put(one, "u[0]", 0.8)
one.setFMUState(saved)
put(one, "u[0]", 0.7 + 1e-9)
one.doStep(0.1, 0.2)
fails(lambda: same(get(one, *motion), there), "another input goes elsewhere")

as_bytes = one.serializeFMUState(saved)
two = instance()
read = two.deserializeFMUState(as_bytes)
two.setFMUState(read)
check(get(two, "rod", "u[0]", "time").tolist() == [0.1, 0.7, 0.1], "a state as bytes goes into another instance")
two.doStep(0.1, 0.2)
holds(lambda: close(get(two, *motion), there, 1e-14), "a state as bytes goes on within rounding")
check(one.serializeFMUState(read) == as_bytes, "a state that was read writes the same bytes")
refused(lambda: two.deserializeFMUState(as_bytes[:-8]), fmi3Error, "bytes")
refused(lambda: two.deserializeFMUState(as_bytes[:-1]), fmi3Error, "bytes")
refused(lambda: two.deserializeFMUState(bytes(8) + as_bytes[8:]), fmi3Error, "bytes")
one.freeFMUState(saved)
two.freeFMUState(read)

# --- derivatives: against differences of the unit's own motion ---------------------------------------------------------

begin = {"q[0]": 0.2, "q[1]": 0.7, "v[0]": -0.3, "v[1]": 1.1}
ends = ["q[0]", "q[1]", "p[0]", "p[1]", "v[0]", "v[1]", "energy"]
# Three steps of h and a shorter one.
SIZE = 0.034


def end_of(start_values, u=0.4, **then):
    """q and p at the beginning of a communication step of three times h, and where it ends."""
    made = instance(start_values)
    put(made, "u[0]", u)
    for name, value in then.items():
        put(made, name, value)
    first = get(made, *ends[:4])
    made.doStep(0.0, SIZE)
    return first, get(made, *ends), made


def differences(varied, e=1e-5):
    (first_up, up, _), (first_down, down, _) = varied(e), varied(-e)
    return (first_up - first_down) / (2 * e), (up - down) / (2 * e)


first, end, linearized = end_of(begin)


def along(unknowns, knowns, seed):
    return linearized.getDirectionalDerivative([vr[n] for n in unknowns], [vr[n] for n in knowns], list(seed))


_, by_u = differences(lambda e: end_of(begin, u=0.4 + e))
holds(lambda: close(along(ends, ["u[0]"], [1.0]), by_u, 1e-8), "B of a communication step, v and the energy too")
fails(lambda: close(along(ends, ["u[0]"], [1.001]), by_u, 1e-8), "a thousandth is seen in B")
for name in begin:
    # The start moves q and, with it, p: both are seeds.
    by_start, by_end = differences(lambda e: end_of({**begin, name: begin[name] + e}))
    holds(lambda: close(along(ends, ends[:4], by_start), by_end, 1e-8), f"A of a communication step, along {name}")
    by_start *= 1.001
    fails(lambda: close(along(ends, ends[:4], by_start), by_end, 1e-8), f"a thousandth is seen in A, along {name}")
for name in ["cart", "rod"]:
    _, by_end = differences(lambda e: end_of(begin, **{name: get(linearized, name)[0] + e}))
    holds(lambda: close(along(ends[:4], [name], [1.0]), by_end[:4], 1e-8), f"by the parameter {name}")
    fails(lambda: close(along(ends[:4], [name], [-1.0]), by_end[:4], 1e-8), f"its sign, by {name}")
both = along(ends, ["u[0]", "q[1]"], [2.0, -0.5])
holds(
    lambda: close(both, 2.0 * np.array(along(ends, ["u[0]"], [1.0])) - 0.5 * np.array(along(ends, ["q[1]"], [1.0])), 1e-13),
    "seeds add up",
)
holds(lambda: same(get(linearized, *ends), end), "derivatives change nothing")
refused(lambda: along(["v[0]"], ["rod"], [1.0]), fmi3Error, "v[0]", "rod")
refused(lambda: along(["q[0]"], ["half_length"], [1.0]), fmi3Error, "half_length")
refused(lambda: along(["tip"], ["q[0]"], [1.0]), fmi3Error, "tip", "no derivative")
refused(lambda: instance().getDirectionalDerivative([vr["q[0]"]], [vr["u[0]"]], [1.0]), fmi3Error, "communication step")


def initial(start_values):
    made = instance(start_values, initialize=False)
    made.enterInitializationMode(startTime=0.0)
    return made, get(made, "p[0]", "p[1]", "energy")


made, _ = initial(begin)
for name in begin:
    found = made.getDirectionalDerivative([vr[n] for n in ["p[0]", "p[1]", "energy"]], [vr[name]], [1.0])
    up, down = (initial({**begin, name: begin[name] + e})[1] for e in (1e-5, -1e-5))
    holds(lambda: close(found, (up - down) / 2e-5, 1e-8), f"in initialization mode, by {name}")
    fails(lambda: close(found, (up - down) / 2e-5 + 1e-3, 1e-8), f"a thousandth is seen, by {name}")

# --- what no importer should do ----------------------------------------------------------------------------------------

library = ctypes.CDLL(str(next(Path(folder).rglob("*.so"))))
declared = Path(fmpy.__file__).parent.joinpath("c-code", "fmi3Functions.h").read_text()
expected = {word.removesuffix("TYPE") for word in declared.replace(";", " ").split() if word.startswith("fmi3") and word.endswith("TYPE")}
check(len(expected) > 70, f"FMI's functions: {len(expected)}")
check([name for name in sorted(expected) if not hasattr(library, name)] == [], "all functions of FMI are there")
check(not hasattr(library, "fmi3NotAFunction"), "control: one that is not there is missed")

pointer, size = ctypes.c_void_p, ctypes.c_size_t
reference_of_rod, value = (ctypes.c_uint32 * 1)(vr["rod"]), (ctypes.c_double * 2)(7.0, 7.0)
live = pointer(ctypes.cast(one.component if hasattr(one, "component") else one.instance, pointer).value)


def raw(name, *arguments):
    function = getattr(library, name)
    function.restype = ctypes.c_int
    return function(*arguments)


get_raw = lambda *arguments: raw("fmi3GetFloat64", *arguments)
check(get_raw(live, reference_of_rod, size(1), value, size(1)) == fmi3OK and value[0] == 0.1, "control: a right call")
value[0] = 7.0
for wrong in [
    (pointer(None), reference_of_rod, size(1), value, size(1)),
    (live, pointer(None), size(1), value, size(1)),
    (live, reference_of_rod, size(1), pointer(None), size(1)),
    (live, reference_of_rod, size(1), value, size(2)),
    (live, reference_of_rod, size(2**63), value, size(1)),
    (live, reference_of_rod, size(1), pointer(ctypes.addressof(value) + 1), size(1)),
]:
    check(get_raw(*wrong) == fmi3Error and list(value) == [7.0, 7.0], "a wrong call is refused, and writes nothing")
check(raw("fmi3ExitInitializationMode", pointer(None)) == fmi3Error, "no instance")
library.fmi3FreeInstance(pointer(None))
check(raw("fmi3DoStep", live, ctypes.c_double(9.0), ctypes.c_double(0.01), ctypes.c_bool(True), *[pointer(None)] * 4) == fmi3Error, "answers may be NULL")

# --- FMI 2.0: the same instances by other functions ----------------------------------------------------------------------

in_two = fmpy.read_model_description(unit_of_two)
check(validate_fmu(str(unit_of_two)) == [], f"validates: {validate_fmu(str(unit_of_two))}")
check([variable.name for variable in in_two.modelVariables] == names, "the same variables")
check([variable.unit for variable in in_two.modelVariables] == [of[name].unit for name in names], "the same units")
result = fmpy.simulate_fmu(str(unit_of_two), stop_time=3.0, output=motion)
holds(lambda: same(columns(result), runs["stated"][:, 1:]), "FMI 2.0: the run in Rust")
fails(lambda: same(columns(result), off), "FMI 2.0: a last place is seen")
result = fmpy.simulate_fmu(str(unit_of_two), stop_time=3.0, output=[*motion, "tip", "height"])
holds(lambda: close(outputs(result), tip(result), 1e-15), "FMI 2.0: outputs are those of the motion")
result = fmpy.simulate_fmu(str(unit_of_two), start_values=start, input=signal, **other)
holds(lambda: same(columns(result), runs["other"][:, 1:]), "FMI 2.0: parameters, start, step size and input arrive")
result = fmpy.simulate_fmu(str(unit_of_two), start_values=start, **other)
fails(lambda: same(columns(result), runs["other"][:, 1:]), "FMI 2.0: the input matters")


def log_of_two(environment, name, status, category, message):
    said.append((status, category.decode(), message.decode()))


callbacks = fmi2CallbackFunctions()
callbacks.logger = fmi2CallbackLoggerTYPE(log_of_two)
folder_of_two = fmpy.extract(str(unit_of_two))


def instance_of_two(token=in_two.guid):
    made = FMU2Slave(guid=token, unzipDirectory=folder_of_two, modelIdentifier="cart_pole", instanceName="two")
    made.instantiate(callbacks=callbacks, loggingOn=True)
    made.setupExperiment(startTime=0.0)
    made.enterInitializationMode()
    for name in begin:
        made.setReal([vr[name]], [begin[name]])
    made.exitInitializationMode()
    return made


two = instance_of_two()
two.setReal([vr["u[0]"]], [0.4])
before = two.getFMUstate()
two.doStep(0.0, SIZE)
holds(lambda: same(two.getReal([vr[name] for name in ends]), end), "FMI 2.0: a communication step")
found = two.getDirectionalDerivative([vr[name] for name in ends], [vr["u[0]"]], [1.0])
holds(lambda: same(found, along(ends, ["u[0]"], [1.0])), "FMI 2.0: the same derivatives")
refused(lambda: two.doStep(SIZE, 0.0), fmi3Error, "not positive")
refused(lambda: two.getInteger([vr["rod"]]), fmi3Error, "Float64")
refused(lambda: two.setReal([vr["q[0]"]], [0.0]), fmi3Error, "q[0]")
check(two.getRealStatus(2) == SIZE and not two.getBooleanStatus(3), "FMI 2.0: status")
as_bytes = two.serializeFMUstate(before)
two.setFMUstate(before)
two.doStep(0.0, SIZE)
holds(lambda: same(two.getReal([vr[name] for name in ends]), end), "FMI 2.0: a state that is set goes on bit by bit")
two.setFMUstate(two.deSerializeFMUstate(as_bytes))
two.doStep(0.0, SIZE)
holds(lambda: close(two.getReal([vr[name] for name in ends]), end, 1e-14), "FMI 2.0: a state as bytes")
said.clear()
try:
    instance_of_two("100% another #")
    check(False, "FMI 2.0: another token is refused")
except Exception:
    check("100%% another ##" in said[0][2], f"FMI 2.0: another token is refused, in a format of its own: {said}")
declared = Path(fmpy.__file__).parent.joinpath("c-code", "fmi2Functions.h").read_text().split("FMI2_Export")
expected = {part.split()[1].rstrip(";") for part in declared if part.split()[:1] and part.split()[0].endswith("TYPE")}
exchange = {"EnterEventMode", "NewDiscreteStates", "EnterContinuousTimeMode", "CompletedIntegratorStep", "SetTime"}
exchange |= {"SetContinuousStates", "GetDerivatives", "GetEventIndicators", "GetContinuousStates", "GetNominalsOfContinuousStates"}
expected -= {"fmi2" + name for name in exchange}
check(len(expected) == 34, f"FMI 2.0's functions for co-simulation: {len(expected)}")
check([name for name in sorted(expected) if not hasattr(library, name)] == [], "FMI 2.0: all of them are there")

# --- constraints: start values are guesses, reactions are outputs --------------------------------------------------------

places = ["q[0]", "q[1]", "q[2]", "v[0]", "v[1]", "v[2]"]
M, LENGTH, GRAVITY = 1.3, 0.7, 9.81
guess = {"q[0]": 0.0, "q[1]": 0.3, "q[2]": -0.4, "v[0]": 0.5, "v[1]": 1.0, "v[2]": 1.0}


def packed(version, like):
    """The unit on constraints, its library where that of another unit is."""
    file = Path(descriptions, f"constrained{version}.fmu")
    with zipfile.ZipFile(like) as other, zipfile.ZipFile(file, "w") as new:
        library = next(name for name in other.namelist() if name.startswith("binaries/"))
        new.write(Path(descriptions, f"{version}.xml"), "modelDescription.xml")
        new.write(library_on_constraints, library.replace("cart_pole", "spherical"))
    check(validate_fmu(str(file)) == [], f"validates: {validate_fmu(str(file))}")
    return file


def tension(rows, u, with_motion=1.0):
    """Of the motion: m q'' along the rod is -m v^2 / l."""
    q, v = np.column_stack([rows[name] for name in places[:3]]), np.column_stack([rows[name] for name in places[3:]])
    return -with_motion * M * (v**2).sum(axis=1) / LENGTH + (M * GRAVITY * q[:, 2] - u * q[:, 0]) / LENGTH


for version, like in [(3, unit), (2, unit_of_two)]:
    held = packed(version, like)
    asked = {"output": [*places, "energy", "lambda[0]", "height", "power", "frequency"], "output_interval": 0.001, "stop_time": 1.0}
    result = fmpy.simulate_fmu(str(held), start_values={**guess, "step_size": 0.001, "u[0]": 0.8}, **asked)
    q = np.column_stack([result[name] for name in places[:3]])
    holds(lambda: close([result[name][0] for name in places], [0.0, 0.42, -0.56, 0.5, 1.12, 0.84], 1e-15), "the nearest state begins")
    holds(lambda: close(np.linalg.norm(q, axis=1), LENGTH, 1e-15), "it stays on the sphere")
    # A reaction over a step is that at its beginning, to first order.
    found, expected = result["lambda[0]"][1:], tension(result, 0.8)[:-1]
    off = abs(found - expected).max()
    check(off < 0.02, f"reactions are those of the motion: {off}")
    check(abs(found - tension(result, 0.8, with_motion=0.99)[:-1]).max() > 0.02, "control: a hundredth of the motion is seen")
    check(abs(found - tension(result, 0.7)[:-1]).max() > 0.02, "control: the input is seen")
    check(result["lambda[0]"][0] == result["lambda[0]"][1], "at the start it is that of the first step")
    by_hand = np.column_stack([q[:, 2] + LENGTH, 0.8 * result["v[0]"], np.full(len(q), (GRAVITY / LENGTH) ** 0.5)])
    of_block = np.column_stack([result[name] for name in ["height", "power", "frequency"]])
    holds(lambda: close(of_block, by_hand, 1e-15), "outputs of state and input, at the nearest state to begin with")
    check(abs(of_block[0, :2] - [0.14, 0.4]).max() < 1e-15, "the first of them in numbers")
    fails(lambda: close(of_block, by_hand * [1.0, 0.8001 / 0.8, 1.0], 1e-5), "the input is seen in the outputs")

description_on_constraints = fmpy.read_model_description(descriptions / "constrained3.fmu")
vr_on_constraints = {variable.name: variable.valueReference for variable in description_on_constraints.modelVariables}
folder_on_constraints = fmpy.extract(str(descriptions / "constrained3.fmu"))
lost = FMU3Slave(
    guid=description_on_constraints.instantiationToken,
    unzipDirectory=folder_on_constraints,
    modelIdentifier="spherical",
    instanceName="lost",
)
lost.instantiate(loggingOn=True, logMessage=log)
lost.setFloat64([vr_on_constraints[name] for name in places], [0.0] * 6)
lost.enterInitializationMode(startTime=0.0)
refused(lambda: lost.exitInitializationMode(), fmi3Error, "at time 0", "derivative")
lost.setFloat64([vr_on_constraints["q[2]"]], [-1.0])
lost.exitInitializationMode()
lost.doStep(0.0, 0.01)
holds(lambda: close(lost.getFloat64([vr_on_constraints["lambda[0]"]]), [-M * GRAVITY], 1e-12), "the rod carries the weight")
lost.setFloat64([vr_on_constraints["l"]], [-0.7])
refused(lambda: lost.getFloat64([vr_on_constraints["frequency"]]), fmi3Error, "frequency is NaN", "at time 0.01", "fn outputs")
refused(lambda: lost.getFloat64([vr_on_constraints[name] for name in ["height", "frequency"]]), fmi3Error, "frequency")
check(lost.getFloat64([vr_on_constraints["height"]]) == [lost.getFloat64([vr_on_constraints["q[2]"]])[0] - 0.7], "others are numbers")
lost.setFloat64([vr_on_constraints["l"]], [0.8])
refused(lambda: lost.doStep(0.01, 0.01), fmi3Error, "constraint 0", "1.000e-1")
shutil.rmtree(folder_on_constraints, ignore_errors=True)

# --- speed is no claim, but a unit that leaks or locks shows here --------------------------------------------------------

for _ in range(200):
    each = instance()
    state = each.getFMUState()
    each.doStep(0.0, 0.01)
    each.setFMUState(state)
    each.freeFMUState(state)
    each.terminate()
    each.freeInstance()
for each in [folder, folder_of_two]:
    shutil.rmtree(each, ignore_errors=True)
print(f"units of FMI 3.0 and 2.0 in FMPy {fmpy.__version__}: {passed} passed, 0 failed")
