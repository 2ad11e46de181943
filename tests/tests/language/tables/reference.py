"""Writes `reference.rs` beside it: tables at random, and what SciPy makes of them. Run it by hand: `python3 reference.py`."""

from pathlib import Path

import numpy
import scipy
from scipy.interpolate import CubicSpline, PchipInterpolator

WAYS = {
    "Spline": lambda x, y: CubicSpline(x, y, bc_type="not-a-knot"),
    "Monotone": PchipInterpolator,
    "Periodic": lambda x, y: CubicSpline(x, y, bc_type="periodic"),
}


def array(numbers):
    return "[" + ", ".join(repr(float(number)) for number in numbers) + "]"


def cases(random):
    for name, way in WAYS.items():
        for points in [2, 3, 4, 7]:
            if name == "Periodic" and points == 2:
                continue
            x = numpy.cumsum(random.uniform(0.05, 2.0, points)) - 2.0
            y = random.normal(size=points)
            if name == "Monotone":
                y = numpy.sort(y) if points == 4 else y
            if name == "Periodic":
                y[-1] = y[0]
            curve = way(x, y)
            at = numpy.sort(random.uniform(x[0], x[-1], 6))
            rows = [[place] + [float(curve(place, order)) for order in range(4)] for place in at]
            seen = ", ".join(array(row) for row in rows)
            yield f"    Case {{ of: Interpolation::{name}, x: &{array(x)}, y: &{array(y)}, seen: [{seen}] }},"


text = f"""//! Written by `reference.py`, by SciPy {scipy.__version__}: x, f, f′, f″ and f‴ of curves through random points.

use super::Case;
use dalembert::system::Interpolation;

#[rustfmt::skip]
pub const CASES: [Case; 11] = [
{chr(10).join(cases(numpy.random.default_rng(20)))}
];
"""
Path(__file__).with_name("reference.rs").write_text(text)
