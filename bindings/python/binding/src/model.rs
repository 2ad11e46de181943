//! Systems without their types: what the classes of Python call.

use core::marker::PhantomData;
use std::path::Path;

use dalembert::nalgebra::SVector;
use dalembert::run::Stop as Told;
use dalembert::system::Structure;
use dalembert::{Lagrangian, State, StepError};
use dalembert_face::{Described, Field, Fields, Number};

use crate::checks::{Affine, Ledger, Region, Symmetry};
use crate::events::{Event, Events, Found};
use crate::many::{self, Asked, Control, Kept, NoResult, Written};
use crate::motion::{Given, Motion, measured};
use crate::offer::{ErrorAsked, Offer};
use crate::record::{Failure, Guarded, Plan, Record, Stop};
use crate::refusal::Refusal;
use crate::system::System;
use crate::watch::Watch;

/// A class of systems.
pub trait Kind: Send + Sync {
    /// The name of the class.
    fn name(&self) -> &'static str;
    /// The documentation of the struct, a line each.
    fn documentation(&self) -> &'static [&'static str];
    /// Its fields, in order.
    fn fields(&self) -> &'static [Field];
    /// N.
    fn coordinates(&self) -> usize;
    /// The length of u.
    fn inputs(&self) -> usize;
    /// Whether L, R or f take the time.
    fn takes_time(&self) -> bool;
    /// The parameters by which steps are differentiated.
    fn parameters(&self) -> &'static [&'static str];
    /// The methods by which it is stepped, as `rule=` calls them.
    fn rules(&self) -> Vec<&'static str>;
    /// The structure that was found when it was compiled.
    fn structure(&self) -> Structure;
    /// A system all of whose fields are 0.
    fn zero(&self) -> Box<dyn Model>;
}

/// A system with its fields.
pub trait Model: Send + Sync {
    /// Its class.
    fn kind(&self) -> &'static dyn Kind;
    /// A boxed copy.
    fn copy(&self) -> Box<dyn Model>;
    /// Number `index` of field `field`, arrays row by row.
    fn entry(&self, field: usize, index: usize) -> Option<Number>;
    /// Changes it; whether there is one of this type.
    fn change_entry(&mut self, field: usize, index: usize, value: Number) -> bool;

    /// The records of a run.
    ///
    /// # Errors
    /// Why there is none.
    fn run(&self, run: &Run<'_>, watch: &Watch<'_>) -> Result<Ran, Refusal>;

    /// A step with its derivatives.
    ///
    /// # Errors
    /// Why there is none.
    fn linearized(&self, start: &Start<'_>, h: f64, rule: Option<&str>) -> Result<Linearized, Refusal>;

    /// The effect of each generator on the step by a rule.
    ///
    /// # Errors
    /// Why that is not known.
    fn symmetries(
        &self,
        given: Given<'_>,
        h: f64,
        rule: Option<&str>,
        generators: &[Affine],
        region: &Region<'_>,
        watch: &Watch<'_>,
    ) -> Result<Vec<Symmetry>, Refusal>;

    /// Where the energy of a run of so many steps went.
    ///
    /// # Errors
    /// Why that is not known.
    fn ledger(
        &self,
        start: &Start<'_>,
        h: f64,
        rule: Option<&str>,
        steps: u64,
        watch: &Watch<'_>,
    ) -> Result<Ledger, Refusal>;

    /// Records of many members, as arrays.
    ///
    /// # Errors
    /// Why there is nothing.
    fn kept(&self, asked: &Asked<'_>, control: &Control) -> Result<Kept, NoResult>;

    /// Records of many members, as files.
    ///
    /// # Errors
    /// Why they are not all there.
    fn written(
        &self,
        asked: &Asked<'_>,
        control: &Control,
        folder: &Path,
        members_per_part: u64,
    ) -> Result<Written, NoResult>;

    /// The energies of states, q and v or p of one after the other, at one time or each at its own.
    ///
    /// # Errors
    /// The first that fails.
    fn energies(
        &self,
        times: &[f64],
        q: &[f64],
        motion: MotionGiven<'_>,
        watch: &Watch<'_>,
    ) -> Result<Vec<f64>, Refusal>;
}

/// Velocities or momenta.
#[derive(Clone, Copy, Debug)]
pub enum MotionGiven<'a> {
    /// v.
    Velocity(&'a [f64]),
    /// p.
    Momentum(&'a [f64]),
}

/// Where a run starts. All arrays have the lengths that they should.
#[derive(Clone, Copy, Debug)]
pub struct Start<'a> {
    /// Configuration.
    pub q: &'a [f64],
    /// Velocity or momentum.
    pub motion: MotionGiven<'a>,
    /// u: one for all steps, or one after the other.
    pub inputs: &'a [f64],
    /// The time.
    pub time: f64,
}

/// The steps that a run takes.
#[derive(Clone, Copy, Debug)]
pub enum Stepping<'a> {
    /// So many of size h.
    Fixed {
        /// h.
        h: f64,
        /// How many.
        steps: u64,
        /// By which rule; the first of the system if none is named.
        rule: Option<&'a str>,
    },
    /// The steps that an error asked for needs.
    ToError(ErrorAsked),
}

/// A run that is asked for.
#[derive(Debug)]
pub struct Run<'a> {
    /// Where it starts.
    pub start: Start<'a>,
    /// Its steps.
    pub stepping: Stepping<'a>,
    /// Steps from one record to the next.
    pub every: u64,
    /// Whether it carries along how it follows start and parameters.
    pub is_differentiated: bool,
    /// Events to look for on the way.
    pub events: &'a [Event<'a>],
    /// Whether, to an error asked for, as many runs are tried as it takes to keep it.
    pub is_tried: bool,
}

/// The records of a run, whole or up to where it stopped.
#[derive(Clone, Debug)]
pub struct Ran {
    /// The records.
    pub record: Record,
    /// Why there are no more.
    pub stop: Option<Stop>,
    /// The choice made for the error asked for, and where the run passed it.
    pub guarded: Option<Guarded>,
    /// The events of each function.
    pub events: Vec<Found>,
}

/// A step with its derivatives, row by row.
#[derive(Clone, Debug)]
pub struct Linearized {
    /// Where it leads: q and p.
    pub end: [Vec<f64>; 2],
    /// ∂(q1, p1)/∂(q0, p0).
    pub a: Vec<f64>,
    /// ∂(q1, p1)/∂u.
    pub b: Option<Vec<f64>>,
    /// ∂(q1, p1)/∂θ.
    pub by_parameters: Option<Vec<f64>>,
}

/// The class of S.
pub struct KindOf<S, const N: usize>(pub PhantomData<fn() -> S>);

/// A system of S.
struct ModelOf<S: System<N>, const N: usize> {
    fields: S::Fields,
}

impl<S: System<N>, const N: usize> Kind for KindOf<S, N> {
    fn name(&self) -> &'static str {
        S::NAME
    }

    fn documentation(&self) -> &'static [&'static str] {
        S::Fields::DOCUMENTATION
    }

    fn fields(&self) -> &'static [Field] {
        S::Fields::FIELDS
    }

    fn coordinates(&self) -> usize {
        N
    }

    fn inputs(&self) -> usize {
        S::Fields::INPUTS
    }

    fn takes_time(&self) -> bool {
        S::Fields::TAKES_TIME
    }

    fn parameters(&self) -> &'static [&'static str] {
        S::Fields::PARAMETERS
    }

    fn rules(&self) -> Vec<&'static str> {
        S::offers().iter().filter(|offer| offer.steps.is_some()).map(|offer| offer.name).collect()
    }

    fn structure(&self) -> Structure {
        <S::View<'static> as Lagrangian<N>>::STRUCTURE
    }

    fn zero(&self) -> Box<dyn Model> {
        Box::new(ModelOf::<S, N> { fields: S::Fields::ZERO })
    }
}

impl<S: System<N>, const N: usize> ModelOf<S, N> {
    fn given<'a>(start: &Start<'a>) -> Given<'a> {
        Given { inputs: start.inputs, time: start.time }
    }

    fn state(&self, start: &Start<'_>) -> Result<State<f64, N>, Refusal> {
        let q = SVector::from_column_slice(start.q);
        let state = match start.motion {
            MotionGiven::Velocity(v) => {
                let input = &start.inputs[..S::Fields::INPUTS];
                let system = S::view(&self.fields, input, start.time);
                State::from_velocity(&system, q, SVector::<f64, N>::from_column_slice(v))
            }
            MotionGiven::Momentum(p) => Ok(State { q, p: SVector::from_column_slice(p) }),
        };
        state.map_err(|error| refused(start, error))
    }
}

/// The offer of the rule of this name, or of the first.
fn offered<S: System<N>, const N: usize>(rule: Option<&str>) -> Result<Offer<S, N>, Refusal> {
    let is_asked_for =
        |offer: &Offer<S, N>| rule.is_none_or(|rule| rule == offer.name) && offer.steps.is_some();
    S::offers().into_iter().find(is_asked_for).ok_or(Refusal::Rule)
}

fn refused(start: &Start<'_>, error: StepError) -> Refusal {
    let p = if let MotionGiven::Momentum(p) = start.motion { p } else { &[] };
    Refusal::Start(Failure { error, step: 0, time: start.time, state: [start.q, p].map(<[f64]>::to_vec) })
}

impl<S: System<N>, const N: usize> Model for ModelOf<S, N> {
    fn kind(&self) -> &'static dyn Kind {
        &KindOf::<S, N>(PhantomData)
    }

    fn copy(&self) -> Box<dyn Model> {
        Box::new(Self { fields: self.fields })
    }

    fn entry(&self, field: usize, index: usize) -> Option<Number> {
        self.fields.entry(field, index)
    }

    fn change_entry(&mut self, field: usize, index: usize, value: Number) -> bool {
        self.fields.change_entry(field, index, value)
    }

    fn run(&self, run: &Run<'_>, watch: &Watch<'_>) -> Result<Ran, Refusal> {
        let Run { start: given, stepping, every, is_differentiated, events: asked, is_tried } = run;
        let start = self.state(given)?;
        let found = vec![Found::default(); asked.len()];
        let mut events = Events { asked, origin: given.time, found, error: None };
        let mut watched = (!asked.is_empty()).then_some(&mut events);
        let mut ran = (Record::default(), None);
        let mut guarded = None;
        let is_called_off = || watch.is_called_off();
        let told = Told::when(&is_called_off);
        match *stepping {
            Stepping::Fixed { h, steps, rule } => {
                let plan = Plan { steps, every: *every, origin: given.time };
                let mut record = |motion: &mut dyn Motion<N>| ran = Record::of(motion, &plan, watch);
                let Offer { steps, driven, .. } = offered::<S, N>(rule)?;
                let has_one_input = given.inputs.len() == S::Fields::INPUTS;
                let given = Self::given(given);
                if has_one_input && !is_differentiated {
                    let steps = steps.ok_or(Refusal::Rule)?;
                    steps.run(&self.fields, given, h, &start, watched.take(), &mut record);
                } else if watched.is_some() {
                    return Err(Refusal::NotWatched);
                } else {
                    let driven = driven.ok_or(Refusal::NotDriven)?;
                    driven.run(&self.fields, given, h, &start, *is_differentiated, &mut record);
                }
            }
            Stepping::ToError(asked) if *is_tried => {
                let steps = S::steps_to_error().ok_or(Refusal::NoError)?;
                let mut record = |motion: &mut dyn Motion<N>, steps| {
                    let plan = Plan { steps, every: *every, origin: given.time };
                    ran = Record::of(motion, &plan, watch);
                    if let (_, Some(Stop::Failed(failure))) = &ran { Some(failure.error) } else { None }
                };
                let given = Self::given(given);
                let tried = steps.tried(&self.fields, given, asked, &start, &mut events, &mut record, told);
                // A run that was called off says nothing of its error.
                if !matches!(ran.1, Some(Stop::Interrupted | Stop::TooLarge(_))) {
                    tried.map_err(Refusal::from)?;
                }
            }
            Stepping::ToError(asked) => {
                let steps = S::steps_to_error().ok_or(Refusal::NoError)?;
                let mut record = |motion: &mut dyn Motion<N>, steps| {
                    let plan = Plan { steps, every: *every, origin: given.time };
                    ran = Record::of(motion, &plan, watch);
                };
                let given = Self::given(given);
                let run = steps.run(&self.fields, given, asked, &start, watched.take(), &mut record, told);
                guarded = Some(run?);
            }
        }
        let (record, stop) = ran;
        let stop = stop.or_else(|| events.error.take().map(Stop::Events));
        Ok(Ran { record, stop, guarded, events: events.found })
    }

    fn linearized(&self, start: &Start<'_>, h: f64, rule: Option<&str>) -> Result<Linearized, Refusal> {
        let state = self.state(start)?;
        let given = Self::given(start);
        let linearized = match offered::<S, N>(rule)? {
            Offer { driven: Some(driven), .. } => driven.linearized(&self.fields, given, h, &state),
            Offer { differentiated: Some(steps), .. } => steps.linearized(&self.fields, given, h, &state),
            _ => return Err(Refusal::NotDriven),
        };
        let taken = linearized.map_err(|error| refused(start, error))?;
        let State { q, p } = taken.step.state;
        let end = [q, p].map(|vector| vector.as_slice().to_vec());
        Ok(Linearized { end, a: taken.a, b: taken.b, by_parameters: taken.by_parameters })
    }

    fn symmetries(
        &self,
        given: Given<'_>,
        h: f64,
        rule: Option<&str>,
        generators: &[Affine],
        region: &Region<'_>,
        watch: &Watch<'_>,
    ) -> Result<Vec<Symmetry>, Refusal> {
        let checks = offered::<S, N>(rule)?.checks.ok_or(Refusal::NotChecked)?;
        checks.symmetries(&self.fields, given, h, generators, region, watch)
    }

    fn ledger(
        &self,
        start: &Start<'_>,
        h: f64,
        rule: Option<&str>,
        steps: u64,
        watch: &Watch<'_>,
    ) -> Result<Ledger, Refusal> {
        let state = self.state(start)?;
        let checks = offered::<S, N>(rule)?.checks.ok_or(Refusal::NotChecked)?;
        checks.ledger(&self.fields, Self::given(start), h, &state, steps, watch)
    }

    fn kept(&self, asked: &Asked<'_>, control: &Control) -> Result<Kept, NoResult> {
        many::kept::<S, N>(&self.fields, asked, control)
    }

    fn written(
        &self,
        asked: &Asked<'_>,
        control: &Control,
        folder: &Path,
        members_per_part: u64,
    ) -> Result<Written, NoResult> {
        many::written::<S, N>(&self.fields, asked, control, folder, members_per_part)
    }

    fn energies(
        &self,
        times: &[f64],
        q: &[f64],
        motion: MotionGiven<'_>,
        watch: &Watch<'_>,
    ) -> Result<Vec<f64>, Refusal> {
        let inputs = vec![0.0; S::Fields::INPUTS];
        let vector = SVector::<f64, N>::from_column_slice;
        let (MotionGiven::Velocity(other) | MotionGiven::Momentum(other)) = motion;
        let states = q.chunks_exact(N).zip(other.chunks_exact(N)).enumerate();
        let energy = |(k, (q, other)): (usize, (&[f64], &[f64]))| {
            if (k as u64).is_multiple_of(Told::STRIDE) && watch.is_called_off() {
                return Err(Refusal::CalledOff);
            }
            let (given, q) = (q, vector(q));
            let time = times.get(k).or(times.first()).copied().unwrap_or(0.0);
            let system = S::view(&self.fields, &inputs, time);
            match motion {
                MotionGiven::Velocity(_) => Ok(system.energy(&q, &vector(other))),
                MotionGiven::Momentum(_) => measured(&system, &State { q, p: vector(other) })
                    .map(|(_, energy)| energy)
                    .map_err(|error| {
                        let state = [given, other].map(<[f64]>::to_vec);
                        Refusal::Start(Failure { error, step: 0, time, state })
                    }),
            }
        };
        states.map(energy).collect()
    }
}
