//! Friction that is stiff, not smooth, of the wrong sign, or without a real step.

use dalembert::nalgebra::vector;
use dalembert::system::Function;
use dalembert::{
    Discrete, Discretise, Fitted, FittedTrapezoidal, Midpoint, OneSided, State, StepError, Trapezoidal,
};
use dalembert_tests::hard::{
    Block, Cancelling, CubicDrag, DampedMass, Oscillator, Overflowing, UniformField, VanDerPol, drive,
};

/// v̄_{k+1}/v̄_k of a damped free mass.
fn ratio<R: Copy>(rule: R, hr_over_m: f64) -> f64
where
    DampedMass: Discrete<R, 1, Scalar = f64>,
{
    let (m, h) = (1.3, 0.5);
    let system = DampedMass { m, r: hr_over_m * m / h };
    let mut trajectory = system.by(rule, h).run(State { q: vector![0.0], p: vector![1.0] });
    let [a, b] = [(); 2].map(|()| trajectory.next().unwrap().unwrap().velocity[0]);
    b / a
}

/// Midpoint and trapezoidal rule multiply v̄ by (2m − hr)/(2m + hr): past hr = 2m the sign alternates, and
/// for hr/m → ∞ nothing is damped any more.
#[test]
fn midpoint_rings_past_twice_the_mass_over_h() {
    for hr_over_m in [0.1, 1.0, 1.99, 2.01, 10.0, 1e2, 1e4, 1e6] {
        let z = 0.5 * hr_over_m;
        let expected = (1.0 - z) / (1.0 + z);
        for ratio in [ratio(Midpoint, hr_over_m), ratio(Trapezoidal, hr_over_m)] {
            // (1 − z) carries an error of ε·z, the momenta some roundings.
            assert!((ratio - expected).abs() < 1e-14 * (1.0 + 0.1 * z), "{hr_over_m:e}: {ratio} {expected}");
            assert_eq!(ratio < 0.0, hr_over_m > 2.0);
        }
    }
}

/// The fitted rules decay as the flow does, the one-sided one by 1/(1 + hr/2m)²: none rings.
#[test]
fn the_rules_for_stiff_damping_do_not_ring() {
    for hr_over_m in [0.1, 1.0, 2.01, 10.0, 30.0] {
        let exact = f64::exp(-hr_over_m);
        // v̄ of the second step is that of the first times the decay, to the rounding of the first momentum.
        for ratio in [ratio(Fitted, hr_over_m), ratio(FittedTrapezoidal, hr_over_m)] {
            assert!((ratio - exact).abs() < 1e-15 * (1.0 + hr_over_m), "{hr_over_m}: {ratio:e} {exact:e}");
        }
        let ratio = ratio(OneSided, hr_over_m);
        assert!(
            (ratio * (1.0 + 0.5 * hr_over_m).powi(2) - 1.0).abs() < 1e-13 * (1.0 + hr_over_m),
            "{hr_over_m}: {ratio}"
        );
    }
    for hr_over_m in [1e3, 1e6] {
        assert!(ratio(Fitted, hr_over_m).abs() < 1e-15 && ratio(FittedTrapezoidal, hr_over_m).abs() < 1e-15);
    }
}

/// The rest position under a constant force is exact at any stiffness, ringing or not.
#[test]
fn equilibria_and_terminal_velocities_are_exact() {
    for r in [1e-1, 1e1, 1e3, 1e6] {
        for (k, f) in [(2.0, 3.0), (0.0, 3.0)] {
            let system = Oscillator { m: 1.3, k, r, f };
            let (q, v) = if k > 0.0 { (f / k, 0.0) } else { (0.0, f / r) };
            let start = State::from_velocity(&system, [q], [v]).unwrap();
            for step in system.by(Midpoint, 0.25).run(start).take(200) {
                let step = step.unwrap();
                assert!(
                    (step.velocity[0] - v).abs() < 1e-13 * (1.0 + v.abs()),
                    "r = {r:e}: {}",
                    step.velocity[0]
                );
                assert!((step.state.p[0] - start.p[0]).abs() < 1e-12 * (1.0 + start.p[0].abs()), "{step:?}");
            }
        }
    }
}

/// The block is carried along with the floor until the spring holds the friction μ, then slips: q̈ = −kq − μ
/// from there on, so that q swings about −μ/k with the amplitude u/√k.
#[test]
fn stick_and_slip() {
    let (k, mu, u, h) = (1.0, 1.0, 0.1, 1e-2);
    for epsilon in [1e-2, 1e-4, 1e-6] {
        let system = Block { k, mu, u, epsilon };
        let start = State { q: vector![0.0], p: vector![-u] };
        let mut trajectory = system.by(Midpoint, h).run(start);
        let (mut slipped, mut lowest) = (None, 0.0_f64);
        while trajectory.time() < 16.0 {
            let step = trajectory.next().unwrap().unwrap();
            assert!(step.report.iterations <= 20, "{:?}", step.report);
            if slipped.is_none() && step.velocity[0] + u > 0.5 * u {
                slipped = Some(trajectory.time());
            }
            lowest = lowest.min(step.state.q[0]);
        }
        // k u t = μ at the slip. Before, it creeps at ε artanh(kut/μ), by ε ln 2 μ/(ku) in all; speed u/2
        // takes another π/3.
        let (release, creep) = (mu / (k * u), epsilon * 2.0_f64.ln() * mu / (k * u * u));
        let slipped = slipped.unwrap();
        let expected = release + std::f64::consts::FRAC_PI_3;
        assert!((slipped - expected).abs() < 2.0 * h + 2.0 * creep, "ε = {epsilon:e}: {slipped} {expected}");
        assert!((lowest + mu / k + u).abs() < h + 2.0 * creep * u, "ε = {epsilon:e}: {lowest}");
    }
}

/// A block that slides to rest: the distance is v²/2μ, and there it stays, to within ε. Past the fold hr = 2m
/// of its regularised friction the midpoint momentum rings: that is the rule, and q does not show it.
#[test]
fn sliding_to_rest() {
    let (mu, v, h) = (0.7, 1.3, 1e-3);
    for epsilon in [1e-2, 1e-4, 1e-6] {
        let system = Block { k: 0.0, mu, u: 0.0, epsilon };
        let mut trajectory = system.by(Midpoint, h).run(State { q: vector![0.0], p: vector![v] });
        for _ in 0..4_000 {
            trajectory.next().unwrap().unwrap();
        }
        let distance = v * v / (2.0 * mu);
        let rest = trajectory.state().q[0];
        // The last velocities below ε decay by e^{−μt/ε}, over a way of order ε²/μ · ln; the rule adds its
        // h².
        assert!(
            (rest - distance).abs() < 10.0 * epsilon * epsilon.max(v) + h * h,
            "{epsilon:e}: {rest} {distance}"
        );
        assert!(trajectory.state().p[0].abs() <= 0.5 * h * mu + 10.0 * epsilon, "{:?}", trajectory.state());
    }
}

/// The one-sided rule neither rings nor overshoots: p falls to 0 and stays there.
#[test]
fn sliding_to_rest_without_ringing() {
    let (mu, v, h) = (0.7, 1.3, 1e-3);
    let system = Block { k: 0.0, mu, u: 0.0, epsilon: 1e-6 };
    let start = State { q: vector![0.0], p: vector![v] };
    let mut before = v;
    for step in system.by(OneSided, h).run(start).take(4_000) {
        let p = step.unwrap().state.p[0];
        assert!((0.0..=before).contains(&p), "{before} {p}");
        before = p;
    }
    assert!(before < 1e-15, "{before:e}");
}

/// What the obvious formulas of the same friction do: an overflow is named; 1 − 1 near rest rounds as 1 does,
/// and there is rest to that rounding.
#[test]
fn friction_written_carelessly_is_named() {
    let (mu, epsilon, h) = (0.7, 1e-4, 1e-3);
    let start = State { q: vector![0.0], p: vector![1.3] };
    let step = Overflowing { mu, epsilon }.by(Midpoint, h).near(&start.p).step(&start);
    let error = step.unwrap_err();
    assert_eq!(error, StepError::NoDerivative { function: Function::Rayleigh, coordinate: 0, place: None });

    let system = Cancelling { mu, epsilon };
    let last = system.by(Midpoint, h).run(start).take(10_000).last().unwrap().unwrap().state.p[0];
    assert!(last.abs() <= 16.0 * f64::EPSILON * 0.5 * h * mu, "{last:e}");
    // The control: the same friction in two pieces.
    let system = Block { k: 0.0, mu, u: 0.0, epsilon };
    assert!(system.by(Midpoint, h).run(start).take(10_000).all(|step| step.is_ok()));
}

/// Cubic drag: within the fold the root found is the one that goes to 0 with the step, whatever the guess on
/// its side; beyond it there is none, and the error says so.
#[test]
fn cubic_drag_past_its_fold() {
    let system = CubicDrag { m: 1.3, r: 0.6 };
    let h = 0.4;
    // p = m v + (h/2) r v²
    let fold = -1.3 * 1.3 / (2.0 * h * 0.6);
    for share in [0.999, 0.9, 0.5, 0.1, -1.0, -100.0] {
        let state = State { q: vector![0.0], p: vector![fold * share] };
        let near = (-1.3 + (1.3_f64 * 1.3 + 2.0 * h * 0.6 * state.p[0]).sqrt()) / (h * 0.6);
        let turn = -1.3 / (h * 0.6);
        for guess in [0.0, near * 0.5, near * 2.0, 0.9 * turn].into_iter().filter(|guess| *guess > turn) {
            for step in [
                system.by(Midpoint, h).near(&vector![guess]).step(&state),
                system.by(Trapezoidal, h).near(&vector![guess]).step(&state),
            ] {
                let v = step.unwrap().velocity[0];
                assert!(
                    (v - near).abs() < 1e-12 * near.abs() / (1.0 - share).abs().sqrt(),
                    "{share} {guess}: {v} {near}"
                );
            }
        }
    }
    for share in [1.001, 2.0, 1e3] {
        let state = State { q: vector![0.0], p: vector![fold * share] };
        let step = system.by(Midpoint, h).step(&state);
        assert!(matches!(step, Err(StepError::NoRealSolution { .. })), "{share}: {step:?}");
    }
}

/// Negative damping grows by (1 + z)/(1 − z); at z = 1 the step is singular, and past it the root has the
/// wrong sign.
#[test]
fn negative_damping() {
    for z in [0.1, 0.5, 0.9] {
        let ratio = ratio(Midpoint, -2.0 * z);
        assert!((ratio - (1.0 + z) / (1.0 - z)).abs() < 1e-13 / (1.0 - z), "{z}: {ratio}");
    }
    let singular = DampedMass { m: 1.0, r: -4.0 };
    let start = State { q: vector![0.0], p: vector![1.0] };
    let step = singular.by(Midpoint, 0.5).step(&start);
    assert!(matches!(step, Err(StepError::SingularNewtonMatrix { .. })), "{step:?}");
}

/// The van der Pol oscillator: damping of both signs. Period and amplitude of its cycle are known.
#[test]
fn damping_that_changes_sign() {
    let system = VanDerPol { mu: 1.0 };
    let cycle = |h: f64| {
        let start = State { q: vector![2.0], p: vector![0.0] };
        let mut trajectory = system.by(Midpoint, h).run(start);
        let (mut crossings, mut amplitude, mut before) = (Vec::new(), 0.0_f64, (0.0, 2.0));
        while trajectory.time() < 120.0 {
            let step = trajectory.next().unwrap().unwrap();
            let now = (trajectory.time(), step.state.q[0]);
            if before.1 < 0.0 && now.1 >= 0.0 {
                crossings.push(before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1));
                amplitude = 0.0;
            }
            amplitude = amplitude.max(now.1.abs());
            before = now;
        }
        let cycles = crossings.len() - 4;
        ((crossings[crossings.len() - 1] - crossings[3]) / cycles as f64, amplitude)
    };
    let [(coarse, _), (fine, amplitude)] = [0.02, 0.01].map(cycle);
    let [period, known] = VanDerPol::CYCLE;
    assert!((fine - period).abs() < 5e-4, "{fine}");
    assert!((((coarse - period) / (fine - period)).log2() - 2.0).abs() < 0.3, "{coarse} {fine}");
    assert!((amplitude - known).abs() < 5e-4, "{amplitude}");
    // Strongly nonlinear: T → (3 − 2 ln 2) μ + 3·2.338107 μ^{−1/3}; the slow parts creep, the jumps do not
    // fail.
    let stiff = VanDerPol { mu: 50.0 };
    let effort =
        drive(&stiff, Midpoint, 0.005, State { q: vector![2.0], p: vector![0.0] }, [60_000, 1], |at| {
            assert!(at.state.q[0].abs() < 2.1, "{at:?}");
        });
    assert_eq!(effort.stopped, None);
}

/// A charge in a uniform field, from slow to far faster than h: the speed is kept exactly, each step turns it
/// by 2 arctan(hb/2).
#[test]
fn gyroscopic_terms() {
    let h = 0.1;
    for b in [0.1, 1.0, 1e2, 1e4, 1e6] {
        let system = UniformField { b, r: 0.0 };
        let mut trajectory = system.by(Midpoint, h).run(UniformField::start());
        let mut last: Option<[f64; 2]> = None;
        for step in 1..=1_000_u32 {
            let v = trajectory.next().unwrap().unwrap().velocity;
            // |v̄| = cos of half the angle turned.
            let speed = 1.0 / (1.0 + (0.5 * h * b).powi(2)).sqrt();
            assert!(
                (v.norm() / speed - 1.0).abs() < 1e-13 * f64::from(step).sqrt() * (1.0 + h * b),
                "b = {b:e}: {v}"
            );
            if let Some([x, y]) = last {
                let angle = (x * v[1] - y * v[0]).atan2(x * v[0] + y * v[1]);
                assert!((angle.abs() - 2.0 * (0.5 * h * b).atan()).abs() < 1e-10, "b = {b:e}: {angle}");
            }
            last = Some(v.into());
        }
    }
}
