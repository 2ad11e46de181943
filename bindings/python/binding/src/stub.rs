//! The stub of the module: what type checkers and editors read.

use core::fmt::Write;

use dalembert_face::Field;

use crate::model::Kind;

/// The classes that all modules have.
const COMMON: &str = include_str!("common.pyi");

/// The text of the `.pyi` of a module with these systems.
pub fn stub_of(kinds: &[&dyn Kind]) -> String {
    let mut text = COMMON.to_owned();
    for kind in kinds {
        let documentation = lines(kind.documentation(), "\n    ");
        let _ = write!(text, "\nclass {}(System):\n    \"\"\"{documentation}\"\"\"\n", kind.name());
        let parameters: Vec<String> =
            kind.fields().iter().map(|field| format!("{}: {}", field.name, given(field))).collect();
        let _ = write!(text, "\n    def __new__(cls, {}) -> Self: ...\n", parameters.join(", "));
        for field in kind.fields() {
            let (name, documentation) = (field.name, lines(field.documentation, "\n        "));
            let _ = write!(
                text,
                "    @property\n    def {name}(self) -> {}:\n        \"\"\"{documentation}\"\"\"\n    @{name}.setter\n    def {name}(self, value: {}) -> None: ...\n",
                held(field),
                given(field),
            );
        }
    }
    text
}

/// Lines of documentation, as Rust's comments have them, with this between.
pub fn lines(documentation: &[&str], between: &str) -> String {
    documentation.iter().map(|line| line.trim()).collect::<Vec<_>>().join(between)
}

/// The type of a field's value.
fn held(field: &Field) -> String {
    if field.is_table {
        return "Table".to_owned();
    }
    let number = if is_real(field) { "float" } else { "int" };
    match (field.dimensions, number) {
        ([], number) => number.to_owned(),
        (_, "float") => "_Array".to_owned(),
        _ => "npt.NDArray[np.int64]".to_owned(),
    }
}

/// The type of what may be given for it.
fn given(field: &Field) -> String {
    if field.is_table {
        return held(field);
    }
    match (field.dimensions, is_real(field)) {
        ([], true) => "float".to_owned(),
        ([], false) => "int".to_owned(),
        (_, true) => "_Numbers".to_owned(),
        _ => "Sequence[int] | npt.NDArray[np.integer]".to_owned(),
    }
}

fn is_real(field: &Field) -> bool {
    matches!(field.base, "double" | "float")
}
