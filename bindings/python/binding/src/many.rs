//! An ensemble of a system: what is asked of it, and what is kept.

mod columns;
mod identity;

use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::collections::TryReserveError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use columns::{Column, columns, in_column};
use dalembert::nalgebra::SVector;
use dalembert::{Lagrangian, State, StepError};
use dalembert_ensemble::parts::{self, PartsError};
use dalembert_ensemble::{
    Ensemble, Failure, MemberError, Outcome, Plan, Progress, Record as OfMember, Study,
};
use dalembert_face::{Fields, Number};
use identity::{digest, model};

use crate::events::{Event, Events, Found};
use crate::motion::measured;
use crate::offer::{Offers, Stepping};
use crate::refusal::Refusal;
use crate::together::BySome;
use crate::watched::{Unwatched, Watched};

/// A row of numbers for each member, or one for all.
#[derive(Clone, Copy, Debug)]
pub struct Rows<'a> {
    /// The numbers, row by row.
    pub numbers: &'a [f64],
    /// Numbers of a row.
    pub width: usize,
}

impl<'a> Rows<'a> {
    /// The row of a member.
    #[must_use]
    pub fn of(&self, member: usize) -> &'a [f64] {
        let first = if self.numbers.len() == self.width { 0 } else { member * self.width };
        &self.numbers[first..first + self.width]
    }
}

/// A field that differs from member to member: which, and its numbers for each.
pub type FieldOfMembers = (usize, Vec<Number>);

/// Many members that are asked for.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// How many.
    pub members: usize,
    /// The number of the first.
    pub first: u64,
    /// Configurations.
    pub q: Rows<'a>,
    /// Velocities or momenta.
    pub other: Rows<'a>,
    /// Which of them.
    pub is_velocity: bool,
    /// Inputs, held throughout.
    pub inputs: Rows<'a>,
    /// The time at the start.
    pub time: f64,
    /// Fields that differ.
    pub fields: &'a [FieldOfMembers],
    /// The steps.
    pub stepping: Stepping<'a>,
    /// Steps from one record to the next; the end alone if there are none.
    pub every: Option<u64>,
    /// Events to look for in the run of each.
    pub events: &'a [Event<'a>],
}

impl Asked<'_> {
    /// The fields of a member that differ, and their numbers.
    pub fn entries(&self, member: usize) -> impl Iterator<Item = (usize, &[Number])> {
        self.fields.iter().map(move |(field, numbers)| {
            let width = numbers.len() / self.members.max(1);
            (*field, &numbers[member * width..(member + 1) * width])
        })
    }
}

/// How others follow an ensemble, and end it.
#[derive(Debug)]
pub struct Control<'a> {
    /// Whether to end.
    pub cancel: &'a AtomicBool,
    /// Members that are done.
    pub done: AtomicU64,
}

/// The records of the members, one after the other: t, q, v, p and energy of each.
#[derive(Clone, Debug, Default)]
pub struct Kept {
    /// Times.
    pub t: Vec<f64>,
    /// Configurations.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Momenta.
    pub p: Vec<f64>,
    /// Energies.
    pub energy: Vec<f64>,
    /// Members that failed.
    pub failures: Vec<Failed>,
    /// Records of a member.
    pub records: usize,
    /// The events of each function, if they were looked for.
    pub events: Vec<FoundOfMembers>,
}

/// The events of one function, member by member.
#[derive(Clone, Debug, Default)]
pub struct FoundOfMembers {
    /// The number of the member of each.
    pub members: Vec<i64>,
    /// When and where.
    pub found: Found,
}

/// A member that is not what was asked for.
#[derive(Clone, Debug)]
pub struct Failed {
    /// Its number.
    pub number: u64,
    /// Why.
    pub error: MemberError,
    /// The time of its last good state.
    pub time: f64,
    /// That state, q and p; empty where it has no start.
    pub state: [Vec<f64>; 2],
}

/// Counts of the parts and of the members that failed, and the files.
#[derive(Clone, Debug, Default)]
pub struct Written {
    /// The counts.
    pub counts: parts::Written,
    /// The files, one a part.
    pub paths: Vec<PathBuf>,
}

/// Why there are no results.
#[derive(Debug)]
pub enum NoResult {
    /// The system has no such steps.
    Refused(Refusal),
    /// Others have ended it.
    Cancelled,
    /// Results do not fit into memory.
    TooLarge(TryReserveError),
    /// They are not written.
    Parts(PartsError),
}

/// The fields of each member, or those of all.
fn fields_of_members<S: Offers<N>, const N: usize>(system: &S::Fields, asked: &Asked<'_>) -> Vec<S::Fields> {
    if asked.fields.is_empty() {
        return vec![*system];
    }
    let mut all = vec![*system; asked.members];
    for (member, fields) in all.iter_mut().enumerate() {
        for (field, numbers) in asked.entries(member) {
            // They have been tried where they were given.
            *fields = fields.with_field(field, numbers).unwrap_or(*fields);
        }
    }
    all
}

/// Member `member`: its system and its start.
fn start<'a, S: Offers<N>, const N: usize>(
    fields: &'a [S::Fields],
    asked: &Asked<'_>,
    member: usize,
) -> Result<(S::View<'a>, State<f64, N>), StepError> {
    let fields = &fields[if fields.len() == 1 { 0 } else { member }];
    let view = S::view(fields, asked.inputs.of(member), asked.time);
    let vector = SVector::<f64, N>::from_column_slice;
    let (q, other) = (vector(asked.q.of(member)), vector(asked.other.of(member)));
    let state =
        if asked.is_velocity { State::from_velocity(&view, q, other)? } else { State { q, p: other } };
    Ok((view, state))
}

/// The steps that are asked for.
fn by_some<'a, S: Offers<N>, const N: usize>(
    asked: &'a Asked<'_>,
    control: &'a Control<'_>,
) -> Result<BySome<'a, S::View<'a>, N>, Refusal> {
    let steps = match asked.stepping {
        Stepping::Fixed { h, steps, rule, .. } => {
            let plan = Plan { h, steps, every: asked.every.map(|every| every.max(1)), error: None };
            Unwatched::Fixed(S::offered(rule)?.steps.ok_or(Refusal::Rule)?, plan)
        }
        Stepping::ToError(asked) => Unwatched::ToError(S::to_error()?, asked),
    };
    Ok(BySome(match steps {
        steps if !asked.events.is_empty() => {
            let events = Events { asked: asked.events, origin: asked.time };
            Box::new(Watched { steps, events, done: &control.done })
        }
        Unwatched::Fixed(steps, plan) => steps.together(plan),
        Unwatched::ToError(steps, asked) => steps.together(asked),
    }))
}

/// The members that are asked for, by the steps that are.
#[allow(clippy::type_complexity, reason = "the function that makes members has no name")]
fn study<'a, S: Offers<N>, const N: usize>(
    fields: &'a [S::Fields],
    asked: &'a Asked<'_>,
    control: &'a Control<'_>,
) -> Result<
    Study<
        'a,
        impl Fn(u64) -> Result<(S::View<'a>, State<f64, N>), StepError> + Sync,
        BySome<'a, S::View<'a>, N>,
        S::View<'a>,
        N,
    >,
    NoResult,
> {
    let steps = by_some::<S, N>(asked, control).map_err(NoResult::Refused)?;
    let member = |number: u64| start::<S, N>(fields, asked, (number - asked.first) as usize);
    let told = |Progress { done, .. }| {
        control.done.store(done, Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    Ok(Ensemble::new(member).stepped(steps).cancelled_by(control.cancel).on_progress(told))
}

/// How many records a member has.
fn records(asked: &Asked<'_>) -> u64 {
    match (asked.stepping, asked.every) {
        (Stepping::Fixed { steps, .. }, Some(every)) => 1 + steps.div_ceil(every.max(1)),
        _ => 1,
    }
}

/// The states of all members as arrays.
///
/// # Errors
/// Why there are none.
pub fn kept<S: Offers<N>, const N: usize>(
    system: &S::Fields,
    asked: &Asked<'_>,
    control: &Control<'_>,
) -> Result<Kept, NoResult> {
    let kept = Kept::with_room(asked, N)?;
    let last = asked.first + asked.members as u64;
    let fields = fields_of_members::<S, N>(system, asked);
    let study = study::<S, N>(&fields, asked, control)?;
    let observe = |rows: &mut Vec<Row<N>>, record: &OfMember<'_, S::View<'_>, N>| {
        let of = |system: &S::View<'_>| measured(system, &record.state);
        // Of a member that panics there are none.
        let measured = catch_unwind(AssertUnwindSafe(|| record.system.later(record.time, of)));
        let measured = measured.ok().and_then(Result::ok);
        let (v, energy) = measured.unwrap_or_else(|| (SVector::repeat(f64::NAN), f64::NAN));
        let (t, State { q, p }, event) = (asked.time + record.time, record.state, record.event);
        rows.push(Row { t, q, v, p, energy, event });
    };
    let add = |kept: &mut Kept, outcome: Outcome<Vec<Row<N>>, f64, N>| kept.add(outcome, asked.time);
    study.reduce(asked.first..last, |_| Vec::new(), observe, kept, add).map_err(|_| NoResult::Cancelled)
}

/// Writes the parts of all members into `folder` that are not there.
///
/// # Errors
/// Why they are not all there.
pub fn written<S: Offers<N>, const N: usize>(
    system: &S::Fields,
    asked: &Asked<'_>,
    control: &Control<'_>,
    folder: &Path,
    members_per_part: u64,
) -> Result<Written, NoResult> {
    let last = asked.first + asked.members as u64;
    let fields = fields_of_members::<S, N>(system, asked);
    let study = study::<S, N>(&fields, asked, control)?;
    let digest = |number: u64| digest(&fields, asked, (number - asked.first) as usize);
    let parts = study.parts(folder).members_per_part(members_per_part).identified_by(digest);
    let mut parts = parts.made_within(asked.first..last).metadata("dalembert.model", model::<S, N>());
    for Column { name, field, index } in columns::<S::Fields>(asked, N) {
        let (fields, first) = (&fields, asked.first);
        let value = move |number: u64| {
            fields[(number - first) as usize].entry(field, index).map_or(f64::NAN, in_column)
        };
        parts = parts.column_by_number(name, value);
    }
    let counts = parts.write(asked.first..last).map_err(|error| match error {
        PartsError::Cancelled(_) => NoResult::Cancelled,
        error => NoResult::Parts(error),
    })?;
    Ok(Written { counts, paths: parts.paths(asked.first..last).collect() })
}

/// A record of a member.
struct Row<const N: usize> {
    t: f64,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    p: SVector<f64, N>,
    energy: f64,
    /// The event function that vanishes there.
    event: Option<usize>,
}

impl Kept {
    /// With room for what is asked for.
    ///
    /// # Errors
    /// There is not so much.
    fn with_room(asked: &Asked<'_>, n: usize) -> Result<Self, NoResult> {
        let records = usize::try_from(records(asked)).unwrap_or(usize::MAX);
        let mut kept = Self { records, ..Self::default() };
        kept.events.resize_with(asked.events.len(), FoundOfMembers::default);
        let rows = asked.members.saturating_mul(records);
        for (numbers, width) in kept.columns(n) {
            numbers.try_reserve_exact(rows.saturating_mul(width)).map_err(NoResult::TooLarge)?;
        }
        Ok(kept)
    }

    /// The columns, and how many numbers of each a row has.
    fn columns(&mut self, n: usize) -> [(&mut Vec<f64>, usize); 5] {
        let Self { t, q, v, p, energy, .. } = self;
        [(t, 1), (q, n), (v, n), (p, n), (energy, 1)]
    }

    /// Rows up to those of `members`, NaN where there are none.
    fn fill(&mut self, members: usize, n: usize) {
        let rows = members * self.records;
        for (numbers, width) in self.columns(n) {
            numbers.resize(rows * width, f64::NAN);
        }
    }

    /// The records and events of the next member; NaN where it has failed.
    fn add<const N: usize>(&mut self, outcome: Outcome<Vec<Row<N>>, f64, N>, origin: f64) {
        let Outcome { number, value, failure } = outcome;
        let members = self.t.len() / self.records;
        for Row { t, q, v, p, energy, event } in value {
            let vectors = match event.and_then(|event| self.events.get_mut(event)) {
                None => {
                    self.t.push(t);
                    self.energy.push(energy);
                    [&mut self.q, &mut self.v, &mut self.p]
                }
                Some(FoundOfMembers { members, found }) => {
                    members.push(number.cast_signed());
                    found.t.push(t);
                    [&mut found.q, &mut found.v, &mut found.p]
                }
            };
            for (all, vector) in vectors.into_iter().zip([q, v, p]) {
                all.extend_from_slice(vector.as_slice());
            }
        }
        self.fill(members + 1, N);
        if let Some(Failure { error, last, .. }) = failure {
            let time = origin + last.map_or(0.0, |last| last.time);
            let state = last.map_or([Vec::new(), Vec::new()], |last| {
                [last.state.q, last.state.p].map(|vector| vector.as_slice().to_vec())
            });
            self.failures.push(Failed { number, error, time, state });
        }
    }
}
