//! The energy ledger: where the energy of a step went.

use core::ops::{Add, AddAssign};

use crate::numbers::Scalar;
use crate::step::{Discretised, State, StepError};
use crate::system::{ActingForce, Lagrangian};

/// Where energy went over one step, or, added up, over many.
///
/// With q̄ = (q0 + q1)/2 and v̄ = (q1 − q0)/h, whatever method made the step from (q0, p0) to (q1, p1):
///
/// ```text
/// change     = E(q1, p1) − E(q0, p0)
/// dissipated = h v̄·∂R/∂v(q̄, v̄)
/// work       = h v̄·f(q̄, v̄)
/// remainder  = change + dissipated − work
/// ```
///
/// The remainder is numerical: what the method, not the mechanics, did to the energy. Where nothing is stiff
/// it is h³ times a constant a step for a method of order 2 and above; one that keeps its sign from step to
/// step is a method that drifts.
///
/// A system that takes the time is given as it is at the start of the step, `system.at_time(t)`. Where L
/// itself takes it, the remainder also holds −∫ ∂L/∂t dt, what moving constraints and changing parameters
/// bring.
///
/// ```
/// use dalembert::{Discretise, EnergyLedger, Midpoint, State, rayleigh_system};
///
/// #[rayleigh_system]
/// fn oscillator(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
///     (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0])
/// }
/// let system = Oscillator { r: 0.1 };
/// let by = system.by(Midpoint, 0.1);
/// let mut state = State::from_velocity(&system, [1.0], [0.0])?;
/// let mut ledger = EnergyLedger::default();
/// for step in by.run(state).take(100) {
///     let next = step?.state;
///     ledger += by.ledger(&state, &next)?;
///     state = next;
/// }
/// // L and R of second degree: the midpoint rule loses what friction takes, and nothing else.
/// assert!(ledger.dissipated > 0.2 && ledger.remainder().abs() < 1e-14);
/// # Ok::<(), dalembert::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyLedger<S> {
    /// E(q1, p1) − E(q0, p0), at the nodes.
    pub change: S,
    /// h v̄·∂R/∂v, what friction took.
    pub dissipated: S,
    /// h v̄·f, what the general force brought.
    pub work: S,
}

impl<S: Scalar> EnergyLedger<S> {
    /// Of a step of size `h`, whatever made it.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn of<L: ActingForce<N, Scalar = S>, const N: usize>(
        system: &L,
        from: &State<S, N>,
        to: &State<S, N>,
        h: S,
    ) -> Result<Self, StepError> {
        let half = S::constant(0.5);
        let (q, v) = ((from.q + to.q) * half, (to.q - from.q) / h);
        let change = change(system, from, to, h)?;
        // The system as it is in the middle of the step.
        Ok(system.later(h * half, |system| {
            let dissipated =
                if L::HAS_RAYLEIGH { v.dot(&system.dissipation(&q, &v).d2) * h } else { S::zero() };
            let work = if L::HAS_FORCE { v.dot(&system.general_force(&q, &v)) * h } else { S::zero() };
            Self { change, dissipated, work }
        }))
    }

    /// What the method did: change + dissipated − work.
    #[must_use]
    pub fn remainder(&self) -> S {
        self.change + self.dissipated - self.work
    }
}

/// E(q1, p1) − E(q0, p0).
fn change<S: Scalar, L: Lagrangian<N, Scalar = S>, const N: usize>(
    system: &L,
    from: &State<S, N>,
    to: &State<S, N>,
    h: S,
) -> Result<S, StepError> {
    Ok(system.later(h, |system| to.energy(system))? - from.energy(system)?)
}

/// The energy of a step.
impl<L, M, const N: usize> Discretised<'_, L, M, N>
where
    L: ActingForce<N>,
{
    /// Where the energy of the step from `from` to `to` went: [`EnergyLedger`].
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn ledger(
        &self,
        from: &State<L::Scalar, N>,
        to: &State<L::Scalar, N>,
    ) -> Result<EnergyLedger<L::Scalar>, StepError> {
        EnergyLedger::of(self.system(), from, to, self.step_size())
    }
}

impl<S: Scalar> Add for EnergyLedger<S> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            change: self.change + other.change,
            dissipated: self.dissipated + other.dissipated,
            work: self.work + other.work,
        }
    }
}

impl<S: Scalar> AddAssign for EnergyLedger<S> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
