//! Arrays that results are made of.

use numpy::PyArray;
use numpy::ndarray::{Array, IntoDimension};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// An array of `float64` that takes over `numbers`: nothing is copied.
///
/// # Errors
/// `ValueError` where the shape is not that of so many numbers.
pub fn to_array<D: IntoDimension>(
    py: Python<'_>,
    numbers: Vec<f64>,
    shape: D,
) -> PyResult<Bound<'_, PyArray<f64, D::Dim>>> {
    let array = Array::from_shape_vec(shape.into_dimension(), numbers)
        .map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(PyArray::from_owned_array(py, array))
}
