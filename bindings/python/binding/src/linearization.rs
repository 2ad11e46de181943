//! A step with its derivatives, as an object that prints.

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::to_array;
use crate::model::Linearized;
use crate::pickled::{Reduced, reduced};

/// A step and its derivatives.
#[pyclass(frozen, get_all)]
pub struct Linearization {
    /// Configuration at the end of the step, shape (n,).
    q: Py<PyArray1<f64>>,
    /// Momentum at the end of the step, shape (n,).
    p: Py<PyArray1<f64>>,
    /// A = ∂(q1, p1)/∂(q0, p0), shape (2n, 2n).
    a: Py<PyArray2<f64>>,
    /// B = ∂(q1, p1)/∂u, the input held over the step, shape (2n, inputs); None where there is no input.
    b: Option<Py<PyArray2<f64>>>,
    /// ∂(q1, p1)/∂θ, shape (2n, parameters); None where the attribute lists none.
    by_parameters: Option<Py<PyArray2<f64>>>,
}

impl Linearization {
    /// Of a system with `n` coordinates, and so many inputs and parameters.
    ///
    /// # Errors
    /// Those of Python.
    pub fn new(py: Python<'_>, of: Linearized, n: usize, [inputs, parameters]: [usize; 2]) -> PyResult<Self> {
        let Linearized { end: [q, p], a, b, by_parameters } = of;
        let matrix =
            |numbers: Vec<f64>, columns: usize| to_array(py, numbers, [2 * n, columns]).map(Bound::unbind);
        Ok(Self {
            q: to_array(py, q, [n])?.unbind(),
            p: to_array(py, p, [n])?.unbind(),
            a: matrix(a, 2 * n)?,
            b: b.map(|b| matrix(b, inputs)).transpose()?,
            by_parameters: by_parameters.map(|by| matrix(by, parameters)).transpose()?,
        })
    }
}

#[pymethods]
impl Linearization {
    #[staticmethod]
    fn _restored(
        q: Py<PyArray1<f64>>,
        p: Py<PyArray1<f64>>,
        a: Py<PyArray2<f64>>,
        b: Option<Py<PyArray2<f64>>>,
        by_parameters: Option<Py<PyArray2<f64>>>,
    ) -> Self {
        Self { q, p, a, b, by_parameters }
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(this, &["q", "p", "a", "b", "by_parameters"])
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let mut shown = format!("Linearization\nA =\n{}", self.a.bind(py).str()?);
        if let Some(b) = &self.b {
            shown += &format!("\nB =\n{}", b.bind(py).str()?);
        }
        if let Some(by) = &self.by_parameters {
            shown += &format!("\nby parameters =\n{}", by.bind(py).str()?);
        }
        Ok(shown)
    }
}
