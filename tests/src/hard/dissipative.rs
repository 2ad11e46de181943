//! Friction that is stiff, not smooth, of the wrong sign, or without a real step.

use dalembert::rayleigh_system;

/// A free mass with linear drag: v(t) = v(0) e^{−rt/m}.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal, one_sided])]
pub fn damped_mass(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    let _ = q;
    (0.5 * m * v[0] * v[0], 0.5 * r * v[0] * v[0])
}

/// The damped oscillator under a constant force: m q̈ + r q̇ + k q = f.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal, one_sided])]
pub fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64, f: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0] + f * q[0], 0.5 * r * v[0] * v[0])
}

/// A block of mass 1 on a spring whose other end moves at speed u, on a floor with friction −μ tanh(v/ε).
///
/// In the frame of the moving end the floor moves at −u: R = με ln cosh((v + u)/ε), in two pieces, of which
/// the first keeps its digits near rest and the second does not overflow.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, one_sided])]
pub fn block(q: [f64; 1], v: [f64; 1], k: f64, mu: f64, u: f64, epsilon: f64) -> (f64, f64) {
    let x = ((v[0] + u) / epsilon).abs();
    let ln_cosh = if x < 1.0 { x.cosh().ln() } else { x + (-2.0 * x).exp().ln_1p() - std::f64::consts::LN_2 };
    (0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0], mu * epsilon * ln_cosh)
}

/// The friction of [`block`] without a spring, as one would write it first: cosh overflows.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn overflowing(q: [f64; 1], v: [f64; 1], mu: f64, epsilon: f64) -> (f64, f64) {
    let _ = q;
    (0.5 * v[0] * v[0], mu * epsilon * (v[0] / epsilon).cosh().ln())
}

/// The same as one would write it next: near rest 1 is taken from 1.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn cancelling(q: [f64; 1], v: [f64; 1], mu: f64, epsilon: f64) -> (f64, f64) {
    let _ = q;
    let x = (v[0] / epsilon).abs();
    (0.5 * v[0] * v[0], mu * epsilon * (x + (-2.0 * x).exp().ln_1p()))
}

/// Cubic drag R = r v³/3, which accelerates for v < 0.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn cubic_drag(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    let _ = q;
    (0.5 * m * v[0] * v[0], r * v[0] * v[0] * v[0] / 3.0)
}

/// Damping that changes sign: q̈ − μ(1 − q²) q̇ + q = 0.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn van_der_pol(q: [f64; 1], v: [f64; 1], mu: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * mu * (q[0] * q[0] - 1.0) * v[0] * v[0])
}

impl VanDerPol {
    /// Period and amplitude of the limit cycle at μ = 1, to the digits shown: M. Urabe, Nonlinear Autonomous
    /// Oscillations (1967); more digits by C. M. Andersen and J. F. Geer (1982).
    pub const CYCLE: [f64; 2] = [6.663_286_859_3, 2.008_619_860_9];
}
