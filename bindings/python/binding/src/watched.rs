//! Members that are watched for events: each a run by itself, on whichever core is free.

use core::ops::ControlFlow;
use core::sync::atomic::Ordering;
use std::panic::{AssertUnwindSafe, catch_unwind};

use dalembert_ensemble::MemberError;
use rayon::prelude::*;

use crate::events::{Event, Found};
use crate::many::{Asked, Control, Failed, Kept, NoResult, WhyFailed};
use crate::model::{Model, MotionGiven, Ran, Run, Start};
use crate::record::{Failure, Record, Stop};
use crate::refusal::Refusal;
use crate::watch::{Far, Watch};

/// Members whose runs are held before they are added to the arrays.
const HELD: usize = 16_384;

/// A member after its run.
struct Member {
    record: Record,
    /// Whether its last record is the end of the run.
    has_end: bool,
    events: Vec<Found>,
    failed: Option<Failed>,
}

/// The states of all members as arrays, and their events.
///
/// # Errors
/// Why there are none.
pub fn kept(
    model: &dyn Model,
    asked: &Asked<'_>,
    events: &[Event<'_>],
    control: &Control,
) -> Result<Kept, NoResult> {
    let n = model.kind().coordinates();
    let mut kept = Kept::with_room(asked, n)?;
    kept.events.resize_with(events.len(), Default::default);
    for first in (0..asked.members).step_by(HELD) {
        let held = first..asked.members.min(first + HELD);
        let members: Vec<_> =
            held.into_par_iter().map(|member| run(model, asked, events, control, member)).collect();
        for (member, ran) in (first..).zip(members) {
            let Member { record, has_end, events, failed } = ran?;
            // Where the end alone is asked for there is none of a run that failed, and the last row of others.
            let first = match (asked.every, has_end) {
                (Some(_), _) => 0,
                (None, false) => record.t.len(),
                (None, true) => record.t.len().saturating_sub(1),
            };
            kept.add_record(&record, first, n);
            for (all, found) in kept.events.iter_mut().zip(events) {
                all.add(asked.first + member as u64, found);
            }
            kept.failures.extend(failed);
        }
    }
    Ok(kept)
}

/// The run of one member.
fn run(
    model: &dyn Model,
    asked: &Asked<'_>,
    events: &[Event<'_>],
    control: &Control,
    member: usize,
) -> Result<Member, NoResult> {
    if control.cancel.load(Ordering::Relaxed) {
        return Err(NoResult::Cancelled);
    }
    let mut system = model.copy();
    for (field, entries) in asked.entries(member) {
        for (index, entry) in entries.iter().enumerate() {
            system.change_entry(field, index, *entry);
        }
    }
    let other = asked.other.of(member);
    let motion = if asked.is_velocity { MotionGiven::Velocity(other) } else { MotionGiven::Momentum(other) };
    let start = Start { q: asked.q.of(member), motion, inputs: asked.inputs.of(member), time: asked.time };
    let every = asked.every.unwrap_or(u64::MAX);
    let run =
        Run { start, stepping: asked.stepping, every, is_differentiated: false, events, is_tried: true };
    let look = |_: Far| match control.cancel.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let watch = Watch::new(&look);
    let ran = catch_unwind(AssertUnwindSafe(|| system.run(&run, &watch)));
    control.done.fetch_add(1, Ordering::Relaxed);
    let number = asked.first + member as u64;
    let without_start = |error| {
        let failed = Failed { number, error, time: asked.time, state: [Vec::new(), Vec::new()] };
        let events = vec![Found::default(); events.len()];
        Ok(Member { record: Record::default(), has_end: false, events, failed: Some(failed) })
    };
    let Ok(ran) = ran else { return without_start(MemberError::Panicked.into()) };
    match ran {
        Ok(ran) => outcome(ran, number),
        Err(Refusal::Start(failure)) => without_start(MemberError::Step(failure.error).into()),
        Err(Refusal::Tolerance(error)) => without_start(MemberError::from(error).into()),
        Err(Refusal::CalledOff) => Err(NoResult::Cancelled),
        Err(refusal) => Err(NoResult::Refused(refusal)),
    }
}

/// The outcome of a run, with the events up to where it failed.
fn outcome(ran: Ran, number: u64) -> Result<Member, NoResult> {
    let Ran { record, stop, guarded, events } = ran;
    let has_end = stop.is_none();
    let last = |record: &Record| {
        let n = record.q.len() / record.t.len().max(1);
        [&record.q, &record.p].map(|rows| rows[rows.len() - n..].to_vec())
    };
    let time = record.t.last().copied().unwrap_or(f64::NAN);
    let failed = match stop {
        Some(Stop::Interrupted) => return Err(NoResult::Cancelled),
        Some(Stop::TooLarge(reason)) => return Err(NoResult::TooLarge(reason)),
        Some(Stop::Failed(Failure { error, time, state, .. })) => {
            Some(Failed { number, error: MemberError::Step(error).into(), time, state })
        }
        Some(Stop::Events(error)) => {
            Some(Failed { number, error: WhyFailed::Events(error), time, state: last(&record) })
        }
        None => guarded.and_then(|guarded| guarded.breach).map(|breach| {
            let error = MemberError::Breach(breach).into();
            Failed { number, error, time, state: last(&record) }
        }),
    };
    Ok(Member { record, has_end, events, failed })
}
