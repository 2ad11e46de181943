//! An ensemble of a system: what is asked of it, and what is kept.

use core::fmt;
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::collections::TryReserveError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use dalembert::nalgebra::SVector;
use dalembert::run::events::EventError;
use dalembert::system::sampled_forces;
use dalembert::{Lagrangian, State, StepError};
use dalembert_ensemble::parts::{self, PartsError};
use dalembert_ensemble::{Ensemble, Failure, MemberError, Outcome, Plan, Progress, Record as OfMember};
use dalembert_face::{Described, Fields, Number};
use twox_hash::XxHash3_128;

use crate::events::Found;
use crate::model::Stepping;
use crate::motion::measured;
use crate::offer::Offer;
use crate::record::Record;
use crate::refusal::Refusal;
use crate::system::System;
use crate::together::BySome;

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
#[derive(Debug, Default)]
pub struct Control {
    /// Whether to end.
    pub cancel: AtomicBool,
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

impl FoundOfMembers {
    /// The events of the next member.
    pub fn add(&mut self, number: u64, found: Found) {
        self.members.resize(self.members.len() + found.t.len(), number.cast_signed());
        let all = &mut self.found;
        for (all, found) in
            [(&mut all.t, found.t), (&mut all.q, found.q), (&mut all.v, found.v), (&mut all.p, found.p)]
        {
            all.extend(found);
        }
    }
}

/// A member that is not what was asked for.
#[derive(Clone, Debug)]
pub struct Failed {
    /// Its number.
    pub number: u64,
    /// Why.
    pub error: WhyFailed,
    /// The time of its last good state.
    pub time: f64,
    /// That state, q and p; empty where it has no start.
    pub state: [Vec<f64>; 2],
}

/// Why a member is not what was asked for.
#[derive(Clone, Debug)]
pub enum WhyFailed {
    /// Its steps, or their error.
    Member(MemberError),
    /// Its events cannot be followed.
    Events(EventError),
}

impl From<MemberError> for WhyFailed {
    fn from(error: MemberError) -> Self {
        Self::Member(error)
    }
}

impl fmt::Display for WhyFailed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Member(error) => error.fmt(f),
            Self::Events(error) => error.fmt(f),
        }
    }
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
fn fields_of_members<S: System<N>, const N: usize>(system: &S::Fields, asked: &Asked<'_>) -> Vec<S::Fields> {
    if asked.fields.is_empty() {
        return vec![*system];
    }
    let mut all = vec![*system; asked.members];
    for (member, fields) in all.iter_mut().enumerate() {
        for (field, numbers) in asked.entries(member) {
            for (index, number) in numbers.iter().enumerate() {
                fields.change_entry(field, index, *number);
            }
        }
    }
    all
}

/// Member `member`: its system and its start.
fn start<'a, S: System<N>, const N: usize>(
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
fn by_some<'a, S: System<N>, const N: usize>(
    asked: &Asked<'_>,
) -> Result<BySome<'a, S::View<'a>, N>, Refusal> {
    let steps = match asked.stepping {
        Stepping::Fixed { h, steps, rule } => {
            let is_asked_for =
                |offer: &Offer<S, N>| rule.is_none_or(|rule| rule == offer.name) && offer.steps.is_some();
            let offer = S::offers().into_iter().find(is_asked_for).ok_or(Refusal::Rule)?;
            let plan = Plan { h, steps, every: asked.every.map(|every| every.max(1)), error: None };
            offer.steps.ok_or(Refusal::Rule)?.together(plan)
        }
        Stepping::ToError(asked) => S::steps_to_error().ok_or(Refusal::NoError)?.together(asked),
    };
    Ok(BySome(steps))
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
pub fn kept<S: System<N>, const N: usize>(
    system: &S::Fields,
    asked: &Asked<'_>,
    control: &Control,
) -> Result<Kept, NoResult> {
    let kept = Kept::with_room(asked, N)?;
    let last = asked.first + asked.members as u64;
    let fields = fields_of_members::<S, N>(system, asked);
    let steps = by_some::<S, N>(asked).map_err(NoResult::Refused)?;
    let member = |number: u64| start::<S, N>(&fields, asked, (number - asked.first) as usize);
    let study = Ensemble::new(member).stepped(steps).cancelled_by(&control.cancel).on_progress(
        |Progress { done, .. }| {
            control.done.store(done, Ordering::Relaxed);
            ControlFlow::Continue(())
        },
    );
    let observe = |rows: &mut Vec<Row<N>>, record: &OfMember<'_, S::View<'_>, N>| {
        let of = |system: &S::View<'_>| measured(system, &record.state);
        // Of a member that panics there are none.
        let measured = catch_unwind(AssertUnwindSafe(|| record.system.later(record.time, of)));
        let measured = measured.ok().and_then(Result::ok);
        let (v, energy) = measured.unwrap_or_else(|| (SVector::repeat(f64::NAN), f64::NAN));
        rows.push(Row { t: asked.time + record.time, q: record.state.q, v, p: record.state.p, energy });
    };
    let add = |kept: &mut Kept, outcome: Outcome<Vec<Row<N>>, f64, N>| kept.add(outcome, asked.time);
    study.reduce(asked.first..last, |_| Vec::new(), observe, kept, add).map_err(|_| NoResult::Cancelled)
}

/// Writes the parts of all members into `folder` that are not there.
///
/// # Errors
/// Why they are not all there.
pub fn written<S: System<N>, const N: usize>(
    system: &S::Fields,
    asked: &Asked<'_>,
    control: &Control,
    folder: &Path,
    members_per_part: u64,
) -> Result<Written, NoResult> {
    let last = asked.first + asked.members as u64;
    let fields = fields_of_members::<S, N>(system, asked);
    let steps = by_some::<S, N>(asked).map_err(NoResult::Refused)?;
    let member = |number: u64| start::<S, N>(&fields, asked, (number - asked.first) as usize);
    let study = Ensemble::new(member).stepped(steps).cancelled_by(&control.cancel).on_progress(
        |Progress { done, .. }| {
            control.done.store(done, Ordering::Relaxed);
            ControlFlow::Continue(())
        },
    );
    let digest = |number: u64| digest(&fields, asked, (number - asked.first) as usize);
    let parts = study.parts(folder).members_per_part(members_per_part).identified_by(digest);
    let parts = parts.made_within(asked.first..last).metadata("dalembert.model", model::<S, N>());
    let counts = parts.write(asked.first..last).map_err(|error| match error {
        PartsError::Cancelled(_) => NoResult::Cancelled,
        error => NoResult::Parts(error),
    })?;
    Ok(Written { counts, paths: parts.paths(asked.first..last).collect() })
}

/// States at which a model is asked for its forces.
const STATES: usize = 2048;

/// The hash that tells a model from one that was edited, whatever its fields and members: of its forces with
/// fields and inputs that are always these.
fn model<S: System<N>, const N: usize>() -> String {
    let mut fields = S::Fields::ZERO;
    let mut number = 0.7;
    for field in 0..S::Fields::FIELDS.len() {
        for index in 0.. {
            let Some(zero) = fields.entry(field, index) else { break };
            // No two alike.
            number = (number + 0.618_033_988_749_894_9) % 1.0;
            fields.change_entry(field, index, one_like(zero, 0.5 + number));
        }
    }
    let inputs: Vec<f64> = (0..S::Fields::INPUTS).map(|k| 0.3 / (1.0 + k as f64)).collect();
    let mut hash = XxHash3_128::new();
    let asked = catch_unwind(AssertUnwindSafe(|| {
        let (q, v) = (SVector::repeat(0.1), SVector::repeat(0.2));
        let system = S::view(&fields, &inputs, 0.0);
        sampled_forces(&system, (&q, &v), 1, STATES).for_each(|force| hash.write(&force.to_le_bytes()));
    }));
    asked.map_or_else(|_| "panics".to_owned(), |()| format!("{:032x}", hash.finish_128()))
}

/// A number of the type of another: 1 where that is a whole one.
fn one_like(like: Number, value: f64) -> Number {
    match like {
        Number::F64(_) => Number::F64(value),
        Number::F32(_) => Number::F32(value as f32),
        Number::I8(_) => Number::I8(1),
        Number::I16(_) => Number::I16(1),
        Number::I32(_) => Number::I32(1),
        Number::I64(_) => Number::I64(1),
        Number::U8(_) => Number::U8(1),
        Number::U16(_) => Number::U16(1),
        Number::U32(_) => Number::U32(1),
        Number::U64(_) => Number::U64(1),
    }
}

/// The hash that tells a member from others: of its fields, start and input.
fn digest<F: Fields>(fields: &[F], asked: &Asked<'_>, member: usize) -> u128 {
    let mut hash = XxHash3_128::new();
    hash.write(&[u8::from(asked.is_velocity)]);
    hash.write(&asked.time.to_le_bytes());
    let fields = &fields[if fields.len() == 1 { 0 } else { member }];
    for field in 0..F::FIELDS.len() {
        for entry in (0..).map_while(|index| fields.entry(field, index)) {
            hash.write(&bytes(entry));
        }
    }
    for row in [asked.q, asked.other, asked.inputs] {
        row.of(member).iter().for_each(|number| hash.write(&number.to_le_bytes()));
    }
    hash.finish_128()
}

fn bytes(number: Number) -> [u8; 8] {
    match number {
        Number::F64(value) => value.to_le_bytes(),
        Number::F32(value) => f64::from(value).to_le_bytes(),
        Number::I8(value) => i64::from(value).to_le_bytes(),
        Number::I16(value) => i64::from(value).to_le_bytes(),
        Number::I32(value) => i64::from(value).to_le_bytes(),
        Number::I64(value) => value.to_le_bytes(),
        Number::U8(value) => u64::from(value).to_le_bytes(),
        Number::U16(value) => u64::from(value).to_le_bytes(),
        Number::U32(value) => u64::from(value).to_le_bytes(),
        Number::U64(value) => value.to_le_bytes(),
    }
}

/// A record of a member.
struct Row<const N: usize> {
    t: f64,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    p: SVector<f64, N>,
    energy: f64,
}

impl Kept {
    /// With room for what is asked for.
    ///
    /// # Errors
    /// There is not so much.
    pub fn with_room(asked: &Asked<'_>, n: usize) -> Result<Self, NoResult> {
        let records = usize::try_from(records(asked)).unwrap_or(usize::MAX);
        let mut kept = Self { records, ..Self::default() };
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

    /// The records of the next member from the `first` on; NaN where it has no more.
    pub fn add_record(&mut self, record: &Record, first: usize, n: usize) {
        let members = self.t.len() / self.records;
        let from = [&record.t, &record.q, &record.v, &record.p, &record.energy];
        for ((numbers, width), from) in self.columns(n).into_iter().zip(from) {
            numbers.extend_from_slice(&from[first * width..]);
        }
        self.fill(members + 1, n);
    }

    /// The records of the next member; NaN where it has failed.
    fn add<const N: usize>(&mut self, outcome: Outcome<Vec<Row<N>>, f64, N>, origin: f64) {
        let Outcome { number, value, failure } = outcome;
        let members = self.t.len() / self.records;
        for Row { t, q, v, p, energy } in value {
            self.t.push(t);
            self.q.extend_from_slice(q.as_slice());
            self.v.extend_from_slice(v.as_slice());
            self.p.extend_from_slice(p.as_slice());
            self.energy.push(energy);
        }
        self.fill(members + 1, N);
        if let Some(Failure { error, last, .. }) = failure {
            let time = origin + last.map_or(0.0, |last| last.time);
            let state = last.map_or([Vec::new(), Vec::new()], |last| {
                [last.state.q, last.state.p].map(|vector| vector.as_slice().to_vec())
            });
            self.failures.push(Failed { number, error: error.into(), time, state });
        }
    }
}
