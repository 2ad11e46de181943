//! Events of a run, whatever makes its steps: when functions of its motion vanish.

use core::fmt;

use dalembert::nalgebra::SVector;
use dalembert::run::Run;
use dalembert::run::between::{Divisible, Moment};
use dalembert::run::events::{Crossing, Event as Happened, EventError, Watch, Watched};
use dalembert::{Lagrangian, State, StepError};

use crate::between::{BySome, looked_at};
use crate::motion::{At, Motion, measured};

/// Most functions of one run.
pub const MOST: usize = 8;

/// An event function, of (t, q, v).
pub type Given<'a> = dyn Fn(f64, &[f64], &[f64]) -> f64 + Send + Sync + 'a;

/// A function whose zeros are events.
pub enum Function<'a> {
    /// a·q + b·v − c, of numbers alone: asked for without Python.
    Plane {
        /// a.
        q: Vec<f64>,
        /// b.
        v: Vec<f64>,
        /// c.
        value: f64,
    },
    /// |q − c|² − r², the sign of which is that of the distance from a sphere.
    Sphere {
        /// c.
        center: Vec<f64>,
        /// r.
        radius: f64,
    },
    /// The energy less a value.
    Energy(f64),
    /// One of those that the block of the system states.
    OfBlock(usize),
    /// Any other.
    Given(Box<Given<'a>>),
}

impl fmt::Debug for Function<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plane { q, v, value } => write!(f, "q·{q:?} + v·{v:?} = {value:?}"),
            Self::Sphere { center, radius } => write!(f, "|q − {center:?}| = {radius:?}"),
            Self::Energy(value) => write!(f, "energy = {value:?}"),
            Self::OfBlock(index) => write!(f, "event function {index} of the block"),
            Self::Given(_) => f.write_str("a function"),
        }
    }
}

/// A function, and which of its zeros count.
#[derive(Debug)]
pub struct Event<'a> {
    /// The function.
    pub function: Function<'a>,
    /// In which direction it passes 0.
    pub crossing: Crossing,
    /// Whether the run ends there.
    pub is_terminal: bool,
}

/// The events of one function, one after the other.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Times.
    pub t: Vec<f64>,
    /// Configurations.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Momenta.
    pub p: Vec<f64>,
}

impl Found {
    /// One more, of a run that begins at the time `origin`.
    pub fn add<const N: usize>(&mut self, origin: f64, event: &Happened<f64, N>) {
        self.t.push(origin + event.time);
        self.q.extend_from_slice(event.state.q.as_slice());
        self.v.extend_from_slice(event.velocity.as_slice());
        self.p.extend_from_slice(event.state.p.as_slice());
    }
}

/// Events to be looked for along a run.
#[derive(Clone, Copy, Debug)]
pub struct Events<'a> {
    /// At most [`MOST`].
    pub asked: &'a [Event<'a>],
    /// The time at the start of the run.
    pub origin: f64,
}

/// A run that is watched, while it is recorded.
struct Watching<'t, 'r, 'e, L: Lagrangian<N, Scalar = f64>, G, const N: usize> {
    watch: Watch<'t, BySome<'r, L, N>, G, N, MOST>,
    asked: &'e [Event<'e>],
    /// Where a terminal event has ended the run.
    end: Option<(f64, State<f64, N>)>,
}

/// The value at (q, v) of an event function that the block of a system states.
pub(crate) type OfBlock<L, const N: usize> = fn(&L, &SVector<f64, N>, &SVector<f64, N>, usize) -> f64;

/// [`OfBlock`] of a system; NaN where there are not so many.
pub(crate) fn of_block<E, L, const N: usize>(
    system: &L,
    q: &SVector<f64, N>,
    v: &SVector<f64, N>,
    index: usize,
) -> f64
where
    E: dalembert_face::Events<L, N>,
    L: Lagrangian<N, Scalar = f64>,
{
    E::values(system, q, v).as_ref().get(index).copied().unwrap_or(f64::NAN)
}

/// Records `run` while it is watched for events.
pub(crate) fn watched<L, const N: usize>(
    run: &mut BySome<'_, L, N>,
    Events { asked, origin }: Events<'_>,
    of_block: OfBlock<L, N>,
    record: &mut dyn FnMut(&mut dyn Motion<N>),
) where
    L: Lagrangian<N, Scalar = f64>,
{
    let functions = |at: &Moment<'_, L, N>| {
        let mut values = [1.0; MOST];
        let mut velocity = None;
        for (value, Event { function, .. }) in values.iter_mut().zip(asked) {
            let mut v = || *velocity.get_or_insert_with(|| at.velocity());
            *value = match function {
                Function::Plane { q, v: by_v, value } => {
                    let of_v = if by_v.is_empty() { 0.0 } else { dot(by_v, v().as_slice()) };
                    dot(q, at.q.as_slice()) + of_v - value
                }
                Function::Sphere { center, radius } => {
                    let squares = center.iter().zip(at.q.as_slice()).map(|(c, q)| (q - c) * (q - c));
                    squares.sum::<f64>() - radius * radius
                }
                Function::Energy(value) => at.ask(|system| system.energy(&at.q, &v())) - value,
                Function::OfBlock(index) => at.ask(|system| of_block(system, &at.q, &v(), *index)),
                Function::Given(function) => function(origin + at.time, at.q.as_slice(), v().as_slice()),
            };
        }
        values
    };
    let mut crossings = [Crossing::Either; MOST];
    crossings.iter_mut().zip(asked).for_each(|(crossing, event)| *crossing = event.crossing);
    let watch = Watch::new(run, functions).crossing(crossings);
    record(&mut Watching { watch, asked, end: None });
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<L, G, const N: usize> Motion<N> for Watching<'_, '_, '_, L, G, N>
where
    L: Lagrangian<N, Scalar = f64>,
    G: Fn(&Moment<'_, L, N>) -> [f64; MOST],
{
    fn advance(&mut self) -> Option<Result<Watched<f64, N>, EventError>> {
        if self.end.is_some() {
            return None;
        }
        let next = self.watch.advance()?;
        if let Ok(Watched::Event(event)) = &next
            && self.asked.get(event.index).is_some_and(|asked| asked.is_terminal)
        {
            self.end = Some((event.time, event.state));
        }
        Some(next)
    }

    fn state(&self) -> &State<f64, N> {
        self.end.as_ref().map_or_else(|| Run::state(self.watch.run()), |(_, state)| state)
    }

    fn time(&self) -> f64 {
        self.end.map_or_else(|| Run::time(self.watch.run()), |(time, _)| time)
    }

    fn measured(&self) -> Result<(SVector<f64, N>, f64), StepError> {
        let run = self.watch.run();
        Divisible::system(run)
            .later(self.time() - Divisible::since(run), |system| measured(system, self.state()))
    }

    fn at(&self, time: f64) -> Option<Result<At<N>, StepError>> {
        let dense = self.watch.dense();
        // The step of a terminal event goes further.
        let is_past_end = self.end.is_some_and(|(end, _)| match Divisible::step_size(dense.run()) {
            h if h < 0.0 => time < end,
            _ => time > end,
        });
        if is_past_end { None } else { looked_at(dense, time) }
    }
}
