//! Random systems, and what is asked for of them.

use proc_macro2::TokenStream;

use super::super::oracle::{Expression, Random};

/// Attributes that ask for every kind of function among them.
const ATTRIBUTES: [&str; 7] = [
    "rule = [midpoint, trapezoidal, gauss], step_derivatives = second, parameters = [m, k]",
    "rule = [trapezoidal, midpoint, one_sided]",
    "rule = [midpoint, gauss], lanes = [midpoint, gauss]",
    "rule = trapezoidal, lanes = explicit",
    "rule = [midpoint, gauss], lanes = [midpoint, gauss], multiply_add = fused",
    "rule = gauss",
    "rule = [trapezoidal, midpoint], parameters = [m, k]",
];

/// A system with random L, R and f, and what is asked for.
pub fn system(seed: u64) -> (TokenStream, TokenStream) {
    let mut random = Random(seed);
    let [l, r, f, place] = [0; 4].map(|_| {
        let depth = 1 + random.below(4);
        Expression::random(&mut random, depth).text()
    });
    let attribute = ATTRIBUTES[random.below(ATTRIBUTES.len())];
    // Explicit steps and the one-sided rule take less: L = ½vᵀMv − V(q), R of v alone; and no force.
    let (is_explicit, is_joint) = (attribute.contains("explicit"), attribute.contains("one_sided"));
    let is_timed = !is_joint && random.below(2) == 0;
    let (t, phase) = if is_timed { (", t: f64", " * (0.3 * t).cos()") } else { ("", "") };
    let [l, f, place] = [l, f, place].map(|text| if is_explicit { text.replace("v[", "q[") } else { text });
    // A characteristic at the same place twice, of each system or of all, or none.
    let whose = ["Self::CAM", "self.cam"][random.below(2)];
    let cam = format!("{whose}.at({place})");
    let [of_l, of_f] = if random.below(3) == 0 { ["0.0", "0.0"] } else { [&*cam; 2] };
    let is_plain = is_explicit || is_joint;
    let r = if is_plain { "0.1 * v[0] * v[1]".to_owned() } else { format!("self.k * v[0] * v[0] + {r}") };
    let (input, drive) = if is_explicit { ("", "self.k") } else { (", u: [f64; 1]", "u[0] * q[1]") };
    let force = format!(
        "fn force(&self, q: [f64; 2], v: [f64; 2]{input}) -> [f64; 2] {{ let _ = v; [{drive}, {of_f} + {f}] }}"
    );
    let force = if is_joint { "" } else { &force };
    let scale = "fn time_scale(&self, q: [f64; 2]) -> f64 { 1.0 + self.m * q[0].cos() * q[1] }";
    let scale = if attribute == "rule = gauss" { scale } else { "" };
    let constraints = format!(
        "fn constraints(&self, q: [f64; 2]{t}) -> [f64; 1] {{ [self.k * q[0] * q[0] * q[1].sin() - self.m{phase}] }}
        fn velocity_constraints(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 1] {{
            [self.m * q[0].cos() * v[1] - v[0] / self.k]
        }}"
    );
    let is_constrained = attribute == "rule = [trapezoidal, midpoint], parameters = [m, k]";
    let constraints = if is_constrained { &constraints } else { "" };
    let item = format!(
        "impl Random {{
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]{t}) -> f64 {{
                0.5 * self.m * (v[0] * v[0] + 2.0 * v[1] * v[1]) + ({l}){phase} - {of_l}
            }}
            fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {{ let _ = q; {r} }}
            {force}
            {scale}
            {constraints}
        }}"
    );
    (attribute.parse().expect("tokens"), item.parse().expect("tokens"))
}
