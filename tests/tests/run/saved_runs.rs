//! Runs saved as text and read again go on bit by bit, whatever their rule remembers: velocities, stages with
//! compensated sums, a kept matrix, an explicit step's force, one memory for each substep of a composition.

use dalembert::step::Flow;
use dalembert::{
    Checkpoint, Composition, Discrete, Discretise, Gauss, Midpoint, Splitting, State, StepError, Trajectory,
    Trapezoidal, rayleigh_system,
};
use dalembert_tests::systems::{Chain, DoublePendulum};

/// Explicit by the trapezoidal rule.
#[rayleigh_system(rule = trapezoidal)]
fn ring(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
    let s = q[0] * q[0] + q[1] * q[1];
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2), 0.5 * k * (v[0] * v[0] + v[1] * v[1]))
}

fn bits<const N: usize>(state: &State<f64, N>) -> Vec<u64> {
    state.q.iter().chain(&state.p).map(|entry| entry.to_bits()).collect()
}

fn start<const N: usize>() -> State<f64, N> {
    let entry = |i: usize| 0.3 + 0.17 * i as f64;
    State {
        q: std::array::from_fn(|i| entry(i) * (-1.0_f64).powi(i as i32)).into(),
        p: std::array::from_fn(entry).into(),
    }
}

fn as_text<const N: usize>(checkpoint: Checkpoint<f64, N>) -> Checkpoint<f64, N> {
    serde_json::from_str(&serde_json::to_string(&checkpoint).unwrap()).unwrap()
}

/// The bits of 300 states: after 100 and 200 steps there is a checkpoint, from which another run goes on if
/// `is_resumed`.
fn by_method<L, R: Copy, const N: usize>(system: &L, rule: R, h: f64, is_resumed: bool) -> Vec<Vec<u64>>
where
    L: Discrete<R, N, Scalar = f64>,
{
    let mut run = system.by(rule, h).run(start());
    let mut states = Vec::new();
    for _ in 0..3 {
        states.extend(run.by_ref().take(100).map(|step| bits(&step.unwrap().state)));
        let checkpoint = run.checkpoint();
        if is_resumed {
            run = Trajectory::resume(system, rule, as_text(checkpoint));
        }
    }
    states.push(vec![run.time().to_bits()]);
    states
}

#[test]
fn every_rule_goes_on_bit_by_bit() {
    fn check<L, R: Copy, const N: usize>(system: &L, rule: R, h: f64)
    where
        L: Discrete<R, N, Scalar = f64>,
    {
        let resumed = by_method(system, rule, h, true);
        assert!(resumed == by_method(system, rule, h, false));
        // The control: the bits are those of this step size.
        assert!(resumed != by_method(system, rule, h.next_up(), false));
    }
    check(&DoublePendulum::EXAMPLE, Midpoint, 0.07);
    check(&DoublePendulum::EXAMPLE, Gauss::<4>, 0.2);
    check(&Chain::EXAMPLE, Midpoint, 0.1);
    check(&Ring { k: 1e-3 }, Trapezoidal, 0.1);
}

/// What a checkpoint makes a run forget is rounding: without it the bits are others, the motion is the same.
#[test]
fn forgetting_changes_no_more_than_rounding() {
    let of = |every: usize| {
        let mut run = DoublePendulum::FREE.by(Gauss::<4>, 0.1).run(start());
        for _ in 0..100 / every {
            run.by_ref().take(every).for_each(|step| assert!(step.is_ok()));
            run.checkpoint();
        }
        *run.state()
    };
    let (never, often) = (of(100), of(1));
    assert_ne!(bits(&never), bits(&often));
    assert!((never.q - often.q).amax() < 1e-12, "{}", (never.q - often.q).amax());
}

#[test]
fn compositions_go_on_bit_by_bit() {
    fn states<const S: usize>(method: Composition<Trapezoidal, S>, is_resumed: bool) -> Vec<Vec<u64>> {
        let system = Ring { k: 1e-3 };
        let mut run = system.by(method, 0.3).run(start());
        let mut states = Vec::new();
        for _ in 0..3 {
            states.extend(run.by_ref().take(50).map(|step| bits(&step.unwrap().state)));
            let checkpoint = run.checkpoint();
            if is_resumed {
                run = Trajectory::resume(&system, method, as_text(checkpoint));
            }
        }
        states.push(vec![run.time().to_bits()]);
        states
    }
    let six = Composition::kahan_li_6(Trapezoidal);
    let eight = Composition::kahan_li_8(Trapezoidal);
    assert!(states(six, true) == states(six, false));
    assert!(states(eight, true) == states(eight, false));
    // The control.
    assert!(states(six, true)[149] != states(eight, true)[149]);
}

/// A state that is no state, or text that broke off, is refused.
#[test]
fn broken_text_is_refused() {
    let checkpoint = Ring { k: 0.0 }.by(Trapezoidal, 0.1).run(start()).checkpoint();
    let text = serde_json::to_string(&checkpoint).unwrap();
    assert!(serde_json::from_str::<Checkpoint<f64, 2>>(&text).is_ok());
    for wrong in [
        text.replace("0.3", "null"),
        text.replace("\"steps\":0", "\"steps\":-1"),
        text.replace("\"origin\":0.0,", ""),
        text[..text.len() - 1].to_owned(),
    ] {
        assert_ne!(wrong, text);
        assert!(serde_json::from_str::<Checkpoint<f64, 2>>(&wrong).is_err(), "{wrong}");
    }
    // Another number of coordinates.
    assert!(serde_json::from_str::<Checkpoint<f64, 3>>(&text).is_err());
}

/// A damped mass that is pushed by a force of time.
#[rayleigh_system(rule = [midpoint, gauss])]
impl Pushed {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.05 * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [t.cos()]
    }
}

struct Pushed;

/// Checkpoints that no run has left: everything that their types allow.
struct Odd(u64);

impl Odd {
    /// Splitmix64.
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let a = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let b = (a ^ (a >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        b ^ (b >> 31)
    }

    fn one_of<T: Copy>(&mut self, values: &[T]) -> T {
        values[(self.bits() % values.len() as u64) as usize]
    }

    fn checkpoint<const N: usize>(&mut self) -> Checkpoint<f64, N> {
        let any = f64::from_bits(self.bits());
        let mut state = start();
        if self.bits().is_multiple_of(4) {
            let entry = self.one_of(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, 1e-310, any]);
            let index = self.bits() as usize % N;
            if self.bits().is_multiple_of(2) { state.q[index] = entry } else { state.p[index] = entry }
        }
        let small = self.bits() % 1_000_000;
        let near_the_limit = u64::MAX - small % 4;
        let any = if self.bits().is_multiple_of(4) { any } else { 0.1 };
        let step_size = self.one_of(&[
            0.1,
            0.1,
            0.07,
            0.03,
            -0.1,
            1e-3,
            1e-12,
            -1e-12,
            1e-310,
            1e300,
            0.0,
            -0.0,
            f64::NAN,
            f64::INFINITY,
            any,
        ]);
        if self.bits().is_multiple_of(2) {
            return Checkpoint { state, step_size, origin: self.one_of(&[0.0, -37.5, 1e3]), steps: small };
        }
        Checkpoint {
            state,
            step_size,
            origin: self.one_of(&[
                0.0,
                1.0,
                1e9,
                4e14,
                9e15,
                1e16,
                -1e18,
                1e300,
                f64::MAX,
                f64::NAN,
                f64::INFINITY,
                any,
            ]),
            steps: self.one_of(&[small, 1 << 52, (1 << 53) - 2, 1 << 53, 1 << 63, near_the_limit, self.0]),
        }
    }
}

/// How many runs went on, and how many ended with an error of each kind.
#[derive(Debug, Default)]
struct Ends {
    went_on: u32,
    step_size: u32,
    state: u32,
    time: u32,
}

type States<const N: usize> = Vec<Result<State<f64, N>, StepError>>;

/// A few steps of the run from a checkpoint, and where it stands then.
fn some<const N: usize>(states: &mut dyn Iterator<Item = Result<State<f64, N>, StepError>>) -> States<N> {
    let states: Vec<_> = states.take(5).collect();
    // An error is the last thing that a run says.
    assert!(states.iter().rev().skip(1).all(Result::is_ok));
    states
}

/// A run from `checkpoint` took steps and stands at `end`: as `fresh`, the run of the same state and step
/// size whose clock begins at 0, up to an error that is right about the clock.
fn is_right<const N: usize>(
    checkpoint: &Checkpoint<f64, N>,
    (states, end): (&States<N>, &Checkpoint<f64, N>),
    fresh: Option<&States<N>>,
    ends: &mut Ends,
) {
    let good: Vec<_> = states.iter().flatten().collect();
    let last = good.last().map_or(checkpoint.state, |state| **state);
    assert_eq!(bits(&end.state), bits(&last), "an error leaves the last good state: {checkpoint:?}");
    assert_eq!(end.origin.to_bits(), checkpoint.origin.to_bits());
    assert_eq!(u128::from(end.steps), u128::from(checkpoint.steps) + good.len() as u128, "{checkpoint:?}");
    if let Some(fresh) = fresh {
        for (state, fresh) in good.iter().zip(fresh) {
            assert_eq!(bits(state), bits(fresh.as_ref().unwrap()), "{checkpoint:?}");
        }
    }
    // The clock at the start of each step, not by the code's own formula: fused, and in integers for the
    // count.
    let h = checkpoint.step_size;
    let time = |k: usize| h.mul_add((u128::from(checkpoint.steps) + k as u128) as f64, checkpoint.origin);
    let blur = |k: usize| {
        4.0 * f64::EPSILON * (checkpoint.origin.abs() + h.abs() * (checkpoint.steps as f64 + k as f64 + 1.0))
    };
    for k in 0..good.len() {
        assert!(
            ((time(k + 1) - time(k)) - h).abs() <= h.abs() + blur(k) && time(k + 1).is_finite(),
            "{checkpoint:?}"
        );
    }
    match states.last() {
        Some(Err(StepError::Time { time: said, h: step })) => {
            ends.time += 1;
            assert_eq!((said.to_bits(), step.to_bits()), (end.time().to_bits(), h.to_bits()));
            let k = good.len();
            let is_stuck = h.abs() <= blur(k) || !time(k).is_finite() || !time(k + 1).is_finite();
            assert!(is_stuck, "the clock can tell this step: {checkpoint:?}");
        }
        Some(Err(error)) => {
            if let Some(fresh) = fresh {
                assert_eq!(format!("{:?}", fresh[good.len()]), format!("{:?}", states[good.len()]));
            }
            match error {
                StepError::StepSize { .. } => ends.step_size += 1,
                _ => ends.state += 1,
            }
        }
        _ => ends.went_on += 1,
    }
    if h == 0.0 || !h.is_finite() {
        let error = states.last().unwrap();
        assert!(matches!(error, Err(StepError::StepSize { .. } | StepError::NonFinite { .. })), "{error:?}");
    }
}

/// Whatever stands in a checkpoint, the run goes on rightly or says in a typed error what is wrong; no
/// counter wraps, no clock stands still.
#[test]
fn odd_checkpoints_end_in_a_typed_error_or_a_right_run() {
    const EACH: u32 = if cfg!(debug_assertions) { 20 } else { 2_000 };
    let mut odd = Odd(20);
    let mut ends = Ends::default();
    fn by_method<L, M: Copy, const N: usize>(
        system: &L,
        method: M,
        is_timed: bool,
        odd: &mut Odd,
        ends: &mut Ends,
    ) where
        L: Flow<M, N, Scalar = f64>,
    {
        for _ in 0..EACH {
            let checkpoint = odd.checkpoint();
            let of = |checkpoint| {
                let mut run = Trajectory::resume(system, method, checkpoint);
                let states = some(&mut run.by_ref().map(|step| step.map(|step| step.state)));
                (states, run.checkpoint())
            };
            let (states, end) = of(checkpoint);
            let (fresh, _) = of(Checkpoint::new(checkpoint.step_size, checkpoint.state));
            is_right(&checkpoint, (&states, &end), (!is_timed).then_some(&fresh), ends);
            // In parts, and sampled.
            let mut parted = Trajectory::resume(system, method, checkpoint);
            match (parted.next_in_parts(3), states[0].as_ref()) {
                (Ok(_), _) => {
                    assert_eq!(u128::from(parted.checkpoint().steps), u128::from(checkpoint.steps) + 1)
                }
                (Err(error), Err(whole)) => {
                    assert_eq!(format!("{error:?}"), format!("{whole:?}"));
                    assert_eq!(bits(parted.state()), bits(&checkpoint.state));
                }
                (Err(error), Ok(_)) => panic!("{error:?} of {checkpoint:?}"),
            }
            let mut sampled = Trajectory::resume(system, method, checkpoint);
            let sample = sampled.sample_every(1).next().unwrap();
            assert_eq!(sample.is_ok(), states[0].is_ok());
        }
    }
    by_method(&DoublePendulum::EXAMPLE, Midpoint, false, &mut odd, &mut ends);
    by_method(&DoublePendulum::EXAMPLE, Gauss::<4>, false, &mut odd, &mut ends);
    by_method(&Chain::EXAMPLE, Midpoint, false, &mut odd, &mut ends);
    by_method(&Ring { k: 1e-3 }, Trapezoidal, false, &mut odd, &mut ends);
    by_method(&Pushed.at_time(0.0), Midpoint, true, &mut odd, &mut ends);
    by_method(&Pushed.at_time(0.0), Gauss::<2>, true, &mut odd, &mut ends);
    by_method(&Ring { k: 1e-3 }, Composition::kahan_li_6(Trapezoidal), false, &mut odd, &mut ends);
    by_method(&DoublePendulum::EXAMPLE, Composition::kahan_li_8(Midpoint), false, &mut odd, &mut ends);
    by_method(&Pushed.at_time(0.0), Composition::kahan_li_6(Midpoint), true, &mut odd, &mut ends);
    by_method(&Ring { k: 1e-3 }, Splitting::blanes_moan_4(), false, &mut odd, &mut ends);
    by_method(&Ring { k: 0.0 }, Splitting::blanes_moan_6(), false, &mut odd, &mut ends);
    let all = 11 * EACH;
    println!("{all} checkpoints: {ends:?}");
    let Ends { went_on, step_size, state, time } = ends;
    assert_eq!(went_on + step_size + state + time, all);
    assert!([went_on, step_size, state, time].iter().all(|&count| count > all / 22), "{ends:?}");
    // The control: without a look at the clock, the time of the last step that can be counted is that of the
    // first.
    let last = Checkpoint { steps: u64::MAX, ..Checkpoint::new(0.1, start::<2>()) };
    assert_eq!(Checkpoint { steps: last.steps.wrapping_add(1), ..last }.time(), 0.0);
    assert_eq!(Checkpoint { steps: last.steps - 1, ..last }.time(), last.time());
    assert!(matches!(
        Trajectory::resume(&DoublePendulum::EXAMPLE, Midpoint, last).next(),
        Some(Err(StepError::Time { h: 0.1, .. }))
    ));
}
