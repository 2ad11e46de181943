//! modelDescription.xml of FMI 2.0.

use std::io;

use dalembert_c::Number;
use dalembert_c::machine::Interface;
use quick_xml::Writer;

use super::{To, categories, documentation, experiment, finished, roles, text, units};
use crate::Unit;
use crate::variables::{self, Role, Variable, type_name};

impl<I: Interface<N>, const N: usize> Unit<I, N> {
    /// modelDescription.xml of FMI 2.0.
    ///
    /// # Errors
    /// Where a field is of a type that FMI 2.0 has not, an integer beyond 32 bits with a sign.
    pub fn description_fmi2(&self) -> io::Result<String> {
        let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
        write(self, &mut writer)?;
        Ok(finished(writer))
    }
}

fn write<I: Interface<N>, const N: usize>(unit: &Unit<I, N>, to: &mut To) -> io::Result<()> {
    let variables = variables::of(unit);
    let (description, token) = (documentation(unit), unit.token());
    let root = to.create_element("fmiModelDescription").with_attributes([
        ("fmiVersion", "2.0"),
        ("modelName", unit.header.prefix),
        ("guid", &token),
        ("description", &description),
        ("generationTool", super::TOOL),
        ("variableNamingConvention", "structured"),
        ("numberOfEventIndicators", "0"),
    ]);
    root.write_inner_content(|to| {
        to.create_element("CoSimulation")
            .with_attributes([
                ("modelIdentifier", unit.header.prefix),
                ("canHandleVariableCommunicationStepSize", "false"),
                ("canGetAndSetFMUstate", "true"),
                ("canSerializeFMUstate", "true"),
                ("providesDirectionalDerivative", "true"),
            ])
            .write_empty()?;
        units(&variables, to)?;
        categories(to)?;
        experiment(unit, to)?;
        to.create_element("ModelVariables").write_inner_content(|to| {
            variables.iter().enumerate().try_for_each(|(reference, of)| variable(reference, of, to))
        })?;
        to.create_element("ModelStructure").write_inner_content(|to| structure(&variables, to))?;
        Ok(())
    })?;
    Ok(())
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
    let reference = reference.to_string();
    let (causality, variability, initial) = roles(of.role);
    let mut element = to.create_element("ScalarVariable").with_attributes([
        ("name", of.name.as_str()),
        ("valueReference", &reference),
        ("description", &of.description),
        ("causality", causality),
        ("variability", variability),
    ]);
    if let Some(initial) = initial {
        element = element.with_attribute(("initial", initial));
    }
    element.write_inner_content(|to| {
        let mut element = to.create_element(kind);
        if let (Some(unit), "Real") = (&of.unit, kind) {
            element = element.with_attribute(("unit", unit.as_str()));
        }
        if !matches!(of.role, Role::Independent | Role::Calculated) {
            element = element.with_attribute(("start", text(of.start).as_str()));
        }
        element.write_empty().map(drop)
    })?;
    Ok(())
}

fn structure(variables: &[Variable], to: &mut To) -> io::Result<()> {
    for (name, which) in [("Outputs", None), ("InitialUnknowns", Some(Role::Calculated))] {
        to.create_element(name).write_inner_content(|to| {
            // Counted from 1.
            for (index, variable) in (1..).zip(variables) {
                if variable.is_output() && which.is_none_or(|role| variable.role == role) {
                    let index: i32 = index;
                    to.create_element("Unknown")
                        .with_attribute(("index", &*index.to_string()))
                        .write_empty()?;
                }
            }
            Ok(())
        })?;
    }
    Ok(())
}
