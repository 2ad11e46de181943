//! Every case by every method that takes it: midpoint, trapezoidal, Gauss with 3 stages, Kahan and Li's
//! composition of order 6 of the midpoint rule, and the rules for damping where they apply.

use std::f64::consts::TAU;

use dalembert::nalgebra::vector;
use dalembert::run::Explicit;
use dalembert::system::ForcedLagrangian;
use dalembert::{
    Composition, Discrete, Discretise, Fitted, FittedTrapezoidal, Gauss, Midpoint, OneSided, Splitting,
    State, StepError, Trapezoidal,
};
use dalembert_tests::hard::{
    Arm, Block, CubicDrag, DampedMass, Effort, Fermi, FirstOrder, HenonHeiles, Kepler, MathewsLakshmanan,
    Oscillator, Progress, Scaled, SpringPendulum, TwoPendulums, UNITS, UniformField, VanDerPol, drive,
    drive_composed,
};

/// The largest of what `measure` says of the states, and how the run went.
#[derive(Debug)]
struct Run {
    largest: f64,
    stopped: Option<StepError>,
    steps: u64,
}

fn watched<const N: usize>(
    measure: &impl Fn(&Progress<N>) -> f64,
    run: impl FnOnce(&mut dyn FnMut(Progress<N>)) -> Effort,
) -> Run {
    let mut largest = 0.0_f64;
    let effort = run(&mut |at| largest = largest.max(measure(&at)));
    Run { largest, stopped: effort.stopped, steps: effort.steps }
}

fn by<S, R, const N: usize>(
    system: &S,
    rule: R,
    h: f64,
    start: State<f64, N>,
    steps: u64,
    measure: &impl Fn(&Progress<N>) -> f64,
) -> Run
where
    S: Discrete<R, N, Scalar = f64>,
{
    watched(measure, |look| drive(system, rule, h, start, [steps, 1], look))
}

/// The splittings of order 4 and 6.
fn by_splittings<S, const N: usize>(
    system: &S,
    h: f64,
    start: State<f64, N>,
    steps: u64,
    measure: impl Fn(&Progress<N>) -> f64,
) -> [Run; 2]
where
    S: Explicit<N, Scalar = f64>,
{
    let (four, six) = (Splitting::blanes_moan_4(), Splitting::blanes_moan_6());
    [
        watched(&measure, |look| drive_composed(system.by(four, h).run(start), steps, look)),
        watched(&measure, |look| drive_composed(system.by(six, h).run(start), steps, look)),
    ]
}

/// Midpoint, trapezoidal, Gauss, composition.
fn by_each<S, const N: usize>(
    system: &S,
    h: f64,
    start: State<f64, N>,
    steps: u64,
    measure: impl Fn(&Progress<N>) -> f64,
) -> [Run; 4]
where
    S: Discrete<Midpoint, N, Scalar = f64> + Discrete<Trapezoidal, N> + ForcedLagrangian<N, Scalar = f64>,
{
    let order_6 = Composition::kahan_li_6(Midpoint);
    [
        by(system, Midpoint, h, start, steps, &measure),
        by(system, Trapezoidal, h, start, steps, &measure),
        by(system, Gauss::<3>, h, start, steps, &measure),
        watched(&measure, |look| drive_composed(system.by(order_6, h).run(start), steps, look)),
    ]
}

/// That every run came to its end with what was measured below its bound.
#[track_caller]
fn assert_below<const K: usize>(case: &str, runs: &[Run; K], bounds: [f64; K]) {
    for (run, bound) in runs.iter().zip(bounds) {
        assert!(run.stopped.is_none() && run.largest < bound, "{case}: {runs:?}, bounds {bounds:?}");
    }
}

/// That every run came to its end or has an error which says that the step has no root that can be found.
#[track_caller]
fn assert_named(case: &str, runs: &[Run]) {
    for run in runs {
        let named = matches!(
            run.stopped,
            None | Some(
                StepError::NoRealSolution { .. }
                    | StepError::NotConverged { .. }
                    | StepError::NonFinite { .. }
                    | StepError::SingularNewtonMatrix { .. }
                    // Angles of which rounding takes more than a thousandth.
                    | StepError::LostPrecision { .. }
            )
        );
        assert!(named, "{case}: {runs:?}");
    }
}

/// J e^{kt}, which the flow keeps. Where the near side is resolved all are right to their order; where it is
/// not, a step returns a named error or J is right all the same.
#[test]
fn orbits_that_almost_collide_with_and_without_drag() {
    let resolved = if cfg!(debug_assertions) { 8_000 } else { 20_000 };
    for k in [0.0, 0.05] {
        for e in [0.9, 0.99, 0.999] {
            // The resolved orbits take long without optimisation.
            let is_left_out = cfg!(debug_assertions) && (e != 0.9 || k == 0.0);
            let counts: &[u64] = if is_left_out { &[1_000] } else { &[1_000, resolved] };
            for &steps in counts {
                let (system, start, h) = (Kepler { k }, Kepler::aphelion(e), TAU / steps as f64);
                let taken = if cfg!(debug_assertions) { steps } else { 3 * steps };
                let error = |at: &Progress<2>| {
                    let exact = Kepler::angular_momentum(&start) * (-k * at.time).exp();
                    (Kepler::angular_momentum(&at.state) / exact - 1.0).abs()
                };
                let runs = by_each(&system, h, start, taken, error);
                assert_named("Kepler", &runs);
                for run in &runs {
                    assert!(run.largest < if k == 0.0 { 1e-8 } else { 1e-3 }, "{k} {e} {steps}: {runs:?}");
                }
                if e == 0.9 && steps == resolved {
                    let drag = [3e-5, 1e-10, 1e-11, 1e-10];
                    assert_below("Kepler, resolved", &runs, if k == 0.0 { [1e-12; 4] } else { drag });
                }
                // The explicit fitted rule has the law exactly, resolved or not: what is left is the rounding
                // of q × p, on orbits thrown far out.
                let explicit = by(&system, FittedTrapezoidal, h, start, taken, &error);
                assert!(
                    explicit.stopped.is_none() && explicit.largest < 1e-7,
                    "{k} {e} {steps}: {explicit:?}"
                );
                for run in by_splittings(&system, h, start, taken, error) {
                    assert!(run.stopped.is_none() && run.largest < 1e-7, "{k} {e} {steps}: {run:?}");
                }
                let fitted = by(&system, Fitted, h, start, taken, &error);
                assert!(
                    fitted.largest <= runs[0].largest * 1.01 + 1e-12,
                    "{k} {e} {steps}: {fitted:?} {runs:?}"
                );
                assert_named("Kepler, fitted", &[fitted]);
            }
        }
    }
}

#[test]
fn chaotic_motions() {
    let system = TwoPendulums { r: 0.0 };
    let energy = |at: &Progress<2>| (at.state.energy(&system).unwrap() - 7.0).abs();
    let runs = by_each(
        &system,
        0.02,
        system.high_energy(),
        if cfg!(debug_assertions) { 400 } else { 10_000 },
        energy,
    );
    assert_below("double pendulum", &runs, [0.1, 0.15, 1e-5, 1e-4]);
    // The trapezoidal rule leaves the well at these steps after some 40 000: a limit of the rule, not of the
    // solver.
    let start = HenonHeiles::start(1.0 / 6.0, -0.1, 0.1);
    let energy = |at: &Progress<2>| (HenonHeiles::energy_of(&at.state) - 1.0 / 6.0).abs();
    let steps = if cfg!(debug_assertions) { 2_500 } else { 20_000 };
    let runs = by_each(&HenonHeiles { r: 0.0 }, 0.05, start, steps, energy);
    assert_below("Hénon–Heiles", &runs, [1e-4, 5e-4, 1e-12, 1e-11]);
    let runs = by_splittings(&HenonHeiles { r: 0.0 }, 0.05, start, steps, energy);
    assert_below("Hénon–Heiles, splittings", &runs, [1e-9, 1e-12]);
}

/// Spring pendulums of every ratio by Gauss: residuals that grow with the square of a sideways step, and
/// rounding of the spring's force far above that of the momentum. The energy is that of the start, to the
/// rounding of the spring's, ½k(ε|q|)², and its force times the way.
#[test]
fn stiff_springs_by_gauss() {
    for ratio in [1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8] {
        let system = SpringPendulum { k: ratio * ratio, r: 0.0 };
        let start = system.at_angle(1.0);
        let energy = |at: &Progress<2>| (system.energy_of(&at.state) - system.energy_of(&start)).abs();
        let run =
            by(&system, Gauss::<3>, 1e-3, start, if cfg!(debug_assertions) { 250 } else { 3_000 }, &energy);
        let bound = 1e-12 + 1e-10 * ratio / 1e4 + 1e-18 * system.k;
        assert!(run.stopped.is_none() && run.largest < bound.max(1e-15 * system.k), "{ratio:e}: {run:?}");
    }
    // ωh² up to 1, as far as the midpoint rule is stable; its composition shares the limit.
    for ratio in [1e2, 1e4] {
        let system = SpringPendulum { k: ratio * ratio, r: 0.0 };
        let start = system.at_angle(1.0);
        let energy = |at: &Progress<2>| (system.energy_of(&at.state) - system.energy_of(&start)).abs();
        let [midpoint, trapezoidal, gauss, order_6] =
            by_each(&system, 0.01, start, if cfg!(debug_assertions) { 200 } else { 2_000 }, energy);
        assert_below("spring pendulum", &[midpoint, gauss, order_6], [2e-2, 1e-9, 0.1]);
        // The explicit one asks for h below the spring's period, and says so.
        assert!(trapezoidal.stopped.is_none() == (ratio == 1e2), "{trapezoidal:?}");
    }
}

/// The start of Fermi's chain: coordinates at rest without a force, whose residuals have no scale.
#[test]
fn fermi_by_each() {
    let system = Fermi { omega: 50.0, r: 0.0 };
    let start = system.start();
    let energy =
        |at: &Progress<6>| (at.state.energy(&system).unwrap() - start.energy(&system).unwrap()).abs();
    let steps = if cfg!(debug_assertions) { 400 } else { 5_000 };
    let runs = by_each(&system, 0.01, start, steps, energy);
    assert_below("Fermi, energy", &runs, [5e-4, 0.1, 1e-8, 1e-7]);
    assert_below("Fermi, splittings", &by_splittings(&system, 0.01, start, steps, energy), [1e-4, 1e-5]);
    let sum = |at: &Progress<6>| (system.stiff_energies(&at.state).iter().sum::<f64>() - 1.0).abs();
    let runs = by_each(&system, 0.01, start, steps, sum);
    assert_below("Fermi, sum of stiff energies", &runs, [0.15; 4]);
}

/// The lowest point of stick and slip, −μ/k − u = −1.1.
#[test]
fn dry_friction() {
    let steps = if cfg!(debug_assertions) { 1_300 } else { 1_600 };
    for epsilon in [1e-2, 1e-4, 1e-6] {
        let system = Block { k: 1.0, mu: 1.0, u: 0.1, epsilon };
        let start = State { q: vector![0.0], p: vector![-0.1] };
        let lowest = |at: &Progress<1>| -at.state.q[0];
        let [midpoint, trapezoidal, gauss, order_6] = by_each(&system, 1e-2, start, steps, lowest);
        let one_sided = by(&system, OneSided, 1e-2, start, steps, &lowest);
        for run in [midpoint, trapezoidal, gauss, one_sided] {
            let expected = 1.1 - 3.0 * epsilon;
            assert!(
                run.stopped.is_none() && (run.largest - expected).abs() < 1e-2 + epsilon,
                "{epsilon:e}: {run:?}"
            );
        }
        // Negative substeps make friction accelerate: a composition may have no root there, and says so.
        assert_named("block", &[order_6]);
    }
}

#[test]
fn folds_and_damping_of_the_wrong_sign() {
    let system = CubicDrag { m: 1.3, r: 0.6 };
    let h = 0.4;
    let fold = -1.3 * 1.3 / (2.0 * h * 0.6);
    let momentum = |at: &Progress<1>| at.state.p[0].abs();
    // p(t) = p/(1 + rpt/m²) of the flow: blows up at a share of 2.
    for share in [0.1, 0.5, 0.9] {
        let runs = by_each(&system, h, State { q: vector![0.0], p: vector![fold * share] }, 1, momentum);
        let exact = fold * share / (1.0 + 0.6 * fold * share * h / 1.69);
        for (run, tolerance) in runs.iter().zip([0.5, 0.5, 1e-2, 1e-2]) {
            assert!((run.largest / exact.abs() - 1.0).abs() < tolerance, "{share}: {runs:?} {exact}");
        }
    }
    for share in [1e1, 1e3] {
        let runs = by_each(&system, h, State { q: vector![0.0], p: vector![fold * share] }, 1, momentum);
        for run in runs {
            assert!(matches!(run.stopped, Some(StepError::NoRealSolution { .. })), "{share}: {run:?}");
        }
    }

    // Negative damping grows by e^{2|z|}; the fitted rules have that exactly, and no singular step.
    let start = State { q: vector![0.0], p: vector![1.0] };
    for z in [0.1, 0.9, 1.0, 3.0] {
        let system = DampedMass { m: 1.0, r: -2.0 * z / 0.5 };
        let exact = f64::exp(2.0 * z);
        for run in [
            by(&system, Fitted, 0.5, start, 1, &momentum),
            by(&system, FittedTrapezoidal, 0.5, start, 1, &momentum),
        ] {
            assert!((run.largest / exact - 1.0).abs() < 1e-14, "{z}: {run:?}");
        }
        let [midpoint, trapezoidal, gauss, order_6] = by_each(&system, 0.5, start, 1, momentum);
        for run in [midpoint, trapezoidal] {
            if z == 1.0 {
                assert!(matches!(run.stopped, Some(StepError::SingularNewtonMatrix { .. })), "{run:?}");
            } else {
                assert!((run.largest / ((1.0 + z) / (1.0 - z)).abs() - 1.0).abs() < 1e-13, "{z}: {run:?}");
            }
        }
        if z <= 1.0 {
            assert!(
                (gauss.largest / exact - 1.0).abs() < 2e-3 && (order_6.largest / exact - 1.0).abs() < 5e-2
            );
        }
    }

    // Damping of both signs, depending on q: the cycle's amplitude.
    // Half a cycle at least.
    let [few, many] = if cfg!(debug_assertions) { [1_000, 10_000] } else { [3_000, 40_000] };
    for (mu, h, steps) in [(1.0, 0.02, few), (50.0, 0.005, many)] {
        let start = State { q: vector![2.0], p: vector![0.0] };
        let runs = by_each(&VanDerPol { mu }, h, start, steps, |at| at.state.q[0].abs());
        for run in &runs {
            assert!(run.stopped.is_none() && (run.largest - 2.005).abs() < 2e-2, "{mu}: {runs:?}");
        }
    }
}

/// |p1/p0| of a free mass in the limit of stiff damping: 1 by every rule that is A-stable and no more, Gauss included; 0 by the fitted ones.
#[test]
fn stiff_damping() {
    let start = State { q: vector![0.0], p: vector![1.0] };
    for ratio in [1e3, 1e4, 1e6] {
        let system = DampedMass { m: 1.0, r: ratio };
        let momentum = |at: &Progress<1>| at.state.p[0].abs();
        for run in by_each(&system, 1.0, start, 1, momentum) {
            assert!((1.0 - run.largest).abs() < 300.0 / ratio, "{ratio:e}: {run:?}");
        }
        assert!(by(&system, Fitted, 1.0, start, 1, &momentum).largest < 1e-300);
        assert!(by(&system, FittedTrapezoidal, 1.0, start, 1, &momentum).largest < 1e-300);
        // Drifts backwards are undone: those by so much that e^{0.49 hr/m} overflows return a named error.
        for run in by_splittings(&system, 1.0, start, 1, momentum) {
            let is_named = matches!(run.stopped, Some(StepError::NonFinite { .. }));
            assert!(if ratio < 1.5e3 { run.largest < 1e-300 } else { is_named }, "{ratio:e}: {run:?}");
        }
        assert!(by(&system, OneSided, 1.0, start, 1, &momentum).largest < 4.0 / (ratio * ratio));
    }
}

#[test]
fn gyroscopic_terms_keep_the_speed() {
    let steps = if cfg!(debug_assertions) { 400 } else { 1_000 };
    for b in [1.0, 1e3, 1e6] {
        let system = UniformField { b, r: 0.0 };
        let error = |at: &Progress<2>| {
            let [x, y] = system.velocity_of(&at.state);
            (x.hypot(y) - 1.0).abs()
        };
        assert_below("field", &by_each(&system, 0.1, UniformField::start(), steps, error), [1e-11; 4]);
    }
}

#[test]
fn masses_up_to_their_singularity() {
    for a in [0.9, 0.999] {
        let system = MathewsLakshmanan { lambda: -1.0, r: 0.0 };
        let omega = system.frequency(a);
        let error = |at: &Progress<1>| (at.state.q[0] - a * (omega * at.time).sin()).abs();
        let runs = by_each(
            &system,
            TAU / omega / 2_000.0,
            system.start(a),
            if cfg!(debug_assertions) { 500 } else { 4_000 },
            error,
        );
        assert_below("Mathews–Lakshmanan", &runs, [1e-4, 5e-3, 1e-10, 1e-9]);
    }
    let steps = if cfg!(debug_assertions) { 1_000 } else { 5_000 };
    for m in [1e-2, 1e-4, 1e-6] {
        let system = Arm { m, r: 0.0 };
        let start = State::from_velocity(&system, [0.3, 0.31], [0.2, 0.25]).unwrap();
        let energy =
            |at: &Progress<2>| (at.state.energy(&system).unwrap() - start.energy(&system).unwrap()).abs();
        assert_below(
            "arm",
            &by_each(&system, 0.02 * m.sqrt(), start, steps, energy),
            [1e-5, 1e-5, 1e-9, 1e-9],
        );
    }
    let start = State { q: vector![0.1, 0.2], p: vector![0.3, 0.4] };
    for run in by_each(&FirstOrder { r: 0.1 }, 0.1, start, 1, |_| 0.0) {
        assert_eq!((run.stopped, run.steps), (Some(StepError::DegenerateLagrangian { column: 0 }), 0));
    }
}

/// Gauss in units that differ by 24 decades takes the very same steps; so does any method with other units of
/// mass and time.
#[test]
fn units() {
    let (plain, scaled) = (Scaled { units: [1.0; 3], r: 0.1 }, Scaled { units: UNITS, r: 0.1 });
    let (q, p) = ([1.1, -0.6, 0.4], [0.3, 1.2, -0.5]);
    let a = plain.by(Gauss::<3>, 0.05).run(plain.state(q, p));
    let b = scaled.by(Gauss::<3>, 0.05).run(scaled.state(q, p));
    for (a, b) in a.zip(b).take(if cfg!(debug_assertions) { 400 } else { 1_000 }) {
        let (a, b) = (a.unwrap(), b.unwrap());
        assert!((scaled.plain(&b.state).q - a.state.q).amax() < 1e-13);
    }

    // Mass in units of 2⁻⁹⁰ and time in units of 2⁻³⁰, as for atoms: m → 2⁹⁰m, h → 2³⁰h, r → 2⁶⁰r, k → 2³⁰k,
    // p → 2⁶⁰p.
    let (mass, time) = (2.0_f64.powi(90), 2.0_f64.powi(30));
    let plain = Oscillator { m: 1.3, k: 0.7, r: 0.2, f: 0.3 };
    let atomic = Oscillator {
        m: 1.3 * mass,
        k: 0.7 * mass / time / time,
        r: 0.2 * mass / time,
        f: 0.3 * mass / time / time,
    };
    fn same<R: Copy>(rule: R, [a, b]: [&Oscillator; 2], time: f64, momentum: f64)
    where
        Oscillator: Discrete<R, 1, Scalar = f64>,
    {
        let start = |unit: f64| State { q: vector![0.4], p: vector![-0.2 * unit] };
        let a = a.by(rule, 0.1).run(start(1.0));
        let b = b.by(rule, 0.1 * time).run(start(momentum));
        for (a, b) in a.zip(b).take(if cfg!(debug_assertions) { 200 } else { 500 }) {
            let (a, b) = (a.unwrap(), b.unwrap());
            // Powers of 2 round nothing.
            assert!((a.state.q - b.state.q).amax() < 1e-15 && a.report.iterations == b.report.iterations);
        }
    }
    let both = [&plain, &atomic];
    same(Midpoint, both, time, mass / time);
    same(Trapezoidal, both, time, mass / time);
    same(Gauss::<3>, both, time, mass / time);
    same(Fitted, both, time, mass / time);
    same(FittedTrapezoidal, both, time, mass / time);
    same(OneSided, both, time, mass / time);
}

/// Forward and back again, without friction, by Gauss and by a composition.
#[test]
fn time_reverses() {
    let (system, start) = (Kepler { k: 0.0 }, Kepler::aphelion(0.6));
    let mut run = system.by(Gauss::<3>, 0.05).run(start);
    run.by_ref().take(2_000).for_each(|step| assert!(step.is_ok()));
    run.change_step_size(-0.05);
    run.by_ref().take(2_000).for_each(|step| assert!(step.is_ok()));
    assert!((run.state().q - start.q).amax() < 1e-11 && (run.state().p - start.p).amax() < 1e-11);

    let order_6 = Composition::kahan_li_6(Midpoint);
    let mut state = start;
    for h in [0.05, -0.05] {
        state = system.by(order_6, h).run(state).take(500).last().unwrap().unwrap().state;
    }
    assert!((state.q - start.q).amax() < 1e-11);
    // The control: a way back of another length.
    let other = system.by(order_6, -0.05).run(state).take(499).last().unwrap().unwrap().state;
    assert!((other.q - start.q).amax() > 1e-2);
}

/// From h = ±1e-12 to ±1e12: a step, or a named error that says what is wrong with it.
#[test]
fn steps_of_every_size_by_gauss_and_by_composition() {
    let (system, steps) = (TwoPendulums { r: 0.01 }, if cfg!(debug_assertions) { 8 } else { 20 });
    // Without optimisation every second size.
    for exponent in (-12..=12).step_by(if cfg!(debug_assertions) { 2 } else { 1 }) {
        for sign in [1.0, -1.0] {
            let h = sign * 10.0_f64.powi(exponent);
            let runs = by_each(&system, h, system.high_energy(), steps, |_| 0.0);
            assert_named("sizes", &runs);
            assert!(exponent >= -1 || runs.iter().all(|run| run.stopped.is_none()), "{h:e}: {runs:?}");
        }
    }
}

/// Odd values in every argument of the rules that the test of the plain rules leaves out.
#[test]
fn odd_values_by_the_other_rules() {
    const ODD: [f64; 11] =
        [0.0, -0.0, 5e-324, -1e-310, 1e-200, 1.0, 1e150, -1e200, f64::MAX, f64::NEG_INFINITY, f64::NAN];
    /// Of the combinations of q, p and h, without optimisation a fifth: of any two of them all.
    const EVERY: usize = if cfg!(debug_assertions) { 5 } else { 1 };
    fn all<R: Copy>(rule: R) -> [u32; 2]
    where
        Oscillator: Discrete<R, 1, Scalar = f64>,
    {
        let mut counts = [0; 2];
        for field in [1.0, 1e-300, 1e300, f64::NAN, f64::INFINITY, 0.0] {
            for which in 0..3 {
                let mut system = Oscillator { m: 1.3, k: 0.7, r: 0.2, f: 0.3 };
                *[&mut system.m, &mut system.k, &mut system.r][which] = field;
                for (i, q) in ODD.into_iter().enumerate() {
                    for (j, p) in ODD.into_iter().enumerate() {
                        for (k, h) in ODD.into_iter().enumerate() {
                            if (i + j + k) % EVERY != 0 {
                                continue;
                            }
                            let state = State { q: vector![q], p: vector![p] };
                            match system.by(rule, h).step(&state) {
                                Ok(step) => {
                                    counts[0] += 1;
                                    assert!(q.is_finite() && p.is_finite() && h.is_finite() && h != 0.0);
                                    assert!(field.is_finite(), "{system:?} {state:?} {h:e}: {step:?}");
                                    assert!(step.state.q[0].is_finite() && step.state.p[0].is_finite());
                                }
                                Err(_) => counts[1] += 1,
                            }
                        }
                    }
                }
            }
        }
        counts
    }
    for [taken, refused] in [all(Gauss::<3>), all(Fitted), all(FittedTrapezoidal), all(OneSided)] {
        let least = 1_000 / EVERY as u32;
        assert!(taken > least && refused > least, "{taken} {refused}");
    }
}
