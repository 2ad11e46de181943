//! The ledger of a run, step by step.

use core::marker::PhantomData;

use crate::numbers::Scalar;
use crate::run::between::Restartable;
use crate::run::{HeldInput, Trajectory};
use crate::step::{Discretised, Flow, ForceWork, Memory, StepError};
use crate::system::Lagrangian;
use crate::theory::EnergyLedger;

/// The energy of a run.
impl<L, M, const N: usize> Trajectory<'_, L, M, N>
where
    L: ForceWork<M, N>,
{
    /// Where the energy of each step went, while the run takes it: [`EnergyEntries`], which add up.
    ///
    /// Each step is accounted for at its own time and of its own size, whatever the time of the view that the
    /// run was begun with.
    ///
    /// ```
    /// use dalembert::{Discretise, EnergyLedger, Gauss, State, rayleigh_system};
    ///
    /// struct Pushed;
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// impl Pushed {
    ///     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
    ///         0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    ///     }
    ///     fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
    ///         [(0.7 * t).cos()]
    ///     }
    /// }
    ///
    /// let view = Pushed.at_time(0.0);
    /// let by = view.by(Gauss::<3>, 0.1);
    /// let start = State { q: [1.0].into(), p: [0.0].into() };
    /// let ledger: EnergyLedger<f64> = by.run(start).ledger().take(200).sum::<Result<_, _>>()?;
    /// assert!(ledger.work.abs() > 0.1 && ledger.remainder().abs() < 1e-13);
    ///
    /// // By the view, which stands at t = 0, the method seems to add energy.
    /// let (mut state, mut at_start) = (start, EnergyLedger::default());
    /// for step in by.run(start).take(200) {
    ///     let next = step?.state;
    ///     at_start += by.ledger(&state, &next)?;
    ///     state = next;
    /// }
    /// assert!(at_start.remainder().abs() > 0.1);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    pub fn ledger(&mut self) -> EnergyEntries<'_, Self, M, N> {
        EnergyEntries::of(self)
    }
}

/// The energy of a run while an input is held.
impl<L, V, M, const N: usize> HeldInput<'_, '_, L, V, M, N>
where
    V: Flow<M, N>,
    L: ForceWork<M, N> + Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
    V::RunMemory: Memory<L, M, N>,
{
    /// Where the energy of each step went, while the run takes it: [`EnergyEntries`], which add up.
    pub fn ledger(&mut self) -> EnergyEntries<'_, Self, M, N> {
        EnergyEntries::of(self)
    }
}

/// The energy ledger of each step of a run, as it is taken: [`Trajectory::ledger`].
///
/// An iterator over entries, `Result<EnergyLedger<S>, StepError>`, that ends with an error. `sum` adds them
/// up; [`run`](Self::run) has the state and its time.
pub struct EnergyEntries<'t, T, M, const N: usize> {
    run: &'t mut T,
    end: Option<f64>,
    has_failed: bool,
    method: PhantomData<fn() -> M>,
}

impl<'t, T: Restartable<N>, M, const N: usize> EnergyEntries<'t, T, M, N> {
    fn of(run: &'t mut T) -> Self {
        Self { run, end: None, has_failed: false, method: PhantomData }
    }

    /// The steps up to `end`, where the run then stands: [`Until`](crate::run::between::Until).
    #[must_use]
    pub fn until(self, end: f64) -> Self {
        Self { end: Some(end), ..self }
    }

    /// The run, at the end of the last step.
    #[must_use]
    pub fn run(&self) -> &T {
        self.run
    }
}

impl<T, M, const N: usize> Iterator for EnergyEntries<'_, T, M, N>
where
    T: Restartable<N>,
    T::System: ForceWork<M, N>,
{
    type Item = Result<EnergyLedger<T::Scalar>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.has_failed {
            return None;
        }
        let (from, time) = (*self.run.state(), self.run.time());
        let size = match self.end {
            Some(end) => self.run.next_until(end)?.map(|(_, size)| size),
            // Where steps follow the motion, the size is known now.
            None => self.run.next()?.map(|_| self.run.step_size()),
        };
        let entry = size.and_then(|size| {
            let elapsed = Scalar::constant(time - self.run.since());
            self.run.system().later(elapsed, |system| {
                Discretised::<T::System, M, N>::new(system, size).ledger(&from, self.run.state())
            })
        });
        self.has_failed = entry.is_err();
        Some(entry)
    }
}
