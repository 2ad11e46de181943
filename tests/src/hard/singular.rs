//! Masses that are singular or nearly so, and functions without derivatives somewhere.

use dalembert::{State, rayleigh_system};

/// L = ½(v² − q²)/(1 + λq²): for λ < 0 the mass grows without bound towards q² = −1/λ.
///
/// q = A sin(ωt + φ) with ω² = 1/(1 + λA²) (P. M. Mathews and M. Lakshmanan, 1974).
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn mathews_lakshmanan(q: [f64; 1], v: [f64; 1], lambda: f64, r: f64) -> (f64, f64) {
    (0.5 * (v[0] * v[0] - q[0] * q[0]) / (1.0 + lambda * q[0] * q[0]), 0.5 * r * v[0] * v[0])
}

impl MathewsLakshmanan {
    /// ω of the motion with amplitude `a`.
    pub fn frequency(&self, a: f64) -> f64 {
        1.0 / (1.0 + self.lambda * a * a).sqrt()
    }

    /// Passing q = 0 on the motion with amplitude `a`.
    pub fn start(&self, a: f64) -> State<f64, 1> {
        State { q: [0.0].into(), p: [a * self.frequency(a)].into() }
    }
}

/// Two pendulums of length 1 under g = 1, the upper mass m small: det ∂²L/∂v² = m + sin²(q1 − q2), which all
/// but vanishes where the arms align.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn arm(q: [f64; 2], v: [f64; 2], m: f64, r: f64) -> (f64, f64) {
    let upper = 0.5 * m * v[0] * v[0];
    let lower = 0.5 * (v[0] * v[0] + v[1] * v[1]) + v[0] * v[1] * (q[0] - q[1]).cos();
    (upper + lower + (1.0 + m) * q[0].cos() + q[1].cos(), 0.5 * r * (v[0] * v[0] + (v[1] - v[0]).powi(2)))
}

/// L = x v_y − y v_x − ½|q|²: linear in v, of first order.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn first_order(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    (q[0] * v[1] - q[1] * v[0] - 0.5 * (q[0] * q[0] + q[1] * q[1]), 0.5 * r * (v[0] * v[0] + v[1] * v[1]))
}

/// V = |q| + ⅔ a |q|^{3/2} + b √|q|: a kink at 0, then an infinite curvature, then an infinite slope.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn roots(q: [f64; 1], v: [f64; 1], kink: f64, a: f64, b: f64) -> (f64, f64) {
    let x = q[0].abs();
    (0.5 * v[0] * v[0] - kink * x - 2.0 / 3.0 * a * x.powf(1.5) - b * x.sqrt(), 0.0 * v[0])
}

/// R = c |v|^{3/2}/1.5: drag with an infinite slope at rest.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn drag(q: [f64; 1], v: [f64; 1], c: f64) -> (f64, f64) {
    let _ = q;
    (0.5 * v[0] * v[0], c / 1.5 * v[0].abs().powf(1.5))
}
