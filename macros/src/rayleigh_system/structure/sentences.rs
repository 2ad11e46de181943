//! The findings as sentences of documentation, in Unicode text.

use super::{Damping, Engine, Findings, Newton, Structure};

/// One line for each, as a list.
pub fn of(structure: &Structure) -> Vec<String> {
    let mut lines = vec!["Known at compile time:".to_owned()];
    lines.push(match &structure.engine {
        Engine::Expanded => "- Derivatives are written out.".to_owned(),
        Engine::NumDual(None) => "- Derivatives are made by dual numbers, as asked.".to_owned(),
        Engine::NumDual(Some(refusal)) => format!(
            "- Derivatives are made by dual numbers; in the way of writing them out is `{}`: {}.",
            refusal.token,
            escaped(&refusal.reason)
        ),
    });
    if let Some(findings) = &structure.findings {
        lines.extend(sentences(findings).into_iter().map(|sentence| format!("- {sentence}")));
    }
    lines
}

fn sentences(findings: &Findings) -> Vec<String> {
    let mut sentences = Vec::new();
    match (findings.quadratic_lagrangian, findings.separable_lagrangian) {
        (true, true) => sentences.push("L = T(v) − V(q), of degree at most 2.".to_owned()),
        (true, false) => sentences.push("L is of degree at most 2 in (q, v).".to_owned()),
        (false, true) => sentences.push("L = T(v) − V(q).".to_owned()),
        (false, false) => {}
    }
    if findings.constant_mass_matrix {
        sentences.push("The mass matrix ∂²L/∂v² is constant.".to_owned());
    }
    if findings.fused {
        sentences
            .push("Products are rounded with the sums that they stand in, as the attribute asks.".to_owned());
    }
    match findings.damping {
        Damping::Unknown | Damping::Absent => {}
        Damping::Linear => {
            sentences.push("The damping force −∂R/∂v is linear in v with constant coefficients.".to_owned());
        }
        Damping::LinearByConfiguration => {
            sentences.push(
                "The damping force −∂R/∂v is linear in v with coefficients that depend on q.".to_owned(),
            );
        }
        Damping::Nonlinear => sentences.push("The damping force −∂R/∂v is not linear in v.".to_owned()),
    }
    match findings.kinks {
        0 => {}
        1 => sentences.push("R has a kink in v, at which its friction holds: `rule = proximal`.".to_owned()),
        count => {
            sentences
                .push(format!("R has {count} kinks in v, at which its friction holds: `rule = proximal`."));
        }
    }
    sentences.extend(findings.newton.iter().map(|newton| newton_matrix(newton, findings.n)));
    for coordinate in &findings.cyclic {
        let i = subscript(coordinate.index);
        let acting = match (coordinate.damped, coordinate.forced) {
            (false, false) => None,
            (true, false) => Some("R acts"),
            (false, true) => Some("f acts"),
            (true, true) => Some("R and f act"),
        };
        sentences.push(match acting {
            None => format!("q{i} is cyclic: the momentum p{i} = ∂L/∂v{i} is conserved, by every rule."),
            Some(acting) => {
                format!("q{i} is cyclic, but {acting} on it: the momentum p{i} = ∂L/∂v{i} is not conserved in general.")
            }
        });
    }
    sentences
}

fn newton_matrix(newton: &Newton, n: usize) -> String {
    let rule = newton.rule.entry().name;
    let shape = match newton.bandwidth {
        _ if n == 1 => String::new(),
        0 => " is diagonal and".to_owned(),
        bandwidth if bandwidth + 1 >= n => String::new(),
        1 => " is tridiagonal and".to_owned(),
        bandwidth => format!(" has {bandwidth} diagonals on either side and"),
    };
    let change =
        if newton.constant { "is constant: a step is one linear solve" } else { "changes with the state" };
    format!("By the rule `{rule}` the Newton matrix{shape} {change}.")
}

/// 12 as ₁₂.
fn subscript(index: usize) -> String {
    index.to_string().chars().filter_map(|digit| char::from_u32('₀' as u32 + digit.to_digit(10)?)).collect()
}

/// Text in which nothing but code between backticks has a meaning of its own.
fn escaped(text: &str) -> String {
    let mut is_code = false;
    let mut escaped = String::new();
    for character in text.chars() {
        is_code ^= character == '`';
        if !is_code && matches!(character, '[' | ']' | '<' | '>' | '*' | '_') {
            escaped.push('\\');
        }
        escaped.push(character);
    }
    escaped
}
