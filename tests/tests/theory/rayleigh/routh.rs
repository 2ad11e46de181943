//! Discrete Routh reduction with Rayleigh forces.

use dalembert::nalgebra::{SVector, vector};
use dalembert::rayleigh::routh::{ReducedState, Routh, RouthError};
use dalembert::samples::{Pair, segments};
use dalembert::step::{DiscreteRayleigh, Flow};
use dalembert::{Discrete, Discretise, Gauss, Midpoint, State, Trapezoidal, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// r, θ, z: an arm of variable inertia, whose θ is coupled to r by inertia as well.
#[derive(Clone, Copy, Debug)]
struct Arm {
    mass: [f64; 2],
    inertia: [f64; 3],
    coupling: f64,
    /// On r and z.
    friction: [f64; 2],
    /// On θ, as its inertia: R = c times what L has of θ̇.
    even: f64,
    /// On θ alone, which no reduction takes.
    uneven: f64,
    /// A potential of θ.
    spring: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Arm {
    fn turning(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let [a, b, c] = self.inertia;
        0.5 * (a + b * q[0] * q[0] + c * q[2].cos()) * v[1] * v[1] + self.coupling * q[2] * v[0] * v[1]
    }
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let [m, n] = self.mass;
        let potential = (q[0] - 1.0).powi(2) + 0.5 * q[2] * q[2] + 0.3 * q[0] * q[2] + 0.1 * q[2].powi(4);
        0.5 * (m * v[0] * v[0] + n * v[2] * v[2]) + self.turning(q, v) - potential - self.spring * q[1].cos()
    }
    fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let [r, z] = self.friction;
        0.5 * (r * v[0] * v[0] + z * (1.0 + q[0] * q[0]) * v[2] * v[2])
            + self.even * self.turning(q, v)
            + 0.5 * self.uneven * v[1] * v[1]
    }
}

const ARM: Arm = Arm {
    mass: [1.2, 0.8],
    inertia: [1.0, 0.5, 0.2],
    coupling: 0.3,
    friction: [0.2, 0.1],
    even: 0.0,
    uneven: 0.0,
    spring: 0.0,
};

const H: f64 = 0.1;
const THETA: usize = 1;

fn samples() -> Vec<Pair<f64, 3>> {
    segments(
        [0.5, -3.0, -0.5],
        [1.5, 3.0, 0.5],
        [0.1, 0.2, 0.1],
        if cfg!(debug_assertions) { 10 } else { 30 },
    )
}

fn draw(random: &mut StdRng, even: f64) -> (Arm, State<f64, 3>) {
    let mut entry = |range: std::ops::Range<f64>| random.random_range(range);
    let arm = Arm {
        mass: [entry(0.5..2.0), entry(0.5..2.0)],
        inertia: [entry(0.5..2.0), entry(0.0..1.0), entry(-0.3..0.3)],
        coupling: entry(-0.3..0.3),
        friction: [entry(0.0..0.5), entry(0.0..0.5)],
        even,
        ..ARM
    };
    let q = [entry(0.7..1.3), entry(-1.0..1.0), entry(-0.4..0.4)];
    let v = [entry(-0.5..0.5), entry(-1.0..1.0), entry(-0.5..0.5)];
    (arm, State::from_velocity(&arm, q, v).unwrap())
}

/// The largest difference between the reconstructed run and the run of the whole system over 20 steps, and
/// what is left of μ, as a factor for each step.
fn compare<R: Copy>(arm: &Arm, rule: R, start: &State<f64, 3>) -> (f64, f64)
where
    Arm: Discrete<R, 3> + Flow<R, 3, Scalar = f64>,
{
    let by = arm.by(rule, H);
    // What is at rest says as much as another segment.
    let mut samples = samples();
    samples.insert(0, Pair::new([1.0, 0.0, 0.3], [1.0, 0.0, 0.3]));
    let routh = by.routh::<2>(THETA, &samples).unwrap();
    let whole: Vec<_> = by.run(*start).take(20).map(|step| step.unwrap().state).collect();
    let reduced: Vec<_> = routh.run(start).take(20).map(|state| state.unwrap()).collect();
    assert_eq!(reduced.len(), 20);
    let off = whole.iter().zip(&reduced).map(|(a, b)| (a.q - b.q).amax().max((a.p - b.p).amax()));
    (off.fold(0.0, f64::max), (reduced[19].p[THETA] / start.p[THETA]).powf(1.0 / 20.0))
}

/// Reduced run, θ from it, and the whole run agree to rounding; μ moves as g says.
#[test]
fn the_reduced_run_is_that_of_the_whole_system() {
    let mut random = StdRng::seed_from_u64(31);
    let mut worst: f64 = 0.0;
    for &even in &[0.0, 0.3, 0.6][..if cfg!(debug_assertions) { 2 } else { 3 }] {
        let (arm, start) = draw(&mut random, even);
        // By both rules of order 2 (1 − hc/2)/(1 + hc/2), by Gauss 2 the Padé approximant of e^{−hc}.
        let z = H * even;
        let rational = (1.0 - z / 2.0) / (1.0 + z / 2.0);
        let of_gauss = (1.0 - z / 2.0 + z * z / 12.0) / (1.0 + z / 2.0 + z * z / 12.0);
        for ((off, factor), expected) in [
            (compare(&arm, Midpoint, &start), rational),
            (compare(&arm, Trapezoidal, &start), rational),
            (compare(&arm, Gauss::<2>, &start), of_gauss),
        ] {
            worst = worst.max(off);
            assert!(off < 1e-12, "{arm:?}: {off:e}");
            assert!((factor - expected).abs() < 1e-14, "{arm:?}: {factor} {expected}");
        }
    }
    println!("reduced against whole: {worst:.1e}");
}

/// Friction on θ that is not linear: g is what p = Iw + (h/2)κw³ ↦ Iw − (h/2)κw³ is.
#[test]
fn the_momentum_moves_by_a_function_that_need_not_be_linear() {
    #[rayleigh_system]
    fn drum(q: [f64; 2], v: [f64; 2], kappa: f64) -> (f64, f64) {
        // θ, x; θ carries x along, by inertia alone.
        let lagrangian =
            0.5 * (2.0 * v[0] * v[0] + v[1] * v[1]) + 0.1 * v[0] * v[0] * v[1] - 0.5 * q[1] * q[1];
        (lagrangian, 0.25 * kappa * v[0].powi(4) + 0.1 * v[1] * v[1])
    }
    // ∂L/∂θ̇ = 2θ̇ + 0.2θ̇ẋ: the momentum depends on ẋ otherwise than friction does.
    let coupled = Drum { kappa: 0.5 };
    let error =
        coupled.by(Midpoint, H).routh::<1>(0, &segments([0.0; 2], [1.0; 2], [0.1; 2], 20)).unwrap_err();
    assert!(matches!(error, RouthError::NotReducible { .. }), "{error}");

    #[rayleigh_system]
    fn wheel(q: [f64; 2], v: [f64; 2], kappa: f64) -> (f64, f64) {
        let lagrangian = 0.5 * (2.0 * v[0] * v[0] + v[1] * v[1]) - 0.5 * q[1] * q[1];
        (lagrangian, 0.25 * kappa * v[0].powi(4) + 0.1 * v[1] * v[1])
    }
    let wheel = Wheel { kappa: 0.5 };
    let by = wheel.by(Midpoint, H);
    let routh = by.routh::<1>(0, &segments([0.0; 2], [1.0; 2], [0.1; 2], 20)).unwrap();
    for w in [-1.5, 0.2, 1.0, 3.0_f64] {
        let drag = 0.5 * H * 0.5 * w.powi(3);
        assert!((routh.next_momentum(2.0 * w + drag).unwrap() - (2.0 * w - drag)).abs() < 1e-14);
    }
    let start = State::from_velocity(&wheel, [0.0, 0.5], [2.0, 0.0]).unwrap();
    let (whole, reduced) =
        (by.run(start).nth(99).unwrap().unwrap().state, routh.run(&start).nth(99).unwrap().unwrap());
    assert!((whole.q - reduced.q).amax() < 1e-12 && (whole.p - reduced.p).amax() < 1e-12);
}

/// −D1 L̂⁺ = p0 and D2 L̂⁻ = p1 on reduced steps, by differences of fourth order: the reduced system is a
/// discrete Rayleigh system.
#[test]
fn the_reduced_system_is_a_discrete_rayleigh_system() {
    fn check<R: Copy>(arm: &Arm, rule: R, start: &State<f64, 3>)
    where
        Arm: DiscreteRayleigh<R, 3> + Flow<R, 3, Scalar = f64>,
    {
        let by = arm.by(rule, H);
        let routh = by.routh::<2>(THETA, &samples()).unwrap();
        let (mut state, _) = routh.reduce(start);
        for _ in 0..3 {
            let step = routh.step(&state).unwrap();
            let (x0, x1, mu) = (state.shape.q, step.state.shape.q, state.momentum);
            let gradient = |f: &dyn Fn(SVector<f64, 2>) -> f64| {
                SVector::<f64, 2>::from_fn(|i, _| {
                    let mut unit = SVector::<f64, 2>::zeros();
                    unit[i] = 1e-3;
                    let slope = |k: f64| (f(unit * k) - f(-unit * k)) / (2e-3 * k);
                    (4.0 * slope(1.0) - slope(2.0)) / 3.0
                })
            };
            let p0 = -gradient(&|d| routh.modified_plus(&(x0 + d), &x1, mu).unwrap());
            let p1 = gradient(&|d| routh.modified_minus(&x0, &(x1 + d), mu).unwrap());
            assert!((p0 - state.shape.p).amax() < 1e-8, "{p0} {}", state.shape.p);
            assert!((p1 - step.state.shape.p).amax() < 1e-8, "{p1} {}", step.state.shape.p);
            // The control: without the term of g the gradient is another's.
            let swapped = gradient(&|d| routh.modified_plus(&x0, &(x1 + d), mu).unwrap());
            assert!((swapped - step.state.shape.p).amax() > 1e-3);
            state = step.state;
        }
    }
    let mut random = StdRng::seed_from_u64(32);
    for even in [0.0, 0.5] {
        let (arm, start) = draw(&mut random, even);
        check(&arm, Midpoint, &start);
        check(&arm, Trapezoidal, &start);
    }
}

/// The control, friction on θ that does not go with its inertia; and what else fails.
#[test]
fn hypotheses_that_fail_have_names() {
    let refused = |arm: Arm| {
        arm.by(Midpoint, H).routh::<2>(THETA, &samples()).map(|_: Routh<'_, _, _, 3, 2>| ()).unwrap_err()
    };
    let error = refused(Arm { uneven: 0.3, ..ARM });
    let RouthError::NotReducible { found, expected, .. } = error else { panic!("{error}") };
    assert!((found - expected).abs() > 1e-4, "{error}");
    // Where the inertia is constant it goes.
    let even = Arm { uneven: 0.3, inertia: [1.0, 0.0, 0.0], coupling: 0.0, ..ARM };
    assert!(even.by(Midpoint, H).routh::<2>(THETA, &samples()).is_ok());
    assert!(matches!(refused(Arm { spring: 0.1, ..ARM }), RouthError::NotCyclic { .. }));
    assert!(matches!(refused(Arm { coupling: f64::NAN, ..ARM }), RouthError::NonFinite { sample: 0 }));
    let by = ARM.by(Midpoint, H);
    assert_eq!(by.routh::<2>(3, &samples()).unwrap_err(), RouthError::NoSuchCoordinate { cyclic: 3 });
    assert_eq!(by.routh::<2>(THETA, &[]).unwrap_err(), RouthError::Uninformative);
    let one_shape = [Pair::new([1.0, 0.0, 0.0], [1.0, 0.1, 0.0])];
    assert_eq!(by.routh::<2>(THETA, &one_shape).unwrap_err(), RouthError::Uninformative);
    let routh = by.routh::<2>(THETA, &samples()).unwrap();
    let shape = State { q: vector![f64::NAN, 0.0], p: vector![0.0, 0.0] };
    assert!(matches!(routh.step(&ReducedState { shape, momentum: 1.0 }), Err(RouthError::Step(_))));
    assert!(routh.next_momentum(f64::NAN).is_err());

    // Friction that leaves the inertia's only beyond where the segments were: found at the step that gets
    // there.
    #[rayleigh_system]
    fn brake(q: [f64; 2], v: [f64; 2]) -> (f64, f64) {
        let beyond = if q[0] > 1.0 { 1.0 + (q[0] - 1.0).powi(2) } else { 1.0 };
        let turning = 0.5 * (1.0 + q[0] * q[0]) * v[1] * v[1];
        (0.5 * v[0] * v[0] + turning, 0.2 * beyond * turning)
    }
    let routh =
        Brake {}.by(Midpoint, H).routh::<1>(1, &segments([0.2, 0.0], [0.9, 1.0], [0.05, 0.1], 20)).unwrap();
    let start = State::from_velocity(&Brake {}, [0.5, 0.0], [0.2, 1.0]).unwrap();
    let run: Vec<_> = routh.run(&start).take(100).collect();
    let (last, before) = run.split_last().unwrap();
    assert!(matches!(last, Err(RouthError::NotReducible { .. })), "{last:?}");
    assert!(before.len() > 3 && before.iter().all(Result::is_ok));
}
