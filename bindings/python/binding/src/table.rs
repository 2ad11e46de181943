//! Curves given by points: the class, and such curves as fields.

use dalembert::system::{Interpolation, TableSlice};
use dalembert_face::{Field, Number, interpolation_number};
use numpy::PyUntypedArrayMethods;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyModule, PySequence};

use crate::arguments::{array, expected, numbers, of_shape};
use crate::arrays::to_array;
use crate::pickled::{Reduced, reduced};

/// A curve through points, for a field that is one.
///
/// Made by `linear`, `spline` (not-a-knot), `monotone` or `periodic`, of x in increasing order and as many y.
/// Beyond its ends it keeps its value, or goes on by its slope there, with `straight_beyond=True`. A call has
/// its values.
#[pyclass(frozen, eq)]
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    x: Vec<f64>,
    y: Vec<f64>,
    of: Interpolation,
    straight_beyond: bool,
}

impl Table {
    fn new(
        of: Interpolation,
        x: &Bound<'_, PyAny>,
        y: &Bound<'_, PyAny>,
        straight_beyond: bool,
    ) -> PyResult<Self> {
        let (x, y) = (array("x", x)?, array("y", y)?);
        if x.ndim() != 1 {
            return Err(of_shape("x", "(points,)", x.shape()));
        }
        if y.shape() != x.shape() {
            return Err(of_shape("y", &format!("({},)", x.len()), y.shape()));
        }
        let table = Self { x: numbers(&x), y: numbers(&y), of, straight_beyond };
        table.with(|_| ())?;
        Ok(table)
    }

    /// Does `ask` of the curve.
    fn with<T>(&self, ask: impl FnOnce(&TableSlice<'_>) -> T) -> PyResult<T> {
        let mut pieces = vec![[0.0; 4]; self.x.len()];
        let table = TableSlice::through(self.of, &self.x, &self.y, &mut pieces);
        let table =
            table.map_err(|error| PyValueError::new_err(error.to_string().replace("Table::", "Table.")))?;
        Ok(ask(&if self.straight_beyond { table.straight_beyond() } else { table }))
    }

    /// The table of the numbers of a field.
    fn of_entries(entries: &[Number]) -> Option<Self> {
        let (points, [Number::I32(number), Number::I32(straight)]) = entries.split_last_chunk()? else {
            return None;
        };
        let of = Interpolation::ALL.into_iter().find(|of| interpolation_number(*of) == *number)?;
        let mut all = points.iter().map(|entry| match *entry {
            Number::F32(value) => value.into(),
            Number::F64(value) => value,
            _ => f64::NAN,
        });
        let x = all.by_ref().take(points.len() / 2).collect();
        Some(Self { x, y: all.collect(), of, straight_beyond: *straight != 0 })
    }

    /// The numbers of the field, of the type that its points have.
    fn entries(&self, like: Number) -> Vec<Number> {
        let of = |value: &f64| match like {
            Number::F32(_) => Number::F32(*value as f32),
            _ => Number::F64(*value),
        };
        let numbers = [interpolation_number(self.of), self.straight_beyond.into()];
        self.x.iter().chain(&self.y).map(of).chain(numbers.map(Number::I32)).collect()
    }
}

#[pymethods]
impl Table {
    /// Straight lines between the points.
    #[staticmethod]
    #[pyo3(signature = (x, y, *, straight_beyond=false))]
    fn linear(x: &Bound<'_, PyAny>, y: &Bound<'_, PyAny>, straight_beyond: bool) -> PyResult<Self> {
        Self::new(Interpolation::Linear, x, y, straight_beyond)
    }

    /// Cubics with continuous second derivatives, as SciPy's CubicSpline.
    #[staticmethod]
    #[pyo3(signature = (x, y, *, straight_beyond=false))]
    fn spline(x: &Bound<'_, PyAny>, y: &Bound<'_, PyAny>, straight_beyond: bool) -> PyResult<Self> {
        Self::new(Interpolation::Spline, x, y, straight_beyond)
    }

    /// Cubics that turn at points alone, as SciPy's PchipInterpolator.
    #[staticmethod]
    #[pyo3(signature = (x, y, *, straight_beyond=false))]
    fn monotone(x: &Bound<'_, PyAny>, y: &Bound<'_, PyAny>, straight_beyond: bool) -> PyResult<Self> {
        Self::new(Interpolation::Monotone, x, y, straight_beyond)
    }

    /// The periodic spline, which goes on for ever; the last y is the first.
    #[staticmethod]
    fn periodic(x: &Bound<'_, PyAny>, y: &Bound<'_, PyAny>) -> PyResult<Self> {
        Self::new(Interpolation::Periodic, x, y, false)
    }

    /// The x of the points.
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(to_array(py, self.x.clone(), [self.x.len()])?.into_any())
    }

    /// The y of the points.
    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(to_array(py, self.y.clone(), [self.y.len()])?.into_any())
    }

    /// The interpolation between the points: "linear", "spline", "monotone" or "periodic".
    #[getter]
    fn interpolation(&self) -> String {
        self.of.to_string()
    }

    /// Whether the curve goes on by its slope beyond its ends.
    #[getter]
    fn straight_beyond(&self) -> bool {
        self.straight_beyond
    }

    /// The values at x, a number or an array.
    fn __call__<'py>(&self, py: Python<'py>, x: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let given = array("x", x)?;
        let (shape, places) = (given.shape().to_vec(), numbers(&given));
        let values = self.with(|table| places.iter().map(|&x| table.at(x)).collect::<Vec<_>>())?;
        match (&shape[..], &values[..]) {
            ([], [value]) => Ok(value.into_pyobject(py)?.into_any()),
            _ => Ok(to_array(py, values, &shape[..])?.into_any()),
        }
    }

    #[staticmethod]
    fn _restored(
        x: &Bound<'_, PyAny>,
        y: &Bound<'_, PyAny>,
        interpolation: &str,
        straight_beyond: bool,
    ) -> PyResult<Self> {
        let of = Interpolation::ALL.into_iter().find(|of| of.to_string() == interpolation);
        let of = of.ok_or_else(|| PyValueError::new_err(format!("no interpolation {interpolation}")))?;
        Self::new(of, x, y, straight_beyond)
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(this, &["x", "y", "interpolation", "straight_beyond"])
    }

    fn __repr__(&self) -> String {
        let beyond = if self.straight_beyond { ", straight_beyond=True" } else { "" };
        format!("Table.{}({:?}, {:?}{beyond})", self.of, self.x, self.y)
    }
}

/// The numbers of a field that is a table: `like` is one of its points.
///
/// # Errors
/// `TypeError` where no table is given, `ValueError` where it has more or fewer points.
pub fn entries(field: &Field, like: Number, given: &Bound<'_, PyAny>) -> PyResult<Vec<Number>> {
    let points = field.dimensions.last().copied().unwrap_or(0);
    let table = given.cast::<Table>().map_err(|_| {
        let one = format!("a Table of {points} points, such as Table.linear(x, y)");
        expected(field.name, &one, given)
    })?;
    let table = table.get();
    if table.x.len() == points {
        return Ok(table.entries(like));
    }
    let found = table.x.len();
    Err(PyValueError::new_err(format!(
        "{}: expected a Table of {points} points, got one of {found}",
        field.name
    )))
}

/// The numbers of a field that is a table for each member, one after the other, and for how many members.
///
/// # Errors
/// Those of [`entries`], and `TypeError` where no sequence is given.
pub fn entries_of_members(
    field: &Field,
    like: Number,
    given: &Bound<'_, PyAny>,
) -> PyResult<(Vec<Number>, usize)> {
    let tables = given.cast::<PySequence>().map_err(|_| expected(field.name, "a list of Tables", given))?;
    let mut all = Vec::new();
    for table in tables.try_iter()? {
        all.extend(entries(field, like, &table?)?);
    }
    Ok((all, tables.len()?))
}

/// The value of a field that is a table.
///
/// # Errors
/// Those of Python.
pub fn value<'py>(py: Python<'py>, name: &str, entries: &[Number]) -> PyResult<Bound<'py, PyAny>> {
    let table = Table::of_entries(entries).ok_or_else(|| PyTypeError::new_err(name.to_owned()))?;
    Ok(Py::new(py, table)?.into_bound(py).into_any())
}

/// Adds the class to `module`, as its own.
///
/// # Errors
/// Those of Python.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Table>()?;
    module.getattr("Table")?.setattr("__module__", module.name()?)
}
