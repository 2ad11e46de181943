//! One instance: its variables, its run, and what is allowed when.

mod derivatives;
mod outputs;
mod reactions;
mod saved;

use std::rc::Rc;

use dalembert::run::DrivenTrajectory;
use dalembert::step::require_step_size;
use dalembert::system::Scalar;
use dalembert::{Lagrangian, State, nalgebra::SVector};
use dalembert_face::{Described, Field, Fields, Input, Interface, Number, WrongPoints};

use crate::Unit;
use crate::model::Model;
use crate::refusal::{Mode, Refusal};
use crate::variables::{self, Place, Role, Variable, number, type_name};

/// How far the importer's clock may be from the unit's, in steps: what sums of communication steps round to.
const DRIFT: f64 = 1e-3;
/// The part of a step below which what is left of a communication step is rounding.
const ROUNDING: f64 = 1e-6;

type Filled<I, const N: usize> = <<I as Interface<N>>::System as Fields>::Given;
type Run<I, const N: usize> = DrivenTrajectory<<I as Interface<N>>::Kind, <I as Interface<N>>::Rule, N>;

/// An instance of a unit.
pub struct CoSimulation<I: Interface<N>, const N: usize> {
    unit: &'static Unit<I, N>,
    variables: Rc<[Variable]>,
    mode: Mode,
    start_time: f64,
    step_size: I::Scalar,
    /// The fields as they were set.
    given: Filled<I, N>,
    /// The system that was last made of them.
    system: I::System,
    /// Why the points of a table make none.
    wrong: Option<WrongPoints>,
    input: Vec<I::Scalar>,
    /// (q, v) that the run begins at, on constraints at the nearest that is on them.
    start: [[I::Scalar; N]; 2],
    /// From the end of initialization on.
    run: Option<Run<I, N>>,
    /// The last communication step, while neither state nor parameters were set since.
    last: Option<Communication<I, N>>,
    /// λ of the last step; nothing before the first.
    reactions: Vec<I::Scalar>,
}

/// (q, p) and v.
type Motion<S, const N: usize> = (State<S, N>, SVector<S, N>);

/// Where a communication step began, and what it was taken with.
struct Communication<I: Interface<N>, const N: usize> {
    before: Run<I, N>,
    system: I::System,
    input: Vec<I::Scalar>,
    lengths: Lengths<I::Scalar>,
}

/// The steps of a communication step: so many of h, and a shorter one with what is left.
#[derive(Clone, Copy)]
struct Lengths<S> {
    h: S,
    whole: u64,
    rest: Option<S>,
}

impl<S: Scalar> Lengths<S> {
    /// Of a communication step of this size; nothing where it is none.
    fn of(size: f64, h: S) -> Option<Self> {
        let steps = size / h.widen();
        let whole = (steps + ROUNDING).floor();
        let rest = (steps - whole > ROUNDING).then(|| S::constant(size - whole * h.widen()));
        let is_some = steps > ROUNDING && whole <= f64::from(u32::MAX);
        is_some.then_some(Self { h, whole: whole as u64, rest })
    }

    /// Each of them.
    fn each(self) -> impl Iterator<Item = S> {
        (0..self.whole).map(move |_| self.h).chain(self.rest)
    }
}

impl<I: Interface<N>, const N: usize> Clone for Communication<I, N> {
    fn clone(&self) -> Self {
        Self {
            before: self.before.clone(),
            system: self.system,
            input: self.input.clone(),
            lengths: self.lengths,
        }
    }
}

impl<I: Interface<N>, const N: usize> Clone for CoSimulation<I, N> {
    fn clone(&self) -> Self {
        Self {
            unit: self.unit,
            variables: self.variables.clone(),
            mode: self.mode,
            start_time: self.start_time,
            step_size: self.step_size,
            given: self.given,
            system: self.system,
            wrong: self.wrong,
            input: self.input.clone(),
            start: self.start,
            run: self.run.clone(),
            last: self.last.clone(),
            reactions: self.reactions.clone(),
        }
    }
}

impl<I: Interface<N>, const N: usize> CoSimulation<I, N> {
    pub fn new(unit: &'static Unit<I, N>) -> Self {
        Self::begun(unit, variables::of(unit).into())
    }

    fn begun(unit: &'static Unit<I, N>, variables: Rc<[Variable]>) -> Self {
        Self {
            unit,
            variables,
            mode: Mode::Instantiated,
            start_time: 0.0,
            step_size: unit.step_size,
            given: unit.parameters.given(),
            system: unit.parameters,
            wrong: None,
            input: vec![I::Scalar::constant(0.0); I::System::INPUTS],
            start: unit.start,
            run: None,
            last: None,
            reactions: Vec::new(),
        }
    }

    fn variable(&self, reference: u32) -> Result<&Variable, Refusal> {
        self.variables.get(reference as usize).ok_or(Refusal::NoVariable(reference))
    }

    /// `input` and the time, as the system takes them.
    fn given(input: &[I::Scalar], time: f64) -> (I::Input, I::Scalar) {
        let input = I::Input::of(input).expect("as many inputs as the unit has");
        (input, I::Scalar::constant(time))
    }

    fn without_input(&self) -> (I::Input, I::Scalar) {
        Self::given(&vec![I::Scalar::constant(0.0); self.input.len()], self.time())
    }

    /// The system without an input, now: what velocities, momenta and energy are asked of.
    fn undriven(&self) -> I::View<'_> {
        let (input, time) = self.without_input();
        I::view(&self.system, input, time)
    }

    /// (q, p) and v.
    fn motion(&self) -> Result<Motion<I::Scalar, N>, Refusal> {
        if let Some(wrong) = self.wrong {
            return Err(Refusal::Points(wrong));
        }
        let system = self.undriven();
        let motion = match &self.run {
            Some(run) => run.state().velocity(&system).map(|v| (*run.state(), v)),
            None => I::nearest(&system, self.start).and_then(|state| match I::System::CONSTRAINTS {
                0 => Ok((state, self.start[1].into())),
                _ => state.velocity(&system).map(|v| (state, v)),
            }),
        };
        motion.map_err(|error| Refusal::Step { error, time: self.time() })
    }

    /// Whether q and v are as they were set, as long as nothing follows from them.
    fn is_as_set(&self) -> bool {
        let is_solved_for = I::System::CONSTRAINTS > 0 && self.mode == Mode::Initialization;
        self.run.is_none() && !is_solved_for
    }

    fn require(&self, mode: Mode) -> Result<(), Refusal> {
        if self.mode == mode { Ok(()) } else { Err(Refusal::NotNow(self.mode)) }
    }

    /// Changes a number of a field, a table's in what is given alone; returns whether it was another.
    fn change_parameter(&mut self, field: usize, index: usize, value: Number) -> bool {
        let before = self.given.entry(field, index);
        self.given.change_entry(field, index, value);
        self.system.change_entry(field, index, value);
        before != Some(value)
    }

    /// Makes the tables, unless all are given as they were `before`: those of the unit have the bits that it
    /// was packed with.
    fn make_tables(&mut self, before: &Self) {
        let tables = I::System::FIELDS.iter().enumerate().filter(|(_, field)| field.is_table);
        let points = |(field, of): (usize, &Field)| {
            let count: usize = of.dimensions.iter().product();
            (0..count).map(move |index| (field, index))
        };
        let mut entries = tables.flat_map(points);
        if entries.all(|(field, index)| self.given.entry(field, index) == before.given.entry(field, index)) {
            return;
        }
        match I::System::of(&self.given) {
            Ok(system) => (self.system, self.wrong) = (system, None),
            Err(wrong) => self.wrong = Some(wrong),
        }
    }

    fn set_value(&mut self, reference: u32, value: Number) -> Result<(), Refusal> {
        let variables = self.variables.clone();
        let variable = variables.get(reference as usize).ok_or(Refusal::NoVariable(reference))?;
        let name = || variable.name.clone();
        if type_name(value) != type_name(variable.start) {
            return Err(Refusal::AnotherType { name: name(), kind: type_name(variable.start) });
        }
        let before_the_run = matches!(self.mode, Mode::Instantiated | Mode::Initialization);
        let settable = match variable.role {
            Role::Independent | Role::Calculated => false,
            Role::Fixed | Role::Exact | Role::Approximate => before_the_run,
            Role::Tunable | Role::Input => self.mode != Mode::Terminated,
        };
        if !settable {
            return Err(Refusal::NotSettable { name: name(), mode: self.mode });
        }
        let scalar = match value {
            Number::F64(value) => value,
            Number::F32(value) => value.into(),
            _ => 0.0,
        };
        let is_parameter = matches!(variable.place, Place::Parameter { .. });
        if scalar.is_nan() || scalar.is_infinite() && !is_parameter {
            return Err(Refusal::NotFinite { name: name() });
        }
        let scalar = I::Scalar::constant(scalar);
        match variable.place {
            Place::Parameter { field, index } => {
                // Importers set again what has not changed.
                if self.change_parameter(field, index, value) {
                    // What the run remembers is of the system before.
                    self.run = self.run.take().map(|run| DrivenTrajectory::resume(run.present()));
                    self.last = None;
                }
            }
            Place::StepSize if scalar.widen() <= 0.0 => return Err(Refusal::StepSize(scalar.widen())),
            Place::StepSize => self.step_size = scalar,
            Place::Input(i) => self.input[i] = scalar,
            Place::Configuration(i) => self.start[0][i] = scalar,
            Place::Velocity(i) => self.start[1][i] = scalar,
            Place::Time | Place::Momentum(_) | Place::Energy | Place::Multiplier(_) | Place::Output(_) => {}
        }
        Ok(())
    }
}

impl<I: Interface<N>, const N: usize> Model for CoSimulation<I, N> {
    fn time(&self) -> f64 {
        self.start_time + self.run.as_ref().map_or(0.0, DrivenTrajectory::time)
    }

    fn kinds(&self, references: &[u32]) -> Result<Vec<Number>, Refusal> {
        references.iter().map(|&reference| self.variable(reference).map(|variable| variable.start)).collect()
    }

    fn values(&self, references: &[u32]) -> Result<Vec<Number>, Refusal> {
        let (mut motion, mut multipliers, mut outputs) = (None, None, None);
        let mut values = Vec::with_capacity(references.len());
        for &reference in references {
            let variable = self.variable(reference)?;
            values.push(match variable.place {
                Place::Time => Number::F64(self.time()),
                Place::StepSize => number(self.step_size),
                Place::Parameter { field, index } => {
                    self.given.entry(field, index).expect("variables are listed from the fields")
                }
                Place::Input(i) => number(self.input[i]),
                Place::Configuration(i) if self.is_as_set() => number(self.start[0][i]),
                Place::Velocity(i) if self.is_as_set() => number(self.start[1][i]),
                Place::Multiplier(i) => {
                    if multipliers.is_none() {
                        multipliers = Some(self.multipliers()?);
                    }
                    number(multipliers.as_deref().unwrap_or_default()[i])
                }
                of_motion => {
                    let (state, v) = match motion {
                        Some(motion) => motion,
                        None => *motion.insert(self.motion()?),
                    };
                    number(match of_motion {
                        Place::Configuration(i) => state.q[i],
                        Place::Velocity(i) => v[i],
                        Place::Momentum(i) => state.p[i],
                        Place::Output(i) => {
                            let all = outputs.get_or_insert_with(|| self.outputs(&state.q, &v));
                            self.output(variable, all[i])?
                        }
                        _ => self.undriven().energy(&state.q, &v),
                    })
                }
            });
        }
        Ok(values)
    }

    fn set_values(&mut self, references: &[u32], values: &[Number]) -> Result<(), Refusal> {
        if references.len() != values.len() {
            return Err(Refusal::Lengths { asked: references.len(), given: values.len() });
        }
        let mut changed = self.clone();
        for (&reference, &value) in references.iter().zip(values) {
            changed.set_value(reference, value)?;
        }
        changed.make_tables(self);
        *self = changed;
        Ok(())
    }

    fn enter_initialization(&mut self, start_time: f64) -> Result<(), Refusal> {
        self.require(Mode::Instantiated)?;
        if !start_time.is_finite() {
            return Err(Refusal::StartTime(start_time));
        }
        (self.mode, self.start_time) = (Mode::Initialization, start_time);
        Ok(())
    }

    fn exit_initialization(&mut self) -> Result<(), Refusal> {
        self.require(Mode::Initialization)?;
        require_step_size(self.step_size).map_err(|error| Refusal::Step { error, time: self.start_time })?;
        self.run = Some(Run::<I, N>::new(self.step_size, self.motion()?.0));
        self.mode = Mode::Step;
        Ok(())
    }

    fn step(&mut self, point: f64, size: f64) -> Result<(), Refusal> {
        self.require(Mode::Step)?;
        let (own, h) = (self.time(), self.step_size.widen());
        let is_here = (point - own).abs() <= DRIFT * h;
        if !is_here {
            return Err(Refusal::AnotherTime { given: point, own });
        }
        let lengths = Lengths::of(size, self.step_size).ok_or(Refusal::CommunicationStep(size))?;
        let mut run = self.run.clone().ok_or(Refusal::NotNow(self.mode))?;
        let mut made = None;
        for length in lengths.each() {
            made = Some(self.advance(&mut run, length)?);
        }
        if lengths.rest.is_some() {
            run.change_step_size(self.step_size);
        }
        let reactions = made.map(|(time, made)| self.reactions_of(time, &made)).transpose()?;
        self.reactions = reactions.unwrap_or_default();
        let (system, input) = (self.system, self.input.clone());
        let before = self.run.replace(run);
        self.last = before.map(|before| Communication { before, system, input, lengths });
        Ok(())
    }

    fn terminate(&mut self) -> Result<(), Refusal> {
        self.require(Mode::Step)?;
        self.mode = Mode::Terminated;
        Ok(())
    }

    fn reset(&mut self) {
        *self = Self::begun(self.unit, self.variables.clone());
    }

    fn directional_derivative(
        &self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, Refusal> {
        derivatives::along(self, unknowns, knowns, seed)
    }

    fn copy(&self) -> Box<dyn Model> {
        Box::new(self.clone())
    }

    fn bytes(&self) -> Vec<u8> {
        saved::bytes(self)
    }

    fn of_bytes(&self, bytes: &[u8]) -> Result<Box<dyn Model>, Refusal> {
        Ok(Box::new(saved::read(self, bytes)?))
    }
}
