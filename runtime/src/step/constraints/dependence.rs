//! Steps that are refused beside constraints whose gradients depend on one another: whether these are
//! redundant, so that a smaller step may help, or the configuration is singular.
//!
//! Where Σₖ κₖGₖ = 0 at q, the function κ·g has no slope there. Of redundant constraints it is 0 along N, and
//! has no curvature along N either,
//!
//! ```text
//! dᵀ ∂(Gᵀκ)/∂q d = 0        for all d with G d = 0
//! ```
//!
//! Of a taut rope it has one across the rope, so that no motion leads on; of a loop at its dead point, too.

use nalgebra::{SMatrix, SVector};

use super::equation::OnConstraints;
use super::independent::Independent;
use super::inertia::Inertia;
use super::nearest::dependent;
use crate::numbers::{Scalar, linear::by_columns};
use crate::step::{ClosedForm, Discrete, StepError, step_at_length_by};
use crate::system::Constrained;

/// Parts of h that are tried, each a quarter of the one before: over a shorter one, what constraints
/// contradict by the square of h may be less than rounding.
const PARTS: u32 = 4;

/// A part of the one before.
const PART: f64 = 0.25;

impl<L, R, const N: usize, const M: usize> OnConstraints<'_, L, R, N, M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + Constrained<N, M>,
{
    /// The error of a step of size `h`, by the constraints where these are its cause: where they depend on
    /// one another and are not redundant. Without the standard library they are taken for its cause.
    ///
    /// From a guess the error stays as it is: the caller goes on without one.
    #[cold]
    #[inline(never)]
    pub(super) fn explained(&self, error: StepError, h: L::Scalar, has_guess: bool) -> StepError {
        if has_guess {
            return error;
        }
        match self.dependence(error) {
            Some(dependence) if !cfg!(feature = "std") || !self.may_hold(h) => dependence,
            _ => error,
        }
    }

    /// The error that names a constraint which depends on the others, in place of one that may be due to it.
    #[cold]
    pub(super) fn dependence(&self, error: StepError) -> Option<StepError> {
        let may_be =
            matches!(error, StepError::SingularNewtonMatrix { .. } | StepError::NoRealSolution { .. });
        let constraint = may_be.then(|| dependent::<L, N, M>(self.system, &self.state.q))??;
        Some(StepError::DependentConstraints { constraint })
    }

    /// Whether constraints that depend on one another hold a smaller step: redundant ones do. Those of
    /// velocity and those that are prescribed are seen over parts of `h`.
    fn may_hold(&self, h: L::Scalar) -> bool {
        (L::OF_VELOCITY > 0 || is_redundant::<_, L, N, M>(self.system, &self.state.q))
            && (!L::IS_PRESCRIBED && L::OF_VELOCITY == 0 || self.holds_part(h))
    }

    /// Whether a step of some part of `h` is solved.
    fn holds_part(&self, h: L::Scalar) -> bool {
        let mut part = h;
        (0..PARTS).any(|_| {
            part *= L::Scalar::constant(PART);
            step_at_length_by(self.system, self, self.state, part)
                .and_then(|step| self.on_constraints(step, part))
                .is_ok()
        })
    }
}

/// Whether holonomic constraints are redundant at q to second order where their gradients depend on one
/// another, in the metric of the mass at rest: their curvature along N is half of the digits less than its
/// terms.
#[cold]
#[inline(never)]
fn is_redundant<S, L, const N: usize, const M: usize>(system: &L, q: &SVector<S, N>) -> bool
where
    S: Scalar,
    L: Constrained<N, M, Scalar = S>,
{
    let Ok(inertia) = Inertia::at(system, q, &nalgebra::zero()) else { return false };
    let gradients = system.constraint_gradients(q).1;
    let directions = gradients.transpose();
    let answers = by_columns(&directions, |direction| inertia.solve(direction));
    let Some(independent) = Independent::of(&gradients, &directions, &answers) else { return false };
    // Onto d with G d = 0, and onto κ with Gᵀκ = 0.
    let along = SMatrix::identity() - answers * by_columns(&gradients, |column| independent.solve(column));
    let redundant =
        SMatrix::identity() - by_columns(&(gradients * answers), |column| independent.solve(column));
    let least = S::EPSILON.sqrt();
    redundant.data.0.iter().enumerate().all(|(k, kappa)| {
        // Rounding is left where a constraint depends on no others.
        if kappa.get(k).is_none_or(|own| own.abs() <= least) {
            return true;
        }
        let kappa = SVector::from(*kappa);
        let curvature = along.transpose() * system.constraint_curvature(q, &kappa) * along;
        let terms = along.abs().transpose() * curvature_terms(system, q, &kappa) * along.abs();
        let mut entries = curvature.as_slice().iter().zip(terms.as_slice());
        entries.all(|(entry, terms)| entry.abs() <= *terms * least)
    })
}

/// Σₖ |∂(Gₖκₖ)/∂q|, entry by entry.
fn curvature_terms<S, L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<S, N>,
    kappa: &SVector<S, M>,
) -> SMatrix<S, N, N>
where
    S: Scalar,
    L: Constrained<N, M, Scalar = S>,
{
    let mut terms: SMatrix<S, N, N> = nalgebra::zero();
    for k in 0..M {
        let mut one: SVector<S, M> = nalgebra::zero();
        for (one, kappa) in one.as_mut_slice().iter_mut().zip(kappa.as_slice()).skip(k).take(1) {
            *one = *kappa;
        }
        terms += system.constraint_curvature(q, &one).abs();
    }
    terms
}
