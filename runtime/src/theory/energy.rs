//! The energy ledger: where the energy of a step went.

mod of_run;

use core::fmt;
use core::iter::Sum;
use core::ops::{Add, AddAssign};

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::{Discretised, EnergyExchange, ForceWork, Quantity, State, StepError, require_step_size};
use crate::system::ActingForce;

pub use of_run::EnergyEntries;

/// Where energy went over one step, or, added up, over many.
///
/// ```text
/// change     = E(q1, p1) − E(q0, p0)
/// dissipated = ∫ v·∂R/∂v dt        work = ∫ v·f dt        over the step, as its method sees it
/// remainder  = change + dissipated − work
/// ```
///
/// **By the method's own quadrature**, [`ledger`](Discretised::ledger): h Σ bᵢ Vᵢ·∂R/∂v(Qᵢ, Vᵢ) at the points
/// where a rule evaluates the forces, the stages of a Gauss rule among them; the loss of kinetic energy in
/// the drifts of splittings and fitted rules, which is exact; of a composition the sum over its substeps.
/// What remains is then the method's doing, not the account's. Where L is of second degree it is 0 to
/// rounding by Gauss rules for any R and f, and by the midpoint rule for any f and R(v); where R depends on
/// q the midpoint rule leaves (h³/4) ∂R/∂q·M⁻¹(∇V + ∂R/∂v − f) a step, at q̄ and v̄. Elsewhere it is h^p over
/// a fixed time for a method of order p.
///
/// **Drift.** Without friction the remainder of a method that drifts adds up with one sign over many periods.
/// Within a period any method's may keep its sign. With friction it may keep it for good and drift nowhere:
/// the sum stays of the size h^p as the motion comes to rest.
///
/// **On constraints** the work of reactions at the nodes is in the remainder, of the order of the rule, and
/// what moves them where they are prescribed.
///
/// **Of a step made otherwise**, [`of`](Self::of): Simpson's rule on the cubic through both ends with their
/// velocities. Below h⁴ over a fixed time the remainder is then the account's own.
///
/// **Of a run**, `run.ledger()`: [`Trajectory::ledger`](crate::Trajectory::ledger) has an entry for each
/// step, taken at the step's own time and of its own size, and entries add up.
///
/// A system that takes the time is otherwise given as it is at the start of the step, `system.at_time(t)`: a
/// view that stands still while the steps go on tells of remainders that are none. Where L itself takes it,
/// the remainder also holds −∫ ∂L/∂t dt, what moving constraints and changing parameters bring.
///
/// ```
/// use dalembert::{Discretise, EnergyLedger, Midpoint, State, rayleigh_system};
///
/// #[rayleigh_system]
/// fn oscillator(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
///     (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0])
/// }
/// let system = Oscillator { r: 0.1 };
/// let start = State::from_velocity(&system, [1.0], [0.0])?;
/// let mut run = system.by(Midpoint, 0.1).run(start);
/// let ledger: EnergyLedger<f64> = run.ledger().take(100).sum::<Result<_, _>>()?;
/// // L and R of second degree: the midpoint rule loses what friction takes, and nothing else.
/// assert!(ledger.dissipated > 0.2 && ledger.remainder().abs() < 1e-14);
/// let text = format!("{:.2}", EnergyLedger { change: -0.5, dissipated: 0.25, work: 0.0 });
/// assert_eq!(
///     text,
///     "energy changed by -5.00e-1: friction took 2.50e-1, forces brought 0.00e0, the method -2.5e-1"
/// );
/// # Ok::<(), dalembert::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyLedger<S> {
    /// E(q1, p1) − E(q0, p0), at the nodes.
    pub change: S,
    /// ∫ v·∂R/∂v dt, what friction took.
    pub dissipated: S,
    /// ∫ v·f dt, what the general force brought.
    pub work: S,
}

impl<S: Scalar> EnergyLedger<S> {
    /// Of a step of size `h`, whatever made it: by Simpson's rule on the cubic with q and v of both ends.
    ///
    /// # Errors
    /// Those of [`State::velocity`]; [`StepError::StepSize`]; [`StepError::NonFinite`].
    pub fn of<L: ActingForce<N, Scalar = S>, const N: usize>(
        system: &L,
        from: &State<S, N>,
        to: &State<S, N>,
        h: S,
    ) -> Result<Self, StepError> {
        require_step_size(h)?;
        let of = |number| S::constant(number);
        let v0 = from.velocity(system)?;
        let v1 = system.later(h, |system| to.velocity(system))?;
        let middle = (
            (from.q + to.q) * of(0.5) + (v0 - v1) * (h * of(0.125)),
            (to.q - from.q) / h * of(1.5) - (v0 + v1) * of(0.25),
        );
        let power = |share, (q, v): (_, _)| {
            system.later(h * of(share), |system| EnergyExchange::power(system, &q, &v))
        };
        let sum = power(0.0, (from.q, v0)) + power(0.5, middle) * of(4.0) + power(1.0, (to.q, v1));
        Self::from_exchange(system, from, to, h, sum * (h / of(6.0)))
    }

    fn from_exchange<L: ActingForce<N, Scalar = S>, const N: usize>(
        system: &L,
        from: &State<S, N>,
        to: &State<S, N>,
        h: S,
        EnergyExchange { dissipated, work }: EnergyExchange<S>,
    ) -> Result<Self, StepError> {
        let change = system.later(h, |system| to.energy(system))? - from.energy(system)?;
        StepError::require_finite(&SVector::from([change, dissipated, work]), Quantity::Derivatives)?;
        Ok(Self { change, dissipated, work })
    }

    /// The energy that the method added: change + dissipated − work.
    #[must_use]
    pub fn remainder(&self) -> S {
        self.change + self.dissipated - self.work
    }
}

impl<S: Scalar + fmt::LowerExp> fmt::Display for EnergyLedger<S> {
    /// One line, with as many digits as the formatter asks for, or four.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (change, friction, work, rest) = (self.change, self.dissipated, self.work, self.remainder());
        let digits = f.precision().unwrap_or(4);
        write!(
            f,
            "energy changed by {change:.digits$e}: friction took {friction:.digits$e}, forces brought \
             {work:.digits$e}, the method {rest:.1e}"
        )
    }
}

/// The energy of a step.
impl<L, M, const N: usize> Discretised<'_, L, M, N>
where
    L: ForceWork<M, N>,
{
    /// Where the energy of the step from `from` to `to` went, by this method's own account of what forces
    /// did: [`EnergyLedger`]. A run's own [`ledger`](crate::Trajectory::ledger) is of each of its steps.
    ///
    /// A view has to have the time at which the step starts. Gauss rules, compositions and splittings make
    /// the step from `from` again, for the points between.
    ///
    /// # Errors
    /// Those of [`step`](Self::step) and [`State::velocity`]; [`StepError::NonFinite`].
    pub fn ledger(
        &self,
        from: &State<L::Scalar, N>,
        to: &State<L::Scalar, N>,
    ) -> Result<EnergyLedger<L::Scalar>, StepError> {
        let h = self.step_size();
        require_step_size(h)?;
        let exchange = self.system().energy_exchange(from, to, h)?;
        EnergyLedger::from_exchange(self.system(), from, to, h, exchange)
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

impl<S: Scalar> Sum for EnergyLedger<S> {
    fn sum<I: Iterator<Item = Self>>(entries: I) -> Self {
        let none = Self { change: S::zero(), dissipated: S::zero(), work: S::zero() };
        entries.fold(none, Add::add)
    }
}

impl<S: Scalar> AddAssign for EnergyLedger<S> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
