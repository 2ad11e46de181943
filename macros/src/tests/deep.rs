//! Expressions as deep as generated programs make them: they are followed, or refused at a token, and never
//! end the compiler.

use proc_macro2::TokenStream;

use crate::rayleigh_system::{Runtime, rayleigh_system};

/// A system with a term of `n` levels of one kind, written on a line of its own.
fn system(kind: &str, n: usize) -> TokenStream {
    let around = |before: &str, after: &str| format!("{}q[0]{}", before.repeat(n), after.repeat(n));
    let joined =
        |term: &dyn Fn(usize) -> String, operator: &str| (0..n).map(term).collect::<Vec<_>>().join(operator);
    let term = match kind {
        "sum" => joined(&|i| format!("self.k[{i}] * q[0]"), " + "),
        "sum of fields" => format!("q[0] * ({})", joined(&|i| format!("self.k[{i}]"), " + ")),
        "methods" => around("", ".sin()"),
        "parentheses" => around("(", ")"),
        "blocks" => around("{ let x = 1.0; ", "}"),
        "signs" => around("-", ""),
        "calls" => around("Self::f(", ")"),
        "conditions" => {
            format!("if {} {{ 1.0 }} else {{ q[0] }}", joined(&|i| format!("q[0] < {i}.0"), " && "))
        }
        "choices" => {
            let choices = joined(&|i| format!("else if q[0] < {i}.5 {{ v[0] }}"), " ");
            format!("if q[0] < 0.0 {{ 1.0 }} {choices} else {{ q[0] }}")
        }
        // A sum whose first term is a sum, and so on.
        "sums within sums" => format!("{}q[0]{}", "(".repeat(n / 10), " + 1.0 + v[0] + q[0])".repeat(n / 10)),
        _ => unreachable!("{kind}"),
    };
    let text = format!(
        "impl System {{ fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {{\nv[0] * v[0] + {term}\n}}
         fn f(x: f64) -> f64 {{ x }} }}"
    );
    text.parse().expect("tokens")
}

fn expanded(kind: &str, n: usize, engine: &str) -> String {
    let attribute = format!("derivatives = {engine}").parse().expect("an option");
    rayleigh_system(Runtime::STD, attribute, system(kind, n)).to_string()
}

#[test]
fn deep_expressions_are_followed() {
    let kinds =
        ["sum", "sum of fields", "parentheses", "blocks", "signs", "calls", "conditions", "sums within sums"];
    for kind in kinds {
        for engine in ["auto", "num_dual"] {
            // Calls within calls are followed up to 64.
            let n = if kind == "calls" && engine == "auto" { 60 } else { 1_000 };
            let expanded = expanded(kind, n, engine);
            assert!(!expanded.contains("compile_error"), "{kind} by {engine}");
        }
    }
    // Derivatives of these are long, and take their time.
    for (kind, n) in [("methods", 250), ("choices", 250)] {
        assert!(!expanded(kind, n, "expanded").contains("compile_error"), "{kind}");
        assert!(!expanded(kind, 1_000, "num_dual").contains("compile_error"), "{kind}");
    }
}

#[test]
fn what_is_deeper_is_refused_at_its_token() {
    for kind in ["sum", "methods", "parentheses", "blocks", "signs", "calls", "conditions", "choices"] {
        for n in [7_000, 50_000] {
            // Printed whole, so deep a text would overflow the stack of the test.
            let answer = rayleigh_system(Runtime::STD, TokenStream::new(), system(kind, n));
            let message = answer.into_iter().last().expect("a message");
            assert!(message.to_string().contains("stand one within the other up to here"), "{kind}");
            assert_eq!(message.span().start().line, 2, "{kind}: the line of the body");
        }
    }
}

#[test]
fn calls_within_calls_of_deep_bodies_are_refused() {
    let deep = format!("{}self.f(x){}", "(".repeat(200), ")".repeat(200));
    let text = format!(
        "impl System {{ fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {{ self.f(q[0]) * v[0] }}
         fn f(&self, x: f64) -> f64 {{ {deep} }} }}"
    );
    let item = text.parse().expect("tokens");
    let expanded = rayleigh_system(Runtime::STD, quote::quote!(derivatives = expanded), item).to_string();
    assert!(expanded.contains("nested too deeply"), "{expanded}");
}
