//! Arguments go by their place, and names tell a reader which is which: the two must not disagree.

use syn::{Ident, Type};

use super::super::diagnostics::{Mistake, Report};
use super::super::hygiene::unmarked;

/// The name of a parameter, if it has one, and its type.
pub type Parameter<'s> = (Option<&'s Ident>, &'s Type);

/// The place of an argument.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Place {
    Configuration,
    Velocity,
    Input,
    Time,
    /// A parameter of a free function.
    Field,
}

impl Place {
    /// The name by which a system's argument is known.
    fn of_name(name: &str) -> Option<Self> {
        Some(match name.strip_prefix('_').unwrap_or(name) {
            "q" => Self::Configuration,
            "v" => Self::Velocity,
            "u" => Self::Input,
            "t" | "time" => Self::Time,
            _ => return None,
        })
    }

    /// The argument in words.
    fn told(self) -> &'static str {
        match self {
            Self::Configuration => "the configuration q",
            Self::Velocity => "the velocity v",
            Self::Input => "the input u",
            Self::Time => "the time t",
            Self::Field => "a constant, a field of the system",
        }
    }
}

/// The place that the name of a parameter is known for.
pub fn known_place((name, _): Parameter<'_>) -> Option<Place> {
    Place::of_name(&unmarked(&name?.to_string()))
}

/// Reports a name that is known for another argument, and a time that is not called so: a number after v
/// might be meant as anything.
pub fn at_place(name: Option<&Ident>, place: Place, report: &mut Report) {
    let Some(name) = name else { return };
    let text = unmarked(&name.to_string());
    match Place::of_name(&text) {
        None | Some(Place::Input) if place == Place::Time => {
            report.at(name, Mistake::TimeByAnotherName(text));
        }
        Some(known) if known != place => {
            report.at(name, Mistake::OtherPlace { name: text, known: known.told(), place: place.told() });
        }
        _ => {}
    }
}

/// Reports a parameter of a free function, which becomes a field, by the name of an argument that it does not
/// take. A number may be called u, as a speed is.
pub fn at_field((name, ty): Parameter<'_>, report: &mut Report) {
    let Some(name) = name else { return };
    let text = unmarked(&name.to_string());
    match Place::of_name(&text) {
        Some(Place::Input) if !matches!(ty, Type::Array(_)) => {}
        Some(Place::Input | Place::Time) => report.at(name, Mistake::NoConstant(text)),
        Some(_) => at_place(Some(name), Place::Field, report),
        None => {}
    }
}
