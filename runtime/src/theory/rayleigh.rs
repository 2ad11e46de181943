//! The Rayleigh structure of forced discrete systems (paper, sections 3.3 and 3.4): does f_d have a
//! potential, which one, which systems are equivalent, and is R dissipative.
//!
//! ```text
//! f_d⁻ = D1 R_d,  f_d⁺ = −D2 R_d                                                   f_d is Rayleigh
//!   iff D2 f_d⁺ and D1 f_d⁻ are symmetric and D1 f_d⁺ = −(D2 f_d⁻)ᵀ                 structure, Potential
//! L_d + φ, R_d + χ has the same equations as L_d, R_d                              Comparison
//!   iff φ = ψ(q0) + φ1(q1) + φ0(q0) − ψ(q1),  χ = ψ(q0) + φ1(q1) − φ0(q0) + ψ(q1)
//! −D1 L_d⁺ = p0 and D2 L_d⁻ = p1 have a solution                                   Resplit
//!   iff D1 f_d⁻ and D2 f_d⁺ are symmetric; always for n = 1
//! p0 = −D1(L_d + R_d), p1 = D2(L_d − R_d) for some L_d, R_d, whatever made the step  RayleighStep
//!   iff a bᵀ and bᵀd are symmetric; always for n = 1
//! p1(q_{k−1}, q_k) = p0(q_k, q_{k+1}) is the equation of some L_d, R_d               RayleighEquation
//!   iff K11 − K00 is symmetric at every node; always for n = 1
//! AᵀΩA = cΩ, the step multiplies the symplectic form by a constant                  ConformalStep
//!   iff R_d = κL_d + α(q0) + β(q1), c = (1 − κ)/(1 + κ)                            Proportion
//! v·∂R/∂v ≥ 0                                                                      dissipation
//! ```
//!
//! [`OrderFour`] has q of order 4 with an R_d. [`modified`] has the Rayleigh system on whose motion a run
//! lies, [`routh`] the reduction by a cyclic coordinate.
//!
//! On holonomic constraints [`structure`] and `rayleigh_step` judge the pair restricted to N×N, N = g⁻¹(0),
//! which is a pair again; [`dissipation`] judges R at the points given, on constraints those of TN. The
//! others take no constraints.
//!
//! Of a system at a time t0, a view, the k-th segment is judged at t0 + k h.
//!
//! The first condition has three parts (the paper prints the last alone, which is enough for n = 1), and χ
//! the sign + before φ1 and − before φ0.
//!
//! ```
//! use dalembert::rayleigh::{Potential, structure};
//! use dalembert::samples::{self, Pair};
//! use dalembert::{Midpoint, rayleigh_system};
//!
//! struct Drag { c: [f64; 2] }
//!
//! #[rayleigh_system]
//! impl Drag {
//!     fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
//!         0.5 * (v[0] * v[0] + v[1] * v[1])
//!     }
//!     fn force(&self, _q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
//!         [-v[0] - self.c[0] * v[1], -self.c[1] * v[0] - v[1]]
//!     }
//! }
//!
//! let segments = samples::segments([-1.0; 2], [1.0; 2], [0.3; 2], 40);
//! let symmetric = Drag { c: [0.5, 0.5] };
//! assert!(structure(&symmetric, Midpoint, 0.1, &segments)?.is_rayleigh());
//! assert!(!structure(&Drag { c: [0.5, 0.4] }, Midpoint, 0.1, &segments)?.is_rayleigh());
//!
//! // R = ½(vx² + vx vy + vy²), R_d = (h²/2) R, recovered from the force alone.
//! let potential = Potential::new(&symmetric, Midpoint, 0.1, Pair::new([0.0; 2], [0.0; 2]));
//! let recovered = potential.at(&[0.0, 0.0].into(), &[0.1, 0.2].into());
//! assert!((recovered.value - 0.5 * 0.5 * (0.01 + 0.02 + 0.04)).abs() < 1e-15);
//! # Ok::<(), dalembert::samples::SampleError>(())
//! ```

mod asked;
mod comparison;
mod conformal_step;
mod dissipation;
mod equation;
pub mod modified;
mod order_four;
mod potential;
mod proportion;
pub(super) mod quadrature;
mod rayleigh_step;
mod residual;
mod resplit;
pub mod routh;
mod structure;

pub use comparison::{Comparison, Equivalence};
pub use conformal_step::{ConformalStep, ConformalStepError};
pub use dissipation::{Dissipation, dissipation, dissipation_over};
pub use equation::{NodeSteps, RayleighEquation};
pub use order_four::{OrderFour, OrderFourError, OrderFourState, PotentialEnergy};
pub use potential::{Potential, Recovery};
pub use proportion::{Proportion, ProportionError, ProportionalSplit};
pub use quadrature::Integral;
pub use rayleigh_step::{Asymmetry, Entry, RayleighStep, RayleighStepError};
pub use residual::SegmentFinding;
pub use resplit::{Resplit, ResplitReport};
pub use structure::{Condition, RayleighStructure, structure};
