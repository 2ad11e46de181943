//! Names, descriptions and units of u, q, v and p, as the documentation of the struct has them.
//!
//! ```text
//! /// - `q[0]` position: of the cart on the rail. Unit: m
//! /// - `u[0]`: force on the cart. Unit: N
//! ```
//!
//! A name, where there is one, takes the place of `q[0]`; the unit of v is that of q over s unless it has a
//! line of its own.

use super::Variable;

/// A line about a variable.
struct Told<'a> {
    name: Option<&'a str>,
    description: &'a str,
    unit: Option<&'a str>,
}

/// The line of a variable: `` - `q[0]` name: description. Unit: m ``, all of it but the variable optional.
fn told<'a>(line: &'a str, variable: &str) -> Option<Told<'a>> {
    let line = line.trim().trim_start_matches("- ").strip_prefix('`')?;
    let rest = line.strip_prefix(variable)?.strip_prefix('`')?;
    let (name, text) = rest.split_once(':')?;
    let (description, unit) = match text.split_once("Unit:") {
        Some((description, unit)) => (description, Some(unit.trim().trim_end_matches('.'))),
        None => (text, None),
    };
    let name = Some(name.trim()).filter(|name| is_name(name));
    Some(Told { name, description: description.trim(), unit })
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
    let line = line.trim().trim_start_matches("- ");
    ["`u[", "`q[", "`v[", "`p["].iter().any(|start| line.starts_with(start)) && line.contains(':')
}

/// Names, describes and gives a unit to the variables `u[0]` … that the documentation tells of.
pub fn tell(documentation: &[&str], variables: &mut [Variable]) {
    let unit_of = |variable: &str| documentation.iter().find_map(|line| told(line, variable)?.unit);
    for variable in variables {
        let symbol = variable.name.clone();
        if let Some(index) = symbol.strip_prefix('v') {
            variable.unit = unit_of(&format!("q{index}")).map(per_second);
        }
        let Some(told) = documentation.iter().find_map(|line| told(line, &symbol)) else { continue };
        if let Some(name) = told.name {
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

#[cfg(test)]
mod tests {
    use super::told;

    #[test]
    fn a_line_has_a_name_a_description_and_a_unit_or_fewer() {
        let parts = |line| told(line, "q[0]").map(|told| (told.name, told.description, told.unit));
        let all = parts(" - `q[0]` cart.position: of the cart: on the rail. Unit: m");
        assert_eq!(all, Some((Some("cart.position"), "of the cart: on the rail.", Some("m"))));
        assert_eq!(parts("`q[0]`: the angle"), Some((None, "the angle", None)));
        assert_eq!(parts("`q[0]`: Unit: rad."), Some((None, "", Some("rad"))));
        for other in
            ["`q[1]` angle: of the pole", "q[0] angle: of the pole", "`q[0]` is the angle", "`q[0` a: b"]
        {
            assert_eq!(parts(other), None, "{other}");
        }
        // No name of FMI's.
        assert_eq!(parts("`q[0]` 2nd angle: of the pole"), Some((None, "of the pole", None)));
    }
}
