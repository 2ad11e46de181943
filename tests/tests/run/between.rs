//! State at any time: to the order of the run, by a step, and for nothing, by a polynomial; the grid is the
//! same bit by bit, whoever looks between.

use dalembert::nalgebra::vector;
use dalembert::run::between::TimeError;
use dalembert::step::Flow;
use dalembert::{Composition, Discretise, Gauss, Midpoint, Splitting, State, Trapezoidal, rayleigh_system};
use dalembert_tests::systems::DoublePendulum;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

struct Well {
    r: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Well {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1])
            - (q[0] * q[0] * q[1]).cosh()
            - q[1].powi(4)
            - 0.5 * (q[0] * q[0] + q[1] * q[1])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + v[0] * v[1] + v[1] * v[1])
    }
}

const WELL: Well = Well { r: 0.1 };
const START: State<f64, 2> = State { q: vector![0.7, -0.4], p: vector![0.5, 1.1] };

/// Calls a macro with every kind of method.
macro_rules! for_all_methods {
    ($check:ident) => {
        $check(&DoublePendulum::EXAMPLE, Midpoint, 0.05);
        $check(&DoublePendulum::EXAMPLE, Trapezoidal, 0.05);
        $check(&DoublePendulum::EXAMPLE, Gauss::<1>, 0.05);
        $check(&DoublePendulum::EXAMPLE, Gauss::<4>, 0.1);
        $check(&WELL, Midpoint, 0.05);
        $check(&WELL, Trapezoidal, 0.05);
        $check(&WELL, Gauss::<2>, 0.1);
        $check(&WELL, Gauss::<8>, -0.25);
        $check(&WELL, Composition::kahan_li_6(Midpoint), 0.2);
        $check(&WELL, Composition::kahan_li_8(Trapezoidal), -0.2);
        $check(&WELL, Splitting::blanes_moan_4(), 0.2);
        $check(&WELL, Splitting::blanes_moan_6(), 0.2);
        $check(&WELL, Splitting::blanes_casas_escorihuela_8(), -0.2);
    };
}

/// A run that is looked into, at random times by both answers, takes the steps of one that is not, bit by
/// bit.
#[test]
fn looking_between_steps_leaves_the_grid_as_it_is() {
    fn check<L: Flow<M, 2, Scalar = f64>, M: Copy>(system: &L, method: M, h: f64) {
        let by = system.by(method, h);
        let mut random = StdRng::seed_from_u64(5);
        let (mut alone, mut looked) = (by.run(START), by.run(START));
        let mut dense = looked.dense();
        for _ in 0..20 {
            let before = *dense.run().state();
            assert_eq!(dense.next(), alone.next());
            let [from, to] = dense.interval().unwrap();
            assert_eq!(dense.state_at(from).unwrap(), before);
            assert_eq!(&dense.state_at(to).unwrap(), alone.state());
            for _ in 0..3 {
                let time = from + random.random_range(0.0..1.0) * (to - from);
                let (state, near) = (dense.state_at(time).unwrap(), dense.interpolated_at(time).unwrap());
                assert!((state.q - near.q).amax() < 1e-2 && (state.p - near.momentum()).amax() < 0.1);
            }
        }
        assert_eq!(alone.checkpoint(), looked.checkpoint());
    }
    for_all_methods!(check);
}

/// Samples at times of the grid are the grid's, bit by bit; between, they are steps from it; and the run goes
/// on as if nobody had asked.
#[test]
fn samples_on_the_grid_are_the_grids_own() {
    fn check<L: Flow<M, 2, Scalar = f64>, M: Copy>(system: &L, method: M, h: f64) {
        let by = system.by(method, h);
        let (mut alone, mut sampled) = (by.run(START), by.run(START));
        let times = (0..40).map(|k| f64::from(k / 2) * h + if k % 2 == 1 { 0.3 * h } else { 0.0 });
        let mut previous = START;
        for (k, sample) in sampled.sample_at(times).enumerate() {
            let sample = sample.unwrap();
            if k % 2 == 0 {
                if k > 0 {
                    previous = alone.next().unwrap().unwrap().state;
                }
                assert_eq!(sample.state, previous);
                assert_eq!(sample.time, alone.time());
            } else {
                let alone = by.with_step(sample.time - alone.time()).step(&previous).unwrap();
                assert!((alone.state.q - sample.state.q).amax() < 1e-14);
                assert!((alone.state.p - sample.state.p).amax() < 1e-13);
                assert_eq!(sample.previous, previous.q);
            }
        }
        alone.next().unwrap().unwrap();
        for _ in 0..5 {
            assert_eq!(alone.next(), sampled.next());
        }
    }
    for_all_methods!(check);
}

/// The largest errors of both answers between the steps over one time, in q, and of the polynomial in p.
fn errors<M: Copy>(method: M, h: f64) -> [f64; 3]
where
    Well: Flow<M, 2, Scalar = f64>,
{
    let mut run = WELL.by(method, h).run(START);
    let mut exact = WELL.by(Gauss::<8>, 0.05).run(START);
    let mut exact = exact.dense();
    let mut dense = run.dense();
    let mut errors = [0.0_f64; 3];
    for _ in 0..(2.4 / h).round() as u32 {
        dense.next().unwrap().unwrap();
        let [from, _] = dense.interval().unwrap();
        let some = if cfg!(debug_assertions) { &[0.31, 0.77][..] } else { &[0.12, 0.31, 0.5, 0.77, 0.93] };
        for &share in some {
            let time = from + share * h;
            while exact.interval().is_none_or(|[_, to]| to < time) {
                exact.next().unwrap().unwrap();
            }
            let state = exact.state_at(time).unwrap();
            let near = dense.interpolated_at(time).unwrap();
            let found =
                [dense.state_at(time).unwrap().q - state.q, near.q - state.q, near.momentum() - state.p];
            for (error, miss) in errors.iter_mut().zip(found) {
                *error = error.max(miss.amax());
            }
        }
    }
    errors
}

/// By a step: the order of the run. By a polynomial: of Gauss rules of three stages on S + 1 in q and S in v,
/// of the cubic 4 and 3, where the run has it.
#[test]
fn both_answers_have_their_orders() {
    fn check<M: Copy>(method: M, h: f64, orders: [f64; 3])
    where
        Well: Flow<M, 2, Scalar = f64>,
    {
        let (coarse, fine) = (errors(method, h), errors(method, 0.5 * h));
        for k in 0..3 {
            let order = (coarse[k] / fine[k]).log2();
            assert!(
                (order - orders[k]).abs() < 0.35,
                "{}: {order} {coarse:?} {fine:?}",
                core::any::type_name::<M>()
            );
        }
    }
    check(Midpoint, 0.01, [2.0, 2.0, 2.0]);
    check(Gauss::<2>, 0.05, [4.0, 4.0, 3.0]);
    check(Gauss::<3>, 0.1, [6.0, 4.0, 3.0]);
    check(Gauss::<4>, 0.15, [8.0, 5.0, 4.0]);
    check(Composition::kahan_li_6(Trapezoidal), 0.08, [6.0, 4.0, 3.0]);
    check(Splitting::blanes_moan_4(), 0.1, [4.0, 4.0, 3.0]);
    check(Splitting::blanes_moan_6(), 0.15, [6.0, 4.0, 3.0]);
}

/// A force that changes with time is seen at its own time.
#[test]
fn time_goes_on_between_the_steps() {
    struct Driven;
    #[rayleigh_system(rule = gauss)]
    impl Driven {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            0.5 * v[0] * v[0] - 0.0 * q[0]
        }
        fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
            [t.cos()]
        }
    }
    let now = Driven.at_time(0.25);
    let start = State { q: vector![0.0], p: vector![0.0] };
    let mut run = now.by(Gauss::<6>, 0.5).run(start);
    for sample in run.sample_at((0..100).map(|k| f64::from(k) * 0.07)) {
        let sample = sample.unwrap();
        let velocity = (0.25 + sample.time).sin() - 0.25_f64.sin();
        assert!((sample.state.p[0] - velocity).abs() < 1e-13);
    }
    let mut dense = run.dense();
    dense.next().unwrap().unwrap();
    let [from, to] = dense.interval().unwrap();
    let middle = dense.interpolated_at(0.5 * (from + to)).unwrap();
    let velocity = (0.25 + middle.time).sin() - 0.25_f64.sin();
    assert!((middle.velocity()[0] - velocity).abs() < 1e-7 && middle.momentum() == middle.velocity());
}

#[test]
fn single_precision_is_looked_into_as_well() {
    #[rayleigh_system(rule = [trapezoidal, gauss])]
    fn rotor(q: [f32; 1], v: [f32; 1]) -> f32 {
        0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    }
    fn check<M: Copy>(method: M, h: f32)
    where
        Rotor: Flow<M, 1, Scalar = f32>,
    {
        let mut run = Rotor {}.by(method, h).run(State { q: vector![1.0], p: vector![0.0] });
        for sample in run.sample_at((0..50).map(|k| f64::from(k) * 0.1)) {
            let sample = sample.unwrap();
            assert!((f64::from(sample.state.q[0]) - sample.time.cos()).abs() < 2e-6);
        }
    }
    check(Gauss::<4>, 0.25);
    check(Splitting::blanes_moan_6(), 0.25);
}

/// Times by another arithmetic miss the clock by their rounding, to either side: they are the grid's all the
/// same. Nor does a sensor at the end of a period take the run, or come after it, into another period's step.
#[test]
fn a_time_that_rounding_takes_off_the_grid_is_on_it() {
    let mut ahead = 0;
    for h in [0.1, 0.007, 0.3] {
        let grid: Vec<_> =
            WELL.by(Midpoint, h).run(START).take(200).map(|step| step.unwrap().state).collect();
        let mut run = WELL.by(Midpoint, h).run(START);
        let mut in_periods = WELL.by(Midpoint, h).run(START);
        let times: Vec<f64> = (0..200).map(|k| f64::from(k) * h + h).collect();
        for (k, sample) in run.sample_at(times.iter().copied()).enumerate() {
            assert_eq!(sample.unwrap().state, grid[k], "{k}");
        }
        for (k, &time) in times.iter().enumerate() {
            let clock = (k + 1) as f64 * h;
            ahead += i32::from(time > clock);
            let sample = in_periods.sample_at([time]).next().unwrap().unwrap();
            assert_eq!((sample.state, in_periods.time()), (grid[k], clock));
            // As the next period's first.
            assert_eq!(in_periods.sample_at([time.min(clock)]).next().unwrap().unwrap().state, grid[k]);
        }
        // Positive control: what is off by more than rounding is another time.
        let off = in_periods.time() * (1.0 - 1e-13);
        assert!(matches!(in_periods.sample_at([off]).next(), Some(Err(TimeError::NotSorted { .. }))));
        assert_ne!(
            in_periods.sample_at([200.0 * h * (1.0 + 1e-13)]).next().unwrap().unwrap().state,
            grid[199]
        );
    }
    assert!((1..600).contains(&ahead), "{ahead}");
}

/// What is no time of the run has a name, and the run is where it was.
#[test]
fn times_that_are_none_are_refused() {
    let by = WELL.by(Gauss::<4>, 0.1);
    let refused = |times: &[f64], h: f64| {
        let mut run = by.with_step(h).run(START);
        let last = run.sample_at(times.iter().copied()).last().unwrap();
        (last.unwrap_err(), run.time())
    };
    let not_sorted = |error| matches!(error, TimeError::NotSorted { .. });
    let (error, time) = refused(&[0.15, 0.12], 0.1);
    assert_eq!((error, time), (TimeError::NotSorted { time: 0.12, after: 0.15 }, 0.2));
    assert!(error.to_string().contains("0.12 does not come after 0.15"));
    assert!(not_sorted(refused(&[0.1, f64::NAN], 0.1).0) && not_sorted(refused(&[f64::INFINITY], 0.1).0));
    assert!(not_sorted(refused(&[-0.1], 0.1).0) && not_sorted(refused(&[0.1], -0.1).0));
    // Positive control: the same times in order.
    let mut run = by.run(START);
    assert_eq!(run.sample_at([0.12, 0.12, 0.15]).filter(|sample| sample.is_ok()).count(), 3);
    // Before the first step there is the state alone, and after it no other step can be looked into.
    let (stands, mut dense) = (*run.state(), run.dense());
    assert!(dense.state_at(0.2) == Ok(stands) && dense.has_reached(0.2) && !dense.has_reached(0.25));
    assert!(matches!(dense.state_at(0.25), Err(TimeError::Outside { .. })));
    assert!(matches!(dense.interpolated_at(0.2), Err(TimeError::Outside { .. })));
    dense.next().unwrap().unwrap();
    assert!(dense.state_at(0.25).is_ok() && dense.interpolated_at(0.25).is_ok());
    for time in [0.15, 0.35, f64::NAN] {
        assert!(matches!(dense.state_at(time), Err(TimeError::Outside { .. })));
        assert!(matches!(dense.interpolated_at(time), Err(TimeError::Outside { .. })));
    }
    // A run that fails says so.
    let mut run = by.with_step(f64::NAN).run(START);
    assert!(matches!(run.sample_at([1.0]).next(), Some(Err(TimeError::Step(_))) | None));
}
