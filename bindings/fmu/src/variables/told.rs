//! Names, descriptions and units of u, q, v, p and y, as lines of the documentation have them, that of the
//! struct or of `fn outputs`.
//!
//! ```text
//! /// - `q[0]` position: of the cart on the rail. Unit: m
//! /// - `u[0]`: force on the cart. Unit: N
//! ```
//!
//! A name, where there is one, takes the place of `q[0]`; the unit of v is that of q over s unless it has a
//! line of its own.

use super::Variable;
use super::naming::NamingError;

/// A line about a variable.
struct Told<'a> {
    /// `q[0]`.
    variable: &'a str,
    name: Option<&'a str>,
    description: &'a str,
    unit: Option<&'a str>,
}

/// The line of a variable: `` - `q[0]` name: description. Unit: m ``, all of it but the variable optional.
fn told(line: &str) -> Option<Told<'_>> {
    let line = line.trim().trim_start_matches("- ").strip_prefix('`')?;
    let (variable, rest) = line.split_once('`')?;
    let (name, text) = rest.split_once(':')?;
    let (description, unit) = match text.split_once("Unit:") {
        Some((description, unit)) => (description, Some(unit.trim().trim_end_matches('.'))),
        None => (text, None),
    };
    let name = Some(name.trim()).filter(|name| !name.is_empty());
    // Several words before the colon are prose.
    if name.is_some_and(|name| name.contains(char::is_whitespace)) {
        return None;
    }
    Some(Told { variable, name, description: description.trim(), unit })
}

/// Whether this is a name as FMI's structured naming has them, without arrays.
fn is_name(text: &str) -> bool {
    let is_part = |part: &str| {
        part.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_')
            && part.chars().all(|other| other.is_ascii_alphanumeric() || other == '_')
    };
    text.split('.').all(is_part)
}

/// Whether a line of the documentation is about a variable.
pub fn is_told(line: &str) -> bool {
    told(line).is_some_and(|told| {
        ["u[", "q[", "v[", "p[", "y["].iter().any(|start| told.variable.starts_with(start))
    })
}

/// Names, describes and gives a unit to the variables `u[0]` … that lines of the documentation tell of.
pub fn tell(documentation: &[&str], variables: &mut [Variable]) {
    let about = |variable: &str| {
        documentation.iter().filter_map(|line| told(line)).find(|told| told.variable == variable)
    };
    for variable in variables {
        let symbol = variable.name.clone();
        if let Some(index) = symbol.strip_prefix('v') {
            variable.unit = about(&format!("q{index}")).and_then(|told| told.unit).map(per_second);
        }
        let Some(told) = about(&symbol) else { continue };
        if let Some(name) = told.name.filter(|name| is_name(name)) {
            variable.name = name.to_owned();
        }
        if !told.description.is_empty() {
            variable.description = told.description.to_owned();
        }
        if let Some(unit) = told.unit {
            variable.unit = Some(unit.to_owned());
        }
    }
}

/// The unit over s.
fn per_second(unit: &str) -> String {
    if unit == "1" { "1/s".into() } else { format!("{unit}/s") }
}

/// Whether the lines can be followed: `symbols` are the names of all variables without them, `names` with
/// them.
pub fn check(documentation: &[&'static str], symbols: &[&str], names: &[&str]) -> Result<(), NamingError> {
    let lines = documentation.iter().copied().filter(|line| is_told(line));
    let all: Vec<_> = lines.filter_map(|line| Some((line.trim(), told(line)?))).collect();
    let count = |names: &[&str], name: &str| names.iter().filter(|other| **other == name).count();
    for (index, (line, told)) in all.iter().enumerate() {
        if count(symbols, told.variable) == 0 {
            return Err(NamingError::NoVariable { line });
        }
        if all[..index].iter().any(|(_, before)| before.variable == told.variable) {
            return Err(NamingError::ToldTwice { line });
        }
        let Some(name) = told.name else { continue };
        if !is_name(name) {
            return Err(NamingError::NoName { line });
        }
        if count(names, name) > 1 {
            return Err(NamingError::NameTwice { line });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_a_name_a_description_and_a_unit_or_fewer() {
        let parts = |line| told(line).map(|told| (told.variable, told.name, told.description, told.unit));
        let all = parts(" - `q[0]` cart.position: of the cart: on the rail. Unit: m");
        assert_eq!(all, Some(("q[0]", Some("cart.position"), "of the cart: on the rail.", Some("m"))));
        assert_eq!(parts("`q[0]`: the angle"), Some(("q[0]", None, "the angle", None)));
        assert_eq!(parts("`y[1]`: Unit: rad."), Some(("y[1]", None, "", Some("rad"))));
        let prose = "`q[0]` is the angle: positive upwards";
        for other in ["q[0] angle: of the pole", "`q[0]` is the angle", "`q[0] a: b", prose] {
            assert_eq!(parts(other), None, "{other}");
        }
        assert!(is_told("`y[0]` load: x") && !is_told("`friction[0]`: of the rail"));
    }

    #[test]
    fn lines_that_tell_what_cannot_be_are_found() {
        let symbols = ["energy", "q[0]", "y[0]", "y[1]"];
        let found = |documentation: &[&'static str], names: [&str; 2]| {
            check(documentation, &symbols, &["energy", "q[0]", names[0], names[1]])
        };
        let [load, tension] = ["- `y[0]` load: over the floor", "- `y[1]` tension: of the rope. Unit: N"];
        assert_eq!(found(&["A hoist.", load, tension], ["load", "tension"]), Ok(()), "the control");
        let line = "- `y[2]` speed: of the load";
        assert_eq!(found(&[load, tension, line], ["load", "tension"]), Err(NamingError::NoVariable { line }));
        let line = "`y[0` height: of the load";
        assert_eq!(found(&[load, tension, line], ["load", "tension"]), Err(NamingError::NoVariable { line }));
        let line = "`y[1]` 2nd: of the rope";
        assert_eq!(found(&[load, line], ["load", "y[1]"]), Err(NamingError::NoName { line }));
        let line = "- `y[0]` tension: of the rope";
        assert_eq!(found(&[load, line], ["load", "y[1]"]), Err(NamingError::ToldTwice { line }));
        let line = "- `y[1]` energy: of the load";
        assert_eq!(found(&[line], ["y[0]", "energy"]), Err(NamingError::NameTwice { line }));
        let line = "- `y[0]` load: over the floor";
        assert_eq!(
            found(&[line, "`y[1]` load: again"], ["load", "load"]),
            Err(NamingError::NameTwice { line })
        );
    }
}
