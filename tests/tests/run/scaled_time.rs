//! Steps that follow a time scale: what they are, what they keep, where they end.

use std::f64::consts::TAU;

use dalembert::nalgebra::{SVector, Vector2, vector};
use dalembert::step::Flow;
use dalembert::system::TimeScale;
use dalembert::{
    Checkpoint, Composition, Discretise, EnergyLedger, Gauss, Midpoint, Splitting, State, StepError,
    Trajectory, Trapezoidal, rayleigh_system,
};
use dalembert_tests::hard::{EccentricKepler, Kepler};
use rand::{RngExt, SeedableRng, rngs::StdRng};

const FREE: EccentricKepler = EccentricKepler { k: 0.0 };

/// λ = ∇σ·v/σ of σ = |q|^{3/2} on paper.
fn rate(state: &State<f64, 2>) -> f64 {
    1.5 * state.q.dot(&state.p) / state.q.norm_squared()
}

/// Every step is the method's own with a size by the recursion on paper, which the first starts at Δτ σ.
#[test]
fn steps_are_of_the_method_with_a_size_that_follows() {
    fn check<M: Copy>(method: M, step: f64)
    where
        EccentricKepler: Flow<M, 2, Scalar = f64>,
    {
        let start = Kepler::aphelion(0.9);
        let mut run = FREE.by(method, step).run(start).in_scaled_time();
        let mut density = 1.0 / (step * start.q.norm().powf(1.5)) - 0.5 * rate(&start);
        let mut state = start;
        for k in 0..200 {
            let taken = run.next().unwrap().unwrap();
            let h = run.step_size();
            assert!((h * density - 1.0).abs() < 1e-12, "{k}: {h:e} {:e}", 1.0 / density);
            let alone = FREE.by(method, h).step(&state).unwrap();
            assert!((taken.state.q - alone.state.q).norm() < 1e-13 * (1.0 + alone.state.q.norm()), "{k}");
            assert!((taken.state.p - alone.state.p).norm() < 1e-13 * (1.0 + alone.state.p.norm()), "{k}");
            state = taken.state;
            density = 1.0 / h - rate(&state);
        }
    }
    check(Gauss::<6>, 0.3);
    check(Gauss::<6>, -0.3);
    check(Trapezoidal, 0.02);
    check(Composition::kahan_li_6(Trapezoidal), 0.1);
    check(Splitting::blanes_moan_6(), 0.1);
}

/// With linear drag J = J₀ e^{−kt} to rounding, and the energy lost is what the rule says that friction took.
#[test]
fn drag_takes_its_due() {
    let system = EccentricKepler { k: 1e-3 };
    for (e, rounding) in [(0.99, 1e-13), (0.999, 1e-13)] {
        let start = Kepler::aphelion(e);
        let mut run = system.by(Gauss::<8>, 0.3).run(start).in_scaled_time();
        let (mut state, mut ledger) = (start, EnergyLedger::default());
        let (mut worst, mut momentum) = (0.0_f64, 0.0_f64);
        while run.time() < 10.0 * TAU {
            let next = run.next().unwrap().unwrap().state;
            let j = Kepler::angular_momentum(&start) * (-system.k * run.time()).exp();
            momentum = momentum.max((Kepler::angular_momentum(&next) / j - 1.0).abs());
            ledger += system.by(Gauss::<8>, run.step_size()).ledger(&state, &next).unwrap();
            worst = worst.max(ledger.remainder().abs());
            state = next;
        }
        assert!(momentum < rounding, "{e}: {momentum:e}");
        let taken = Kepler::energy_of(&start) - Kepler::energy_of(&state);
        assert!(taken > 0.03 && (ledger.dissipated / taken - 1.0).abs() < 1e-9, "{taken} {ledger:?}");
        // What is left of a passage of the near side at speeds of 14 and 45.
        assert!(worst < if e < 0.995 { 1e-11 } else { 2e-10 }, "{e}: {worst:e}");
    }
}

/// From p reversed, and the step that would have come next, the run retraces its steps to its start.
#[test]
fn a_run_is_reversible() {
    let start = Kepler::aphelion(0.9);
    let mut run = FREE.by(Gauss::<4>, 0.4).run(start).in_scaled_time();
    let mut sizes = Vec::new();
    for _ in 0..100 {
        run.next().unwrap().unwrap();
        sizes.push(run.step_size());
    }
    let state = *run.state();
    run.next().unwrap().unwrap();
    let checkpoint = Checkpoint {
        state: State { q: state.q, p: -state.p },
        step_size: run.step_size(),
        origin: 0.0,
        steps: 1,
    };
    let mut back = Trajectory::resume(&FREE, Gauss::<4>, checkpoint).in_scaled_time();
    for size in sizes.iter().rev() {
        back.next().unwrap().unwrap();
        assert!((back.step_size() / size - 1.0).abs() < 1e-10, "{} {size}", back.step_size());
    }
    assert!((back.state().q - start.q).norm() < 1e-10, "{:?}", back.state());
    assert!((back.state().p + start.p).norm() < 1e-10, "{:?}", back.state());
}

/// The way back from the end of 100 steps, with the 1/h that would have come next: with p reversed and h > 0,
/// and with p as it is and h < 0. The largest distances from the start, of q and p.
fn ways_back<L>(system: &L, start: State<f64, 2>) -> [f64; 2]
where
    L: TimeScale<2> + Flow<Gauss<4>, 2, Scalar = f64>,
{
    let mut run = system.by(Gauss::<4>, 0.4).run(start).in_scaled_time();
    let end = run.by_ref().take(100).last().unwrap().unwrap().state;
    run.next().unwrap().unwrap();
    [-1.0, 1.0].map(|sign| {
        let checkpoint = Checkpoint {
            state: State { q: end.q, p: end.p * sign },
            step_size: -sign * run.step_size(),
            origin: 0.0,
            steps: 1,
        };
        let back = Trajectory::resume(system, Gauss::<4>, checkpoint).in_scaled_time();
        let back = back.take(100).last().unwrap().unwrap().state;
        (back.q - start.q).amax().max((back.p - start.p * sign).amax())
    })
}

/// Reversed momenta lead back where L is even in v and no friction acts; −1/h leads back always; a run begun
/// anew from σ does neither.
#[test]
fn friction_and_gyroscopic_terms_take_the_way_back_by_reversed_momenta() {
    /// A term linear in v, of a uniform magnetic field.
    struct Charge {
        field: f64,
    }

    #[rayleigh_system(rule = gauss)]
    impl Charge {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            0.5 * (v[0] * v[0] + v[1] * v[1])
                + 0.5 * self.field * (q[0] * v[1] - q[1] * v[0])
                + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
        }
        fn time_scale(&self, q: [f64; 2]) -> f64 {
            (q[0] * q[0] + q[1] * q[1]).powf(0.75)
        }
    }

    let start = Kepler::aphelion(0.5);
    for [reversed, backwards] in [ways_back(&FREE, start), ways_back(&Charge { field: 0.0 }, start)] {
        assert!(reversed < 1e-11 && backwards < 1e-11, "{reversed:e} {backwards:e}");
    }
    for [reversed, backwards] in
        [ways_back(&EccentricKepler { k: 1e-2 }, start), ways_back(&Charge { field: 0.3 }, start)]
    {
        assert!(reversed > 1e-2 && backwards < 1e-11, "{reversed:e} {backwards:e}");
    }

    // Begun anew, with 1/h from σ: other steps, even without friction.
    let mut run = FREE.by(Gauss::<4>, 0.4).run(start).in_scaled_time();
    let end = run.by_ref().take(100).last().unwrap().unwrap().state;
    let anew = FREE.by(Gauss::<4>, 0.4).run(State { p: -end.p, ..end }).in_scaled_time();
    let back = anew.take(100).last().unwrap().unwrap().state;
    let miss = (back.q - start.q).amax();
    assert!(miss > 1e-6, "{miss:e}");
}

/// J is kept where σ does not have the symmetry either: a step of any size keeps it.
#[test]
fn the_scale_need_not_have_the_symmetry() {
    struct Skew;

    #[rayleigh_system(rule = [midpoint, gauss])]
    impl Skew {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
        }
        fn time_scale(&self, q: [f64; 2]) -> f64 {
            1.0 + 0.5 * q[0].tanh()
        }
    }

    let start = Kepler::aphelion(0.5);
    let j = Kepler::angular_momentum(&start);
    let mut run = Skew.by(Midpoint, 0.05).run(start).in_scaled_time();
    let mut sizes = (f64::INFINITY, 0.0_f64);
    for _ in 0..2000 {
        let state = run.next().unwrap().unwrap().state;
        assert!((Kepler::angular_momentum(&state) / j - 1.0).abs() < 1e-13);
        sizes = (sizes.0.min(run.step_size()), sizes.1.max(run.step_size()));
    }
    assert!(sizes.1 > 1.5 * sizes.0, "{sizes:?}");
}

/// A motion that explodes or comes to rest where σ says so: what stands in the way is named, the state stays,
/// and another Δτ lets the run go on.
struct Falling {
    /// σ = a + bq.
    a: f64,
    b: f64,
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Falling {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn time_scale(&self, q: [f64; 1]) -> f64 {
        self.a + self.b * q[0]
    }
}

#[test]
fn what_stands_in_the_way_has_a_name() {
    let start = State { q: vector![0.0], p: vector![1.0] };
    let first = |system: &Falling, step: f64| {
        let mut run = system.by(Midpoint, step).run(start).in_scaled_time();
        let error = run.next().unwrap().unwrap_err();
        assert_eq!((*run.state(), run.time()), (start, 0.0));
        assert!(run.next().is_none(), "ended");
        error
    };
    let scale = |error: StepError| match error {
        StepError::TimeScale { scale, .. } => scale,
        other => panic!("{other}"),
    };
    assert_eq!(scale(first(&Falling { a: 0.0, b: 1.0 }, 0.1)), 0.0);
    assert_eq!(scale(first(&Falling { a: -1.0, b: 1.0 }, 0.1)), -1.0);
    assert!(scale(first(&Falling { a: f64::NAN, b: 1.0 }, 0.1)).is_nan());
    // λ = 4, and a step of ½ would be followed by none.
    assert_eq!(scale(first(&Falling { a: 1.0, b: 4.0 }, 0.6)), 1.0);
    for step in [0.0, f64::NAN, f64::INFINITY] {
        let error = first(&Falling { a: 1.0, b: 0.0 }, step);
        assert!(matches!(error, StepError::StepSize { .. }), "{error}");
    }

    // On the way: q = −1, where σ is 0, is infinitely far in τ; the clock stops before. The state is the last
    // good one.
    let system = Falling { a: 1.0, b: 1.0 };
    let mut run = system.by(Midpoint, 0.1).run(start).in_scaled_time();
    let mut last = start;
    let error = loop {
        match run.next().unwrap() {
            Ok(step) => last = step.state,
            Err(error) => break error,
        }
        assert!(run.time() < 100.0, "it passed");
    };
    assert!(matches!(error, StepError::Time { .. }), "{error}");
    assert_eq!(*run.state(), last);
    assert!(last.q[0] > -1.0 && (run.time() - (1.0 + 3.0_f64.sqrt())).abs() < 1e-12, "{last:?}");

    // After an error, in parts or by another Δτ.
    let mut run = Falling { a: 1.0, b: 4.0 }.by(Midpoint, 0.6).run(start).in_scaled_time();
    assert!(run.next().unwrap().is_err() && run.next_in_parts(4).is_err());
    run.change_step_size(0.1);
    run.next().unwrap().unwrap();
    // 1/h = 1/(σ Δτ) − ½ λ = 10 − 2.
    assert!((run.step_size() - 0.125).abs() < 1e-15);
}

/// A run saved between two steps and resumed goes on bit by bit alike; one that failed too.
#[test]
fn a_checkpoint_holds_the_whole_run() {
    let mut run = FREE.by(Gauss::<5>, 0.2).run(Kepler::aphelion(0.95)).in_scaled_time();
    run.by_ref().take(33).for_each(|step| assert!(step.is_ok()));
    let mut resumed = Trajectory::resume(&FREE, Gauss::<5>, run.checkpoint()).in_scaled_time();
    for _ in 0..100 {
        assert_eq!(run.next(), resumed.next());
        assert_eq!(run.step_size(), resumed.step_size());
        assert_eq!(run.time(), resumed.time());
    }
}

/// The clock is the sum of the steps, to a rounding of its own.
#[test]
fn the_clock_loses_nothing() {
    let mut run = FREE.by(Trapezoidal, 0.1).run(Kepler::aphelion(0.5)).in_scaled_time();
    let (mut sum, mut rest, mut plain) = (0.0_f64, 0.0_f64, 0.0);
    for _ in 0..100_000 {
        run.next().unwrap().unwrap();
        let h = run.step_size();
        plain += h;
        let next = sum + h;
        rest += if sum > h { (sum - next) + h } else { (h - next) + sum };
        sum = next;
    }
    let exact = sum + rest;
    let units = |time: f64| (time - exact).abs() / (f64::EPSILON * exact);
    assert!(units(run.time()) <= 1.0, "{}", units(run.time()));
    assert!(units(plain) > 10.0, "the control: {}", units(plain));
}

/// Events and samples of such a run: the near side of every orbit at its time, (k − ½) 2π.
#[test]
fn events_are_found_between_the_steps() {
    for e in [0.9, 0.99] {
        let mut run = FREE.by(Gauss::<8>, 0.2).run(Kepler::aphelion(e)).in_scaled_time();
        let mut orbits = 0.0;
        let watch = run.watch(|at| [at.q.dot(&at.momentum())]);
        let watch = watch.crossing([dalembert::run::events::Crossing::Rising]);
        for event in watch.until(20.0 * TAU) {
            let event = event.unwrap();
            orbits += 1.0;
            assert!(
                (event.time / ((orbits - 0.5) * TAU) - 1.0).abs() < 1e-12,
                "{e}: {orbits} {}",
                event.time
            );
            assert!((event.state.q.norm() - (1.0 - e)).abs() < 1e-12);
        }
        assert_eq!(orbits, 20.0);
        // Once around, at times that have nothing to do with the steps.
        let mut run = FREE.by(Gauss::<8>, 0.2).run(Kepler::aphelion(e)).in_scaled_time();
        for (k, sample) in run.sample_at((1..8).map(|k| f64::from(k) * TAU / 8.0)).enumerate() {
            let sample = sample.unwrap();
            // Kepler's equation from the far side, M = u + e sin u.
            let mean = (k as f64 + 1.0) * TAU / 8.0;
            let mut u = mean;
            for _ in 0..60 {
                u -= ((u + e * u.sin() - mean) / (1.0 + e * u.cos())).clamp(-0.3, 0.3);
            }
            let q = vector![e + u.cos(), (1.0 - e * e).sqrt() * u.sin()];
            assert!((sample.state.q - q).norm() < 1e-10, "{e} {k}");
        }
    }
}

/// An impact restarts the run at the same Δτ: a ball whose steps shrink towards the ground.
#[test]
fn a_restart_begins_with_the_same_parameter_step() {
    let system = Falling { a: 1.0, b: 0.5 };
    let start = State { q: vector![1.0], p: vector![0.0] };
    let mut run = system.by(Midpoint, 0.05).run(start).in_scaled_time();
    let mut watch = run.watch(|at| [at.q[0]]).terminal([true]);
    // A ball from height 1 without loss: impacts at √2 (2k + 1).
    for k in 0..20 {
        let impact = watch.next().unwrap().unwrap();
        let expected = 2.0_f64.sqrt() * f64::from(2 * k + 1);
        assert!((impact.time / expected - 1.0).abs() < 1e-13, "{k} {}", impact.time);
        watch.restart(State { q: impact.state.q, p: -impact.state.p });
    }
    let state = *run.state();
    run.next().unwrap().unwrap();
    let scale = 1.0 + 0.5 * state.q[0];
    let density = 1.0 / (0.05 * scale) - 0.25 * state.p[0] / scale;
    assert!((run.step_size() * density - 1.0).abs() < 1e-13);
}

/// L with the time in it: each step sees that of its own start.
#[test]
fn steps_of_different_sizes_see_their_own_time() {
    struct Shaken;

    #[rayleigh_system(rule = gauss)]
    impl Shaken {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
            0.5 * v[0] * v[0] + q[0] * (2.0 * t).cos()
        }
        fn time_scale(&self, q: [f64; 1]) -> f64 {
            1.5 + q[0].sin()
        }
    }

    let start = State { q: vector![-0.25], p: vector![0.3] };
    let shaken = Shaken.at_time(0.0);
    let mut run = shaken.by(Gauss::<6>, 0.1).run(start).in_scaled_time();
    for _ in 0..200 {
        let q = run.next().unwrap().unwrap().state.q[0];
        // q̈ = cos 2t
        let exact = 0.3 * run.time() - 0.25 * (2.0 * run.time()).cos();
        assert!((q - exact).abs() < 1e-12, "{}", run.time());
    }
}

/// σ and ∇σ as written out, by dual numbers and by differences, at random points.
#[test]
fn gradients_of_the_scale_by_both_engines() {
    struct Written {
        a: f64,
    }
    struct Dual {
        a: f64,
    }

    #[rayleigh_system(derivatives = expanded)]
    impl Written {
        fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
            0.5 * (v[0] * v[0] + v[1] * v[1])
        }
        fn time_scale(&self, q: [f64; 2]) -> f64 {
            let r = Self::radius(q);
            if r < 1.0 { r * r * self.a } else { self.a + (r - 1.0).tanh() }
        }
        fn radius(q: [f64; 2]) -> f64 {
            (q[0] * q[0] + 2.0 * q[1] * q[1]).sqrt()
        }
    }

    #[rayleigh_system(derivatives = num_dual)]
    impl Dual {
        fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
            0.5 * (v[0] * v[0] + v[1] * v[1])
        }
        fn time_scale(&self, q: [f64; 2]) -> f64 {
            let r = Self::radius(q);
            if r < 1.0 { r * r * self.a } else { self.a + (r - 1.0).tanh() }
        }
        fn radius(q: [f64; 2]) -> f64 {
            (q[0] * q[0] + 2.0 * q[1] * q[1]).sqrt()
        }
    }

    let mut random = StdRng::seed_from_u64(17);
    for _ in 0..1000 {
        let q: Vector2<f64> = SVector::from_fn(|_, _| random.random_range(-2.0..2.0));
        let written = Written { a: 0.75 };
        let (value, gradient) = written.time_scale_gradient(&q);
        let (same, by_duals) = Dual { a: 0.75 }.time_scale_gradient(&q);
        assert_eq!((value, value), (same, TimeScale::time_scale(&written, &q)));
        assert!((gradient - by_duals).norm() < 1e-13 * (1.0 + gradient.norm()));
        for i in 0..2 {
            let mut step = Vector2::zeros();
            step[i] = 1e-5;
            let at = |q: Vector2<f64>| TimeScale::time_scale(&written, &q);
            let r = (q[0] * q[0] + 2.0 * q[1] * q[1]).sqrt();
            if (r - 1.0).abs() > 1e-3 {
                assert!(((at(q + step) - at(q - step)) / 2e-5 - gradient[i]).abs() < 1e-8, "{q:?}");
            }
        }
    }
}
