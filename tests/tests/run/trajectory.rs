//! A trajectory is its steps: errors end it, another step size lets it go on, samples skip nothing.

use dalembert::nalgebra::{SVector, vector};
use dalembert::{Discretise, Midpoint, State, StepError, rayleigh_system};
use dalembert_tests::systems::{Bead, DoublePendulum};

fn start() -> State<f64, 2> {
    State::from_velocity(&DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 1.2]).unwrap()
}

#[test]
fn it_takes_the_steps_of_the_flow() {
    let trajectory = DoublePendulum::EXAMPLE.by(Midpoint, 0.1).run(start());
    let mut state = start();
    for step in trajectory.take(50) {
        let step = step.unwrap();
        // Another guess, the same root to rounding.
        let alone = DoublePendulum::EXAMPLE.by(Midpoint, 0.1).step(&state).unwrap();
        assert!(
            (alone.state.q - step.state.q).amax() < 1e-14 && (alone.state.p - step.state.p).amax() < 1e-14
        );
        assert!((state.q + step.velocity * 0.1 - step.state.q).amax() < 1e-15);
        state = step.state;
    }
}

#[test]
fn its_guess_saves_iterations() {
    let with_history: u32 = DoublePendulum::EXAMPLE
        .by(Midpoint, 0.02)
        .run(start())
        .take(200)
        .map(|step| step.unwrap().report.iterations)
        .sum();
    let mut state = start();
    let from_velocity: u32 = (0..200)
        .map(|_| {
            let step = DoublePendulum::EXAMPLE.by(Midpoint, 0.02).step(&state).unwrap();
            state = step.state;
            step.report.iterations
        })
        .sum();
    // Without one, a step starts at the velocity of its state.
    assert!(5 * with_history < 4 * from_velocity, "{with_history} {from_velocity}");
}

/// Cubic drag, R = r v³/3: no real step beyond its fold.
#[rayleigh_system]
fn cubic_drag(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.0 * q[0], r * v[0].powi(3) / 3.0)
}

#[test]
fn an_error_ends_it_and_another_step_size_lets_it_go_on() {
    let system = CubicDrag { m: 1.0, r: 1.0 };
    let start = State { q: vector![0.5], p: vector![-1.3] };
    let mut trajectory = system.by(Midpoint, 1.0).run(start);
    // p = v + v²/2 has no root for p = −1.3.
    assert!(matches!(trajectory.next(), Some(Err(StepError::NoRealSolution { .. }))));
    assert_eq!(trajectory.state(), &start);
    assert_eq!(trajectory.time(), 0.0);
    assert!(trajectory.next().is_none() && trajectory.next().is_none(), "it has ended");

    trajectory.change_step_size(0.25);
    assert_eq!(trajectory.step_size(), 0.25);
    let step = trajectory.next().unwrap().unwrap();
    assert_eq!(trajectory.state(), &step.state);
    assert_eq!(trajectory.time(), 0.25);
    // v + v²/8 = −1.3
    assert!((step.velocity[0] - (5.6_f64.sqrt() - 4.0)).abs() < 1e-14);
}

#[test]
fn a_step_size_that_is_no_number_leaves_its_time_and_state() {
    let mut trajectory = DoublePendulum::EXAMPLE.by(Midpoint, 0.1).run(start());
    trajectory.next().unwrap().unwrap();
    let (time, state) = (trajectory.time(), *trajectory.state());
    for h in [f64::NAN, f64::INFINITY, 0.0] {
        trajectory.change_step_size(h);
        assert!(matches!(trajectory.next(), Some(Err(StepError::StepSize { .. }))));
        assert_eq!((trajectory.time(), *trajectory.state()), (time, state));
    }
    trajectory.change_step_size(0.1);
    trajectory.next().unwrap().unwrap();
    assert_eq!(trajectory.time(), 0.1 + 0.1);
}

#[test]
fn its_time_is_a_product_and_not_a_sum() {
    let mut trajectory = Bead::EXAMPLE.by(Midpoint, 0.1).run(State { q: vector![0.1], p: vector![0.0] });
    let mut sum = 0.0;
    for steps in 1..=10_000_u32 {
        trajectory.next().unwrap().unwrap();
        sum += 0.1;
        assert_eq!(trajectory.time(), 0.1 * f64::from(steps));
    }
    // Positive control: a running sum is off.
    assert!((sum - trajectory.time()).abs() > 1e-10);
    trajectory.change_step_size(-0.5);
    trajectory.next().unwrap().unwrap();
    assert_eq!(trajectory.time(), 1000.0 - 0.5);
}

#[test]
fn samples_are_its_every_kth_state() {
    let mut sampled = DoublePendulum::EXAMPLE.by(Midpoint, 0.1).run(start());
    let mut plain = DoublePendulum::EXAMPLE.by(Midpoint, 0.1).run(start());
    for sample in sampled.sample_every(7).take(20) {
        let sample = sample.unwrap();
        let (mut iterations, mut worst, mut previous) = (0, 0.0_f64, SVector::zeros());
        for _ in 0..7 {
            previous = plain.state().q;
            let report = plain.next().unwrap().unwrap().report;
            iterations += u64::from(report.iterations);
            worst = worst.max(report.residual / report.floor);
        }
        assert_eq!(&sample.state, plain.state());
        assert_eq!(sample.time, plain.time());
        assert_eq!((sample.iterations, sample.worst_residual), (iterations, worst));
        assert_eq!(sample.previous, previous);
        assert_eq!(sample.damped, 0);
    }
}

#[test]
fn a_stride_of_0_counts_as_1() {
    let mut sampled = DoublePendulum::EXAMPLE.by(Midpoint, 0.1).run(start());
    let mut plain = DoublePendulum::EXAMPLE.by(Midpoint, 0.1).run(start());
    let sample = sampled.sample_every(0).next().unwrap().unwrap();
    assert_eq!(sample.state, plain.next().unwrap().unwrap().state);
}

#[test]
fn an_error_between_two_samples_is_returned_at_once() {
    // Accelerated by its drag (v < 0), p = v + hv²/2 reaches the fold after some steps.
    let system = CubicDrag { m: 1.0, r: 1.0 };
    let start = State { q: vector![0.0], p: vector![-0.2] };
    let mut plain = system.by(Midpoint, 0.5).run(start);
    let good = plain.by_ref().take_while(Result::is_ok).count() as u64;
    assert!(good > 2, "{good}");

    let mut sampled = system.by(Midpoint, 0.5).run(start);
    let mut samples = sampled.sample_every(good + 1);
    assert!(matches!(samples.next(), Some(Err(StepError::NoRealSolution { .. }))));
    assert!(samples.next().is_none());
    assert_eq!(sampled.state(), plain.state());
    assert_eq!(sampled.time(), 0.5 * good as f64);
}
