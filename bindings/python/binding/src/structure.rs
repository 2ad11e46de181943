//! The structure of a system, found when it was compiled, as data of Python.

use dalembert::system::{Damping, Engine, Structure};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// The findings as a dict.
///
/// # Errors
/// Those of Python.
pub fn to_dict<'py>(py: Python<'py>, structure: &Structure) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    found.set_item("engine", engine(structure.engine))?;
    found.set_item("constant_mass_matrix", structure.constant_mass_matrix)?;
    found.set_item("quadratic_lagrangian", structure.quadratic_lagrangian)?;
    found.set_item("separable_lagrangian", structure.separable_lagrangian)?;
    found.set_item("fused_multiply_add", structure.fused_multiply_add)?;
    found.set_item("damping", damping(structure.damping))?;
    found.set_item("kinks", structure.kinks)?;
    let cyclic = PyList::empty(py);
    for coordinate in structure.cyclic {
        let entry = PyDict::new(py);
        entry.set_item("index", coordinate.index)?;
        entry.set_item("damped", coordinate.damped)?;
        entry.set_item("forced", coordinate.forced)?;
        cyclic.append(entry)?;
    }
    found.set_item("cyclic", cyclic)?;
    let matrices = PyList::empty(py);
    for matrix in structure.newton_matrices {
        let entry = PyDict::new(py);
        entry.set_item("rule", matrix.rule)?;
        entry.set_item("constant", matrix.constant)?;
        entry.set_item("bandwidth", matrix.bandwidth)?;
        matrices.append(entry)?;
    }
    found.set_item("newton_matrices", matrices)?;
    Ok(found)
}

fn engine(engine: Engine) -> &'static str {
    match engine {
        Engine::ByHand => "by hand",
        Engine::Expanded => "expanded",
        Engine::NumDual { .. } => "num_dual",
        _ => "another",
    }
}

fn damping(damping: Damping) -> &'static str {
    match damping {
        Damping::Absent => "absent",
        Damping::Linear => "linear",
        Damping::LinearByConfiguration => "linear by configuration",
        Damping::Nonlinear => "nonlinear",
        _ => "unknown",
    }
}
