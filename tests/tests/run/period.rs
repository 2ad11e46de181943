//! Control periods: samples and events in the order of time, and derivatives of the period and of its
//! samples, against differences of periods from nearby starts, under nearby inputs and with nearby
//! parameters.

use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::run::between::TimeError;
use dalembert::run::events::{Crossing, EventError};
use dalembert::run::{Carried, HeldInput, InPeriod, Run, Sensitivities};
use dalembert::step::{Linearizable, Linearization, PhaseMatrix};
use dalembert::{Discretise, Discretised, Gauss, Midpoint, State, Trapezoidal, rayleigh_system};
use dalembert_tests::draws::Draws;

/// Two links with a motor in each joint, and a force that turns with time.
struct Links {
    c: f64,
    g: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], parameters = [c, g])]
impl Links {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        v[0] * v[0]
            + 0.5 * v[1] * v[1]
            + (q[0] - q[1]).cos() * v[0] * v[1]
            + self.g * (2.0 * q[0].cos() + q[1].cos())
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c * (v[0] * v[0] + (v[1] - v[0]).powi(2))
    }
    fn force(&self, _q: [f64; 2], v: [f64; 2], u: [f64; 2], t: f64) -> [f64; 2] {
        [u[0] - u[1] * v[1] + (2.0 * t).sin(), u[1]]
    }
}

/// A ball under a push.
struct Ball;

#[rayleigh_system(rule = [midpoint, gauss])]
impl Ball {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 9.81 * q[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

/// (q0, q1, p0, p1, u0, u1, c, g).
type Point = SVector<f64, 8>;
type All = Sensitivities<f64, 2, 2, 2>;

fn columns(by: &All) -> SMatrix<f64, 4, 8> {
    let mut matrix = SMatrix::<f64, 4, 8>::zeros();
    let a = &by.a;
    for (row, column, block) in [
        (0, 0, a.q_by_q),
        (0, 2, a.q_by_p),
        (2, 0, a.p_by_q),
        (2, 2, a.p_by_p),
        (0, 4, by.b.q),
        (2, 4, by.b.p),
    ] {
        matrix.fixed_view_mut::<2, 2>(row, column).copy_from(&block);
    }
    matrix.fixed_view_mut::<2, 2>(0, 6).copy_from(&by.by_parameters.q);
    matrix.fixed_view_mut::<2, 2>(2, 6).copy_from(&by.by_parameters.p);
    matrix
}

fn assembled(state: &State<f64, 2>) -> SVector<f64, 4> {
    vector![state.q[0], state.q[1], state.p[0], state.p[1]]
}

/// Two periods, by `method` with steps of `h`: the samples of the second with their derivatives by the start
/// of it, and its end with its own.
macro_rules! second_period {
    ($method:expr, $h:expr, $point:expr, $times:expr, $end:expr) => {{
        let x: Point = $point;
        let links = Links { c: x[6], g: x[7] };
        let start = State { q: vector![x[0], x[1]], p: vector![x[2], x[3]] };
        let mut run = links.driven([0.0, 0.0], 0.0).by($method, $h).run_with_inputs(start);
        // From where the run remembers nothing, so that the start is that of the period.
        run.restart_at(0.3, start);
        let held = links.driven([x[4], x[5]], run.time());
        let mut held = run.hold(&held);
        let times: &[f64] = $times;
        let mut period = held.period($end, times.iter().copied(), |_| []).linearized::<All>();
        let (mut samples, mut steps) = (Vec::new(), 0);
        while let Some(item) = period.advance() {
            match item.unwrap() {
                InPeriod::Sample { time, state } => {
                    samples.push((time, assembled(&state), columns(period.derivatives().unwrap())));
                }
                InPeriod::Step(_) => steps += 1,
                InPeriod::Event(event) => panic!("{event:?}"),
            }
        }
        let by = columns(period.derivatives().unwrap());
        assert_eq!(run.time(), $end);
        samples.push(($end, assembled(run.state()), by));
        (samples, steps)
    }};
}

#[test]
fn derivatives_of_a_period_and_of_its_samples_are_those_of_differences() {
    let mut draws = Draws::new(11);
    macro_rules! check {
        ($method:expr) => {
            for _ in 0..if cfg!(debug_assertions) { 2 } else { 10 } {
                let point = Point::from_fn(|i, _| match i {
                    6 => draws.between(0.05, 0.4),
                    7 => draws.between(0.5, 2.0),
                    _ => draws.between(-0.8, 0.8),
                });
                let h = draws.between(0.03, 0.09);
                let end = 0.3 + draws.between(0.1, 0.4);
                // At the start, on the grid, between, at the end.
                let mut times = vec![0.3, 0.3 + h, 0.3 + draws.between(0.0, 1.0) * (end - 0.3), end];
                times.sort_by(f64::total_cmp);
                let (samples, steps) = second_period!($method, h, point, &times, end);
                assert_eq!(samples.len(), times.len() + 1);
                assert!(steps >= 2);
                let step = 1e-5;
                for column in 0..8 {
                    let moved = |sign: f64| {
                        let mut moved = point;
                        moved[column] += sign * step;
                        second_period!($method, h, moved, &times, end).0
                    };
                    let (ahead, behind) = (moved(1.0), moved(-1.0));
                    for (index, (time, _, by)) in samples.iter().enumerate() {
                        let expected = (ahead[index].1 - behind[index].1) / (2.0 * step);
                        let off = (by.column(column) - expected).amax();
                        assert!(off < 2e-8, "{time} {column}: {off}\n{by}{expected}");
                    }
                }
                // Positive control: B of the period is none of its last step alone.
                let last = samples.last().unwrap().2;
                assert!(last.fixed_view::<2, 2>(0, 4).amax() > 1e-3);
            }
        };
    }
    check!(Midpoint);
    check!(Trapezoidal);
    check!(Gauss::<2>);
    check!(Gauss::<4>);
}

/// Samples, impacts and steps come in the order of time; a sample at an impact is of the state before it; and
/// after the impact there are no derivatives, and the error says which event it was.
#[test]
fn impacts_and_samples_of_a_period_come_in_order() {
    for h in [0.004, 0.01, 0.03, 0.2] {
        let start = State { q: vector![0.05], p: vector![0.0] };
        let held = Ball.driven([0.0]);
        let by = held.by(Gauss::<2>, h);
        let impact = (0.1_f64 / 9.81).sqrt();
        let mut run = by.run_with_inputs(start);
        let mut held: HeldInput<'_, '_, _, _, _, 1> = run.hold(&held);
        let samples = [0.0, 0.05, impact - 1e-9, impact + 1e-9, 0.15, 0.17];
        let mut period = held
            .period(0.17, samples, |at| [1.0, at.q[0]])
            .crossing([Crossing::Either, Crossing::Falling])
            .terminal([false, true])
            .linearized::<Linearization<f64, 1, 1>>();
        let (mut seen, mut now, mut impacts) = (Vec::new(), 0.0, 0);
        while let Some(item) = period.advance() {
            let time = match item.unwrap() {
                InPeriod::Sample { time, state } => {
                    // By hand, with 0.8 of the speed left.
                    let after = time - impact;
                    let expected = if after < 0.0 {
                        0.05 - 0.5 * 9.81 * time * time
                    } else {
                        0.8 * 9.81 * impact * after - 0.5 * 9.81 * after * after
                    };
                    assert!((state.q[0] - expected).abs() < 1e-12, "{time}: {} {expected}", state.q[0]);
                    seen.push(time);
                    assert_eq!(period.derivatives().is_ok(), impacts == 0);
                    time
                }
                InPeriod::Event(event) => {
                    impacts += 1;
                    assert!((event.time - impact).abs() < 1e-12 && event.index == 1);
                    period.restart(State { q: event.state.q, p: -0.8 * event.state.p });
                    event.time
                }
                InPeriod::Step(_) => Run::time(period.run()),
            };
            assert!(time >= now, "{h}: {time} after {now}");
            now = time;
        }
        assert_eq!((&seen[..], impacts), (&samples[..], 1));
        let told = period.derivatives().unwrap_err();
        assert!(
            matches!(told, EventError::Restarted { index: 1, time } if (time - impact).abs() < 1e-12),
            "{told}"
        );
        assert_eq!(run.time(), 0.17);
    }
}

/// A time that is none of the period is an error, and the run stands at a good state; without derivatives a
/// period takes the steps of `until`, bit by bit.
#[test]
fn times_beside_the_period_are_refused() {
    let start = State { q: vector![0.3], p: vector![0.1] };
    let held = Ball.driven([0.5]);
    let by = held.by(Midpoint, 0.01);
    let period = |times: &[f64]| {
        let mut run = by.run_with_inputs(start);
        let error = {
            let mut hold = run.hold(&held);
            let mut period = hold.period(0.035, times.iter().copied(), |_| []);
            let mut error = None;
            while let Some(item) = period.advance() {
                error = item.err();
            }
            assert!(period.advance().is_none());
            error
        };
        (run.time(), *run.state(), error)
    };
    let mut alone = by.run_with_inputs(start);
    assert!(alone.hold(&held).until(0.035).all(|step| step.is_ok()));
    assert_eq!(period(&[0.01, 0.02]), (0.035, *alone.state(), None));
    for times in [[0.01, 0.036], [0.02, 0.005], [-0.1, 0.01], [0.01, f64::NAN]] {
        let (_, _, error) = period(&times);
        assert!(matches!(error, Some(EventError::Time(TimeError::Outside { .. }))), "{times:?} {error:?}");
    }
    // A alone; it begins as the identity.
    fn identity<D: Carried<L, M, 1>, L: Linearizable<M, 1>, M>(_: &Discretised<'_, L, M, 1>) -> D {
        D::identity()
    }
    assert_eq!(identity::<PhaseMatrix<f64, 1>, _, _>(&by), PhaseMatrix::identity());
    let mut run = by.run_with_inputs(start);
    let mut hold = run.hold(&held);
    let mut period = hold.period(0.035, [], |_| []).linearized::<PhaseMatrix<f64, 1>>();
    while period.advance().transpose().unwrap().is_some() {}
    assert!((period.derivatives().unwrap().q_by_p[0] - 0.035).abs() < 1e-15);
}
