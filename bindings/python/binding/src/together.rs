//! Steps of many members without the type of their method: one study is compiled for a system, not one for each method.

use core::cell::RefCell;
use core::mem::replace;
use core::ops::ControlFlow;

use dalembert::run::Stop;
use dalembert::{Lagrangian, State, StepError};
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

    /// As [`Stepping::at_once`].
    fn at_once(&self) -> u64;

    /// As [`Stepping::description`].
    fn description(&self) -> String;

    /// As [`Stepping::has_events`].
    fn has_events(&self) -> bool;

    /// As [`Stepping::at_start`].
    fn at_start(&self, system: &L, start: &State<L::Scalar, N>) -> Vec<f64>;
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

    fn at_once(&self) -> u64 {
        Stepping::at_once(self)
    }

    fn description(&self) -> String {
        Stepping::description(self)
    }

    fn has_events(&self) -> bool {
        Stepping::has_events(self)
    }

    fn at_start(&self, system: &L, start: &State<L::Scalar, N>) -> Vec<f64> {
        Stepping::at_start(self, system, start)
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

    fn at_once(&self) -> u64 {
        self.0.at_once()
    }

    fn description(&self) -> String {
        self.0.description()
    }

    fn has_events(&self) -> bool {
        self.0.has_events()
    }

    /// Numbers of event functions alone: fields and starts are told apart by digests of their own.
    fn at_start(&self, system: &L, start: &State<L::Scalar, N>) -> Vec<f64> {
        if self.0.has_events() { self.0.at_start(system, start) } else { Vec::new() }
    }
}
