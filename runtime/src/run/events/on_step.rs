//! The events of one step, where a glance does not rule them out.

use nalgebra::SVector;

use super::nodes::{MOST, Nodes};
use super::range::missed;
use super::roots::{CLEAR, Curve, Origin, ROOTS, Search, Settled};
use super::{Crossing, Event, EventError, Passage, RESTARTS, Watch};
use crate::numbers::Scalar;
use crate::run::between::{Dense, Divisible, Moment, Start};
use crate::step::State;

/// Partial steps in one step at most, for all functions together.
const PARTIAL_STEPS: u32 = 10_000;

/// An event that was found and has not been reported.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found<S, const N: usize> {
    pub(super) index: usize,
    pub(super) passage: Passage,
    pub(super) time: f64,
    pub(super) state: State<S, N>,
    from: State<S, N>,
    from_time: f64,
    pub(super) elapsed: S,
}

impl<S: Scalar, const N: usize> Found<S, N> {
    pub(super) fn event(&self, velocity: SVector<S, N>, since: f64) -> Event<S, N> {
        let Self { index, passage, time, state, from, from_time, elapsed } = *self;
        Event { index, passage, time, state, velocity, from, from_time, elapsed, since }
    }
}

impl<T, G, const N: usize, const K: usize> Watch<'_, T, G, N, K>
where
    T: Divisible<N> + ?Sized,
    G: Fn(&Moment<'_, T::System, N>) -> [T::Scalar; K],
{
    /// The values at the start of the run, 0 where it starts on the event.
    #[cold]
    #[inline(never)]
    pub(super) fn begin(&mut self) -> Result<[T::Scalar; K], EventError> {
        let (time, state) = (self.dense.run().time(), *self.dense.run().state());
        if self.restarts > RESTARTS {
            // That which happened last: the state pushes against it.
            let index = self.happened.iter().position(|happened| *happened).unwrap_or(0);
            return Err(EventError::Chattering { index, time, stands: time });
        }
        let velocity = self.dense.velocity(time, &state)?;
        let moves = State { q: velocity * self.dense.run().step_size(), p: state.p };
        let times = [time, self.dense.since()];
        self.residues = [0.0; K];
        let mut present = (self.g)(&Moment::of(self.dense.system(), times, &state, Some(velocity)));
        let zero = T::Scalar::constant(0.0);
        for (index, value) in present.iter_mut().enumerate() {
            if !value.widen().is_finite() {
                return Err(EventError::NotFinite { index, time });
            }
            let happened = self.happened.get(index).copied().unwrap_or(false);
            let floor = || rounding(&self.g, self.dense.system(), times, &state, &moves, index);
            // After an impact what did not happen is to come.
            if happened || (self.restarts == 0 && value.widen().abs() <= CLEAR * floor()) {
                self.residues[index] = value.widen().abs();
                *value = zero;
            }
        }
        self.happened = [false; K];
        self.rested = [0.0; K];
        self.velocity = Some(velocity);
        self.present = Some(present);
        Ok(present)
    }

    /// Finds the events of the last step; whether there are none.
    #[cold]
    #[inline(never)]
    pub(super) fn locate(
        &mut self,
        earlier: Option<&(f64, [T::Scalar; K])>,
        before: &[T::Scalar; K],
        after: &[T::Scalar; K],
        ends: &[SVector<T::Scalar, N>; 2],
    ) -> Result<bool, EventError> {
        let Some(&start) = self.dense.start() else { return Ok(true) };
        // As a watch measures that begins there: what the one counts the other does not.
        let end = *self.dense.run().state();
        let velocity = self.dense.velocity(self.dense.run().time(), &end)?;
        let moves = State { q: velocity * self.dense.run().step_size(), p: end.p };
        let nodes = Nodes::of(self.dense.nodes());
        let mut between = [[0.0; MOST]; K];
        self.dense.at_nodes(&start, ends, |i, at| {
            for (row, value) in between.iter_mut().zip((self.g)(at)) {
                if let Some(place) = row.get_mut(i + 1) {
                    *place = value.widen();
                }
            }
        });
        self.found = [None; ROOTS];
        self.next = 0;
        let mut count = 0;
        let mut left = PARTIAL_STEPS;
        for (index, values) in between.iter_mut().enumerate() {
            let [first, last] = [before[index].widen(), after[index].widen()];
            values[0] = first;
            if let Some(place) = values.get_mut(nodes.degree) {
                *place = last;
            }
            if values.iter().any(|value| !value.is_finite()) {
                return Err(EventError::NotFinite { index, time: start.time });
            }
            let mut curve = OnStep {
                dense: &self.dense,
                g: &self.g,
                start,
                index,
                ends: [first, last],
                moves,
                is_restarted: self.restarts > 0 && first == 0.0,
                residue: if first == 0.0 { self.residues[index] } else { 0.0 },
                left,
                latest: None,
            };
            let epsilon = T::Scalar::EPSILON.widen();
            let resolution = root_of_epsilon::<T::Scalar>();
            let origin = if self.dense.is_collocated() {
                Origin::Stages
            } else {
                // Over two steps a change of the slope moves the ends by eight times what it bends one step.
                Origin::Cubic(earlier.map_or(f64::INFINITY, |(time, earlier)| {
                    let value = |values: &[T::Scalar; K]| values[index].widen();
                    let ends_of_two = [value(earlier), first, last];
                    let low = ends_of_two.iter().fold(f64::INFINITY, |low, value| low.min(*value));
                    let high = ends_of_two.iter().fold(f64::NEG_INFINITY, |high, value| high.max(*value));
                    let beyond = (self.g)(&self.dense.on_cubic(&start, ends, *time));
                    0.25 * (high - low) + (value(&missed(earlier, beyond)) - value(earlier)).abs()
                }))
            };
            let crossing = self.crossings.get(index).copied().unwrap_or_default();
            let mut search = Search {
                curve: &mut curve,
                epsilon,
                resolution,
                crossing,
                starts_there: first == 0.0,
                before: self.rested[index],
                came_from: self.came_from[index],
                caution: 1.0,
            };
            let Settled { roots, ends_there, before } = search.roots(nodes, values, origin)?;
            self.rested[index] = before;
            if !ends_there || roots.iter().next().is_some() {
                self.came_from[index] = 0.0;
            }
            if ends_there && let Some(present) = &mut self.present {
                present[index] = T::Scalar::constant(0.0);
            }
            for root in roots.iter() {
                let counts = match crossing {
                    Crossing::Rising => root.passage == Passage::Rising,
                    Crossing::Falling => root.passage == Passage::Falling,
                    Crossing::Either => true,
                };
                if counts {
                    let At { time, elapsed, state } = curve.at(root.share)?;
                    let found = Found {
                        index,
                        passage: root.passage,
                        time,
                        state,
                        from: start.state,
                        from_time: start.time,
                        elapsed,
                    };
                    let place = self.found.get_mut(count);
                    *place.ok_or(curve.too_many())? = Some(found);
                    count += 1;
                }
            }
            left = curve.left;
        }
        if let Some(found) = self.found.get_mut(..count) {
            in_order(found);
        }
        if count == 0 {
            self.restarts = 0;
        }
        Ok(count == 0)
    }
}

fn root_of_epsilon<S: Scalar>() -> f64 {
    S::EPSILON.sqrt().widen()
}

/// Sorts by time, what happens at one time as it stands.
fn in_order<S: Scalar, const N: usize>(found: &mut [Option<Found<S, N>>]) {
    let elapsed =
        |found: &Option<Found<S, N>>| found.as_ref().map_or(0.0, |found| found.elapsed.widen().abs());
    for end in 1..found.len() {
        let mut at = end;
        while at > 0 && elapsed(&found[at - 1]) > elapsed(&found[at]) {
            found.swap(at - 1, at);
            at -= 1;
        }
    }
}

/// The rounding error of an event function from that of the state: its changes, added up, when each
/// coordinate and momentum moves by some last places, of itself and of what a step adds to it.
fn rounding<L, G, S: Scalar, const N: usize, const K: usize>(
    g: &G,
    system: &L,
    times: [f64; 2],
    state: &State<S, N>,
    moves: &State<S, N>,
    index: usize,
) -> f64
where
    L: crate::system::Lagrangian<N, Scalar = S>,
    G: Fn(&Moment<'_, L, N>) -> [S; K],
{
    let value = |state: &State<S, N>| {
        g(&Moment::of(system, times, state, None)).get(index).map_or(0.0, |value| value.widen())
    };
    let here = value(state);
    let places = S::EPSILON * S::constant(4.0);
    // Those of the smallest numbers are no smaller.
    let least = places * S::SMALLEST_NORMAL;
    let mut sum = 0.0;
    for i in 0..N {
        let mut moved = *state;
        moved.q[i] += places * (state.q[i].abs() + moves.q[i].abs()) + least;
        sum += (value(&moved) - here).abs();
        let mut moved = *state;
        moved.p[i] += places * (state.p[i].abs() + moves.p[i].abs()) + least;
        sum += (value(&moved) - here).abs();
    }
    sum
}

/// A time, how long it is after the start of the step, and the state then.
struct At<S, const N: usize> {
    time: f64,
    elapsed: S,
    state: State<S, N>,
}

/// An event function along a step of a run.
struct OnStep<'s, 't, T: Divisible<N> + ?Sized, G, const N: usize> {
    dense: &'s Dense<'t, T, N>,
    g: &'s G,
    start: Start<T::Scalar, N>,
    index: usize,
    ends: [f64; 2],
    /// By how much a step of the run's own size moves the state at the end.
    moves: State<T::Scalar, N>,
    is_restarted: bool,
    /// The distance from 0 of a value at the start that counts as 0.
    residue: f64,
    /// Partial steps left.
    left: u32,
    /// The share asked for last, and the state there.
    latest: Option<(f64, State<T::Scalar, N>)>,
}

impl<T, G, const N: usize, const K: usize> OnStep<'_, '_, T, G, N>
where
    T: Divisible<N> + ?Sized,
    G: Fn(&Moment<'_, T::System, N>) -> [T::Scalar; K],
{
    /// The error where partial steps do not tell: after an impact it is the next one that they do not see.
    fn unresolved(&self) -> EventError {
        if self.is_restarted {
            self.too_many()
        } else {
            EventError::Unresolved { index: self.index, time: self.start.time }
        }
    }

    /// The time and the state at a share of the step.
    fn at(&mut self, share: f64) -> Result<At<T::Scalar, N>, EventError> {
        let h = self.start.size;
        let elapsed = T::Scalar::constant(share * h.widen());
        if share == 1.0 || elapsed == h {
            return Ok(At { time: self.dense.run().time(), elapsed: h, state: *self.dense.run().state() });
        }
        let time = self.start.time + elapsed.widen();
        if let Some((latest, state)) = self.latest
            && latest == share
        {
            return Ok(At { time, elapsed, state });
        }
        self.left = self.left.checked_sub(1).ok_or(self.unresolved())?;
        let state = self.dense.partial(&self.start, elapsed)?;
        self.latest = Some((share, state));
        Ok(At { time, elapsed, state })
    }
}

impl<T, G, const N: usize, const K: usize> Curve for OnStep<'_, '_, T, G, N>
where
    T: Divisible<N> + ?Sized,
    G: Fn(&Moment<'_, T::System, N>) -> [T::Scalar; K],
{
    fn value(&mut self, share: f64) -> Result<f64, EventError> {
        if share == 0.0 || share == 1.0 {
            return Ok(self.ends[usize::from(share == 1.0)]);
        }
        let At { time, state, .. } = self.at(share)?;
        let times = [time, self.dense.since()];
        let values = (self.g)(&Moment::of(self.dense.system(), times, &state, None));
        let value = values.get(self.index).map_or(0.0, |value| value.widen());
        if value.is_finite() { Ok(value) } else { Err(EventError::NotFinite { index: self.index, time }) }
    }

    fn is_restarted(&self) -> bool {
        self.is_restarted
    }

    fn floor(&mut self, share: f64) -> Result<f64, EventError> {
        let At { time, state, .. } = self.at(share)?;
        let moves = if share == 1.0 {
            self.moves
        } else {
            State { q: state.q - self.start.state.q, p: state.p - self.start.state.p }
        };
        let times = [time, self.dense.since()];
        Ok(self.residue + rounding(self.g, self.dense.system(), times, &state, &moves, self.index))
    }

    fn unresolved(&self) -> EventError {
        self.unresolved()
    }

    fn too_many(&self) -> EventError {
        let (index, time) = (self.index, self.start.time);
        EventError::Chattering { index, time, stands: time }
    }
}
