//! Random sequences of calls, right and wrong, against the run in Rust: every status foreseen, every state
//! bit by bit.

use core::ptr::null_mut;

use dalembert::run::DrivenTrajectory;
use dalembert::{Midpoint, State, StepError};
use dalembert_c::{CReport, Status};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::systems::{CartPole, DrivenCartPole, cart_pole};
use crate::{Memory, bits, bytes};

const SEQUENCES: u64 = if cfg!(miri) { 20 } else { 4000 };

/// What has been done to a run, to be done again.
#[derive(Clone, Copy)]
enum Deed {
    Step(f64),
    Linearized(f64),
    State([f64; 2], [f64; 2]),
    Parameters(CartPole),
    StepSize(f64),
}

type Run = DrivenTrajectory<DrivenCartPole<'static>, Midpoint, 2>;

/// The run in Rust that the memory stands for.
struct Oracle {
    system: CartPole,
    run: Run,
    start: (CartPole, f64, State<f64, 2>),
    deeds: Vec<Deed>,
}

impl Oracle {
    fn new(system: CartPole, h: f64, q: [f64; 2], v: [f64; 2]) -> Result<Self, StepError> {
        let start = State::from_velocity(&system.driven([0.0]), q, v)?;
        Ok(Self { system, run: Run::new(h, start), start: (system, h, start), deeds: Vec::new() })
    }

    fn act(&mut self, deed: Deed) -> Result<Option<[f64; 5]>, StepError> {
        let mut derivatives = None;
        match deed {
            Deed::Step(u) => drop(self.run.advance(&self.system.driven([u]))?),
            Deed::Linearized(u) => {
                let view = self.system.driven([u]);
                let taken = self.run.advance_linearized(&view)?;
                let (a, b) = (taken.by_state()?, taken.by_input::<1>()?);
                derivatives = Some([a.q_by_q[(0, 1)], a.q_by_p[(1, 0)], a.p_by_q[(1, 1)], b.q[1], b.p[0]]);
            }
            Deed::State(q, p) => self.run.correct(State { q: q.into(), p: p.into() }),
            Deed::Parameters(system) => {
                self.system = system;
                self.run = Run::resume(self.run.checkpoint());
            }
            Deed::StepSize(h) => self.run.change_step_size(h),
        }
        Ok(derivatives)
    }

    /// Does it, or nothing: a run that failed may have forgotten its guess, and is made again.
    fn done(&mut self, deed: Deed) -> Result<Option<[f64; 5]>, Status> {
        match self.act(deed) {
            Ok(derivatives) => {
                self.deeds.push(deed);
                Ok(derivatives)
            }
            Err(error) => {
                let deeds = std::mem::take(&mut self.deeds);
                let (system, h, start) = self.start;
                (self.system, self.run) = (system, Run::new(h, start));
                for deed in deeds {
                    self.act(deed).expect("it was done before");
                    self.deeds.push(deed);
                }
                Err(error.into())
            }
        }
    }

    fn bits(&self) -> [u64; 4] {
        let State { q, p } = self.run.state();
        [q[0], q[1], p[0], p[1]].map(f64::to_bits)
    }
}

/// Random values, now and then such as no caller means.
struct Caller(StdRng);

impl Caller {
    fn often(&mut self) -> bool {
        self.0.random_bool(0.9)
    }

    fn number(&mut self) -> f64 {
        match self.0.random_range(0..60) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => 1e300,
            3 => 0.0,
            _ => self.0.random_range(-1.0..1.0),
        }
    }

    fn vector(&mut self) -> [f64; 2] {
        [self.number(), self.number()]
    }

    fn system(&mut self) -> CartPole {
        let mut positive = || self.number().abs();
        CartPole {
            cart: 0.5 + positive(),
            rod: 0.1 + positive(),
            half_length: 0.3 + positive(),
            friction: [positive(), positive()],
        }
    }

    /// The address of `value`, or one that is refused, and by what.
    fn address<T>(&mut self, value: &mut [T; 2], optional: bool) -> (*mut T, Option<Status>) {
        match self.0.random_range(0..24) {
            0 if optional => (null_mut(), None),
            0 => (null_mut(), Some(Status::NullPointer)),
            1 => (value.as_mut_ptr().wrapping_byte_add(1), Some(Status::Misaligned)),
            _ => (value.as_mut_ptr(), None),
        }
    }
}

fn finite(values: &[f64], otherwise: Status) -> Option<Status> {
    values.iter().any(|value| !value.is_finite()).then_some(otherwise)
}

fn step_size(h: f64) -> Option<Status> {
    (h == 0.0 || !h.is_finite()).then_some(Status::StepSize)
}

fn parameters(system: &CartPole) -> Option<Status> {
    let CartPole { cart, rod, half_length, friction } = *system;
    [cart, rod, half_length, friction[0], friction[1]]
        .iter()
        .any(|value| value.is_nan())
        .then_some(Status::ParameterNan)
}

/// One call, and the statuses that were foreseen: any of those of its wrong arguments, or that of the oracle.
fn call(caller: &mut Caller, memory: &mut Memory, oracle: &mut Option<Oracle>) -> (Status, Vec<Status>) {
    let at = memory.as_mut_ptr();
    let mut wrong = Vec::new();
    if oracle.is_none() {
        wrong.push(Status::NotInitialised);
    }
    let (u, after, h) = (caller.number(), caller.number(), 0.05 * caller.number());
    let (given_q, given_v, system) = (caller.vector(), caller.vector(), caller.system());
    let (mut q, mut p) = ([given_q, [0.0; 2]], [given_v, [0.0; 2]]);
    let mut reports = [CReport { time: 0.0, residual: 0.0, floor: 0.0, iterations: 0, damped: 0 }; 2];
    let (mut inputs, mut systems) = ([[u], [0.0]], [system; 2]);
    let mut linearized =
        [cart_pole::CLinearized { by_state: [[0.0; 4]; 4], by_input: [[0.0]; 4], by_parameters: [[]; 4] }; 2];
    // The rest of a call whose arguments are right.
    macro_rules! foreseen {
        ($status:expr, $deed:expr) => {{
            let status = $status;
            if wrong.is_empty() {
                match oracle.as_mut().expect("a run").done($deed) {
                    Ok(derivatives) => (status, vec![Status::Ok], derivatives),
                    Err(error) => (status, vec![error], None),
                }
            } else {
                (status, wrong, None)
            }
        }};
    }
    let (optional, required) = (true, false);
    let kind = caller.0.random_range(0..12);
    match kind {
        0 => {
            wrong.clear();
            let (size, layout) = (size_of::<Memory>(), cart_pole::HEADER.layout);
            let (size, layout) = (
                if caller.often() {
                    size
                } else {
                    wrong.push(Status::WrongMemory);
                    size - 1
                },
                layout,
            );
            let layout = if caller.often() {
                layout
            } else {
                wrong.push(Status::WrongMemory);
                layout ^ (1 << 40)
            };
            let (s, refused_s) = caller.address(&mut systems, required);
            let (q, refused_q) = caller.address(&mut q, required);
            let (v, refused_v) = caller.address(&mut p, required);
            wrong.extend(
                [refused_s, refused_q, refused_v, parameters(&system), step_size(h)].into_iter().flatten(),
            );
            wrong.extend(finite(&[given_q, given_v].concat(), Status::NotFinite));
            let status = unsafe { cart_pole::init_with(at, size, layout, s.cast(), h, q, v) };
            if !wrong.is_empty() {
                return (status, wrong);
            }
            match Oracle::new(system, h, given_q, given_v) {
                Ok(new) => {
                    *oracle = Some(new);
                    (status, vec![Status::Ok])
                }
                Err(error) => (status, vec![error.into()]),
            }
        }
        1..=4 => {
            let (input, refused) = caller.address(&mut inputs, required);
            let (report, refused_report) = caller.address(&mut reports, optional);
            wrong.extend(
                [refused, refused_report, finite(&[u], Status::InputNotFinite)].into_iter().flatten(),
            );
            if kind < 4 {
                let (status, foreseen, _) =
                    foreseen!(unsafe { cart_pole::step(at, input, report) }, Deed::Step(u));
                return (status, foreseen);
            }
            let (to, refused) = caller.address(&mut linearized, required);
            wrong.extend(refused);
            let (status, foreseen, derivatives) =
                foreseen!(unsafe { cart_pole::step_linearized(at, input, report, to) }, Deed::Linearized(u));
            if let (Some(expected), [cart_pole::CLinearized { by_state: a, by_input: b, .. }, _]) =
                (derivatives, linearized)
            {
                let found = [a[0][1], a[1][2], a[3][1], b[1][0], b[2][0]];
                assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
            }
            (status, foreseen)
        }
        5 => {
            let (q, refused_q) = caller.address(&mut q, required);
            let (p, refused_p) = caller.address(&mut p, required);
            wrong.extend(
                [refused_q, refused_p, finite(&[given_q, given_v].concat(), Status::NotFinite)]
                    .into_iter()
                    .flatten(),
            );
            let (status, foreseen, _) =
                foreseen!(unsafe { cart_pole::set_state(at, q, p) }, Deed::State(given_q, given_v));
            (status, foreseen)
        }
        6 => {
            let (s, refused) = caller.address(&mut systems, required);
            wrong.extend([refused, parameters(&system)].into_iter().flatten());
            let (status, foreseen, _) =
                foreseen!(unsafe { cart_pole::set_parameters(at, s.cast()) }, Deed::Parameters(system));
            (status, foreseen)
        }
        7 => {
            wrong.extend(step_size(h));
            let (status, foreseen, _) =
                foreseen!(unsafe { cart_pole::set_step_size(at, h) }, Deed::StepSize(h));
            (status, foreseen)
        }
        8 => {
            let (to, refused) = caller.address(&mut q, required);
            wrong.extend(refused);
            let status = unsafe { cart_pole::velocity(at, to) };
            let Some(Oracle { system, run, .. }) = oracle.as_ref().filter(|_| wrong.is_empty()) else {
                return (status, wrong);
            };
            match run.state().velocity(&system.driven([0.0])) {
                Ok(v) => {
                    assert_eq!(q[0].map(f64::to_bits), [v[0], v[1]].map(f64::to_bits));
                    (status, vec![Status::Ok])
                }
                Err(error) => (status, vec![error.into()]),
            }
        }
        9 => {
            let mut energy = [0.0; 2];
            let (to, refused) = caller.address(&mut energy, required);
            wrong.extend(refused);
            let status = unsafe { cart_pole::energy(at, to) };
            let Some(Oracle { system, run, .. }) = oracle.as_ref().filter(|_| wrong.is_empty()) else {
                return (status, wrong);
            };
            match run.state().energy(&system.driven([0.0])) {
                Ok(expected) if !expected.is_finite() => (status, vec![Status::DerivativesNotFinite]),
                Ok(expected) => {
                    assert_eq!(energy[0].to_bits(), expected.to_bits());
                    (status, vec![Status::Ok])
                }
                Err(error) => (status, vec![error.into()]),
            }
        }
        10 => {
            let mut time = [0.0; 2];
            let (to, refused) = caller.address(&mut time, required);
            wrong.extend(refused);
            let status = unsafe { cart_pole::time(at, to) };
            let Some(Oracle { run, .. }) = oracle.as_ref().filter(|_| wrong.is_empty()) else {
                return (status, wrong);
            };
            assert_eq!(time[0].to_bits(), run.time().to_bits());
            (status, vec![Status::Ok])
        }
        _ => {
            let (input, refused) = caller.address(&mut inputs, required);
            let (to_q, refused_q) = caller.address(&mut q, optional);
            let (to_p, refused_p) = caller.address(&mut p, optional);
            let finite = finite(&[u], Status::InputNotFinite);
            let wrong_h = (!after.is_finite()).then_some(Status::StepSize);
            wrong.extend([refused, refused_q, refused_p, finite, wrong_h].into_iter().flatten());
            let status = unsafe { cart_pole::state_after(at, input, after, to_q, to_p) };
            let Some(Oracle { system, run, .. }) = oracle.as_ref() else { return (status, wrong) };
            if after == 0.0 || !wrong.is_empty() {
                // Where the step fails, its error may be seen before a misaligned address is.
                let misplaced = !wrong.is_empty() && status != Status::Ok;
                return (status, if misplaced { vec![status] } else { vec![Status::Ok] });
            }
            use dalembert::Discretise;
            match system.driven([u]).by(Midpoint, after).step(run.state()) {
                Ok(step) => {
                    let expected = [step.state.q, step.state.p].map(|x| [x[0], x[1]].map(f64::to_bits));
                    assert!(to_q.is_null() || q[0].map(f64::to_bits) == expected[0]);
                    assert!(to_p.is_null() || p[0].map(f64::to_bits) == expected[1]);
                    (status, vec![Status::Ok])
                }
                Err(error) => (status, vec![error.into()]),
            }
        }
    }
}

#[test]
fn random_calls_do_what_the_run_does_or_nothing() {
    let mut counts = vec![0_u32; Status::ALL.len()];
    for seed in 0..SEQUENCES {
        let mut caller = Caller(StdRng::seed_from_u64(seed));
        let (mut memory, mut oracle) = (Memory::zeroed(), None);
        for i in 0..20 {
            let before = (bytes(&memory), bits(&memory));
            let (status, foreseen) = call(&mut caller, &mut memory, &mut oracle);
            counts[status as usize] += 1;
            assert!(
                foreseen.contains(&status),
                "sequence {seed}, call {i}: {status:?}, foreseen {foreseen:?}"
            );
            let now = (bytes(&memory), bits(&memory));
            if status != Status::Ok {
                assert_eq!(now, before, "sequence {seed}, call {i}: {status:?}, and bytes were changed");
            }
            let expected = oracle.as_ref().map(Oracle::bits).ok_or(Status::NotInitialised);
            assert_eq!(now.1, expected, "sequence {seed}, call {i}");
        }
    }
    // What was tried: enough of each kind.
    let count = |status: Status| counts[status as usize];
    let least = if cfg!(miri) { 1 } else { 500 };
    for status in [Status::Ok, Status::NullPointer, Status::Misaligned, Status::NotInitialised] {
        assert!(count(status) >= least, "{status:?}: {}", count(status));
    }
    if !cfg!(miri) {
        for status in [Status::WrongMemory, Status::StepSize, Status::NotFinite, Status::InputNotFinite] {
            assert!(count(status) >= 200, "{status:?}: {}", count(status));
        }
        assert!(counts.iter().filter(|count| **count > 0).count() >= 10, "{counts:?}");
    }
}
