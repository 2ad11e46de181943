//! Discrete Hamilton–Jacobi theory with forces: what the paper defines, evaluated as printed, and the
//! corrected theory.
//!
//! Start from [`Discretised::hamilton_jacobi`](crate::Discretised::hamilton_jacobi). Every check returns a
//! report: for each equation whether it holds, the residual, the place where it is worst, and the tolerance
//! that it was held against.
//!
//! **As printed** (paper, section 4). One family of functions S_k gives γ⁻ = DS_k − f_d⁻ and γ⁺ = DS_{k+1} +
//! f_d⁺, which are to be the momenta at both ends of a segment. They are only where there is no net force at
//! the nodes,
//!
//! ```text
//! f_d⁺(q_{k−1}, q_k) + f_d⁻(q_k, q_{k+1}) = 0
//! ```
//!
//! [`HamiltonJacobi::as_printed`] evaluates all of it on a family and a trajectory,
//! [`HamiltonJacobi::along_trajectory`] where S_k is the discrete action along one trajectory,
//! [`HamiltonJacobi::right_equation_everywhere`] for all q.
//!
//! **Corrected.** Sections γ_k: Q → T*Q and maps F_k: Q → Q with
//!
//! ```text
//! 𝔽⁻(q, F_k(q)) = (q, γ_k(q)),      𝔽⁺(q, F_k(q)) = (F_k(q), γ_{k+1}(F_k(q)))
//! ```
//!
//! Then c_{k+1} = F_k(c_k), p_k = γ_k(c_k) solves the forced discrete equations. With γ_k = dS_k:
//!
//! ```text
//! S_{k+1}(F_k(q)) − S_k(q) = L_d(q, F_k(q)) + W_k(q),     dW_k = f_d⁻(q, F_k(q)) + DF_k(q)ᵀ f_d⁺(q, F_k(q))
//! ```
//!
//! W_k is the virtual work of the discrete force; without force it is constant and this is the discrete
//! Hamilton–Jacobi equation of Ohsawa, Bloch and Leok (SIAM J. Control Optim. 49, 2011).
//! [`HamiltonJacobi::check_sections`], [`check_solution`](HamiltonJacobi::check_solution) and
//! [`check_generating_functions`](HamiltonJacobi::check_generating_functions) say whether a candidate is a
//! solution; [`HamiltonJacobi::carry`] makes one from γ_0, with the tangent frame (Q_k, P_k) along each
//! characteristic, and [`HamiltonJacobi::characteristics_report`] its closedness defect Q_kᵀP_k − P_kᵀQ_k and
//! its caustics det Q_k = 0.
//!
//! For n = 1 every S_k has a W_k, and an S_{k+1} on the image of an interval where DF_k ≠ 0. Where F_k folds,
//! at a caustic, two momenta belong to one q1, and no S_{k+1} has both. For n ≥ 2 the right side of dW_k has
//! to be closed as well, and that of **every** S_0 is so only if the step is conformally symplectic,
//! AᵀΩA = cΩ.
//!
//! **Theorem.** For a regular pair (L_d, R_d), n ≥ 2, on connected regions, these are equivalent: (i) every
//! closed section γ_0 = dS_0 stays closed; (ii) AᵀΩA = cΩ; (iii) D1D2R_d = κ D1D2L_d, κ constant. Then
//! c = (1 − κ)/(1 + κ), R_d = κL_d + α(q0) + β(q1), and
//!
//! ```text
//! S_{k+1}(F_k(q)) = c S_k(q) + G(q, F_k(q)),     G = (1 − κ)L_d + cα(q0) − β(q1)
//! c^{−k} ∂S_k/∂λ is constant along trajectories with p = ∂S_k/∂q(·; λ)
//! ```
//!
//! [`ConformalStep`](crate::rayleigh::ConformalStep) tells (ii) of any step,
//! [`Proportion`](crate::rayleigh::Proportion) (iii) of a pair, [`ConformalHamiltonJacobi`] carries S_k and
//! finds the motion from its derivatives by λ. For n = 1 (i) is empty: (ii) and (iii), still equivalent, give
//! the rest.
//!
//! **Stationary.** For an angle and 0 < c < 1 one S* stays as it is, S*(q1) = min [c S*(q0) + G(q0, q1)]:
//! [`StationaryEquation`].
//!
//! Of a system at a time t0, a view, step k and its segment (q_k, q_{k+1}) are those of t0 + k h, in every
//! check of a sequence.

mod caustics;
mod characteristics;
mod conformal;
mod error;
mod family;
mod frame;
mod hamilton_equations;
mod hamiltonian;
mod jacobi_constants;
mod lemma;
mod printed;
mod printed_report;
mod residual;
mod section;
mod solution;
mod stationary;
mod trajectory;
mod unforced;
mod virtual_work;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::{Discrete, Discretised};
use crate::theory::samples::{at_segment, at_time_of};

pub use caustics::Caustic;
pub use characteristics::{Characteristic, CharacteristicsReport};
pub use conformal::{ConformalCharacteristic, ConformalHamiltonJacobi};
pub use error::{HamiltonJacobiError, ImplicitEquation};
pub use family::{FamilyMember, GeneratingFamily};
pub use frame::Frame;
pub use hamilton_equations::{HamiltonEquationsReport, PrintedAndCorrected};
pub use hamiltonian::DiscreteHamiltonian;
pub use jacobi_constants::JacobiConstants;
pub use printed_report::PrintedReport;
pub use residual::{Outcome, Residual};
pub use section::{ConfigurationMap, Section};
pub use solution::SolutionReport;
pub use stationary::{Jet, PeriodicFunction, StationaryEquation, StationaryError, StationarySolution};
pub use trajectory::TrajectoryReport;
pub use unforced::RightEquationReport;
pub use virtual_work::{CarriedGeneratingFunction, VirtualWork};

/// Tolerance of the reports in units of the rounding of an equation's terms: some dozens of operations each.
const ROUNDINGS: f64 = 256.0;

/// The Hamilton–Jacobi theory of a discretised system.
///
/// ```
/// use dalembert::hamilton_jacobi::HamiltonJacobi;
/// use dalembert::nalgebra::vector;
/// use dalembert::{Discretise, Discrete, Midpoint, rayleigh_system};
///
/// #[rayleigh_system]
/// fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
///     (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
/// }
/// let system = Oscillator { m: 1.0, k: 1.0, r: 0.5 };
/// let theory = system.by(Midpoint, 0.25).hamilton_jacobi();
///
/// let report = theory.hamilton_equations(&[vector![0.3], vector![0.5]])?;
/// assert!(!report.right_momentum.printed?.holds());
/// assert!(report.right_momentum.corrected?.holds());
/// println!("{report}");
/// # Ok::<(), dalembert::hamilton_jacobi::HamiltonJacobiError>(())
/// ```
#[derive(Debug)]
pub struct HamiltonJacobi<'a, L, R, const N: usize>
where
    L: Discrete<R, N>,
{
    by: Discretised<'a, L, R, N>,
    relative: f64,
}

impl<L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// This theory with another relative tolerance, for candidates whose own values carry more than rounding
    /// errors.
    ///
    /// An equation holds if its residual is at most `relative` × the size of its terms, with the rounding of
    /// what they are evaluated at; 256 ε if not said.
    #[must_use]
    pub fn with_tolerance(self, relative: f64) -> Self {
        Self { relative, ..self }
    }

    /// v̄ = (q1 − q0)/h, the guess of whatever is solved on a segment known to be near.
    fn mean_velocity(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
        (q1 - q0) / self.by.h
    }

    /// `evaluate` of the theory at the start of step k, which a check comes to.
    ///
    /// Fails where the caller has ended it.
    fn at_step<T>(
        &self,
        k: usize,
        evaluate: impl FnOnce(&HamiltonJacobi<'_, L, R, N>) -> T,
    ) -> Result<T, HamiltonJacobiError> {
        let relative = self.relative;
        Ok(at_segment(&self.by, k, |by| evaluate(&HamiltonJacobi { by: *by, relative }))?)
    }

    /// `evaluate` of the theory at the start of step k, which is one of those that a check looks at already.
    fn in_step<T>(&self, k: usize, evaluate: impl FnOnce(&HamiltonJacobi<'_, L, R, N>) -> T) -> T {
        at_time_of(&self.by, k, |by| evaluate(&HamiltonJacobi { by: *by, relative: self.relative }))
    }

    /// `evaluate` of the theory a step earlier.
    fn a_step_before<T>(&self, evaluate: impl FnOnce(&HamiltonJacobi<'_, L, R, N>) -> T) -> T {
        let Self { by, relative } = *self;
        by.system.later(-by.h, |system| evaluate(&HamiltonJacobi { by: by.of(system), relative }))
    }
}

impl<'a, L, R, const N: usize> Discretised<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The Hamilton–Jacobi equations of the discrete system, and its characteristics.
    #[must_use]
    pub fn hamilton_jacobi(&self) -> HamiltonJacobi<'a, L, R, N> {
        const { Self::require_unconstrained() };
        HamiltonJacobi { by: *self, relative: ROUNDINGS * L::Scalar::EPSILON.widen() }
    }
}
