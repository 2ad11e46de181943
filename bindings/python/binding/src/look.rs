//! Questions to a run besides the states at the ends of its steps.

use dalembert::run::Run;
use dalembert::run::between::{Dense, Divisible, LastStep, Restartable};
use dalembert::{Lagrangian, State};

use crate::between::{BySome, Looking, Taken};
use crate::events::{Events, OfBlock, watched};
use crate::motion::Motion;

/// A run by some method that can end at a time.
pub(crate) type EndingBySome<'r, L, const N: usize> =
    dyn Restartable<N, Item = Taken<N>, Scalar = f64, System = L> + 'r;

/// Questions to a run besides the states at the ends of its steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Look<'a> {
    /// The events to look for.
    pub events: Option<Events<'a>>,
    /// Whether states between the steps are asked for.
    pub is_dense: bool,
    /// The time from the start at which it ends, where that is no whole number of steps.
    pub end: Option<f64>,
}

impl Look<'_> {
    /// Whether anything is.
    #[must_use]
    pub fn is_any(&self) -> bool {
        self.events.is_some() || self.is_dense || self.end.is_some()
    }
}

/// Records `run` while it is looked into, up to the end that is asked for.
pub(crate) fn looked_into<L, const N: usize>(
    run: &mut EndingBySome<'_, L, N>,
    look: Look<'_>,
    of_block: OfBlock<L, N>,
    record: &mut dyn FnMut(&mut dyn Motion<N>),
) where
    L: Lagrangian<N, Scalar = f64>,
{
    match look.end {
        Some(end) => {
            let size = Divisible::step_size(run);
            seen(&mut Ending { run, end, size }, look.events, of_block, record);
        }
        None => seen(run, look.events, of_block, record),
    }
}

/// Records `run` while it is looked into, for events too where they are asked for.
pub(crate) fn seen<L, const N: usize>(
    run: &mut BySome<'_, L, N>,
    events: Option<Events<'_>>,
    of_block: OfBlock<L, N>,
    record: &mut dyn FnMut(&mut dyn Motion<N>),
) where
    L: Lagrangian<N, Scalar = f64>,
{
    match events {
        Some(events) => watched(run, events, of_block, record),
        None => record(&mut Looking { dense: Dense::new(run) }),
    }
}

/// A run that ends at a time, as any other run that can be looked into.
struct Ending<'t, 'r, L: Lagrangian<N, Scalar = f64>, const N: usize> {
    run: &'t mut EndingBySome<'r, L, N>,
    end: f64,
    /// The size of the last step, of the next one at the start.
    size: f64,
}

impl<L: Lagrangian<N, Scalar = f64>, const N: usize> Iterator for Ending<'_, '_, L, N> {
    type Item = Taken<N>;

    fn next(&mut self) -> Option<Taken<N>> {
        let taken = self.run.next_until(self.end)?;
        Some(taken.map(|(step, size)| {
            self.size = size;
            step
        }))
    }
}

impl<L: Lagrangian<N, Scalar = f64>, const N: usize> Run<N> for Ending<'_, '_, L, N> {
    type Scalar = f64;

    fn state(&self) -> &State<f64, N> {
        Run::state(self.run)
    }

    fn time(&self) -> f64 {
        Run::time(self.run)
    }
}

impl<L: Lagrangian<N, Scalar = f64>, const N: usize> Divisible<N> for Ending<'_, '_, L, N> {
    type System = L;

    fn system(&self) -> &L {
        Divisible::system(self.run)
    }

    fn since(&self) -> f64 {
        Divisible::since(self.run)
    }

    fn step_size(&self) -> f64 {
        self.size
    }

    fn last_step(&self) -> &dyn LastStep<L, N> {
        Divisible::last_step(self.run)
    }
}
