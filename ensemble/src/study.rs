//! An ensemble, and what is made of it.

use core::marker::PhantomData;
use core::ops::{ControlFlow, Range};
use core::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use dalembert::run::Stop;
use dalembert::step::{Flow, FlowInLanes, MethodOf};
use dalembert::tolerance::OffersMethods;
use dalembert::{Gauss, Lagrangian, State, StepError};
use rayon::prelude::*;

use crate::lanes::SideBySide;
use crate::member::{End, Failure, MemberError, Record, caught};
use crate::progress::{Cancelled, Progress};
use crate::stepping::{OneByOne, Plan, Slot, Stepping, ToError};

/// Chunks for each thread between two additions to the total.
const CHUNKS: u64 = 16;

/// Members that a thread takes at a time, at most: it bounds the memory.
const CHUNK: u64 = 1024;

/// Chunks that take less than this on the way from one addition to the next are followed by larger ones.
const BRIEF: Duration = Duration::from_millis(200);

/// Members, each a function of its number.
///
/// The function makes the system and the start of a member, or says by a [`StepError`] why there is none.
#[derive(Clone, Copy, Debug)]
pub struct Ensemble<F> {
    members: F,
}

impl<F> Ensemble<F> {
    /// The ensemble whose member of each number `members` makes.
    pub fn new<L, const N: usize>(members: F) -> Self
    where
        F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
        L: Lagrangian<N>,
    {
        Self { members }
    }

    /// All members by `method`, with step size `h`.
    pub fn by<'f, M, L, const N: usize>(
        self,
        method: M,
        h: L::Scalar,
    ) -> Study<'f, F, OneByOne<M, L::Scalar>, L, N>
    where
        F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
        L: Flow<M, N>,
        M: MethodOf<L, N>,
    {
        Study::new(self.members, OneByOne { method, plan: Plan { h, steps: 0, every: None, error: None } })
    }

    /// All members to the error `tolerance`, in units of q, until `time`: each by the method and step size
    /// that keep it, found by one run or more with a guard
    /// ([`TimedRequest::end`](dalembert::tolerance::TimedRequest::end)). The end alone is recorded. A member
    /// whose error no run that was tried has kept is a [`Failure`].
    pub fn to_error<'f, L, const N: usize>(self, tolerance: f64, time: f64) -> Study<'f, F, ToError, L, N>
    where
        F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
        L: OffersMethods<N>,
    {
        Study::new(self.members, ToError { tolerance, time })
    }

    /// All members by a stepping that is not known when the program is compiled, or of one's own.
    pub fn stepped<'f, M, L, const N: usize>(self, stepping: M) -> Study<'f, F, M, L, N>
    where
        F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
        M: Stepping<L, N>,
        L: Lagrangian<N>,
    {
        Study::new(self.members, stepping)
    }
}

type Callback<'f> = Box<dyn Fn(Progress) -> ControlFlow<()> + Sync + 'f>;

/// A member's system and start, or why there is none.
pub(crate) type Start<L, const N: usize> = Result<(L, State<<L as Lagrangian<N>>::Scalar, N>), StepError>;

/// In place of the error of a start whose making panicked.
pub(crate) const NO_START: StepError = StepError::StepSize { h: 0.0 };

/// Whether a member has arrived.
type Arrival<'f, L, const N: usize> = Box<dyn Fn(&Record<'_, L, N>) -> bool + Sync + 'f>;

/// An ensemble by a method: what is asked for is asked of it.
#[must_use = "a study does nothing until its ends or a reduction are asked for"]
pub struct Study<'f, F, M, L: Lagrangian<N>, const N: usize> {
    pub(crate) members: F,
    pub(crate) stepping: M,
    progress: Option<Callback<'f>>,
    cancel: Option<&'f AtomicBool>,
    pub(crate) arrival: Option<Arrival<'f, L, N>>,
    of: PhantomData<fn() -> L>,
}

/// The state of each member at the end, or why it did not get there.
pub type Ends<S, const N: usize> = Vec<Result<End<S, N>, Failure<S, N>>>;

/// A member after its run: the value kept of it, and why it failed, if it did.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome<V, S, const N: usize> {
    /// Its number.
    pub number: u64,
    /// The value kept of it, up to its failure if it failed.
    pub value: V,
    /// Why it is not what was asked for.
    pub failure: Option<Failure<S, N>>,
}

/// How members are kept in a reduction.
pub(crate) struct Keeping<V, O, T> {
    /// Makes the value of a member, of its number and start.
    pub(crate) value: V,
    /// Changes it at a record.
    pub(crate) observe: O,
    /// Puts the values of a chunk together, where its members were stepped.
    pub(crate) together: T,
}

impl<'f, F, M, L: Lagrangian<N>, const N: usize> Study<'f, F, M, L, N> {
    /// These members, stepped as `change` makes it of how they are.
    pub(crate) fn stepped_by<W>(self, change: impl FnOnce(M) -> W) -> Study<'f, F, W, L, N> {
        let Self { members, stepping, progress, cancel, arrival, of } = self;
        Study { members, stepping: change(stepping), progress, cancel, arrival, of }
    }
}

impl<F, M, L: Lagrangian<N>, const N: usize> Study<'_, F, M, L, N> {
    fn new(members: F, stepping: M) -> Self {
        Self { members, stepping, progress: None, cancel: None, arrival: None, of: PhantomData }
    }
}

impl<F, M, L: Lagrangian<N>, const N: usize> Study<'_, F, OneByOne<M, L::Scalar>, L, N> {
    /// Every member takes this many steps.
    pub fn steps(mut self, steps: u64) -> Self {
        self.stepping.plan.steps = steps;
        self
    }

    /// Records at the start, after every `stride`-th step and at the end; otherwise at the end alone. A
    /// stride of 0 counts as 1.
    pub fn every(mut self, stride: u64) -> Self {
        self.stepping.plan.every = Some(stride.max(1));
        self
    }
}

impl<F, L: Lagrangian<N>, const S: usize, const N: usize> Study<'_, F, OneByOne<Gauss<S>, L::Scalar>, L, N> {
    /// The stages are solved no further than an error of `error`, in units of q, at the last step asks for:
    /// [`Trajectory::solved_for`](dalembert::Trajectory::solved_for) of each member, which says what that
    /// costs of structure. Half the sweeps at three digits, two thirds at eight.
    ///
    /// ```
    /// use dalembert::{Gauss, State, rayleigh_system};
    /// use dalembert_ensemble::Ensemble;
    ///
    /// #[rayleigh_system(rule = gauss, lanes = gauss)]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
    /// }
    ///
    /// let member = |k: u64| Ok((Pendulum { r: 1e-3 * k as f64 }, State { q: [1.0].into(), p: [0.0].into() }));
    /// let study = || Ensemble::new(member).by(Gauss::<6>, 0.5).steps(40);
    /// let solved = study().ends(0..100).expect("nothing cancels it");
    /// let lanes = study().solved_for(1e-6).in_lanes().ends(0..100).expect("nothing cancels it");
    /// for (solved, lane) in solved.into_iter().zip(lanes) {
    ///     let (solved, lane) = (solved.unwrap(), lane.unwrap());
    ///     assert!((solved.state.q - lane.state.q).amax() < 1e-8 && solved.state != lane.state);
    /// }
    /// ```
    pub fn solved_for(mut self, error: f64) -> Self {
        self.stepping.plan.error = Some(error);
        self
    }
}

impl<'f, F, M, L, const N: usize> Study<'f, F, OneByOne<M, L::Scalar>, L, N>
where
    L: FlowInLanes<M, N>,
{
    /// As many members at a time as the machine has lanes for: 32, 16 or 8, fewer of many coordinates; every
    /// field has its own value.
    ///
    /// Members get the bits that they get one by one, many times faster. Sine, cosine and exponential are
    /// branch-free, the same for one member and for many; the other elementary functions are taken member by
    /// member.
    ///
    /// ```
    /// use dalembert::{Splitting, State, rayleigh_system};
    /// use dalembert_ensemble::Ensemble;
    ///
    /// #[rayleigh_system(rule = trapezoidal, lanes = explicit)]
    /// fn ring(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    ///     let s = q[0] * q[0] + q[1] * q[1];
    ///     let speed = v[0] * v[0] + v[1] * v[1];
    ///     (0.5 * speed - s * (s - 1.0) * (s - 1.0), 0.5 * r * speed)
    /// }
    /// let member = |number| {
    ///     let ring = Ring { r: 1e-4 * number as f64 };
    ///     Ok((ring, State { q: [0.1, 1.1].into(), p: [0.5, 0.0].into() }))
    /// };
    /// let study = || Ensemble::new(member).by(Splitting::blanes_moan_6(), 0.1).steps(50);
    /// assert_eq!(study().in_lanes().ends(0..100)?, study().ends(0..100)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn in_lanes(self) -> Study<'f, F, SideBySide<M, L::Scalar>, L, N> {
        self.stepped_by(|OneByOne { method, plan }| SideBySide { method, plan })
    }
}

impl<'f, F, M, L, const N: usize> Study<'f, F, M, L, N>
where
    F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
    L: Lagrangian<N> + Send,
    M: Stepping<L, N>,
{
    /// Calls `progress` from time to time, on the thread that asked for the result; `ControlFlow::Break`
    /// cancels. It is called between many members: what ends members on their way is
    /// [`cancelled_by`](Self::cancelled_by).
    pub fn on_progress(mut self, progress: impl Fn(Progress) -> ControlFlow<()> + Sync + 'f) -> Self {
        self.progress = Some(Box::new(progress));
        self
    }

    /// Cancels when another thread sets `flag`: sooner than the progress callback can, within some hundred
    /// steps, while members are on their way and while their method is chosen. The members that threads have
    /// in hand are not counted.
    ///
    /// ```
    /// use std::sync::atomic::{AtomicBool, Ordering};
    ///
    /// use dalembert::{Midpoint, State, rayleigh_system};
    /// use dalembert_ensemble::Ensemble;
    ///
    /// #[rayleigh_system]
    /// fn falling(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] - q[0]
    /// }
    /// let flag = AtomicBool::new(false);
    /// let study = Ensemble::new(|_| {
    ///     flag.store(true, Ordering::Relaxed);
    ///     Ok((Falling {}, State { q: [1.0].into(), p: [0.0].into() }))
    /// })
    /// .by(Midpoint, 0.5)
    /// .steps(100)
    /// .cancelled_by(&flag);
    /// let cancelled = study.ends(0..1_000_000).expect_err("the flag was set");
    /// assert!(cancelled.total.is_empty());
    /// ```
    pub fn cancelled_by(mut self, flag: &'f AtomicBool) -> Self {
        self.cancel = Some(flag);
        self
    }

    /// Ends a member at the first record for which `has_arrived`: its last.
    ///
    /// ```
    /// use dalembert::{Midpoint, State, rayleigh_system};
    /// use dalembert_ensemble::Ensemble;
    ///
    /// #[rayleigh_system]
    /// fn falling(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] - q[0]
    /// }
    /// let study = Ensemble::new(|number| Ok((Falling {}, State { q: [number as f64].into(), p: [0.0].into() })))
    ///     .by(Midpoint, 0.5)
    ///     .steps(100)
    ///     .every(1)
    ///     .stop_when(|record| record.state.q[0] < 0.0);
    /// // From the height 8 at t = 4, from 32 at t = 8: the next records are below.
    /// let ends = study.ends(0..40)?;
    /// assert_eq!((ends[8].unwrap().time, ends[32].unwrap().time), (4.5, 8.5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn stop_when(mut self, has_arrived: impl Fn(&Record<'_, L, N>) -> bool + Sync + 'f) -> Self {
        self.arrival = Some(Box::new(has_arrived));
        self
    }

    /// The state of each member at the end, or why it did not get there, in the order of numbers.
    ///
    /// # Errors
    /// [`Cancelled`], with the ends so far.
    pub fn ends(&self, numbers: Range<u64>) -> Result<Ends<L::Scalar, N>, Cancelled<Ends<L::Scalar, N>>> {
        let observe = |end: &mut Option<End<L::Scalar, N>>, record: &Record<'_, L, N>| {
            *end = Some(End { number: record.number, time: record.time, state: record.state });
        };
        self.reduce(
            numbers,
            |_| None,
            observe,
            Vec::new(),
            |ends, outcome| {
                ends.push(match (outcome.failure, outcome.value) {
                    (Some(failure), _) => Err(failure),
                    (None, Some(end)) => Ok(end),
                    (None, None) => unreachable!("a member that does not fail has an end"),
                });
            },
        )
    }

    /// Reduces all members to one `total`.
    ///
    /// Of each member a value is kept: made by `value` of its number, changed by `observe` at each record.
    /// `add` then adds the values to the total, on the calling thread and in the order of numbers, so that
    /// the total is the same bits however many threads there are. The values of 16 384 members a thread are
    /// held at a time, at most.
    ///
    /// ```
    /// use dalembert::{Midpoint, State, rayleigh_system};
    /// use dalembert_ensemble::Ensemble;
    ///
    /// #[rayleigh_system]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
    /// }
    /// // The largest angle that each of 100 pendulums reaches, and the mean over all.
    /// let study = Ensemble::new(|number| {
    ///     let system = Pendulum { r: 0.01 * number as f64 };
    ///     let start = State::from_velocity(&system, [0.0], [1.0])?;
    ///     Ok((system, start))
    /// })
    /// .by(Midpoint, 0.1)
    /// .steps(50)
    /// .every(1);
    /// let sum = study.reduce(
    ///     0..100,
    ///     |_| 0.0_f64,
    ///     |largest, record| *largest = largest.max(record.state.q[0]),
    ///     0.0,
    ///     |sum, outcome| *sum += outcome.value,
    /// )?;
    /// assert!((0.5..1.1).contains(&(sum / 100.0)));
    /// # Ok::<(), dalembert_ensemble::Cancelled<f64>>(())
    /// ```
    ///
    /// # Errors
    /// [`Cancelled`], with the total so far.
    pub fn reduce<V: Send, A>(
        &self,
        numbers: Range<u64>,
        value: impl Fn(u64) -> V + Sync,
        observe: impl Fn(&mut V, &Record<'_, L, N>) + Sync,
        total: A,
        mut add: impl FnMut(&mut A, Outcome<V, L::Scalar, N>),
    ) -> Result<A, Cancelled<A>> {
        let members = numbers.end.saturating_sub(numbers.start);
        self.reduce_chunks(
            numbers,
            Progress { done: 0, failed: 0, members },
            Keeping { value: |number, _: &_| value(number), observe, together: |outcomes| outcomes },
            total,
            |total, outcomes| outcomes.into_iter().for_each(|outcome| add(total, outcome)),
        )
    }

    /// As [`reduce`](Self::reduce), but what is kept of a chunk's members is added to the total as one.
    /// `progress` is that before.
    pub(crate) fn reduce_chunks<V, C: Send, A>(
        &self,
        numbers: Range<u64>,
        mut progress: Progress,
        keeping: Keeping<
            impl Fn(u64, &Start<L, N>) -> V + Sync,
            impl Fn(&mut V, &Record<'_, L, N>) + Sync,
            impl Fn(Vec<Outcome<V, L::Scalar, N>>) -> C + Sync,
        >,
        mut total: A,
        mut add: impl FnMut(&mut A, C),
    ) -> Result<A, Cancelled<A>> {
        let Keeping { value, observe, together } = keeping;
        let observe = |value: &mut V, record: &Record<'_, L, N>| {
            observe(value, record);
            let has_arrived = self.arrival.as_ref().is_some_and(|has_arrived| has_arrived(record));
            if has_arrived { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let is_flagged = || self.is_flagged();
        let stop = Stop::when(&is_flagged);
        let mut size = self.stepping.at_once().clamp(1, CHUNK);
        let mut first = numbers.start;
        while first < numbers.end {
            if self.is_cancelled(progress) {
                return Err(Cancelled { total, progress });
            }
            let begin = Instant::now();
            let window = size * CHUNKS * rayon::current_num_threads() as u64;
            let end = numbers.end.min(first.saturating_add(window));
            let chunk = |first: u64| {
                let numbers = first..end.min(first.saturating_add(size));
                let mut panicked = Vec::new();
                let slots: Option<Vec<Slot<L, V, N>>> = numbers
                    .map(|number| {
                        if stop.is_asked() {
                            return None;
                        }
                        let start = self.start(number).unwrap_or_else(|_| {
                            panicked.push(number);
                            Err(NO_START)
                        });
                        Some(Slot { number, value: value(number, &start), start, failure: None })
                    })
                    .collect();
                let mut slots = slots?;
                if self.stepping.advance(&mut slots, &observe, stop).is_break() {
                    return None;
                }
                for Slot { number, failure, .. } in &mut slots {
                    if panicked.contains(number) {
                        *failure =
                            Some(Failure { number: *number, error: MemberError::Panicked, last: None });
                    }
                }
                let outcome = |Slot { number, value, failure, .. }| Outcome { number, value, failure };
                let outcomes: Vec<_> = slots.into_iter().map(outcome).collect();
                let failed = outcomes.iter().filter(|outcome| outcome.failure.is_some()).count();
                Some((outcomes.len() as u64, failed as u64, together(outcomes)))
            };
            let chunks: Vec<u64> = (first..end).step_by(size as usize).collect();
            let chunks: Option<Vec<_>> = chunks.into_par_iter().map(chunk).collect();
            let Some(chunks) = chunks.filter(|_| !stop.is_asked()) else {
                return Err(Cancelled { total, progress });
            };
            for (done, failed, kept) in chunks {
                progress.done += done;
                progress.failed += failed;
                add(&mut total, kept);
            }
            first = end;
            if begin.elapsed() < BRIEF {
                size = CHUNK.min(2 * size);
            }
        }
        // All is done: there is nothing left to cancel.
        self.is_cancelled(progress);
        Ok(total)
    }

    /// A member's system and start, unless the function that makes them panics.
    pub(crate) fn start(&self, number: u64) -> Result<Start<L, N>, MemberError> {
        caught(|| (self.members)(number))
    }

    pub(crate) fn is_flagged(&self) -> bool {
        self.cancel.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// Tells how far it is, and whether it is to end.
    pub(crate) fn is_cancelled(&self, progress: Progress) -> bool {
        self.is_flagged() || self.progress.as_ref().is_some_and(|callback| callback(progress).is_break())
    }
}
