//! The variables of a unit; a value reference is a place among them.

mod naming;
mod told;

use dalembert::system::Scalar;
use dalembert_face::{Described, Field, Fields, Interface, Number};

use crate::Unit;
pub use naming::NamingError;
pub use told::is_told;

/// The quantity that a variable is a number of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Time,
    StepSize,
    /// Number `index` of field `field`; of a table first the x, then the y.
    Parameter {
        field: usize,
        index: usize,
    },
    Input(usize),
    Configuration(usize),
    Velocity(usize),
    Momentum(usize),
    Energy,
    /// λ of a constraint.
    Multiplier(usize),
    /// Number of those that `fn outputs` returns.
    Output(usize),
}

/// The role of a variable: whether the importer may set it, and when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    Independent,
    /// Set until initialization is left.
    Fixed,
    /// Set at any time.
    Tunable,
    Input,
    /// An output with a start value, set until initialization is left.
    Exact,
    /// An output with a guess for its start, set until initialization is left: constraints hold it.
    Approximate,
    /// An output that follows from others.
    Calculated,
}

/// One variable.
#[derive(Clone, Debug)]
pub struct Variable {
    pub name: String,
    pub description: String,
    pub unit: Option<String>,
    pub place: Place,
    pub role: Role,
    /// A number of its type: the start, where it has one.
    pub start: Number,
}

impl Variable {
    fn new(name: impl Into<String>, description: &str, place: Place, role: Role, start: Number) -> Self {
        Self { name: name.into(), description: description.into(), unit: None, place, role, start }
    }

    pub const fn is_output(&self) -> bool {
        matches!(self.role, Role::Exact | Role::Approximate | Role::Calculated)
    }

    /// Whether its value follows from others at the start.
    pub const fn is_initial_unknown(&self) -> bool {
        matches!(self.role, Role::Approximate | Role::Calculated)
    }
}

/// Its type as FMI names it.
pub const fn type_name(number: Number) -> &'static str {
    match number {
        Number::F64(_) => "Float64",
        Number::F32(_) => "Float32",
        Number::I8(_) => "Int8",
        Number::I16(_) => "Int16",
        Number::I32(_) => "Int32",
        Number::I64(_) => "Int64",
        Number::U8(_) => "UInt8",
        Number::U16(_) => "UInt16",
        Number::U32(_) => "UInt32",
        Number::U64(_) => "UInt64",
    }
}

/// A number of the system's scalar type.
pub fn number<S: Scalar>(value: S) -> Number {
    // One of the two, so that f32 loses nothing on the way.
    let wide = value.widen();
    if size_of::<S>() == size_of::<f32>() { Number::F32(wide as f32) } else { Number::F64(wide) }
}

/// All variables of a unit, in the order of their value references.
pub fn of<I: Interface<N>, const N: usize>(unit: &Unit<I, N>) -> Vec<Variable> {
    let mut all = untold(unit);
    told::tell(&documentation::<I, N>(), &mut all);
    all
}

/// As [`of`], where the documentation tells what can be.
pub fn named<I: Interface<N>, const N: usize>(unit: &Unit<I, N>) -> Result<Vec<Variable>, NamingError> {
    fn names(all: &[Variable]) -> Vec<&str> {
        all.iter().map(|variable| variable.name.as_str()).collect()
    }
    let (symbols, all) = (untold(unit), of(unit));
    told::check(&documentation::<I, N>(), &names(&symbols), &names(&all))?;
    Ok(all)
}

/// The lines that may tell of variables.
fn documentation<I: Interface<N>, const N: usize>() -> Vec<&'static str> {
    let texts = I::System::DOCUMENTATION.iter().chain(I::System::OUTPUTS_TOLD);
    texts.flat_map(|text| text.lines()).collect()
}

/// All variables, without what the documentation tells of them.
fn untold<I: Interface<N>, const N: usize>(unit: &Unit<I, N>) -> Vec<Variable> {
    let zero = number(I::Scalar::constant(0.0));
    let mut all = vec![
        Variable::new("time", "Time", Place::Time, Role::Independent, Number::F64(0.0)),
        step_size(unit),
    ];
    for (index, field) in I::System::FIELDS.iter().enumerate() {
        all.extend(parameters(unit, index, field));
    }
    for i in 0..I::System::INPUTS {
        let held = "Input, held over a communication step";
        all.push(Variable::new(format!("u[{i}]"), held, Place::Input(i), Role::Input, zero));
    }
    let [q, v] = unit.start;
    let role = if I::System::CONSTRAINTS > 0 { Role::Approximate } else { Role::Exact };
    for (i, &start) in q.iter().enumerate() {
        let (place, start) = (Place::Configuration(i), number(start));
        all.push(Variable::new(format!("q[{i}]"), "Configuration", place, role, start));
    }
    for (i, &start) in v.iter().enumerate() {
        let (place, start) = (Place::Velocity(i), number(start));
        all.push(Variable::new(format!("v[{i}]"), "Velocity", place, role, start));
    }
    for i in 0..N {
        all.push(Variable::new(format!("p[{i}]"), "Momentum", Place::Momentum(i), Role::Calculated, zero));
    }
    all.push(Variable::new("energy", "Energy", Place::Energy, Role::Calculated, zero));
    for i in 0..I::System::CONSTRAINTS {
        let (name, place) = (format!("lambda[{i}]"), Place::Multiplier(i));
        let of = format!(
            "Reaction of constraint {i} over the last step: its force on q[k] is this times the derivative by q[k]"
        );
        all.push(Variable::new(name, &of, place, Role::Calculated, zero));
    }
    for i in 0..I::System::OUTPUTS {
        all.push(Variable::new(format!("y[{i}]"), "Output", Place::Output(i), Role::Calculated, zero));
    }
    all
}

fn step_size<I: Interface<N>, const N: usize>(unit: &Unit<I, N>) -> Variable {
    let description = format!(
        "Step size of the rule {}: a communication step takes whole ones, and a shorter one for what is left",
        unit.rule.replace(' ', "")
    );
    Variable::new("step_size", &description, Place::StepSize, Role::Fixed, number(unit.step_size))
}

/// The numbers of a field: `mass`, or `friction[0]`, `friction[1]`, or `weights[0,0]` …; of a table those of
/// its points, `thrust.x[0]` … and `thrust.y[0]` …, since its interpolation is the unit's. Its points are set
/// before the run: one by one they may be wrong on the way.
fn parameters<'a, I: Interface<N>, const N: usize>(
    unit: &'a Unit<I, N>,
    field: usize,
    of: &'static Field,
) -> impl Iterator<Item = Variable> + 'a {
    let says_unit = |line: &&&str| line.trim().starts_with("Unit:");
    let lines = of.documentation.iter();
    let text: Vec<_> = lines.clone().filter(|line| !says_unit(line)).map(|line| line.trim()).collect();
    let units: Vec<_> = lines
        .filter(says_unit)
        .flat_map(|line| line.trim().trim_start_matches("Unit:").split(','))
        .map(|unit| unit.trim().to_owned())
        .collect();
    let entry = move |index| unit.parameters.entry(field, index);
    let count = of.dimensions.iter().product();
    (0..count).map_while(move |index| entry(index).map(|start| (index, start))).map(move |(index, start)| {
        let name = match *of.dimensions {
            [_, points] if of.is_table => {
                format!("{}.{}[{}]", of.name, ["x", "y"][index / points], index % points)
            }
            [_, columns] => format!("{}[{},{}]", of.name, index / columns, index % columns),
            [_] => format!("{}[{index}]", of.name),
            _ => of.name.to_owned(),
        };
        let (place, role) =
            (Place::Parameter { field, index }, if of.is_table { Role::Fixed } else { Role::Tunable });
        let mut variable = Variable::new(name, text.join(" ").trim(), place, role, start);
        // One unit for all numbers of an array, or one each; of a table one for the x, one for the y.
        let which = if of.is_table { 2 * index / count } else { index };
        variable.unit = units.get(which).or(units.last()).cloned();
        variable
    })
}
