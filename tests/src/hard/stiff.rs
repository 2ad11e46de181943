//! Stiff springs in slow motions.

use dalembert::{State, rayleigh_system};

/// A unit mass on a spring of unit length and stiffness k under g = 1, in the plane: √k is the ratio of the
/// frequencies.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn spring_pendulum(q: [f64; 2], v: [f64; 2], k: f64, r: f64) -> (f64, f64) {
    let speed = v[0] * v[0] + v[1] * v[1];
    let stretch = (q[0] * q[0] + q[1] * q[1]).sqrt() - 1.0;
    (0.5 * speed - 0.5 * k * stretch * stretch - q[1], 0.5 * r * speed)
}

impl SpringPendulum {
    /// At rest at the angle `a` from the vertical, with the stretch that balances gravity.
    pub fn at_angle(&self, a: f64) -> State<f64, 2> {
        let length = 1.0 + a.cos() / self.k;
        State { q: [length * a.sin(), -length * a.cos()].into(), p: [0.0, 0.0].into() }
    }

    /// The angle from the vertical.
    pub fn angle(state: &State<f64, 2>) -> f64 {
        state.q[0].atan2(-state.q[1])
    }

    /// E = ½|p|² + V.
    pub fn energy_of(&self, state: &State<f64, 2>) -> f64 {
        let stretch = state.q.norm() - 1.0;
        0.5 * state.p.norm_squared() + 0.5 * self.k * stretch * stretch + state.q[1]
    }
}

/// Stiff springs of the chain: 2m masses, m stiff springs.
pub const FERMI: usize = 3;

/// The chain of Fermi, Pasta, Ulam and Tsingou with stiff harmonic and soft quartic springs in turn, in the
/// coordinates of Hairer, Lubich and Wanner, Geometric Numerical Integration, section I.5.1: x₀ᵢ scaled
/// displacements, x₁ᵢ scaled expansions of the stiff springs.
///
/// ```text
/// V = ½ω² Σ x₁ᵢ² + ¼[(x₀₁ − x₁₁)⁴ + Σ (x₀ᵢ₊₁ − x₁ᵢ₊₁ − x₀ᵢ − x₁ᵢ)⁴ + (x₀ₘ + x₁ₘ)⁴]
/// ```
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn fermi(q: [f64; 6], v: [f64; 6], omega: f64, r: f64) -> (f64, f64) {
    let speed: f64 = v.iter().map(|v| v * v).sum();
    let stiff = q[3] * q[3] + q[4] * q[4] + q[5] * q[5];
    let mut soft = (q[0] - q[3]).powi(4) + (q[2] + q[5]).powi(4);
    for i in 0..2 {
        soft += (q[i + 1] - q[i + 4] - q[i] - q[i + 3]).powi(4);
    }
    (0.5 * speed - 0.5 * omega * omega * stiff - 0.25 * soft, 0.5 * r * speed)
}

impl Fermi {
    /// The book's start: x₀₁ = 1, p₀₁ = 1, x₁₁ = 1/ω, p₁₁ = 1, all else 0.
    pub fn start(&self) -> State<f64, 6> {
        State {
            q: [1.0, 0.0, 0.0, 1.0 / self.omega, 0.0, 0.0].into(),
            p: [1.0, 0.0, 0.0, 1.0, 0.0, 0.0].into(),
        }
    }

    /// Energies of the stiff springs, Iⱼ = ½(p₁ⱼ² + ω²x₁ⱼ²); their sum is an adiabatic invariant.
    pub fn stiff_energies(&self, state: &State<f64, 6>) -> [f64; FERMI] {
        std::array::from_fn(|j| {
            0.5 * (state.p[FERMI + j].powi(2) + (self.omega * state.q[FERMI + j]).powi(2))
        })
    }
}
