//! The damped oscillator by the midpoint rule, with the complete solution of its Hamilton–Jacobi problem in
//! closed form.
//!
//! ```text
//! α = m/h − kh/4,  β = m/h + kh/4,  ρ = r/2,  ω = √(km − r²/4),  δ = (β − ρ)/(β + ρ),  tan θ = ω/α,  ϕ_k = ϕ_0 + kθ
//! S_k = ½ s_k q² + λ_k q + c_k,   s_k = −r/2 − ω tan ϕ_k,   λ_k = λ_0 δ^{k/2} cos ϕ_0/cos ϕ_k
//! F_k(q) = √δ (cos ϕ_{k+1}/cos ϕ_k) q + λ_k/(β + ρ),   Q_k = δ^{k/2} cos ϕ_k/cos ϕ_0
//! W_k = −ρ [½(φ² − 1) q² + (1 + φ) μ q],   φ = (s_k + α + ρ)/(β + ρ),   μ = λ_k/(β + ρ)
//! ```

use dalembert::hamilton_jacobi::ConfigurationMap;
use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::{Discretise, Midpoint, ScalarField, State, rayleigh_system};

/// m q̈ + r q̇ + k q = 0.
#[rayleigh_system]
pub fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// A point or covector of ℝ.
pub type Vector = SVector<f64, 1>;

/// The parameters of the figures: h = ¼, m = k = 1, r = ½.
pub const DAMPED: Oscillator = Oscillator { m: 1.0, k: 1.0, r: 0.5 };
/// Its undamped twin, the control.
pub const UNDAMPED: Oscillator = Oscillator { m: 1.0, k: 1.0, r: 0.0 };
/// The step size of the figures.
pub const H: f64 = 0.25;

/// Coefficients of the closed form.
#[derive(Clone, Copy, Debug)]
pub struct CompleteSolution {
    /// α.
    pub alpha: f64,
    /// β.
    pub beta: f64,
    /// ρ.
    pub rho: f64,
    /// ω.
    pub omega: f64,
    /// δ, the squared shrinkage of a step.
    pub delta: f64,
    /// θ, the angle of a step.
    pub theta: f64,
    /// ϕ_0.
    pub phase: f64,
    /// λ_0, the parameter of the family.
    pub lambda: f64,
}

/// S_k = ½ s_k q² + λ_k q + c_k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadratic {
    /// s_k.
    pub s: f64,
    /// λ_k.
    pub lambda: f64,
    /// c_k.
    pub constant: f64,
}

/// q ↦ slope q + shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// DF.
    pub slope: f64,
    /// F(0).
    pub shift: f64,
}

impl CompleteSolution {
    /// The family with ϕ_0 = `phase` and λ_0 = `lambda`.
    pub fn new(system: &Oscillator, h: f64, phase: f64, lambda: f64) -> Self {
        let Oscillator { m, k, r } = *system;
        let (alpha, beta, rho) = (m / h - k * h / 4.0, m / h + k * h / 4.0, r / 2.0);
        let omega = (k * m - r * r / 4.0).sqrt();
        let delta = (beta - rho) / (beta + rho);
        Self { alpha, beta, rho, omega, delta, theta: omega.atan2(alpha), phase, lambda }
    }

    /// ϕ_k = ϕ_0 + kθ.
    pub fn angle(&self, k: usize) -> f64 {
        self.phase + k as f64 * self.theta
    }

    /// s_k = −r/2 − ω tan ϕ_k.
    pub fn s(&self, k: usize) -> f64 {
        -self.rho - self.omega * self.angle(k).tan()
    }

    /// λ_k = λ_0 δ^{k/2} cos ϕ_0/cos ϕ_k.
    pub fn lambda(&self, k: usize) -> f64 {
        self.lambda * self.shrinkage(k) * self.phase.cos() / self.angle(k).cos()
    }

    /// c_k with W_k(0) = 0: c_{k+1} − c_k = L_d(0, μ) − ½ s_{k+1} μ² − λ_{k+1} μ, L_d(0, μ) = ½ α μ², μ =
    /// F_k(0).
    pub fn constant(&self, k: usize) -> f64 {
        (0..k).fold(0.0, |constant, j| {
            let mu = self.map(j).shift;
            constant + 0.5 * (self.alpha - self.s(j + 1)) * mu * mu - self.lambda(j + 1) * mu
        })
    }

    /// S_k.
    pub fn function(&self, k: usize) -> Quadratic {
        Quadratic { s: self.s(k), lambda: self.lambda(k), constant: self.constant(k) }
    }

    /// S_0, …, S_K, K = `steps`.
    pub fn family(&self, steps: usize) -> Vec<Quadratic> {
        (0..=steps).map(|k| self.function(k)).collect()
    }

    /// F_k.
    pub fn map(&self, k: usize) -> Affine {
        Affine {
            slope: self.delta.sqrt() * self.angle(k + 1).cos() / self.angle(k).cos(),
            shift: self.lambda(k) / (self.beta + self.rho),
        }
    }

    /// Q_k = δ^{k/2} cos ϕ_k/cos ϕ_0.
    pub fn frame(&self, k: usize) -> f64 {
        self.shrinkage(k) * self.angle(k).cos() / self.phase.cos()
    }

    /// W_k(q), 0 at q = 0.
    pub fn work(&self, k: usize, q: f64) -> f64 {
        let phi = (self.s(k) + self.alpha + self.rho) / (self.beta + self.rho);
        let mu = self.lambda(k) / (self.beta + self.rho);
        -self.rho * (0.5 * (phi * phi - 1.0) * q * q + (1.0 + phi) * mu * q)
    }

    fn shrinkage(&self, k: usize) -> f64 {
        self.delta.powf(k as f64 / 2.0)
    }
}

impl ScalarField<1> for Quadratic {
    type Scalar = f64;

    fn value(&self, q: &Vector) -> f64 {
        0.5 * self.s * q[0] * q[0] + self.lambda * q[0] + self.constant
    }

    fn gradient(&self, q: &Vector) -> Vector {
        vector![self.s * q[0] + self.lambda]
    }

    fn hessian(&self, _q: &Vector) -> SMatrix<f64, 1, 1> {
        SMatrix::from_element(self.s)
    }
}

impl ConfigurationMap<1> for Affine {
    type Scalar = f64;

    fn image(&self, q: &Vector) -> Vector {
        vector![self.slope * q[0] + self.shift]
    }

    fn jacobian(&self, _q: &Vector) -> SMatrix<f64, 1, 1> {
        SMatrix::from_element(self.slope)
    }
}

/// `steps` + 1 configurations of the forced discrete trajectory from (q, p).
pub fn trajectory(system: &Oscillator, h: f64, q: f64, p: f64, steps: usize) -> Vec<Vector> {
    let mut state = State { q: vector![q], p: vector![p] };
    let mut configurations = vec![state.q];
    for _ in 0..steps {
        state = system.by(Midpoint, h).step(&state).unwrap().state;
        configurations.push(state.q);
    }
    configurations
}
