//! Steps of many members without the type of their method: one study is compiled for a system, not one for each method.

use core::cell::RefCell;
use core::mem::replace;
use core::ops::ControlFlow;

use dalembert::run::Stop;
use dalembert::{Lagrangian, StepError};
use dalembert_ensemble::{Record, Slot, Stepping};

/// Steps of many members by some method.
pub trait Together<L: Lagrangian<N>, const N: usize>: Sync {
    /// As [`Stepping::advance`], with a place for what is kept.
    fn advance(
        &self,
        members: &mut [Slot<L, usize, N>],
        observe: &dyn Fn(usize, &Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()>;

    /// As [`Stepping::description`].
    fn description(&self) -> String;
}

impl<L: Lagrangian<N>, T: Stepping<L, N>, const N: usize> Together<L, N> for T {
    fn advance(
        &self,
        members: &mut [Slot<L, usize, N>],
        observe: &dyn Fn(usize, &Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()> {
        let observe = |place: &mut usize, record: &Record<'_, L, N>| observe(*place, record);
        Stepping::advance(self, members, &observe, stop)
    }

    fn description(&self) -> String {
        Stepping::description(self)
    }
}

/// Steps by a method that is known when the program runs.
pub struct BySome<'a, L: Lagrangian<N>, const N: usize>(pub Box<dyn Together<L, N> + 'a>);

impl<L: Lagrangian<N>, const N: usize> Stepping<L, N> for BySome<'_, L, N> {
    fn advance<V>(
        &self,
        members: &mut [Slot<L, V, N>],
        observe: &impl Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()> {
        let mut values = Vec::with_capacity(members.len());
        let mut placed = Vec::with_capacity(members.len());
        let mut failures = Vec::with_capacity(members.len());
        for (place, Slot { number, start, value, failure }) in members.iter_mut().enumerate() {
            // Nobody asks for the start again.
            let start = replace(start, Err(StepError::StepSize { h: 0.0 }));
            placed.push(Slot { number: *number, start, value: place, failure: None });
            values.push(RefCell::new(value));
            failures.push(failure);
        }
        let observe =
            |place: usize, record: &Record<'_, L, N>| observe(&mut values[place].borrow_mut(), record);
        self.0.advance(&mut placed, &observe, stop)?;
        for (failure, placed) in failures.into_iter().zip(placed) {
            *failure = placed.failure;
        }
        ControlFlow::Continue(())
    }

    fn description(&self) -> String {
        self.0.description()
    }
}
