//! What is done with a system: steps, runs of them, and what is asked of steps.

use dalembert::derivative::PhaseMatrix;
use dalembert::nalgebra::{ComplexField, SVector};
use dalembert::step::{BoundedFlow, Flow, Fused, Linearizable, Step};
use dalembert::system::Scalar;
use dalembert::{Composition, Discrete, Discretise, Lagrangian, Midpoint, State, StepError, Trajectory};

use crate::numbers::Bytes;
use crate::promise;
use crate::systems::Counted;

/// Most evaluations of L in one step: 100 iterations, each shortened by at least half down to ε², with a look
/// at rounding.
const EVALUATIONS: u32 = 100 * (104 + 16 + 16);

/// Most coordinates of a system here.
const MOST: usize = 8;

/// Where a system is stepped from, and how.
#[derive(Debug)]
pub struct Exercise {
    q: [f64; MOST],
    p: [f64; MOST],
    guess: Option<[f64; MOST]>,
    h: f64,
    /// Which of the costlier questions are asked.
    asked: u8,
}

/// The bits of a state, which tell NaN from NaN.
fn bits<S: Scalar, const N: usize>(state: &State<S, N>) -> [[u64; N]; 2] {
    [&state.q, &state.p].map(|vector| std::array::from_fn(|i| vector[i].widen().to_bits()))
}

fn vector<S: Scalar, const N: usize>(of: &[f64; MOST]) -> SVector<S, N> {
    SVector::from_fn(|i, _| S::constant(of[i]))
}

impl Exercise {
    pub fn new(bytes: &mut Bytes<'_>) -> Self {
        let (h, has_guess, asked) = (bytes.number(), bytes.byte() % 4 == 0, bytes.byte());
        Self { h, asked, q: bytes.numbers(), p: bytes.numbers(), guess: has_guess.then(|| bytes.numbers()) }
    }

    fn asks(&self, question: u8) -> bool {
        self.asked & (1 << question) != 0
    }

    /// A rule whose step solves 𝔽⁻ for v̄ itself.
    pub fn by_rule<L, R, const N: usize>(&self, system: &L, rule: R)
    where
        L: Fused<R, N> + Linearizable<R, N> + BoundedFlow<R, N>,
        R: Copy,
    {
        let (state, guess) = (self.state(), self.guess.as_ref().map(vector));
        let h = L::Scalar::constant(self.h);
        if let Some(step) = self.by_any_rule(system, rule) {
            promise::solved::<L, R, N>(system, &state, h, &step);
        }
        let iterations = u32::from(self.asked >> 5);
        if self.asks(0)
            && let Ok(bounded) =
                BoundedFlow::<R, N>::step_within(system, &state, h, guess.as_ref(), iterations)
        {
            assert!(bounded.step.state.q.iter().chain(&bounded.step.state.p).all(|entry| entry.is_finite()));
        }
    }

    /// A rule that may solve for stages between; the step taken.
    pub fn by_any_rule<L, R, const N: usize>(&self, system: &L, rule: R) -> Option<Step<L::Scalar, N>>
    where
        L: Linearizable<R, N>,
        R: Copy,
    {
        let h = L::Scalar::constant(self.h);
        let (state, guess) = (self.state(), self.guess.as_ref().map(vector));
        let by = system.by(rule, h);
        let step = guess.map_or(by, |guess| by.near(&guess)).step(&state);
        match &step {
            Ok(step) => {
                assert!(guess.is_none_or(|guess| guess.iter().all(|entry| entry.is_finite())));
                promise::finite(&state, h, step);
                let (q0, q1) = (&state.q, &step.state.q);
                let _ = by.certificate(&state, step);
                let _ = by.segment(q0, q1).and_then(|segment| segment.linearized()?.by_state());
                let _ = PhaseMatrix::to_velocity(system, q0, &step.velocity);
                let _ = by.step_configurations(q0, q1);
                if let Ok(segment) = by.segment(q0, q1) {
                    let _ = (segment.discrete_force_derivatives(), segment.energy());
                }
            }
            // Says something, whatever its numbers are.
            Err(error) => assert!(!error.to_string().is_empty()),
        }
        if self.asks(1) {
            let _ = (state.velocity(system), state.energy(system));
            let made = State::from_velocity(system, state.q, state.p);
            assert!(made.is_err() || made.is_ok_and(|made| made.p.iter().all(|entry| entry.is_finite())));
        }
        self.trajectory(system, rule, state);
        step.ok()
    }

    /// Nine substeps of the midpoint rule, of which some go backwards.
    pub fn composed<L: Discrete<Midpoint, N>, const N: usize>(&self, system: &L) {
        if self.asks(2) {
            let six = Composition::kahan_li_6(Midpoint);
            self.trajectory::<L, Composition<Midpoint, 9>, N>(system, six, self.state());
        }
    }

    fn state<S: Scalar, const N: usize>(&self) -> State<S, N> {
        State { q: vector(&self.q), p: vector(&self.p) }
    }

    /// Some steps, a change of step size where one fails, and the same again from a checkpoint.
    fn trajectory<L, M, const N: usize>(&self, system: &L, method: M, state: State<L::Scalar, N>)
    where
        L: Flow<M, N>,
        M: Copy,
    {
        let mut h = L::Scalar::constant(self.h);
        let mut run = system.by(method, h).run(state);
        for _ in 0..8 {
            let (before, time) = (*run.state(), run.time());
            let step = if self.asks(3) {
                run.next_in_parts(3).map(|parted| parted.step)
            } else {
                run.next().expect("no step has failed")
            };
            match step {
                Ok(step) => {
                    assert_eq!(bits(run.state()), bits(&step.state));
                    if !self.asks(3) {
                        promise::finite(&before, h, &step);
                    }
                }
                Err(error) => {
                    let now = (bits(run.state()), run.time().to_bits());
                    assert_eq!(now, (bits(&before), time.to_bits()), "{error}");
                    assert!(run.next().is_none(), "{error}");
                    h *= L::Scalar::constant(0.5);
                    run.change_step_size(h);
                }
            }
        }
        let mut resumed = Trajectory::resume(system, method, run.checkpoint());
        for _ in 0..2 {
            let seen = |step: Option<Result<Step<L::Scalar, N>, StepError>>| match step {
                Some(Ok(step)) => format!("{:?}", bits(&step.state)),
                other => format!("{other:?}"),
            };
            assert_eq!(seen(run.next()), seen(resumed.next()));
        }
    }

    /// A step ends after a fixed number of evaluations, whatever comes.
    pub fn bounded_work(&self, system: &Counted) {
        let state = State::<f64, 1> { q: vector(&self.q), p: vector(&self.p) };
        let guess = self.guess.as_ref().map(vector);
        Counted::evaluations();
        let step = Flow::<Midpoint, 1>::step(system, &state, self.h, guess.as_ref());
        let evaluations = Counted::evaluations();
        assert!(evaluations <= EVALUATIONS, "{evaluations} evaluations: {step:?}");
        if let Ok(step) = step {
            promise::finite(&state, self.h, &step);
            promise::solved::<_, Midpoint, 1>(system, &state, self.h, &step);
        }
        let _ = system.energy(&state.q, &state.p);
    }
}
