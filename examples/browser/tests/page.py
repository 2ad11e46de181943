"""Holds the page against this machine's own runs: `page.py ADDRESS RUNS [PICTURE]`.

RUNS has the lines of `host runs`. With PICTURE the page's picture is written there.
"""

import json
import math
import struct
import sys
import tempfile
import time
from pathlib import Path

from chromium import Chromium

WIDTH, HEIGHT = 1040, 800
COLOURS = {"rule": (0, 114, 178), "rungeKutta": (213, 94, 0)}


def require(holds, what):
    if not holds:
        raise SystemExit(f"the page: {what}")


def reading(page, name):
    return float(page.evaluate(f"document.getElementById('{name}').textContent").replace("−", "-"))


def readings(page, *names):
    """Of one frame."""
    texts = page.evaluate(f"{json.dumps(names)}.map((name) => document.getElementById(name).textContent)")
    return [float(text.replace("−", "-")) for text in texts]


def slide(page, name, value):
    """Moves a slider to the place of this value, or next to it; the value that the page then has."""
    return page.evaluate(f"""import("./scenes.js").then(({{ scenes }}) => {{
        const scene = scenes[document.querySelector("input[name=scene]:checked").value];
        const {{ least, most }} = scene.ranges["{name}"];
        const slider = document.getElementById("{name}");
        slider.value = {value} === 0 ? 0 : 1000 * Math.log({value} / least) / Math.log(most / least);
        slider.dispatchEvent(new Event("input"));
        return parseFloat(document.getElementById("{name}-value").textContent);
    }})""")


def choose(page, scene):
    page.evaluate(f"document.querySelector('input[value={scene}]').click()")


def click(page, name):
    page.evaluate(f"document.getElementById('{name}').click()")


def runs_for_ten_seconds(page):
    page.wait("Number(document.getElementById('time').textContent) > 0", 10)
    (t0, steps0), start = readings(page, "time", "steps"), time.monotonic()
    time.sleep(10)
    (t1, steps1), passed = readings(page, "time", "steps"), time.monotonic() - start
    # 100 of t a second, less what a busy machine leaves out.
    require(20 * passed < t1 - t0 < 110 * passed, f"t went from {t0} to {t1} in {passed:.1f} s")
    require(steps1 - steps0 > 100 * passed, f"{steps1 - steps0} steps in {passed:.1f} s")
    for method in ["rule", "rungeKutta"]:
        rate = page.evaluate(f"document.getElementById('{method}-rate').textContent.replace(/\\D/g, '')")
        require(float(rate) > 1e4, f"{rate} steps a second by {method}")
    print(f"runs: t = {t1:.0f} and {steps1:.0f} steps after 10 s")


def friction_is_what_the_slider_says(page):
    """In the ring J falls as exp(−k t), which the reference follows."""
    for wanted in [0.0, 0.01, 0.05]:
        k = slide(page, "friction", wanted)
        require(abs(k - wanted) <= 0.005 * wanted, f"friction {k} where {wanted} was asked for")
        steps0, j0, e0 = readings(page, "steps", "reference-momentum", "reference-energy")
        page.wait(f"Number(document.getElementById('steps').textContent) > {steps0 + 100}", 20)
        steps1, j1, e1 = readings(page, "steps", "reference-momentum", "reference-energy")
        passed = 0.2 * (steps1 - steps0)
        found = math.log(j0 / j1) / passed
        # What is read has five decimals.
        require(abs(found - k) < 1e-5 / abs(j1) / passed, f"J falls by {found} in unit time at friction {k}")
        require(abs(e1 - e0) < 2e-5 if k == 0 else e0 - e1 > 1e-3, f"E goes from {e0} to {e1} at friction {k}")
    print("friction: J falls as exp(−k t), E with it, and both stand still without")


def step_size_is_what_the_slider_says(page):
    for wanted in [0.05, 0.4]:
        h = slide(page, "h", wanted)
        require(abs(h - wanted) <= 0.005 * wanted, f"h = {h} where {wanted} was asked for")
        t0, steps0 = readings(page, "time", "steps")
        page.wait(f"Number(document.getElementById('time').textContent) > {t0 + 20}", 20)
        t1, steps1 = readings(page, "time", "steps")
        found = (t1 - t0) / (steps1 - steps0)
        require(abs(found - h) < 0.01 * h, f"steps of {found} at h = {h}")
    print("step size: as many steps as the time has room for")


def choose_rule(page, rule):
    page.evaluate(f"""{{
        const choice = document.getElementById("rule");
        choice.value = "{rule}";
        choice.dispatchEvent(new Event("change"));
    }}""")


def each_rule_has_its_energy(page, reference):
    host = {run: energies(reference, f"ring_{run}") for run in ["midpoint", "trapezoidal", "gauss", "runge_kutta"]}
    for rule in ["midpoint", "trapezoidal", "gauss"]:
        # As the scene begins.
        choose(page, "double_pendulum")
        choose(page, "ring")
        choose_rule(page, rule)
        time.sleep(0.5)
        page.wait("Number(document.getElementById('steps').textContent) > 300", 10)
        click(page, "pause")
        time.sleep(0.2)
        steps, found, by_runge_kutta = readings(page, "steps", "rule-energy", "rungeKutta-energy")
        click(page, "pause")
        require(f"{found:.5f}" == f"{host[rule][steps]:.5f}", f"the energy by {rule} after {steps} steps is {found}")
        require(f"{by_runge_kutta:.5f}" == f"{host['runge_kutta'][steps]:.5f}", f"the energy by RK4 after {steps} steps is {found}")
        # The control: it is that of no other.
        others = [run for run, of in host.items() if run != rule and f"{of[steps]:.5f}" == f"{found:.5f}"]
        require(others == [], f"the energy by {rule} is that of {others}")
        name = page.evaluate("document.getElementById('rule-name').textContent")
        require(name.lower() == rule, f"{rule} is called {name}")
    print("rules: each has the host's energy, which is no other's")


def a_failure_is_said(page):
    """At h = 0.1 and without friction the midpoint rule's equations soon have no solution that is found; RK4 goes on."""
    choose(page, "double_pendulum")
    choose_rule(page, "midpoint")
    page.wait("Number(document.getElementById('steps').textContent) > 10", 10)
    slide(page, "speed", 100)
    slide(page, "h", 0.1)
    click(page, "restart")
    # Which of two failures it is hangs on the last bits of a chaotic motion.
    page.wait(
        "/ended at t = .*(no solution in reach|not solved within).*smaller step/.test(document.getElementById('rule-note').textContent)",
        20,
    )
    steps = reading(page, "steps")
    page.wait(f"Number(document.getElementById('steps').textContent) > {steps}", 10)
    require("ended" not in page.evaluate("document.getElementById('rungeKutta-note').textContent"), "RK4 has ended too")
    print("failure: the page says why a run has ended, and the others go on")


def equal_cost_is_shorter_steps(page):
    """Without friction RK4 errs by its order less in shorter steps; the ring's energy is 0.275."""
    errors, parts = [], 0
    for share in ["step", "cost"]:
        choose(page, "ring")
        slide(page, "friction", 0)
        page.evaluate(f"""{{
            const choice = document.getElementById("share");
            choice.value = "{share}";
            choice.dispatchEvent(new Event("change"));
        }}""")
        name = page.evaluate("document.getElementById('rungeKutta-name').textContent")
        require(name.startswith("RK4, h/") == (share == "cost"), f"RK4 is called {name} at equal {share}")
        parts = int(name.removeprefix("RK4, h/")) if share == "cost" else 1
        page.wait("Number(document.getElementById('time').textContent) > 100", 30)
        first = reading(page, "reference-energy")
        errors.append(abs(reading(page, "rungeKutta-energy") - first))
    require(parts > 1 and errors[0] > 1e-2, f"at equal steps RK4 is off by {errors[0]}")
    require(errors[1] < errors[0] / parts, f"in steps of h/{parts} RK4 is off by {errors[1]}, in steps of h by {errors[0]}")
    page.evaluate("document.getElementById('share').value = 'step'")
    print(f"equal cost: RK4 takes {parts} steps to one of the rule, and errs by {errors[1]:.0e} in place of {errors[0]:.0e}")


def parting_is_said(page):
    """Of the chaotic motion alone, and not before it is so."""
    choose(page, "double_pendulum")
    rule = page.evaluate("document.getElementById('rule').value")
    require(rule == "gauss", f"the double pendulum begins with {rule}")
    require(page.evaluate("document.getElementById('rungeKutta-note').textContent") == "", "RK4 has parted at the start")
    slide(page, "speed", 100)
    page.wait("document.getElementById('rungeKutta-note').textContent.includes('another motion')", 30)
    require(reading(page, "time") > 1, "RK4 has parted within 1 s")
    require(page.evaluate("document.getElementById('reference-note').textContent") == "", "the reference has parted from itself")
    choose(page, "ring")
    page.wait("Number(document.getElementById('time').textContent) > 200", 30)
    require(page.evaluate("document.getElementById('rungeKutta-note').textContent") == "", "the ring is called chaotic")
    print("chaos: the page says since when a motion is another")


def differing(found, expected):
    """How many lines differ."""
    found, expected = found.splitlines(), expected.splitlines()
    return abs(len(found) - len(expected)) + sum(a != b for a, b in zip(found, expected))


def bits_are_the_hosts(page, address, reference):
    source = (Path(__file__).parent / "bits.js").read_text().replace('"./', f'"{address}/')
    script = f"""import(URL.createObjectURL(new Blob([{json.dumps(source)}], {{ type: "text/javascript" }}))).then(({{ all }}) => all(%s))"""
    lines = reference.count("\n")
    found = page.evaluate(script % "")
    first = next((pair for pair in zip(found.splitlines(), reference.splitlines()) if pair[0] != pair[1]), None)
    require(lines == 27000 and differing(found, reference) == 0, f"{differing(found, reference)} of {lines} lines differ: {first}")
    # The controls: a step that is longer by a rounding, and one digit.
    control = differing(page.evaluate(script % "2 ** -52"), reference)
    require(control > 0.9 * lines, f"with another step size {control} of {lines} lines differ")
    digit = found.replace("7\n", "8\n", 1)
    require(differing(digit, reference) == 1, "a digit that differs is not seen")
    print(f"bits: {lines} states of 10 runs are the host's; with h longer by a rounding {control} are not")


def energies(reference, run):
    """By the number of the step, while parameters and step size are those of the start."""
    lines = (line.split() for line in reference.splitlines() if line.startswith(f"{run} "))
    return {int(line[1]): struct.unpack(">d", bytes.fromhex(line[6]))[0] for line in lines if int(line[1]) <= 2500}


def by_column(axes, energies, h):
    """The rows of the canvas between which a run goes, by the column of the page's history."""
    spans = {}
    for step, energy in energies.items():
        row = axes["top"] + (axes["high"] - energy) / (axes["high"] - axes["low"]) * axes["height"]
        spans.setdefault(int(step * h / axes["span"]), []).append(row)
    return {column: (min(rows), max(rows)) for column, rows in spans.items()}


def placed(axes, pixels, colour, run, covering):
    """Of the columns of a chart where `run` is not within reach of the curve drawn over it: how many there are, how many
    have a pixel of this colour where the host's energies are, and how many have one elsewhere."""
    told = met = beyond = 0
    for column, (upper, lower) in sorted(run.items())[2:-2]:
        above, below = covering.get(column, (math.inf, -math.inf))
        if upper - 8 < below and above < lower + 8:
            continue
        x = round(axes["left"] + (column + 0.5) * axes["span"] / axes["end"] * axes["width"])
        coloured = [y for y, pixel in enumerate(pixels[x]) if max(abs(a - b) for a, b in zip(pixel, colour)) < 40]
        # The curve goes on to the columns beside.
        near = [run[beside] for beside in range(column - 2, column + 3) if beside in run]
        told += 1
        met += any(upper - 4 <= y <= lower + 4 for y in coloured)
        beyond += any(not min(near)[0] - 4 <= y <= max(rows[1] for rows in near) + 4 for y in coloured)
    return told, met, beyond


def curves_are_where_the_hosts_run_says(page, reference):
    choose(page, "double_pendulum")
    choose(page, "ring")
    choose_rule(page, "midpoint")
    time.sleep(0.5)
    page.wait("Number(document.getElementById('time').textContent) > 350", 60)
    click(page, "pause")
    time.sleep(0.5)
    require(reading(page, "time") < 500, "the host's run ends before the page's")
    axes, bytes_, height = page.evaluate("""{
        const canvas = document.getElementById("energy");
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        [JSON.parse(canvas.dataset.axes), Array.from(data), canvas.height];
    }""")
    width = len(bytes_) // (4 * height)
    pixels = [[bytes_[at:at + 3] for at in range(4 * x, len(bytes_), 4 * width)] for x in range(width)]
    steps = reading(page, "steps")
    host = {name: by_column(axes, {step: energy for step, energy in energies(reference, f"ring_{name}").items() if step <= steps}, 0.2)
            for name in ["midpoint", "trapezoidal", "runge_kutta"]}
    for method, name, over, other in [("rule", "midpoint", "runge_kutta", "trapezoidal"), ("rungeKutta", "runge_kutta", None, "midpoint")]:
        told, met, beyond = placed(axes, pixels, COLOURS[method], host[name], host.get(over, {}))
        require(told > 200 and met > 0.95 * told and beyond == 0,
                f"of {told} columns of {name} {met} have the host's energy and {beyond} another")
        # The control: the run is not taken for another.
        _, _, elsewhere = placed(axes, pixels, COLOURS[method], host[other], {})
        require(elsewhere > 0.1 * told, f"the curve of {name} is elsewhere than that of {other} in {elsewhere} of {told} columns")
        print(f"picture: the curve of {name} is where the host's energies are in {met} of {told} columns, elsewhere in none; "
              f"against those of {other} it is elsewhere in {elsewhere}")
    click(page, "pause")


def fits_a_telephone(page):
    page.size(360, 740, 2)
    time.sleep(0.5)
    wide = page.evaluate("document.documentElement.scrollWidth")
    require(wide <= 360, f"{wide} pixels wide on a telephone of 360")
    page.size(WIDTH, HEIGHT)
    print("fits a telephone")


def draw(page, path):
    """The picture of docs/embedding.md: the ring without friction, after 10 000 steps."""
    choose(page, "ring")
    choose_rule(page, "midpoint")
    slide(page, "friction", 0)
    slide(page, "speed", 200)
    click(page, "restart")
    time.sleep(0.5)
    page.wait("Number(document.getElementById('time').textContent) > 1990", 60)
    slide(page, "speed", 10)
    page.wait("Number(document.getElementById('time').textContent) >= 2000", 60)
    click(page, "pause")
    slide(page, "speed", 100)
    time.sleep(0.5)
    bottom = page.evaluate("document.querySelector('main').getBoundingClientRect().bottom")
    page.picture(path, {"x": 0, "y": 0, "width": WIDTH, "height": math.ceil(bottom), "scale": 1})


def main(address, runs, picture=None):
    reference = Path(runs).read_text()
    with tempfile.TemporaryDirectory() as profile, Chromium(profile, WIDTH, HEIGHT) as page:
        page.open(address)
        runs_for_ten_seconds(page)
        friction_is_what_the_slider_says(page)
        step_size_is_what_the_slider_says(page)
        each_rule_has_its_energy(page, reference)
        a_failure_is_said(page)
        equal_cost_is_shorter_steps(page)
        parting_is_said(page)
        bits_are_the_hosts(page, address, reference)
        curves_are_where_the_hosts_run_says(page, reference)
        fits_a_telephone(page)
        require(page.complaints == [], f"complaints: {page.complaints}")
        # The control: an error is heard.
        page.evaluate("console.error('the control'); fetch('absent.js')")
        page.wait("true", 1)
        time.sleep(0.3)
        page.evaluate("true")
        require(len(page.complaints) == 2, f"two complaints were made, heard were {page.complaints}")
        print("no error in the console, where two made on purpose are heard")
        if picture:
            draw(page, picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
