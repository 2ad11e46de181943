//! modelDescription.xml of FMI 3.0, and what it shares with that of FMI 2.0.

use std::io;

use dalembert_c::Number;
use dalembert_c::machine::Interface;
use quick_xml::Writer;

use crate::Unit;
use crate::variables::{self, Role, Variable, type_name};

mod two;

const TOOL: &str = concat!("dalembert ", env!("CARGO_PKG_VERSION"));

/// What the log is divided into.
pub const CATEGORIES: [(&str, &str); 3] = [
    ("logStatusDiscard", "A communication step that is no multiple of the step size"),
    ("logStatusError", "Calls that were refused, and steps without a solution"),
    ("logStatusFatal", "A panic in the model"),
];

impl<I: Interface<N>, const N: usize> Unit<I, N> {
    /// modelDescription.xml of FMI 3.0.
    #[must_use]
    pub fn description(&self) -> String {
        let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
        write(self, &mut writer).expect("memory takes all that is written");
        finished(writer)
    }
}

type To = Writer<Vec<u8>>;

fn finished(writer: To) -> String {
    let text = String::from_utf8(writer.into_inner()).expect("written from text");
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{text}\n")
}

fn documentation<I: Interface<N>, const N: usize>(unit: &Unit<I, N>) -> String {
    let lines: Vec<_> = unit.header.documentation.iter().map(|line| line.trim()).collect();
    lines.join(" ").trim().to_owned()
}

fn write<I: Interface<N>, const N: usize>(unit: &Unit<I, N>, to: &mut To) -> io::Result<()> {
    let variables = variables::of(unit);
    let (description, token) = (documentation(unit), unit.token());
    let root = to.create_element("fmiModelDescription").with_attributes([
        ("fmiVersion", "3.0"),
        ("modelName", unit.header.prefix),
        ("instantiationToken", &token),
        ("description", &description),
        ("generationTool", TOOL),
        ("variableNamingConvention", "structured"),
    ]);
    root.write_inner_content(|to| {
        to.create_element("CoSimulation")
            .with_attributes([
                ("modelIdentifier", unit.header.prefix),
                ("canGetAndSetFMUState", "true"),
                ("canSerializeFMUState", "true"),
                ("providesDirectionalDerivatives", "true"),
                ("canHandleVariableCommunicationStepSize", "false"),
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

fn units(variables: &[Variable], to: &mut To) -> io::Result<()> {
    let mut names: Vec<_> = variables.iter().filter_map(|variable| variable.unit.as_deref()).collect();
    names.sort_unstable();
    names.dedup();
    if names.is_empty() {
        return Ok(());
    }
    to.create_element("UnitDefinitions").write_inner_content(|to| {
        names.iter().try_for_each(|name| {
            to.create_element("Unit").with_attribute(("name", *name)).write_empty().map(drop)
        })
    })?;
    Ok(())
}

fn categories(to: &mut To) -> io::Result<()> {
    to.create_element("LogCategories").write_inner_content(|to| {
        CATEGORIES.iter().try_for_each(|(name, description)| {
            let category = to.create_element("Category");
            category.with_attributes([("name", *name), ("description", *description)]).write_empty().map(drop)
        })
    })?;
    Ok(())
}

fn experiment<I: Interface<N>, const N: usize>(unit: &Unit<I, N>, to: &mut To) -> io::Result<()> {
    let step_size = text(variables::number(unit.step_size));
    let experiment = to.create_element("DefaultExperiment");
    experiment.with_attributes([("startTime", "0"), ("stepSize", &step_size)]).write_empty()?;
    Ok(())
}

/// Causality, variability and what is known of the start.
fn roles(role: Role) -> (&'static str, &'static str, Option<&'static str>) {
    match role {
        Role::Independent => ("independent", "continuous", None),
        Role::Fixed => ("parameter", "fixed", Some("exact")),
        Role::Tunable => ("parameter", "tunable", Some("exact")),
        Role::Input => ("input", "continuous", None),
        Role::Exact => ("output", "continuous", Some("exact")),
        Role::Calculated => ("output", "continuous", Some("calculated")),
    }
}

fn variable(reference: usize, of: &Variable, to: &mut To) -> io::Result<()> {
    let reference = reference.to_string();
    let is_real = matches!(of.start, Number::F64(_) | Number::F32(_));
    let (causality, variability, initial) = roles(of.role);
    let mut element = to.create_element(type_name(of.start)).with_attributes([
        ("name", of.name.as_str()),
        ("valueReference", &reference),
        ("description", &of.description),
        ("causality", causality),
        ("variability", variability),
    ]);
    if let Some(initial) = initial {
        element = element.with_attribute(("initial", initial));
    }
    if let (Some(unit), true) = (&of.unit, is_real) {
        element = element.with_attribute(("unit", unit.as_str()));
    }
    if !matches!(of.role, Role::Independent | Role::Calculated) {
        element = element.with_attribute(("start", text(of.start).as_str()));
    }
    element.write_empty()?;
    Ok(())
}

fn structure(variables: &[Variable], to: &mut To) -> io::Result<()> {
    for (name, which) in [("Output", None), ("InitialUnknown", Some(Role::Calculated))] {
        for (reference, variable) in variables.iter().enumerate() {
            if variable.is_output() && which.is_none_or(|role| variable.role == role) {
                let reference = reference.to_string();
                to.create_element(name)
                    .with_attribute(("valueReference", reference.as_str()))
                    .write_empty()?;
            }
        }
    }
    Ok(())
}

/// A number as XML Schema writes it, of all its digits.
fn text(number: Number) -> String {
    let real = |digits: String| digits.replace("inf", "INF");
    match number {
        Number::F64(value) => real(format!("{value:?}")),
        Number::F32(value) => real(format!("{value:?}")),
        Number::I8(value) => value.to_string(),
        Number::I16(value) => value.to_string(),
        Number::I32(value) => value.to_string(),
        Number::I64(value) => value.to_string(),
        Number::U8(value) => value.to_string(),
        Number::U16(value) => value.to_string(),
        Number::U32(value) => value.to_string(),
        Number::U64(value) => value.to_string(),
    }
}
