//! Numbers and arrays that Python gives, and what is said where they are not what was expected.

use dalembert_face::{Field, Number};
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt, PySequence, PyString};

use crate::model::Kind;

/// The array of `float64` that is given, whatever its shape.
///
/// # Errors
/// `TypeError` where the type of the entries does not fit, `ValueError` where one of them would lose digits
/// or is masked.
pub fn array<'py>(name: &str, given: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    require_unmasked(name, given)?;
    if let Ok(array) = given.cast::<PyArrayDyn<f64>>()
        && array.is_c_contiguous()
    {
        return Ok(array.try_readonly()?);
    }
    let py = given.py();
    let numpy = py.import("numpy")?;
    let float64 = numpy::dtype::<f64>(py);
    let array = numpy.call_method1("asarray", (given,));
    let array = array.map_err(|error| {
        PyValueError::new_err(format!("{name}: expected rows of numbers, of one length; {}", error.value(py)))
    })?;
    let dtype = array.getattr("dtype")?;
    let is_one = array.getattr("ndim")?.extract::<usize>()? == 0;
    if is_one && given.cast::<PyArrayDyn<f64>>().is_err() && !given.is_instance_of::<PyFloat>() {
        // Of one thing its own words say more than its type in an array.
        if given.extract::<f64>().is_err() {
            return Err(expected(name, "numbers", given));
        }
    }
    if !numpy.call_method1("can_cast", (&dtype, &float64))?.is_truthy()? {
        return Err(PyTypeError::new_err(format!(
            "{name}: expected numbers of dtype float64, or of one that it holds, got {dtype}"
        )));
    }
    require_exact(name, &array)?;
    let keywords = PyDict::new(py);
    keywords.set_item("dtype", float64)?;
    keywords.set_item("order", "C")?;
    let array = numpy.call_method("asarray", (array,), Some(&keywords))?;
    Ok(array.cast_into::<PyArrayDyn<f64>>()?.try_readonly()?)
}

/// Fails where entries are masked, of a masked array or of one in a list: as plain numbers they would count.
fn require_unmasked(name: &str, given: &Bound<'_, PyAny>) -> PyResult<()> {
    if given.is_instance_of::<PyFloat>() || given.is_instance_of::<PyInt>() {
        return Ok(());
    }
    if given.getattr_opt("mask")?.is_none() {
        // Of an array without a mask no entry has one. A text is a sequence of texts.
        return match given.cast::<PySequence>() {
            Ok(sequence) if !given.is_instance_of::<PyString>() => {
                sequence.try_iter()?.try_for_each(|entry| require_unmasked(name, &entry?))
            }
            _ => Ok(()),
        };
    }
    let is_masked = given.py().import("numpy")?.getattr("ma")?.call_method1("is_masked", (given,))?;
    if is_masked.is_truthy()? {
        return Err(PyValueError::new_err(format!(
            "{name}: entries are masked; fill them, as by .filled(0.0), or leave them out"
        )));
    }
    Ok(())
}

/// The integers above which not every one is a `float64`.
const MOST_EXACT: i128 = 1 << f64::MANTISSA_DIGITS;

/// Fails where whole numbers are not those of a `float64`.
fn require_exact(name: &str, array: &Bound<'_, PyAny>) -> PyResult<()> {
    let dtype = array.getattr("dtype")?;
    let (kind, size): (String, usize) =
        (dtype.getattr("kind")?.extract()?, dtype.getattr("itemsize")?.extract()?);
    let entries: usize = array.getattr("size")?.extract()?;
    if !matches!(kind.as_str(), "i" | "u") || size < 8 || entries == 0 {
        return Ok(());
    }
    let end = |which: &str| -> PyResult<i128> { array.call_method0(which)?.call_method0("item")?.extract() };
    if end("min")? >= -MOST_EXACT && end("max")? <= MOST_EXACT {
        return Ok(());
    }
    let entries: Vec<i128> = array.call_method0("ravel")?.call_method0("tolist")?.extract()?;
    match entries.into_iter().find(|&entry| entry as f64 as i128 != entry) {
        Some(entry) => Err(PyValueError::new_err(format!(
            "{name}: {entry} is no float64, and would be rounded to {:.0}; round it yourself if that is meant",
            entry as f64
        ))),
        None => Ok(()),
    }
}

/// The number that is given under this name, if one is.
///
/// # Errors
/// `TypeError` where it is none.
pub fn real(name: &str, given: Option<&Bound<'_, PyAny>>) -> PyResult<Option<f64>> {
    let of = |given: &Bound<'_, PyAny>| {
        require_unmasked(name, given)?;
        given.extract::<f64>().map_err(|_| expected(name, "a number", given))
    };
    given.map(of).transpose()
}

/// The whole number from 0 on that is given under this name, if one is.
///
/// # Errors
/// `TypeError` where it is none, `ValueError` where it is below 0 or does not fit into 64 bits.
pub fn count(name: &str, given: Option<&Bound<'_, PyAny>>) -> PyResult<Option<u64>> {
    count_from(0, name, given)
}

/// The whole number from `least` on that is given under this name, if one is.
///
/// # Errors
/// As of [`count`].
pub fn count_from(least: u64, name: &str, given: Option<&Bound<'_, PyAny>>) -> PyResult<Option<u64>> {
    let of = |given: &Bound<'_, PyAny>| {
        let index = given.py().import("operator")?.call_method1("index", (given,));
        let index = index.map_err(|_| expected(name, "a whole number", given))?;
        let number = index.extract::<u64>().ok().filter(|&number| number >= least);
        number.ok_or_else(|| {
            PyValueError::new_err(format!(
                "{name}: expected a whole number from {least} to 2⁶⁴ − 1, got {index}"
            ))
        })
    };
    given.map(of).transpose()
}

/// The text that is given under this name, if one is.
///
/// # Errors
/// `TypeError` where it is none.
pub fn text(name: &str, given: Option<&Bound<'_, PyAny>>) -> PyResult<Option<String>> {
    let of = |given: &Bound<'_, PyAny>| given.extract().map_err(|_| expected(name, "a text", given));
    given.map(of).transpose()
}

/// The error of something else than was expected.
pub fn expected(name: &str, expected: &str, given: &Bound<'_, PyAny>) -> PyErr {
    let shown = given.repr().and_then(|shown| shown.extract::<String>());
    let shown = shown.unwrap_or_else(|_| "an object without a repr".to_owned());
    let kind = given.get_type().name().map_or_else(|_| String::new(), |name| format!(" ({name})"));
    PyTypeError::new_err(format!("{name}: expected {expected}, got {shown}{kind}"))
}

/// Fails where what is given cannot be called.
///
/// # Errors
/// `TypeError`.
pub fn require_callable(py: Python<'_>, name: &str, given: Option<&Py<PyAny>>) -> PyResult<()> {
    match given.map(|given| given.bind(py)).filter(|given| !given.is_callable()) {
        Some(given) => Err(expected(name, "a function", given)),
        None => Ok(()),
    }
}

/// Fails where a number is not finite.
///
/// # Errors
/// `ValueError`.
pub fn require_finite(name: &str, numbers: &[f64]) -> PyResult<()> {
    match numbers.iter().enumerate().find(|(_, number)| !number.is_finite()) {
        Some((index, number)) => Err(PyValueError::new_err(format!(
            "{name}: expected finite numbers, got {number} at index {index}"
        ))),
        None => Ok(()),
    }
}

/// A vector of `n` finite numbers.
///
/// # Errors
/// Those of [`array`]; `ValueError` where the shape is another, or a number is not finite.
pub fn vector(name: &str, given: &Bound<'_, PyAny>, n: usize) -> PyResult<Vec<f64>> {
    let array = array(name, given)?;
    if array.shape() != [n] {
        return Err(of_shape(name, &format!("({n},)"), array.shape()));
    }
    let numbers = numbers(&array);
    require_finite(name, &numbers)?;
    Ok(numbers)
}

/// One row of `n` numbers for each of `rows`, or one for all.
///
/// # Errors
/// Those of [`array`]; `ValueError` where the shape is another.
pub fn rows(name: &str, given: &Bound<'_, PyAny>, rows: u64, n: usize) -> PyResult<Vec<f64>> {
    let array = array(name, given)?;
    let has_rows = |found: usize| u64::try_from(found).is_ok_and(|found| found == rows);
    match *array.shape() {
        [columns] if columns == n => {}
        [found, columns] if columns == n && has_rows(found) => {}
        _ => return Err(of_shape(name, &format!("({n},) or ({rows}, {n})"), array.shape())),
    }
    let numbers = numbers(&array);
    require_finite(name, &numbers)?;
    Ok(numbers)
}

/// The input, of as many numbers as the system takes, as `read` has it; `None` where it takes none.
///
/// # Errors
/// `TypeError` where it takes none and there is one, or the other way round; those of `read`.
pub fn input<T>(
    kind: &dyn Kind,
    u: Option<&Bound<'_, PyAny>>,
    read: impl FnOnce(&Bound<'_, PyAny>, usize) -> PyResult<T>,
) -> PyResult<Option<T>> {
    let name = kind.name();
    match (u, kind.inputs()) {
        (Some(u), length) if length > 0 => read(u, length).map(Some),
        (None, 0) => Ok(None),
        (None, length) => {
            Err(PyTypeError::new_err(format!("{name} takes an input: give u, {length} numbers")))
        }
        (Some(_), _) => Err(PyTypeError::new_err(format!("{name} takes no input u"))),
    }
}

/// The time, if the system takes it.
///
/// # Errors
/// `TypeError` where it does not, `ValueError` where the time is not finite.
pub fn time(kind: &dyn Kind, t: Option<f64>) -> PyResult<f64> {
    match t {
        Some(_) if !kind.takes_time() => {
            Err(PyTypeError::new_err(format!("{} does not take the time: leave t out", kind.name())))
        }
        Some(t) if !t.is_finite() => {
            Err(PyValueError::new_err(format!("t: expected a finite time, got {t}")))
        }
        t => Ok(t.unwrap_or(0.0)),
    }
}

/// The numbers of an array, row by row.
pub fn numbers(array: &PyReadonlyArrayDyn<'_, f64>) -> Vec<f64> {
    array.as_array().iter().copied().collect()
}

/// The error for an array of another shape.
pub fn of_shape(name: &str, expected: &str, found: &[usize]) -> PyErr {
    let comma = if found.len() == 1 { "," } else { "" };
    let expected = if expected == "()" { "one number" } else { &format!("the shape {expected}") };
    PyValueError::new_err(format!("{name}: expected {expected}, got ({}{comma})", listed(found)))
}

/// The numbers of a field, row by row, of the type that it has: `like` is one of them.
///
/// # Errors
/// `TypeError`, `ValueError` and `OverflowError` where the field does not hold what is given.
pub fn entries(field: &Field, like: Number, given: &Bound<'_, PyAny>) -> PyResult<Vec<Number>> {
    let (numbers, shape) = typed(field, like, given)?;
    if shape == field.dimensions {
        return Ok(numbers);
    }
    let comma = if field.dimensions.len() == 1 { "," } else { "" };
    Err(of_shape(field.name, &format!("({}{comma})", listed(field.dimensions)), &shape))
}

/// The numbers of a field for each member, one after the other, and for how many members.
///
/// # Errors
/// Those of [`entries`].
pub fn entries_of_members(
    field: &Field,
    like: Number,
    given: &Bound<'_, PyAny>,
) -> PyResult<(Vec<Number>, usize)> {
    let (numbers, shape) = typed(field, like, given)?;
    match shape.split_first() {
        Some((&members, rest)) if rest == field.dimensions => Ok((numbers, members)),
        _ => {
            let rest = field.dimensions.iter().map(|length| format!(", {length}")).collect::<String>();
            let comma = if rest.is_empty() { "," } else { "" };
            Err(of_shape(field.name, &format!("(members{rest}{comma})"), &shape))
        }
    }
}

/// Numbers of the type of a field, and the shape in which they are given.
fn typed(field: &Field, like: Number, given: &Bound<'_, PyAny>) -> PyResult<(Vec<Number>, Vec<usize>)> {
    let name = field.name;
    if matches!(like, Number::F64(_) | Number::F32(_)) {
        let array = array(name, given)?;
        let is_single = matches!(like, Number::F32(_));
        let of = |value: f64| if is_single { Number::F32(value as f32) } else { Number::F64(value) };
        return Ok((numbers(&array).into_iter().map(of).collect(), array.shape().to_vec()));
    }
    require_unmasked(name, given)?;
    let array = given.py().import("numpy")?.call_method1("asarray", (given,))?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    if !matches!(kind.as_str(), "i" | "u") {
        let dtype = array.getattr("dtype")?;
        return Err(PyTypeError::new_err(format!("{name}: expected whole numbers, got {dtype}")));
    }
    let integers: Vec<i128> = array.call_method0("ravel")?.call_method0("tolist")?.extract()?;
    let numbers = integers.into_iter().map(|value| integer(field, like, value)).collect::<PyResult<_>>()?;
    Ok((numbers, array.getattr("shape")?.extract()?))
}

fn listed(lengths: &[usize]) -> String {
    lengths.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

fn integer(field: &Field, like: Number, value: i128) -> PyResult<Number> {
    let number = match like {
        Number::I8(_) => i8::try_from(value).map(Number::I8),
        Number::I16(_) => i16::try_from(value).map(Number::I16),
        Number::I32(_) => i32::try_from(value).map(Number::I32),
        Number::I64(_) => i64::try_from(value).map(Number::I64),
        Number::U8(_) => u8::try_from(value).map(Number::U8),
        Number::U16(_) => u16::try_from(value).map(Number::U16),
        Number::U32(_) => u32::try_from(value).map(Number::U32),
        _ => u64::try_from(value).map(Number::U64),
    };
    number.map_err(|_| {
        PyOverflowError::new_err(format!("{}: {value} does not fit into {}", field.name, field.base))
    })
}

/// A number as Python has it.
///
/// # Errors
/// Those of Python.
pub fn number(py: Python<'_>, value: Number) -> PyResult<Bound<'_, PyAny>> {
    Ok(match value {
        Number::F64(value) => value.into_pyobject(py)?.into_any(),
        Number::F32(value) => f64::from(value).into_pyobject(py)?.into_any(),
        Number::I8(value) => value.into_pyobject(py)?.into_any(),
        Number::I16(value) => value.into_pyobject(py)?.into_any(),
        Number::I32(value) => value.into_pyobject(py)?.into_any(),
        Number::I64(value) => value.into_pyobject(py)?.into_any(),
        Number::U8(value) => value.into_pyobject(py)?.into_any(),
        Number::U16(value) => value.into_pyobject(py)?.into_any(),
        Number::U32(value) => value.into_pyobject(py)?.into_any(),
        Number::U64(value) => value.into_pyobject(py)?.into_any(),
    })
}
