//! Terms that cancel in the equation of motion are written out where they can, and nowhere else.

use proc_macro2::TokenStream;

use crate::rayleigh_system::{Runtime, rayleigh_system};

/// Whether the system L = ½v² − `potential`, R = 0.1v² with a force has sizes of terms that may cancel.
fn may_cancel(potential: &str, force: &str) -> bool {
    let item = format!(
        "impl System {{
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {{ 0.5 * v[0] * v[0] - ({potential}) }}
            fn rayleigh(&self, v: [f64; 1]) -> f64 {{ 0.1 * v[0] * v[0] }}
            fn force(&self, q: [f64; 1], v: [f64; 1], u: [f64; 1]) -> [f64; 1] {{ [{force}] }}
        }}"
    );
    let expansion = rayleigh_system(Runtime::STD, TokenStream::new(), item.parse().unwrap()).to_string();
    assert!(!expansion.contains("compile_error"), "{potential}, {force}: {expansion}");
    expansion.contains("fn cancelling_terms")
}

#[test]
fn where_none_can_cancel_none_are_written() {
    for potential in [
        "q[0] * q[0]",
        // One spring, whose force is balanced by p and v; so is a weight.
        "0.5 * self.k * (q[0] - 1.0).powi(2)",
        "9.81 * q[0]",
        // Forces that vanish with q.
        "-q[0].cos()",
        "q[0].powi(2) * (q[0].powi(2) - 1.0).powi(2)",
        "self.k * q[0].cosh() + q[0].powi(4)",
        "(1.0 + q[0] * q[0]).sqrt()",
        "(-q[0] * q[0]).exp()",
    ] {
        assert!(!may_cancel(potential, "-0.3 * v[0]"), "{potential}");
    }
}

#[test]
fn where_some_can_they_are_written() {
    for (potential, force) in [
        ("0.5 * (q[0] - 1.0).powi(2) + 0.5 * (q[0] + 1.0).powi(2)", "0.0"),
        // A spring that holds a weight, a weight that is held by a motor.
        ("0.5 * self.k * (q[0] - self.a).powi(2) + 9.81 * q[0]", "0.0"),
        ("9.81 * q[0].sin()", "u[0]"),
        // 1 − cos q, 1 − e^−q, sin(q − π).
        ("q[0] - q[0].sin()", "0.0"),
        ("q[0] + (-q[0]).exp()", "0.0"),
        ("(q[0] - std::f64::consts::PI).cos()", "0.0"),
        // 1 − sin q/q, and 1 − q^a, where a may be 0.
        ("q[0]", "q[0].sin() / q[0]"),
        ("q[0]", "q[0].powf(self.a)"),
        (
            "-1.0 / ((q[0] - self.a).powi(2) + 1.0).sqrt() - 1.0 / ((q[0] + self.a).powi(2) + 1.0).sqrt()",
            "0.0",
        ),
    ] {
        assert!(may_cancel(potential, force), "{potential}, {force}");
    }
}
