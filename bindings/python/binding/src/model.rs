//! Systems without their types: what the classes of Python call.

use core::marker::PhantomData;
use std::path::Path;

use dalembert::nalgebra::SVector;
use dalembert::run::Stop as Told;
use dalembert::system::Structure;
use dalembert::{Lagrangian, State, StepError};
use dalembert_face::{Described, Field, Fields, Holding, Number, WrongPoints};

use crate::checks::{Affine, Ledger, Region, Symmetry};
use crate::events::{Event, Events};
use crate::look::Look;
use crate::many::{self, Asked, Control, Kept, NoResult, Written};
use crate::motion::{Along, Given, Motion, measured};
use crate::offer::{Offer, Offers, Stepping};
use crate::record::{Failure, Guarded, Plan, Record, Recorded, Stop};
use crate::refusal::Refusal;
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
    /// The number of constraints.
    fn constraints(&self) -> usize;
    /// The number of event functions that its block states.
    fn events(&self) -> usize;
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
    /// Gives field `field` other numbers.
    ///
    /// # Errors
    /// [`WrongPoints`]: the field is then as before.
    fn change_field(&mut self, field: usize, numbers: &[Number]) -> Result<(), WrongPoints>;

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
    fn kept(&self, asked: &Asked<'_>, control: &Control<'_>) -> Result<Kept, NoResult>;

    /// Records of many members, as files.
    ///
    /// # Errors
    /// Why they are not all there.
    fn written(
        &self,
        asked: &Asked<'_>,
        control: &Control<'_>,
        folder: &Path,
        members_per_part: u64,
    ) -> Result<Written, NoResult>;

    /// The configurations and velocities on all constraints that are nearest to those given, one after the
    /// other, at one time or each at its own.
    ///
    /// # Errors
    /// The first that fails.
    fn nearest(
        &self,
        times: &[f64],
        motion: [&[f64]; 2],
        watch: &Watch<'_>,
    ) -> Result<[Vec<f64>; 2], Refusal>;

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

/// A run that is asked for.
#[derive(Debug)]
pub struct Run<'a> {
    /// Where it starts.
    pub start: Start<'a>,
    /// Its steps.
    pub stepping: Stepping<'a>,
    /// The states that are recorded.
    pub recorded: Recorded<'a>,
    /// Questions that it answers along its way.
    pub along: Along,
    /// Events to look for on the way.
    pub events: &'a [Event<'a>],
}

/// The records of a run, whole or up to where it stopped.
#[derive(Clone, Debug)]
pub struct Ran {
    /// The records.
    pub record: Record,
    /// Why there are no more.
    pub stop: Option<Stop>,
    /// The choice made for the tolerance, and where the run passed it.
    pub guarded: Option<Guarded>,
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
struct ModelOf<S: Offers<N>, const N: usize> {
    fields: S::Fields,
}

impl<S: Offers<N>, const N: usize> Kind for KindOf<S, N> {
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

    fn constraints(&self) -> usize {
        S::Fields::CONSTRAINTS
    }

    fn events(&self) -> usize {
        S::Fields::EVENTS
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

impl<S: Offers<N>, const N: usize> ModelOf<S, N> {
    fn given<'a>(start: &Start<'a>) -> Given<'a> {
        Given { inputs: start.inputs, time: start.time }
    }

    /// The system as the run begins.
    fn view(&self, start: &Start<'_>) -> S::View<'_> {
        S::view(&self.fields, &start.inputs[..S::Fields::INPUTS], start.time)
    }

    fn state(&self, start: &Start<'_>) -> Result<State<f64, N>, Refusal> {
        let q = SVector::from_column_slice(start.q);
        let state = match start.motion {
            MotionGiven::Velocity(v) => {
                State::from_velocity(&self.view(start), q, SVector::<f64, N>::from_column_slice(v))
            }
            MotionGiven::Momentum(p) => Ok(State { q, p: SVector::from_column_slice(p) }),
        };
        state.map_err(|error| refused(start, error))
    }
}

fn refused(start: &Start<'_>, error: StepError) -> Refusal {
    let p = if let MotionGiven::Momentum(p) = start.motion { p } else { &[] };
    Refusal::Start(Failure { error, step: 0, time: start.time, state: [start.q, p].map(<[f64]>::to_vec) })
}

impl<S: Offers<N>, const N: usize> Model for ModelOf<S, N> {
    fn kind(&self) -> &'static dyn Kind {
        &KindOf::<S, N>(PhantomData)
    }

    fn copy(&self) -> Box<dyn Model> {
        Box::new(Self { fields: self.fields })
    }

    fn entry(&self, field: usize, index: usize) -> Option<Number> {
        self.fields.entry(field, index)
    }

    fn change_field(&mut self, field: usize, numbers: &[Number]) -> Result<(), WrongPoints> {
        self.fields = self.fields.with_field(field, numbers)?;
        Ok(())
    }

    fn run(&self, run: &Run<'_>, watch: &Watch<'_>) -> Result<Ran, Refusal> {
        let Run { start: given, stepping, recorded, along, events: asked } = run;
        let start = self.state(given)?;
        let origin = given.time;
        let events = (!asked.is_empty()).then_some(Events { asked, origin });
        let look = Look { events, is_dense: matches!(recorded, Recorded::At(_)), end: None };
        let mut ran = (Record::default(), None);
        let ends_by_itself = matches!(stepping, Stepping::Fixed { end: Some(_), .. });
        let mut record = |motion: &mut dyn Motion<N>, steps| {
            let plan = Plan { steps, ends_by_itself, recorded: *recorded, origin, events: asked.len() };
            ran = Record::of(motion, &plan, watch);
        };
        let mut guarded = None;
        match *stepping {
            Stepping::Fixed { h, steps: count, end, rule } => {
                let mut record = |motion: &mut dyn Motion<N>| record(motion, count);
                let Offer { steps, driven, .. } = S::offered(rule)?;
                let look = Look { end, ..look };
                if given.inputs.len() == S::Fields::INPUTS && !along.is_any() {
                    let steps = steps.ok_or(Refusal::Rule)?;
                    steps.run(&self.view(given), h, &start, look, &mut record);
                } else if look.is_any() {
                    return Err(Refusal::NotWatched);
                } else {
                    let driven = driven.ok_or(Refusal::NotDriven)?;
                    let given = Self::given(given);
                    driven.run(&self.fields, given, h, &start, *along, &mut record);
                }
            }
            Stepping::ToError(asked) => {
                let steps = S::to_error()?;
                let is_called_off = || watch.is_called_off();
                let told = Told::when(&is_called_off);
                let run = steps.run(&self.view(given), asked, &start, look, &mut record, told);
                guarded = Some(run?);
            }
        }
        let (record, stop) = ran;
        Ok(Ran { record, stop, guarded })
    }

    fn linearized(&self, start: &Start<'_>, h: f64, rule: Option<&str>) -> Result<Linearized, Refusal> {
        let state = self.state(start)?;
        let system = self.view(start);
        let linearized = match S::offered(rule)? {
            Offer { driven: Some(driven), .. } => driven.linearized(&system, h, &state),
            Offer { steps, .. } => steps.ok_or(Refusal::Rule)?.linearized(&system, h, &state),
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
        let checks = S::offered(rule)?.checks.ok_or(Refusal::NotChecked)?;
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
        let checks = S::offered(rule)?.checks.ok_or(Refusal::NotChecked)?;
        checks.ledger(&self.fields, Self::given(start), h, &state, steps, watch)
    }

    fn kept(&self, asked: &Asked<'_>, control: &Control<'_>) -> Result<Kept, NoResult> {
        many::kept::<S, N>(&self.fields, asked, control)
    }

    fn written(
        &self,
        asked: &Asked<'_>,
        control: &Control<'_>,
        folder: &Path,
        members_per_part: u64,
    ) -> Result<Written, NoResult> {
        many::written::<S, N>(&self.fields, asked, control, folder, members_per_part)
    }

    fn nearest(
        &self,
        times: &[f64],
        [q, v]: [&[f64]; 2],
        watch: &Watch<'_>,
    ) -> Result<[Vec<f64>; 2], Refusal> {
        let inputs = vec![0.0; S::Fields::INPUTS];
        let vector = SVector::<f64, N>::from_column_slice;
        let mut found = [q, v].map(|given| Vec::with_capacity(given.len()));
        for (k, (q, v)) in q.chunks_exact(N).zip(v.chunks_exact(N)).enumerate() {
            if (k as u64).is_multiple_of(Told::STRIDE) && watch.is_called_off() {
                return Err(Refusal::CalledOff);
            }
            let time = times.get(k).or(times.first()).copied().unwrap_or(0.0);
            let system = S::view(&self.fields, &inputs, time);
            let state = S::Multipliers::nearest(&system, vector(q), vector(v));
            let motion = state.and_then(|state| Ok([state.q, state.velocity(&system)?]));
            let motion = motion.map_err(|error| {
                let state = [q.to_vec(), Vec::new()];
                Refusal::Start(Failure { error, step: 0, time, state })
            })?;
            found.iter_mut().zip(motion).for_each(|(all, found)| all.extend_from_slice(found.as_slice()));
        }
        Ok(found)
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
