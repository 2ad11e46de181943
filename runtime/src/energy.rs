//! The energy ledger: where the energy of a step went.

use core::ops::{Add, AddAssign};

use crate::{Force, Lagrangian, Rayleigh, Scalar, State, StepError};

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
/// The remainder is numerical: what the method, not the mechanics, did to the energy. Where nothing is stiff it is h³ times a
/// constant a step for a method of order 2 and above; one that keeps its sign from step to step is a method that drifts.
///
/// ```
/// use dalembert::{EnergyLedger, Midpoint, State, Trajectory, rayleigh_system};
///
/// #[rayleigh_system]
/// fn oscillator(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
///     (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0])
/// }
/// let system = Oscillator { r: 0.1 };
/// let mut state = State::from_velocity(&system, [1.0], [0.0])?;
/// let mut ledger = EnergyLedger::default();
/// for step in Trajectory::new(&system, Midpoint, 0.1, state).take(100) {
///     let next = step?.state;
///     ledger += EnergyLedger::of_rayleigh(&system, &state, &next, 0.1)?;
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
    /// Of a step without a general force.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn of_rayleigh<L: Rayleigh<N, Scalar = S>, const N: usize>(
        system: &L,
        from: &State<S, N>,
        to: &State<S, N>,
        h: S,
    ) -> Result<Self, StepError> {
        let (q, v) = middle(from, to, h);
        let dissipated = v.dot(&system.rayleigh_gradient(&q, &v).d2) * h;
        Ok(Self { change: change(system, from, to)?, dissipated, work: S::zero() })
    }

    /// Of a step without friction.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn of_force<L: Force<N, Scalar = S>, const N: usize>(
        system: &L,
        from: &State<S, N>,
        to: &State<S, N>,
        h: S,
    ) -> Result<Self, StepError> {
        let (q, v) = middle(from, to, h);
        let work = v.dot(&system.force(&q, &v)) * h;
        Ok(Self { change: change(system, from, to)?, dissipated: S::zero(), work })
    }

    /// Of a step with both.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn of_both<L, const N: usize>(
        system: &L,
        from: &State<S, N>,
        to: &State<S, N>,
        h: S,
    ) -> Result<Self, StepError>
    where
        L: Rayleigh<N, Scalar = S> + Force<N>,
    {
        let with_friction = Self::of_rayleigh(system, from, to, h)?;
        let (q, v) = middle(from, to, h);
        Ok(Self { work: v.dot(&system.force(&q, &v)) * h, ..with_friction })
    }

    /// What the method did: change + dissipated − work.
    #[must_use]
    pub fn remainder(&self) -> S {
        self.change + self.dissipated - self.work
    }
}

fn middle<S: Scalar, const N: usize>(
    from: &State<S, N>,
    to: &State<S, N>,
    h: S,
) -> (nalgebra::SVector<S, N>, nalgebra::SVector<S, N>) {
    ((from.q + to.q) * S::constant(0.5), (to.q - from.q) / h)
}

fn change<S: Scalar, L: Lagrangian<N, Scalar = S>, const N: usize>(
    system: &L,
    from: &State<S, N>,
    to: &State<S, N>,
) -> Result<S, StepError> {
    Ok(to.energy(system)? - from.energy(system)?)
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
