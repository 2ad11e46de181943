//! Declarations that the header of a system with tables has besides.

use core::fmt::{self, Display};

use dalembert_face::Field;

use super::Header;
use crate::Status;

/// The types that such headers share.
const SHARED: &str = include_str!("../tables.h");

impl Header {
    /// Whether a field is a table.
    fn has_tables(&self) -> bool {
        self.fields.iter().any(|field| field.is_table)
    }

    /// Statuses of tables, once in a program: by macros, so that the enumeration is the same everywhere.
    pub(super) fn shared_on_tables(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.has_tables() {
            return Ok(());
        }
        let mut all = Status::ALL.iter().filter(|status| status.is_of_tables());
        writeln!(f, "#ifndef {}", Status::PointsNotIncreasing.name())?;
        f.write_str("/* How calls of a system with tables end besides. */\n")?;
        all.try_for_each(|status| {
            let (name, number) = (status.name(), *status as i32);
            writeln!(f, "#define {name} ((dalembert_status){number}) /**< {status} */")
        })?;
        write!(f, "\n{SHARED}#endif\n\n")
    }

    /// A field in the struct that C fills in: a table by its points, as a struct that has a name.
    pub(super) fn field(&self, f: &mut fmt::Formatter<'_>, field: &Field) -> fmt::Result {
        let Field { name, base, .. } = *field;
        let (true, [.., points]) = (field.is_table, field.dimensions) else {
            return writeln!(f, "    {field};");
        };
        writeln!(
            f,
            "    struct {}_{name} {{\n        {base} x[{points}]; /**< increasing */\n        {base} y[{points}];\n        \
             int32_t interpolation; /**< DALEMBERT_LINEAR, _SPLINE, _MONOTONE or _PERIODIC */\n        \
             int32_t straight_beyond; /**< not 0: goes on by its slope beyond its ends */\n    }} {name};",
            self.prefix
        )
    }

    pub(super) fn function_on_tables(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let prefix = self.prefix;
        if !self.has_tables() {
            return Ok(());
        }
        writeln!(
            f,
            "/** The first table whose points make none, and which of them is wrong: why init and set_parameters refuse them. */\n\
             dalembert_status {prefix}_wrong_point(const {prefix}_parameters *parameters, dalembert_wrong_point *wrong);\n"
        )
    }
}

/// The function of tables in C++, where there are some.
pub(super) struct OnTables<'a>(pub(super) &'a Header);

impl Display for OnTables<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let prefix = self.0.prefix;
        if !self.0.has_tables() {
            return Ok(());
        }
        writeln!(
            f,
            "    [[nodiscard]] static dalembert_status wrong_point(const {prefix}_parameters &parameters, dalembert_wrong_point &wrong) noexcept\n    \
             {{\n        return {prefix}_wrong_point(&parameters, &wrong);\n    }}"
        )
    }
}
