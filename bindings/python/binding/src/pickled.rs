//! Results in pickles: the class, and what its attributes hold.

use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

/// A call that makes a result anew, and what it is given.
pub type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyType>,));

/// The call of the method `_restored` of the result's class with what these attributes hold, as `__reduce__`
/// is to return it.
///
/// # Errors
/// Those of Python.
pub fn reduced<'py, T>(result: &Bound<'py, T>, attributes: &[&str]) -> PyResult<Reduced<'py>> {
    let (py, result) = (result.py(), result.as_any());
    let mut given = vec!["_restored".into_pyobject(py)?.into_any()];
    for name in attributes {
        given.push(result.getattr(*name)?);
    }
    let restored = py.import("operator")?.call_method1("methodcaller", PyTuple::new(py, given)?)?;
    Ok((restored, (result.get_type(),)))
}
