//! Fields as Python gives them: numbers, arrays or a table.

use dalembert_face::{Field, Number};
use pyo3::prelude::*;

use crate::{arguments, table};

/// The numbers of a field, of the type that it has: `like` is one of them.
///
/// # Errors
/// Those of [`arguments::entries`] or [`table::entries`].
pub fn entries(field: &Field, like: Number, given: &Bound<'_, PyAny>) -> PyResult<Vec<Number>> {
    if field.is_table { table::entries(field, like, given) } else { arguments::entries(field, like, given) }
}

/// The numbers of a field for each member, one after the other, and for how many members.
///
/// # Errors
/// Those of [`arguments::entries_of_members`] or [`table::entries_of_members`].
pub fn entries_of_members(
    field: &Field,
    like: Number,
    given: &Bound<'_, PyAny>,
) -> PyResult<(Vec<Number>, usize)> {
    if field.is_table {
        table::entries_of_members(field, like, given)
    } else {
        arguments::entries_of_members(field, like, given)
    }
}
