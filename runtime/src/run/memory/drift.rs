//! Steps by the rules fitted to linear damping: what depends on h alone is kept.
//!
//! The functions of Z = ½hM⁻¹C, with their decomposition, cost several times the rest of a step.

use nalgebra::{SMatrix, SVector};

use super::explicit::Prepared;
use crate::numbers::{NewtonMatrix, Scalar};
use crate::rules::{ByDrift, DampedDrift, Fitted, FittedTrapezoidal};
use crate::step::{
    ClosedForm, Discrete, Memory, Momenta, Segment, State, Step, StepError, VelocityHistory, or_without_guess,
};
use crate::system::Rayleigh;

/// The functions of Z that [`Fitted`] asks for, and the latest mean velocities. It belongs to one system.
#[derive(Clone, Copy, Debug)]
pub struct DriftMemory<S, const N: usize> {
    history: VelocityHistory<S, N>,
    /// A step size, and what belongs to it.
    kept: Option<(S, DampedDrift<S, N>)>,
}

impl<S: Scalar, const N: usize> Default for DriftMemory<S, N> {
    fn default() -> Self {
        Self { history: VelocityHistory::default(), kept: None }
    }
}

impl<L, const N: usize> Memory<L, Fitted, N> for DriftMemory<L::Scalar, N>
where
    L: ClosedForm<Fitted, N> + Rayleigh<N> + ?Sized,
{
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let fresh;
        let (is_kept, drift) = match &self.kept {
            Some((of, drift)) if *of == h => (true, drift),
            _ => {
                fresh = DampedDrift::of(system, &state.q, h);
                (false, &fresh)
            }
        };
        let guess = self.history.extrapolation(h);
        let found = Fitted::step_by(drift, system, state, h, guess.as_ref());
        let step =
            or_without_guess(guess.is_some(), found, || Fitted::step_by(drift, system, state, h, None))?;
        if !is_kept {
            self.kept = Some((h, *drift));
        }
        self.history.push(step.velocity, h);
        Ok(step)
    }

    fn suggest(&mut self, velocity: &SVector<L::Scalar, N>, h: L::Scalar) {
        self.history.push(*velocity, h);
    }
}

/// The matrix of a step size, factored, and the functions of Z.
type Kept<S, const N: usize> = (Prepared<S, SMatrix<S, N, N>, N>, DampedDrift<S, N>);

/// The memory of [`FittedTrapezoidal`]: the functions of Z, one of them factored, and the force at the end of
/// the last step. It belongs to one system.
///
/// As for [`Explicit`](super::Explicit) systems, a step costs one gradient.
#[derive(Clone, Copy, Debug)]
pub struct ExplicitDriftMemory<S: Scalar, const N: usize> {
    kept: Option<Kept<S, N>>,
    /// A configuration, and the force there.
    force: Option<(SVector<S, N>, SVector<S, N>)>,
}

impl<S: Scalar, const N: usize> Default for ExplicitDriftMemory<S, N>
where
    SMatrix<S, N, N>: NewtonMatrix<S, N>,
{
    fn default() -> Self {
        Self { kept: None, force: None }
    }
}

impl<L, const N: usize> Memory<L, FittedTrapezoidal, N> for ExplicitDriftMemory<L::Scalar, N>
where
    L: ClosedForm<FittedTrapezoidal, N> + Rayleigh<N> + ?Sized,
{
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        if let Some((prepared, drift)) = &self.kept
            && prepared.h == h
            && let Some((q, force)) = &self.force
            && *q == state.q
            && let Some((step, force)) = prepared.step(
                |q| drift.configuration_force(system, q),
                |v| Momenta { p0: drift.before * v + drift.shift, p1: drift.after * v + drift.shift },
                state,
                force,
            )
        {
            if cfg!(debug_assertions) {
                system.verify_segment(&Segment { q0: state.q, v: step.velocity, h })?;
            }
            self.force = Some((step.state.q, force));
            return Ok(step);
        }
        self.start(system, state, h)
    }
}

impl<S: Scalar, const N: usize> ExplicitDriftMemory<S, N> {
    /// The first step with this step size or from this state, by the general path, which has the verdicts.
    #[cold]
    #[inline(never)]
    fn start<L>(&mut self, system: &L, state: &State<S, N>, h: S) -> Result<Step<S, N>, StepError>
    where
        L: ClosedForm<FittedTrapezoidal, N> + Rayleigh<N, Scalar = S> + ?Sized,
    {
        let (is_kept, drift) = match self.kept {
            Some((prepared, drift)) if prepared.h == h => (true, drift),
            _ => (false, DampedDrift::of(system, &state.q, h)),
        };
        let step = FittedTrapezoidal::step_by(&drift, system, state, h, None)?;
        if !is_kept {
            self.kept = Prepared::new(h, drift.before, drift.shift).map(|prepared| (prepared, drift));
        }
        self.force = Some((step.state.q, drift.configuration_force(system, &step.state.q)));
        Ok(step)
    }
}
