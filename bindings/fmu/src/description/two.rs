//! modelDescription.xml of FMI 2.0.

use std::io;

use dalembert_face::{Interface, Number};

use super::{To, Version, document, labelled, unknown, unknowns, valued};
use crate::Unit;
use crate::variables::{Variable, type_name};

impl<I: Interface<N>, const N: usize> Unit<I, N> {
    /// modelDescription.xml of FMI 2.0.
    ///
    /// # Errors
    /// Where a field is of a type that FMI 2.0 has not, an integer beyond 32 bits with a sign; a
    /// [`NamingError`](crate::NamingError) within, where a line of the documentation cannot be followed.
    pub fn description_fmi2(&self) -> io::Result<String> {
        let version = Version {
            number: "2.0",
            token: "guid",
            also: &[("numberOfEventIndicators", "0")],
            capabilities: ["canGetAndSetFMUstate", "canSerializeFMUstate", "providesDirectionalDerivative"],
            variable,
            structure,
        };
        document(self, &version)
    }
}

fn variable(reference: usize, of: &Variable, to: &mut To) -> io::Result<()> {
    let kind = match of.start {
        Number::F64(_) | Number::F32(_) => "Real",
        Number::I8(_) | Number::I16(_) | Number::I32(_) | Number::U8(_) | Number::U16(_) => "Integer",
        Number::I64(_) | Number::U32(_) | Number::U64(_) => {
            let message = format!("FMI 2.0 has no type for the field {}, {}", of.name, type_name(of.start));
            return Err(io::Error::new(io::ErrorKind::Unsupported, message));
        }
    };
    labelled(reference, of, to.create_element("ScalarVariable"))
        .write_inner_content(|to| valued(of, to.create_element(kind)).write_empty().map(drop))
        .map(drop)
}

fn structure(variables: &[Variable], to: &mut To) -> io::Result<()> {
    list("Outputs", variables, Variable::is_output, to)?;
    list("InitialUnknowns", variables, Variable::is_initial_unknown, to)
}

fn list(name: &str, variables: &[Variable], which: fn(&Variable) -> bool, to: &mut To) -> io::Result<()> {
    let content = |to: &mut To| {
        // Counted from 1.
        unknowns(variables, which, |reference| unknown(to, "Unknown", ("index", reference + 1)))
    };
    to.create_element(name).write_inner_content(content).map(drop)
}
