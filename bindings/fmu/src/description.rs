//! modelDescription.xml of FMI 3.0, and what it shares with that of FMI 2.0.

use std::io;

use dalembert_face::{Fields, Interface, Number};
use quick_xml::writer::{ElementWriter, Writer};

use crate::Unit;
use crate::variables::{self, Role, Variable, type_name};

mod two;

const TOOL: &str = concat!("dalembert ", env!("CARGO_PKG_VERSION"));

/// The categories of the log, each with its description.
pub const CATEGORIES: [(&str, &str); 3] = [
    ("logStatusDiscard", "A communication step that is not positive, or too short or too long"),
    ("logStatusError", "Calls that were refused, and steps without a solution"),
    ("logStatusFatal", "A panic in the model"),
];

impl<I: Interface<N>, const N: usize> Unit<I, N> {
    /// modelDescription.xml of FMI 3.0.
    ///
    /// # Panics
    /// With a [`NamingError`](crate::NamingError), where a line of the documentation cannot be followed.
    #[must_use]
    pub fn description(&self) -> String {
        self.description_fmi3().unwrap_or_else(|error| panic!("{error}"))
    }

    /// modelDescription.xml of FMI 3.0, where no name is given twice.
    pub(crate) fn description_fmi3(&self) -> io::Result<String> {
        let version = Version {
            number: "3.0",
            token: "instantiationToken",
            also: &[],
            capabilities: ["canGetAndSetFMUState", "canSerializeFMUState", "providesDirectionalDerivatives"],
            variable,
            structure,
        };
        document(self, &version)
    }
}

type To = Writer<Vec<u8>>;
type Element<'a> = ElementWriter<'a, Vec<u8>>;

/// A version of FMI, as far as its description differs from the other's.
struct Version {
    number: &'static str,
    token: &'static str,
    also: &'static [(&'static str, &'static str)],
    /// All of them are true.
    capabilities: [&'static str; 3],
    variable: fn(usize, &Variable, &mut To) -> io::Result<()>,
    structure: fn(&[Variable], &mut To) -> io::Result<()>,
}

fn document<I: Interface<N>, const N: usize>(unit: &Unit<I, N>, version: &Version) -> io::Result<String> {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    let variables =
        variables::named(unit).map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
    let (description, token) = (described(I::System::DOCUMENTATION), unit.token());
    let root = writer
        .create_element("fmiModelDescription")
        .with_attributes([
            ("fmiVersion", version.number),
            ("modelName", unit.name),
            (version.token, &*token),
            ("description", &description),
            ("generationTool", TOOL),
            ("variableNamingConvention", "structured"),
        ])
        .with_attributes(version.also.iter().copied());
    root.write_inner_content(|to| {
        to.create_element("CoSimulation")
            .with_attribute(("modelIdentifier", unit.name))
            .with_attributes(version.capabilities.map(|capability| (capability, "true")))
            .with_attribute(("canHandleVariableCommunicationStepSize", "true"))
            .write_empty()?;
        units(&variables, to)?;
        categories(to)?;
        experiment(unit, to)?;
        to.create_element("ModelVariables").write_inner_content(|to| {
            variables.iter().enumerate().try_for_each(|(reference, of)| (version.variable)(reference, of, to))
        })?;
        to.create_element("ModelStructure").write_inner_content(|to| (version.structure)(&variables, to))?;
        Ok(())
    })?;
    let text = String::from_utf8(writer.into_inner()).expect("written from text");
    Ok(format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{text}\n"))
}

fn described(documentation: &[&str]) -> String {
    let of_the_system = documentation.iter().filter(|line| !variables::is_told(line));
    let lines: Vec<_> = of_the_system.map(|line| line.trim()).collect();
    lines.join(" ").trim().to_owned()
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
        Role::Approximate => ("output", "continuous", Some("approx")),
        Role::Calculated => ("output", "continuous", Some("calculated")),
    }
}

fn variable(reference: usize, of: &Variable, to: &mut To) -> io::Result<()> {
    valued(of, labelled(reference, of, to.create_element(type_name(of.start)))).write_empty().map(drop)
}

/// The element with the name of a variable and what it is for.
fn labelled<'a>(reference: usize, of: &Variable, element: Element<'a>) -> Element<'a> {
    let (causality, variability, initial) = roles(of.role);
    element
        .with_attributes([
            ("name", of.name.as_str()),
            ("valueReference", &reference.to_string()),
            ("description", &of.description),
            ("causality", causality),
            ("variability", variability),
        ])
        .with_attributes(initial.map(|initial| ("initial", initial)))
}

/// The element with the unit of a variable and its start value.
fn valued<'a>(of: &Variable, element: Element<'a>) -> Element<'a> {
    let is_real = matches!(of.start, Number::F64(_) | Number::F32(_));
    let starts = !matches!(of.role, Role::Independent | Role::Calculated);
    element
        .with_attributes(of.unit.as_deref().filter(|_| is_real).map(|unit| ("unit", unit)))
        .with_attributes(starts.then(|| text(of.start)).as_deref().map(|start| ("start", start)))
}

fn structure(variables: &[Variable], to: &mut To) -> io::Result<()> {
    unknowns(variables, Variable::is_output, |reference| {
        unknown(to, "Output", ("valueReference", reference))
    })?;
    unknowns(variables, Variable::is_initial_unknown, |reference| {
        unknown(to, "InitialUnknown", ("valueReference", reference))
    })
}

/// The value references of variables.
fn unknowns(
    variables: &[Variable],
    which: fn(&Variable) -> bool,
    write: impl FnMut(usize) -> io::Result<()>,
) -> io::Result<()> {
    let all = variables.iter().enumerate();
    all.filter(|(_, of)| which(of)).map(|(reference, _)| reference).try_for_each(write)
}

fn unknown(to: &mut To, name: &str, (attribute, number): (&str, usize)) -> io::Result<()> {
    to.create_element(name).with_attribute((attribute, &*number.to_string())).write_empty().map(drop)
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
