//! The module: a class for each system, beside those that all have in common.

use dalembert_face::Field;
use pyo3::prelude::*;
use pyo3::types::{PyCFunction, PyDict, PyList, PyModule, PyTuple, PyType};

use crate::class::{KIND, KindObject, System};
use crate::model::Kind;
use crate::structure;
use crate::stub::{lines, stub_of};
use crate::{ensemble, error, reports, results, table, watching};

/// The documentation of a module that has none of its own.
const DOCUMENTATION: &str = "Mechanical systems with friction, by dalembert: SYSTEMS.

A system is made of its fields, as help() of its class lists them. Its methods are run, ensemble, linearization,
energy, nearest, symmetries and energy_ledger; their results have NumPy arrays.";

/// Fills `module`, of a package of this version.
///
/// # Errors
/// Those of Python.
pub fn fill(
    module: &Bound<'_, PyModule>,
    kinds: &'static [&'static dyn Kind],
    version: &str,
) -> PyResult<()> {
    let py = module.py();
    module.add("__version__", version)?;
    if !module.getattr("__doc__")?.is_truthy()? {
        let names: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
        module.setattr("__doc__", DOCUMENTATION.replace("SYSTEMS", &names.join(", ")))?;
    }
    // Ctrl-C raises its exception here. Where the first array is made, importing NumPy panics of it.
    py.import("numpy")?;
    error::add_to(module)?;
    results::add_to(module)?;
    ensemble::add_to(module)?;
    reports::add_to(module)?;
    watching::add_to(module)?;
    table::add_to(module)?;
    module.add_class::<System>()?;
    module.getattr("System")?.setattr("__module__", module.name()?)?;
    for kind in kinds {
        module.add(kind.name(), class(module, *kind)?)?;
    }
    let stub = move |_: &Bound<'_, PyTuple>, _: Option<&Bound<'_, PyDict>>| stub_of(kinds);
    let documentation = c"stub()\n--\n\nThe text of the module's .pyi: what type checkers and editors read.";
    module.add("stub", PyCFunction::new_closure(py, Some(c"stub"), Some(documentation), stub)?)
}

/// The class of a system.
fn class<'py>(module: &Bound<'py, PyModule>, kind: &'static dyn Kind) -> PyResult<Bound<'py, PyAny>> {
    let py = module.py();
    let namespace = PyDict::new(py);
    namespace.set_item("__module__", module.name()?)?;
    namespace.set_item("__doc__", documentation(kind))?;
    namespace.set_item("__slots__", PyTuple::empty(py))?;
    namespace.set_item("__signature__", signature(py, kind.fields())?)?;
    namespace.set_item(KIND, Py::new(py, KindObject(kind))?)?;
    namespace.set_item("COORDINATES", kind.coordinates())?;
    namespace.set_item("INPUTS", kind.inputs())?;
    namespace.set_item("TAKES_TIME", kind.takes_time())?;
    namespace.set_item("CONSTRAINTS", kind.constraints())?;
    namespace.set_item("EVENTS", kind.events())?;
    namespace.set_item("PARAMETERS", PyTuple::new(py, kind.parameters())?)?;
    namespace.set_item("RULES", PyTuple::new(py, kind.rules())?)?;
    namespace.set_item("STRUCTURE", structure::to_dict(py, &kind.structure())?)?;
    for (index, field) in kind.fields().iter().enumerate() {
        namespace.set_item(field.name, property(py, index, field)?)?;
    }
    py.get_type::<PyType>().call1((kind.name(), (py.get_type::<System>(),), namespace))
}

/// The documentation of the struct and of its fields.
fn documentation(kind: &dyn Kind) -> String {
    let mut text = lines(kind.documentation(), "\n");
    for field in kind.fields() {
        let Field { name, documentation, .. } = field;
        text += &format!("\n\n{name} : {}\n    {}", annotation(field), lines(documentation, "\n    "));
    }
    text
}

/// The type of a field as Python writes it.
pub fn annotation(field: &Field) -> String {
    let number = if matches!(field.base, "double" | "float") { "float" } else { "int" };
    match field.dimensions {
        [.., points] if field.is_table => format!("Table of {points} points"),
        [] => number.to_owned(),
        lengths => {
            let lengths: Vec<String> = lengths.iter().map(usize::to_string).collect();
            format!("{} {number}s", lengths.join(" × "))
        }
    }
}

/// `(k)`, as `inspect.signature` has it.
fn signature<'py>(py: Python<'py>, fields: &[Field]) -> PyResult<Bound<'py, PyAny>> {
    let inspect = py.import("inspect")?;
    let parameter = inspect.getattr("Parameter")?;
    let kind = parameter.getattr("POSITIONAL_OR_KEYWORD")?;
    let parameters = PyList::empty(py);
    for field in fields {
        parameters.append(parameter.call1((field.name, &kind))?)?;
    }
    inspect.call_method1("Signature", (parameters,))
}

/// The attribute of a field.
fn property<'py>(py: Python<'py>, index: usize, field: &Field) -> PyResult<Bound<'py, PyAny>> {
    let read = move |arguments: &Bound<'_, PyTuple>, _: Option<&Bound<'_, PyDict>>| -> PyResult<Py<PyAny>> {
        let system = arguments.get_item(0)?;
        Ok(system.cast::<System>()?.get().field(arguments.py(), index)?.unbind())
    };
    let write = move |arguments: &Bound<'_, PyTuple>, _: Option<&Bound<'_, PyDict>>| -> PyResult<()> {
        let system = arguments.get_item(0)?;
        system.cast::<System>()?.get().change_field(index, &arguments.get_item(1)?)
    };
    let read = PyCFunction::new_closure(py, None, None, read)?;
    let write = PyCFunction::new_closure(py, None, None, write)?;
    let documentation = lines(field.documentation, "\n");
    py.import("builtins")?.getattr("property")?.call1((read, write, py.None(), documentation))
}
