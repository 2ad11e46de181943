//! Events of one function, as an object of arrays.

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::to_array;
use crate::events::Found;
use crate::pickled::{Reduced, reduced};

/// When an event function vanished, and where the motion was: one row an event.
#[pyclass(frozen, get_all)]
pub struct Crossings {
    /// The number of the member of each, shape (events,); None of a run.
    member: Option<Py<PyArray1<i64>>>,
    /// Times, shape (events,).
    t: Py<PyArray1<f64>>,
    /// Configurations, shape (events, n).
    q: Py<PyArray2<f64>>,
    /// Velocities, shape (events, n).
    v: Py<PyArray2<f64>>,
    /// Momenta, shape (events, n).
    p: Py<PyArray2<f64>>,
}

impl Crossings {
    /// Of one function, in the run of a system with `n` coordinates or in those of members.
    ///
    /// # Errors
    /// Those of Python.
    pub fn new(py: Python<'_>, found: Found, members: Option<Vec<i64>>, n: usize) -> PyResult<Self> {
        let Found { t, q, v, p } = found;
        let events = t.len();
        let vectors = |numbers| to_array(py, numbers, [events, n]).map(Bound::unbind);
        Ok(Self {
            member: members.map(|members| PyArray1::from_vec(py, members).unbind()),
            q: vectors(q)?,
            v: vectors(v)?,
            p: vectors(p)?,
            t: to_array(py, t, [events])?.unbind(),
        })
    }
}

#[pymethods]
impl Crossings {
    #[staticmethod]
    fn _restored(
        member: Option<Py<PyArray1<i64>>>,
        t: Py<PyArray1<f64>>,
        q: Py<PyArray2<f64>>,
        v: Py<PyArray2<f64>>,
        p: Py<PyArray2<f64>>,
    ) -> Self {
        Self { member, t, q, v, p }
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(this, &["member", "t", "q", "v", "p"])
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.t.bind(py).len()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("Crossings: {}", self.t.bind(py).len()?))
    }
}
