//! When elements of friction that holds come to stick and begin to slip.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::run::Trajectory;
use crate::step::{
    ClosedForm, Discrete, Flow, Friction, Fused, Segment, Slip, Slipping, State, Step, StepError,
};
use crate::system::DryFriction;

/// Halvings of a step in search of a time within it: to 1e-9 of the step, of which the time itself is off by
/// more.
const HALVINGS: u32 = 30;

/// The share of a step that is none.
const AT_ONCE: f64 = 4.0 / (1_u64 << HALVINGS) as f64;

/// The change of an element of friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// It comes to stick.
    Sticks,
    /// It begins to slip.
    Slips,
}

/// The moment at which an element of friction comes to stick or begins to slip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct StickSlipEvent<S, const N: usize, const M: usize> {
    /// Which element: the place of its kink in R, as written.
    pub element: usize,
    /// Its change.
    pub change: Change,
    /// The way it slips, before it sticks or after: of length 1, and 0 in the components of other elements.
    pub direction: SVector<S, M>,
    /// The time of the run.
    pub time: f64,
    /// The state then, by a step from the grid.
    pub state: State<S, N>,
}

/// Friction that holds.
impl<'a, L, R, const N: usize> Trajectory<'a, L, R, N>
where
    L: Flow<R, N>,
{
    /// Takes the steps of this run up to `end`, and tells when elements of friction come to stick and begin
    /// to slip: [`StickSlip`], an iterator over these events.
    ///
    /// ```
    /// use dalembert::run::stick_slip::Change;
    /// use dalembert::{Discretise, Proximal, State, rayleigh_system};
    ///
    /// struct Block;
    ///
    /// #[rayleigh_system(rule = proximal)]
    /// impl Block {
    ///     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
    ///         0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    ///     }
    ///     fn rayleigh(&self, v: [f64; 1]) -> f64 {
    ///         0.2 * v[0].abs()
    ///     }
    /// }
    ///
    /// let mut run = Block.by(Proximal, 0.01).run(State::from_velocity(&Block, [0.9], [-0.3])?);
    /// let events = run.stick_slip(20.0).collect::<Result<Vec<_>, _>>()?;
    /// // It turns once, at −0.5616, and comes to rest.
    /// assert_eq!(events.iter().filter(|event| event.change == Change::Slips).count(), 1);
    /// let rest = events.last().unwrap();
    /// assert!(rest.change == Change::Sticks && rest.direction[0] == 1.0);
    /// assert!((rest.time - 5.8783).abs() < 0.005 && (rest.state.q[0] - 0.1616).abs() < 1e-4);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    pub fn stick_slip<const M: usize>(&mut self, end: f64) -> StickSlip<'_, 'a, L, R, N, M>
    where
        L: Fused<R, N, Border = Friction<M>> + ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
    {
        StickSlip { run: self, end, present: None, earlier: None, found: [None; M], turns: [None; M] }
    }
}

/// The events of friction along a run: [`Trajectory::stick_slip`].
///
/// **What is found.** Each step knows at its end which elements stick and how the others slip; where that is
/// another than at its start, steps of other sizes from there tell when. Friction that stops a slip and lets
/// it go the other way at once is two events at one time, of an element of one component. What begins and
/// ends within one step is not seen.
///
/// **When.** An element sticks from the size of step on with which it does, and slips from the middle of the
/// longest step that holds it: there the force is at its limit. One that a coordinate without mass slips by
/// is held to the end of such a step. Both are as exact as the states that they
/// start from, of first order in h in general.
///
/// **The run** takes the steps of [`until`](Trajectory::until), bit by bit, and stands at the end of the one
/// that an event is found in. To go on from the event, [restart](Trajectory::restart_at) it with the event's
/// time and state. An element without slip at the start is one that sticks. Events come in the order of time.
/// An error is the last item.
pub struct StickSlip<'t, 'a, L, R, const N: usize, const M: usize>
where
    L: Flow<R, N>,
{
    run: &'t mut Trajectory<'a, L, R, N>,
    end: f64,
    /// Sticking and slip at the present state; `None` before the first step, and where the run has failed.
    present: Option<Slipping<L::Scalar, M>>,
    /// The step before the last.
    earlier: Option<Taken<L::Scalar, N, M>>,
    /// Events of the last step, of each element one, and one that follows where it turns.
    found: [Option<StickSlipEvent<L::Scalar, N, M>>; M],
    turns: [Option<StickSlipEvent<L::Scalar, N, M>>; M],
}

/// A step that was taken, from where it began.
#[derive(Clone, Copy, Debug)]
struct Taken<S, const N: usize, const M: usize> {
    state: State<S, N>,
    time: f64,
    /// Sticking and slip there.
    before: Slipping<S, M>,
    mean: SVector<S, N>,
    size: S,
}

impl<L, R, const N: usize, const M: usize> StickSlip<'_, '_, L, R, N, M>
where
    L: Flow<R, N> + Fused<R, N, Border = Friction<M>> + ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    /// Takes a step and finds its events; `None` at the end.
    fn advance(&mut self) -> Option<Result<(), StepError>> {
        let (time, state) = (self.run.time(), *self.run.state());
        let before = match self.present.take() {
            Some(present) => present,
            None => match self.run.at_present(|system| Slipping::at(system, &state)) {
                Ok(start) => start,
                Err(error) => return Some(Err(error)),
            },
        };
        let (step, size) = match self.run.next_until(self.end)? {
            Ok(taken) => taken,
            Err(error) => return Some(Err(error)),
        };
        let taken = Taken { state, time, before, mean: step.velocity, size };
        let found = self.slipping(&taken, &step, size).and_then(|after| {
            self.compare(&taken, &after)?;
            Ok(after)
        });
        self.earlier = Some(taken);
        Some(found.map(|after| self.present = Some(after)))
    }

    /// Finds the events of a step at whose end elements are as `after` says.
    fn compare(
        &mut self,
        taken: &Taken<L::Scalar, N, M>,
        after: &Slipping<L::Scalar, M>,
    ) -> Result<(), StepError> {
        let zero = L::Scalar::constant(0.0);
        for element in 0..L::ELEMENTS.len().min(M) {
            let [from, to] = [&taken.before, after].map(|slipping| slipping.of(L::ELEMENTS, element));
            let is_turned = match (&from, &to) {
                (Slip::Along(from), Slip::Along(to)) => {
                    L::ELEMENTS.get(element) == Some(&1) && from.dot(to) < zero
                }
                _ => false,
            };
            let (first, second) = match (from, to) {
                (Slip::Along(from), Slip::None) => (Some(self.stops(taken, element, from)?), None),
                (Slip::None, Slip::Along(to)) => {
                    let at_limit = after.at_limit(L::ELEMENTS, element);
                    (Some(self.slips(taken, element, to, at_limit)?), None)
                }
                (Slip::Along(from), Slip::Along(direction)) if is_turned => {
                    let stop = self.stops(taken, element, from)?;
                    (Some(stop), Some(StickSlipEvent { change: Change::Slips, direction, ..stop }))
                }
                _ => (None, None),
            };
            for (places, event) in [(&mut self.found, first), (&mut self.turns, second)] {
                if let Some(place) = places.get_mut(element) {
                    *place = event;
                }
            }
        }
        Ok(())
    }

    /// The event that an element which slips along `direction` comes to stick, or turns, within a step.
    #[cold]
    fn stops(
        &self,
        taken: &Taken<L::Scalar, N, M>,
        element: usize,
        direction: SVector<L::Scalar, M>,
    ) -> Result<StickSlipEvent<L::Scalar, N, M>, StepError> {
        let share = self.first(taken, [0.0, 1.0], |slipping| match slipping.of(L::ELEMENTS, element) {
            Slip::None => true,
            Slip::Along(now) => now.dot(&direction) <= L::Scalar::constant(0.0),
        })?;
        self.event(taken, share, (element, Change::Sticks, direction))
    }

    /// The event that an element which sticks begins to slip along `direction` within a step, or in the
    /// second half of the one before, whose middle held it: at this share of the longest step that holds it.
    #[cold]
    fn slips(
        &self,
        taken: &Taken<L::Scalar, N, M>,
        element: usize,
        direction: SVector<L::Scalar, M>,
        at_limit: f64,
    ) -> Result<StickSlipEvent<L::Scalar, N, M>, StepError> {
        let what = (element, Change::Slips, direction);
        let has_slipped = |slipping: &Slipping<L::Scalar, M>| match slipping.of(L::ELEMENTS, element) {
            Slip::None => false,
            Slip::Along(_) => true,
        };
        let share = self.first(taken, [0.0, 1.0], has_slipped)?;
        if share > AT_ONCE {
            return self.event(taken, at_limit * share, what);
        }
        match &self.earlier {
            Some(earlier) if at_limit < 1.0 && !has_slipped(&earlier.before) => {
                let share = self.first(earlier, [1.0, 2.0], has_slipped)?;
                self.event(earlier, at_limit * share, what)
            }
            _ => self.event(taken, 0.0, what),
        }
    }

    /// The least share of a step, between the two given, at the end of which `is_so` is; the larger one where
    /// it is at none.
    fn first(
        &self,
        taken: &Taken<L::Scalar, N, M>,
        [mut from, mut to]: [f64; 2],
        is_so: impl Fn(&Slipping<L::Scalar, M>) -> bool,
    ) -> Result<f64, StepError> {
        for _ in 0..HALVINGS {
            let share = 0.5 * (from + to);
            let (step, size) = self.partial(taken, share)?;
            *(if is_so(&self.slipping(taken, &step, size)?) { &mut to } else { &mut from }) = share;
        }
        Ok(to)
    }

    /// The event at a share of a step.
    fn event(
        &self,
        taken: &Taken<L::Scalar, N, M>,
        share: f64,
        (element, change, direction): (usize, Change, SVector<L::Scalar, M>),
    ) -> Result<StickSlipEvent<L::Scalar, N, M>, StepError> {
        let state = if share == 0.0 { taken.state } else { self.partial(taken, share)?.0.state };
        let time = taken.time + share * taken.size.widen();
        Ok(StickSlipEvent { element, change, direction, time, state })
    }

    /// The step of a share of the size of one that was taken, with its size.
    fn partial(
        &self,
        taken: &Taken<L::Scalar, N, M>,
        share: f64,
    ) -> Result<(Step<L::Scalar, N>, L::Scalar), StepError> {
        let size = taken.size * L::Scalar::constant(share);
        let step = self.run.system.later(L::Scalar::constant(taken.time), |system| {
            Flow::<R, N>::step(system, &taken.state, size, Some(&taken.mean))
        })?;
        Ok((step, size))
    }

    /// Sticking and slip at the end of a step from where one was taken.
    fn slipping(
        &self,
        taken: &Taken<L::Scalar, N, M>,
        step: &Step<L::Scalar, N>,
        size: L::Scalar,
    ) -> Result<Slipping<L::Scalar, M>, StepError> {
        let segment = Segment { q0: taken.state.q, v: step.velocity, h: size };
        self.run
            .system
            .later(L::Scalar::constant(taken.time), |system| Slipping::at_end::<L, R, N>(system, &segment))
    }

    /// The earliest event that was found and has not been told.
    fn next_found(&mut self) -> Option<StickSlipEvent<L::Scalar, N, M>> {
        let times = self.found.iter().enumerate().filter_map(|(i, event)| Some((i, event.as_ref()?.time)));
        let (element, _) = times.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        let then = self.turns.get_mut(element).and_then(Option::take);
        self.found.get_mut(element).and_then(|place| core::mem::replace(place, then))
    }
}

impl<L, R, const N: usize, const M: usize> Iterator for StickSlip<'_, '_, L, R, N, M>
where
    L: Flow<R, N> + Fused<R, N, Border = Friction<M>> + ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    type Item = Result<StickSlipEvent<L::Scalar, N, M>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(event) = self.next_found() {
                return Some(Ok(event));
            }
            if let Err(error) = self.advance()? {
                self.end = self.run.time();
                (self.found, self.turns) = ([None; M], [None; M]);
                return Some(Err(error));
            }
        }
    }
}
