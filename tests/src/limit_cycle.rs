//! The limit cycle of an oscillator that is weakly excited where |q| < 1 and damped beyond, by any method.

use dalembert::{Discrete, Discretise, State, StepError, rayleigh_system};
use nalgebra::vector;

/// q̈ + q + q³ = ε(1 − q²) q̇.
#[rayleigh_system]
pub fn limit_cycle(q: [f64; 1], v: [f64; 1], epsilon: f64) -> (f64, f64) {
    let potential = 0.5 * q[0] * q[0] + 0.25 * q[0].powi(4);
    (0.5 * v[0] * v[0] - potential, 0.5 * epsilon * (q[0] * q[0] - 1.0) * v[0] * v[0])
}

impl LimitCycle {
    /// E at a state.
    #[must_use]
    pub fn energy_of([q, p]: [f64; 2]) -> f64 {
        0.5 * p * p + 0.5 * q * q + 0.25 * q.powi(4)
    }

    /// The cycle's energy as ε → 0, where ∮ (1 − q²) q̇ dq = 0, by bisection for its amplitude A: with
    /// q = A sin θ, q̇ dq is A² cos²θ √(1 + (A² + q²)/2) dθ.
    #[must_use]
    pub fn energy_without_friction() -> f64 {
        let power = |amplitude: f64| -> f64 {
            let squares = (0..64).map(|i| (f64::from(i) * std::f64::consts::TAU / 64.0).sin().powi(2));
            let a = amplitude * amplitude;
            squares.map(|s| (1.0 - a * s) * (1.0 - s) * (1.0 + 0.5 * a * (1.0 + s)).sqrt()).sum()
        };
        let amplitude = bisected(power, [1.0, 4.0]);
        Self::energy_of([amplitude, 0.0])
    }

    /// The mean energy of the cycle that `step` has, after so long that it is reached from inside.
    ///
    /// # Errors
    /// The step's.
    pub fn mean_energy<E>(&self, h: f64, step: impl Fn([f64; 2]) -> Result<[f64; 2], E>) -> Result<f64, E> {
        let mut state = [1.6, 0.0];
        for _ in 0..(15.0 / (self.epsilon * h)) as usize {
            state = step(state)?;
        }
        let mut energies = Vec::new();
        for _ in 0..(400.0 / h) as usize {
            state = step(state)?;
            energies.push(Self::energy_of(state));
        }
        Ok(weighted_mean(&energies))
    }

    /// A step by a rule.
    ///
    /// # Errors
    /// The rule's.
    pub fn step<R>(&self, rule: R, h: f64, [q, p]: [f64; 2]) -> Result<[f64; 2], StepError>
    where
        Self: Discrete<R, 1, Scalar = f64>,
    {
        let State { q, p } = self.by(rule, h).step(&State { q: vector![q], p: vector![p] })?.state;
        Ok([q[0], p[0]])
    }

    /// A step of the classical Runge–Kutta method.
    #[must_use]
    pub fn runge_kutta(&self, h: f64, state: [f64; 2]) -> [f64; 2] {
        let moved = |by: f64, [dq, dp]: [f64; 2]| [state[0] + by * dq, state[1] + by * dp];
        let rate = |[q, v]: [f64; 2]| [v, -q - q.powi(3) + self.epsilon * (1.0 - q * q) * v];
        let k1 = rate(state);
        let k2 = rate(moved(0.5 * h, k1));
        let k3 = rate(moved(0.5 * h, k2));
        let k4 = rate(moved(h, k3));
        moved(h / 6.0, [0, 1].map(|i| k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    }
}

/// Where `of` falls through 0.
pub fn bisected(of: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        *if of(middle) > 0.0 { &mut low } else { &mut high } = middle;
    }
    0.5 * (low + high)
}

/// The mean of values along a quasi-periodic motion, with the weights exp(−1/t(1 − t)): its error falls
/// faster than any power of their number.
#[must_use]
pub fn weighted_mean(values: &[f64]) -> f64 {
    let weight = |i: usize| {
        let t = (i as f64 + 0.5) / values.len() as f64;
        (-1.0 / (t * (1.0 - t))).exp()
    };
    let weighted = values.iter().enumerate().map(|(i, value)| (weight(i) * value, weight(i)));
    let (sum, weights) = weighted.fold((0.0, 0.0), |sum, by| (sum.0 + by.0, sum.1 + by.1));
    sum / weights
}
