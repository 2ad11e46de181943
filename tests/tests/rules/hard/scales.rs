//! Units, sizes of h, and time reversal.

use dalembert::nalgebra::vector;
use dalembert::step::Flow;
use dalembert::step::Quantity;
use dalembert::{Discrete, Discretise, Midpoint, State, StepError, Trapezoidal, rayleigh_system};
use dalembert_tests::hard::{HenonHeiles, Kepler, Oscillator, Scaled, TwoPendulums, UNITS, drive};

fn same_motion<R: Copy>(rule: R)
where
    Scaled: Discrete<R, 3, Scalar = f64>,
{
    let (plain, scaled) = (Scaled { units: [1.0; 3], r: 0.1 }, Scaled { units: UNITS, r: 0.1 });
    let (q, p) = ([1.1, -0.6, 0.4], [0.3, 1.2, -0.5]);
    let a = plain.by(rule, 0.05).run(plain.state(q, p));
    let b = scaled.by(rule, 0.05).run(scaled.state(q, p));
    for (a, b) in a.zip(b).take(if cfg!(debug_assertions) { 800 } else { 2_000 }) {
        let (a, b) = (a.unwrap(), b.unwrap());
        // Powers of 2 change no rounding but through the order of elimination, and friction forgets it.
        let b_state = scaled.plain(&b.state);
        let difference = (b_state.q - a.state.q).amax().max((b_state.p - a.state.p).amax());
        assert!(difference < 1e-13, "{difference:e}");
        assert!(a.report.iterations.abs_diff(b.report.iterations) <= 1, "{:?} {:?}", a.report, b.report);
    }
}

#[test]
fn units_that_differ_by_24_decades_change_nothing() {
    same_motion(Midpoint);
    same_motion(Trapezoidal);
}

/// Forward and back again: a self-adjoint rule without friction returns to where it started, to rounding
/// times how far neighbouring motions part on the way.
fn there_and_back<S, R: Copy, const N: usize>(
    system: &S,
    rule: R,
    h: f64,
    start: State<f64, N>,
    steps: u64,
) -> f64
where
    S: Discrete<R, N, Scalar = f64>,
{
    let mut trajectory = system.by(rule, h).run(start);
    for _ in 0..steps {
        trajectory.next().unwrap().unwrap();
    }
    trajectory.change_step_size(-h);
    for _ in 0..steps {
        trajectory.next().unwrap().unwrap();
    }
    assert!(trajectory.time().abs() < 1e-9 * h * steps as f64);
    let end = trajectory.state();
    (end.q - start.q).amax().max((end.p - start.p).amax())
}

#[test]
fn time_reverses_to_rounding_without_friction() {
    let kepler = Kepler { k: 0.0 };
    let start = Kepler::aphelion(0.6);
    for back in [
        there_and_back(&kepler, Midpoint, 0.01, start, 2_000),
        there_and_back(&kepler, Trapezoidal, 0.01, start, 2_000),
    ] {
        // The phase drifts by the roundings' energy times the time, twice: some (ht)² ε.
        assert!(back < 1e-11, "{back:e}");
    }
    let system = HenonHeiles { r: 0.0 };
    let back = there_and_back(&system, Midpoint, 0.05, HenonHeiles::start(1.0 / 12.0, 0.1, 0.0), 2_000);
    assert!(back < 1e-11, "{back:e}");
    let oscillator = Oscillator { m: 1.3, k: 0.7, r: 0.0, f: 0.0 };
    let start = State { q: vector![0.4], p: vector![-0.2] };
    for h in [1e-3, 0.1, 10.0] {
        let back = there_and_back(&oscillator, Midpoint, h, start, 10_000);
        // One rounding a step, all of one sign, at worst.
        assert!(back < 20_000.0 * f64::EPSILON, "{h}: {back:e}");
    }
}

/// The control: with friction the way back is another one, by self-adjointness the exact inverse all the
/// same; a rule that is not self-adjoint would not return.
#[test]
fn and_with_friction_while_digits_last() {
    let system = TwoPendulums { r: 0.05 };
    let start = State { q: vector![0.5, -0.3], p: vector![0.1, 0.2] };
    let back = there_and_back(&system, Midpoint, 0.02, start, 500);
    assert!(back < 1e-11, "{back:e}");
    // The energy had fallen in between.
    let mut end = start;
    drive(&system, Midpoint, 0.02, start, [500, 500], |at| end = at.state);
    assert!(start.energy(&system).unwrap() - end.energy(&system).unwrap() > 1e-2);
}

/// From h = 1e-12 up, each step is solved or returns a named `StepError`; up to its stability limit the
/// trapezoidal rule keeps a bounded energy.
#[test]
fn steps_of_every_size() {
    let (system, steps) = (TwoPendulums { r: 0.01 }, if cfg!(debug_assertions) { 40 } else { 100 });
    let start = system.high_energy();
    for exponent in -12..=12 {
        for sign in [1.0, -1.0] {
            let h = sign * 10.0_f64.powi(exponent);
            for stopped in [
                drive(&system, Midpoint, h, start, [steps, 1], |_| ()).stopped,
                drive(&system, Trapezoidal, h, start, [steps, 1], |_| ()).stopped,
            ] {
                assert!(exponent >= -1 || stopped.is_none(), "{h:e}: {stopped:?}");
            }
        }
    }
    // Störmer–Verlet is stable iff h²k/m < 4.
    let oscillator = Oscillator { m: 2.0, k: 0.5, r: 0.0, f: 0.0 };
    let limit = 2.0 * (2.0_f64 / 0.5).sqrt();
    let largest = |h: f64| {
        let mut largest = 0.0_f64;
        drive(&oscillator, Trapezoidal, h, State { q: vector![1.0], p: vector![0.0] }, [1_000, 1], |at| {
            largest = largest.max(at.state.q[0].abs());
        });
        largest
    };
    assert!(largest(0.99 * limit) < 10.0 && largest(1.01 * limit) > 1e10);
}

/// Potential of a particle that has run to infinity: huge, subnormal and infinite arguments.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn anharmonic(q: [f64; 1], v: [f64; 1], m: f64, a: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.25 * a * q[0] * q[0] * q[0] * q[0], 0.1 * v[0] * v[0])
}

const ODD: [f64; 13] = [
    0.0,
    -0.0,
    5e-324,
    -1e-310,
    f64::MIN_POSITIVE,
    1e-200,
    1.0,
    1e150,
    -1e200,
    f64::MAX,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

/// Every argument takes every odd value: a step is finite, or has an error; and what is not finite is never
/// called converged.
#[test]
fn odd_values_in_every_argument() {
    let (mut taken, mut refused) = (0, 0);
    for m in [1.0, 1e-300, 1e300, f64::NAN, f64::INFINITY, 0.0] {
        for a in [1.0, 0.0, 1e300, f64::NAN] {
            // One of the two odd at a time.
            if cfg!(debug_assertions) && m != 1.0 && a != 1.0 {
                continue;
            }
            let system = Anharmonic { m, a };
            for q in ODD {
                for p in ODD {
                    let made = State::from_velocity(&system, [q], [p]);
                    assert!(made.is_err() || made.is_ok_and(|s| s.q[0].is_finite() && s.p[0].is_finite()));
                    for h in ODD {
                        let state = State { q: vector![q], p: vector![p] };
                        for guess in [None, Some(vector![q]), Some(vector![p])] {
                            let steps = [
                                Flow::<Midpoint, 1>::step(&system, &state, h, guess.as_ref()),
                                Flow::<Trapezoidal, 1>::step(&system, &state, h, guess.as_ref()),
                            ];
                            for (step, takes_massless) in steps.into_iter().zip([true, false]) {
                                match step {
                                    Ok(step) => {
                                        taken += 1;
                                        assert!(q.is_finite() && p.is_finite() && h.is_finite() && h != 0.0);
                                        assert!(m.is_finite() && a.is_finite(), "{system:?} {step:?}");
                                        // A guess says that the Lagrangian is known to be regular.
                                        assert!(
                                            m != 0.0 || guess.is_some() || takes_massless,
                                            "{system:?} {step:?}"
                                        );
                                        assert!(step.state.q[0].is_finite() && step.state.p[0].is_finite());
                                        assert!(
                                            step.report.residual.is_finite() && step.velocity[0].is_finite()
                                        );
                                    }
                                    Err(error) => {
                                        refused += 1;
                                        if !q.is_finite() && h.is_finite() && h != 0.0 {
                                            let quantity = Quantity::Configuration;
                                            assert_eq!(error, StepError::NonFinite { quantity, index: 0 });
                                        }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
    assert!(taken > 5_000 && refused > taken, "{taken} {refused}");
}
