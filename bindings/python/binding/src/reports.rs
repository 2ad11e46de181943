//! Reports of checkers, as objects that print.

use pyo3::prelude::*;
use pyo3::types::PyModule;

use crate::checks::{Ledger, Symmetry as Found};
use crate::pickled::{Reduced, reduced};

/// What a generator does to L_d, to the force and to its momentum, over samples.
#[pyclass(frozen, get_all)]
pub struct Symmetry {
    /// The name of the generator.
    generator: String,
    /// Whether it is a symmetry of L_d.
    is_symmetry_of_lagrangian: bool,
    /// Whether the discrete force does work along it.
    force_does_work: bool,
    /// Whether its momentum is conserved.
    is_conserved: bool,
    /// Whether the momenta that the step uses are those of L_d and f_d, as they must be.
    is_consistent: bool,
    /// The largest ξ(L_d), and what counts as zero there.
    lagrangian: (f64, f64),
    /// The largest f_d(ξ), and what counts as zero there.
    force: (f64, f64),
    /// The largest sum of both, and what counts as zero there.
    defect: (f64, f64),
    /// The report in words, which it prints.
    text: String,
}

impl From<Found> for Symmetry {
    fn from(found: Found) -> Self {
        let [lagrangian, force, defect] = found.findings.map(|[value, zero]| (value, zero));
        Self {
            generator: found.generator,
            is_symmetry_of_lagrangian: found.is_symmetry_of_lagrangian,
            force_does_work: found.force_does_work,
            is_conserved: found.is_conserved,
            is_consistent: found.is_consistent,
            lagrangian,
            force,
            defect,
            text: found.text,
        }
    }
}

#[pymethods]
impl Symmetry {
    #[staticmethod]
    #[allow(clippy::too_many_arguments, reason = "all attributes")]
    fn _restored(
        generator: String,
        is_symmetry_of_lagrangian: bool,
        force_does_work: bool,
        is_conserved: bool,
        is_consistent: bool,
        lagrangian: (f64, f64),
        force: (f64, f64),
        defect: (f64, f64),
        text: String,
    ) -> Self {
        Self {
            generator,
            is_symmetry_of_lagrangian,
            force_does_work,
            is_conserved,
            is_consistent,
            lagrangian,
            force,
            defect,
            text,
        }
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let verdicts = ["is_symmetry_of_lagrangian", "force_does_work", "is_conserved", "is_consistent"];
        let findings = ["lagrangian", "force", "defect", "text"];
        reduced(this, &[&["generator"], &verdicts[..], &findings[..]].concat())
    }

    fn __repr__(&self) -> &str {
        &self.text
    }
}

/// Where the energy of a run went.
#[pyclass(frozen, get_all)]
pub struct EnergyLedger {
    /// The energy at the end less that at the start.
    change: f64,
    /// What friction took.
    dissipated: f64,
    /// What the general force brought.
    work: f64,
    /// What the method did: change + dissipated − work.
    remainder: f64,
    /// The largest remainder of one step, by size.
    largest_remainder: f64,
}

impl From<Ledger> for EnergyLedger {
    fn from(Ledger { change, dissipated, work, largest, remainder }: Ledger) -> Self {
        Self { change, dissipated, work, remainder, largest_remainder: largest }
    }
}

#[pymethods]
impl EnergyLedger {
    #[staticmethod]
    fn _restored(change: f64, dissipated: f64, work: f64, remainder: f64, largest_remainder: f64) -> Self {
        Self { change, dissipated, work, remainder, largest_remainder }
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(this, &["change", "dissipated", "work", "remainder", "largest_remainder"])
    }

    fn __repr__(&self) -> String {
        let Self { change, dissipated, work, remainder, largest_remainder } = self;
        format!(
            "energy: change {change:+.6e}, friction took {dissipated:.6e}, forces brought {work:+.6e}\n\
             the method's doing: {remainder:+.1e} in all, {largest_remainder:.1e} in one step at most"
        )
    }
}

/// Adds the classes to `module`, as its own.
///
/// # Errors
/// Those of Python.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Symmetry>()?;
    module.add_class::<EnergyLedger>()?;
    for name in ["Symmetry", "EnergyLedger"] {
        module.getattr(name)?.setattr("__module__", module.name()?)?;
    }
    Ok(())
}
