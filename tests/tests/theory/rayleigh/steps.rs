//! Which steps have an R_d: the theorem's table, the leading coefficient, and the order barrier.

use dalembert::derivative::{LegendreDerivatives, PhaseMatrix};
use dalembert::exact::Exact;
use dalembert::nalgebra::{Matrix2, Matrix3, Matrix4, vector};
use dalembert::rayleigh::{RayleighStep, RayleighStepError};
use dalembert::step::{Flow, Momenta};
use dalembert::{
    Composition, Discretise, Fitted, FittedTrapezoidal, Gauss, Lagrangian, Midpoint, Splitting, State,
    StepError, Trapezoidal, rayleigh_system,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// M q̈ + C q̇ + K q = 0, and a quartic potential of both coordinates.
#[derive(Clone, Copy, Debug)]
struct Pair {
    m: [f64; 2],
    c: [f64; 3],
    k: [f64; 3],
    quartic: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal])]
impl Pair {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [a, b, c] = self.k;
        0.5 * (self.m[0] * v[0] * v[0] + self.m[1] * v[1] * v[1])
            - 0.5 * (a * q[0] * q[0] + 2.0 * b * q[0] * q[1] + c * q[1] * q[1])
            - self.quartic * (q[0] - 0.5 * q[1]).powi(4)
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let [a, b, c] = self.c;
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1])
    }
}

const APART: Pair = Pair { m: [1.0, 1.0], c: [0.6, 0.1, 0.2], k: [2.0, -0.7, 1.0], quartic: 0.0 };

impl Pair {
    fn matrices(&self) -> [Matrix2<f64>; 3] {
        let full = |[a, b, c]: [f64; 3]| Matrix2::new(a, b, b, c);
        [Matrix2::from_diagonal(&self.m.into()), full(self.c), full(self.k)]
    }

    /// (CM⁻¹K − KM⁻¹C)₁₀.
    fn bracket(&self) -> f64 {
        let [m, c, k] = self.matrices();
        let product = c * m.try_inverse().unwrap() * k;
        (product - product.transpose())[(1, 0)]
    }

    fn states(random: &mut StdRng) -> Vec<State<f64, 2>> {
        (0..5)
            .map(|_| State {
                q: vector![random.random_range(-1.0..1.0), random.random_range(-1.0..1.0)],
                p: vector![random.random_range(-1.0..1.0), random.random_range(-1.0..1.0)],
            })
            .collect()
    }
}

/// The derivative of the exact flow over the segment.
fn exact(system: &Pair, h: f64) -> PhaseMatrix<f64, 2> {
    let segment = Exact::new(system).segment(vector![0.3, -0.4], vector![0.35, -0.2], h).unwrap();
    let legendre = LegendreDerivatives {
        momenta: Momenta { p0: segment.p0.value, p1: segment.p1.value },
        p0_by_q0: segment.p0.d1,
        p0_by_q1: segment.p0.d2,
        p1_by_q0: segment.p1.d1,
        p1_by_q1: segment.p1.d2,
    };
    legendre.step_matrix().unwrap()
}

/// What is said of every method: its name, its order, and its verdict.
fn verdicts(system: &Pair, h: f64, states: &[State<f64, 2>]) -> Vec<(&'static str, u32, RayleighStep)> {
    fn of<M>(system: &Pair, method: M, h: f64, states: &[State<f64, 2>]) -> RayleighStep
    where
        Pair: Flow<M, 2, Scalar = f64>,
    {
        system.by(method, h).rayleigh_step(states).unwrap()
    }
    let mut all = vec![
        ("midpoint", 2, of(system, Midpoint, h, states)),
        ("trapezoidal", 2, of(system, Trapezoidal, h, states)),
        ("Gauss 1", 2, of(system, Gauss::<1>, h, states)),
        ("Gauss 2", 4, of(system, Gauss::<2>, h, states)),
        ("Gauss 3", 6, of(system, Gauss::<3>, h, states)),
        ("Gauss 8", 16, of(system, Gauss::<8>, h, states)),
        ("Blanes–Moan 4", 4, of(system, Splitting::blanes_moan_4(), h, states)),
        ("Blanes–Moan 6", 6, of(system, Splitting::blanes_moan_6(), h, states)),
        ("Kahan–Li 6", 6, of(system, Composition::kahan_li_6(Midpoint), h, states)),
        ("Kahan–Li 8", 8, of(system, Composition::kahan_li_8(Trapezoidal), h, states)),
        ("Kahan–Li 6 of fitted", 6, of(system, Composition::kahan_li_6(FittedTrapezoidal), h, states)),
    ];
    all.push(("exact", u32::MAX, RayleighStep::of(&[exact(system, h)], Some(1e-12)).unwrap()));
    all
}

/// Where friction and springs commute every method gives Rayleigh steps; where they do not, none of order
/// above 2 does.
#[test]
fn the_order_barrier() {
    let mut random = StdRng::seed_from_u64(9);
    let mut counts = [0; 2];
    let systems = if cfg!(debug_assertions) { 4 } else { 40 };
    for case in 0..systems {
        let mut draw = |range: std::ops::Range<f64>| random.random_range(range);
        let (m, k) = ([draw(0.5..2.0), draw(0.5..2.0)], [draw(1.0..3.0), draw(-0.8..0.8), draw(1.0..3.0)]);
        let c = match case % 4 {
            0 | 1 => [draw(0.2..1.0), draw(-0.15..0.15), draw(0.2..1.0)],
            // C = αM + βK.
            2 => {
                let (alpha, beta) = (draw(0.1..0.4), draw(0.0..0.3));
                [alpha * m[0] + beta * k[0], beta * k[1], alpha * m[1] + beta * k[2]]
            }
            // C = KM⁻¹K: not proportional, and CM⁻¹K = KM⁻¹C all the same.
            _ => {
                let [a, b, d] = k;
                [0.1, 0.1, 0.1]
                    .iter()
                    .zip([
                        a * a / m[0] + b * b / m[1],
                        a * b / m[0] + b * d / m[1],
                        b * b / m[0] + d * d / m[1],
                    ])
                    .map(|(x, y)| x * y)
                    .collect::<Vec<_>>()
                    .try_into()
                    .unwrap()
            }
        };
        let system = Pair { m, c, k, quartic: 0.0 };
        let commute = case % 4 > 1;
        assert_eq!(system.bracket().abs() < 1e-12, commute, "{system:?}");
        let states = Pair::states(&mut random);
        for (name, order, verdict) in verdicts(&system, 0.3, &states) {
            counts[usize::from(verdict.is_rayleigh())] += 1;
            assert_eq!(verdict.is_rayleigh(), commute || order <= 2, "{name} of {system:?}\n{verdict}");
        }
    }
    println!("{systems} systems, 12 methods: {} Rayleigh, {} not", counts[1], counts[0]);
    // K a multiple of M: any damping.
    let isotropic = Pair { k: [1.5, 0.0, 1.5], ..APART };
    for (name, _, verdict) in verdicts(&isotropic, 0.3, &Pair::states(&mut random)) {
        assert!(verdict.is_rayleigh(), "{name}\n{verdict}");
    }
    // Without linearity: midpoint and trapezoidal keep it, the others lose it by V″ alone.
    let bent = Pair { c: [0.5, 0.0, 0.1], k: [1.0, 0.0, 1.0], quartic: 2.0, ..APART };
    for (name, order, verdict) in verdicts(&bent, 0.3, &Pair::states(&mut random)) {
        assert_eq!(verdict.is_rayleigh(), order <= 2, "{name}\n{verdict}");
    }
}

/// a bᵀ − b aᵀ = −(h⁴/12)[C, K] + …, bᵀd − dᵀb = +(h⁴/12)[C, K] + … (M = I), by extrapolation, of the exact
/// flow and of a method of order 6.
#[test]
fn the_leading_coefficient_is_a_twelfth_of_the_bracket() {
    let state = [State { q: vector![0.3, -0.4], p: vector![0.1, 0.2] }];
    let of_gauss = |h: f64| {
        let found = APART.by(Gauss::<3>, h).rayleigh_step(&state).unwrap();
        [found.at_start.value, found.at_end.value]
    };
    let of_exact = |h: f64| {
        let found = RayleighStep::of(&[exact(&APART, h)], None).unwrap();
        [found.at_start.value, found.at_end.value]
    };
    for (of, smallest) in [(&of_gauss as &dyn Fn(f64) -> [f64; 2], 0.02), (&of_exact, 0.05)] {
        for end in 0..2 {
            let scaled = |h: f64| of(h)[end] / h.powi(4);
            let [a, b, c] = [4.0, 2.0, 1.0].map(|factor| scaled(factor * smallest));
            let limit = (8.0 * c - 6.0 * b + a) / 3.0;
            let expected = [-1.0, 1.0][end] * APART.bracket() / 12.0;
            assert!((limit / expected - 1.0).abs() < 1e-3, "{end}: {limit} {expected}");
        }
    }
}

/// A method fitted to damping has the exact asymmetry of order 2 in it, or none: R_d where C is a multiple of
/// M alone. And one coordinate is always enough.
#[test]
fn fitted_rules_and_one_coordinate() {
    let mut random = StdRng::seed_from_u64(10);
    let states = Pair::states(&mut random);
    assert!(!APART.by(Fitted, 0.3).rayleigh_step(&states).unwrap().is_rayleigh());
    assert!(APART.by(FittedTrapezoidal, 0.3).rayleigh_step(&states).unwrap().is_rayleigh());
    let even = Pair { c: [0.4, 0.0, 0.4], ..APART };
    assert!(even.by(Fitted, 0.3).rayleigh_step(&states).unwrap().is_rayleigh());

    #[rayleigh_system(rule = [midpoint, gauss])]
    fn single(q: [f64; 1], v: [f64; 1]) -> (f64, f64) {
        (0.5 * v[0] * v[0] * (1.0 + q[0] * q[0]) + q[0].cos(), 0.3 * v[0] * v[0] * (1.0 + q[0] * q[0]))
    }
    let state = [State::from_velocity(&Single {}, [0.7], [0.4]).unwrap()];
    let six = Single {}.by(Composition::kahan_li_6(Gauss::<2>), 0.3).rayleigh_step(&state).unwrap();
    assert!(six.is_rayleigh() && six.at_start.value == 0.0);
    assert!(Single {}.energy(&state[0].q, &vector![0.4]).is_finite());
}

/// C = 2aM: AᵀΩA = cΩ, c = (1 − ah)/(1 + ah) by the trapezoidal rule, e^{−2ah} by splittings, for a nonlinear
/// V. By the midpoint rule there is no such c unless V″ is a multiple of M.
#[test]
fn proportional_to_mass_damping_makes_steps_conformally_symplectic() {
    fn defect<M>(system: &Pair, method: M, h: f64, c: f64) -> f64
    where
        Pair: Flow<M, 2, Scalar = f64>,
    {
        let mut omega = Matrix4::<f64>::zeros();
        for i in 0..2 {
            (omega[(i, i + 2)], omega[(i + 2, i)]) = (1.0, -1.0);
        }
        let state = State { q: vector![0.3, -0.4], p: vector![0.1, 0.2] };
        let a: Matrix4<f64> = system.by(method, h).linearized_step(&state).unwrap().1.assembled();
        (a.transpose() * omega * a - omega * c).amax()
    }
    let (a, h, m) = (0.35, 0.3, [1.0, 1.7]);
    let system = Pair { m, c: [2.0 * a * m[0], 0.0, 2.0 * a * m[1]], k: [2.0, -0.7, 1.0], quartic: 1.5 };
    let (rational, exact) = ((1.0 - a * h) / (1.0 + a * h), (-2.0 * a * h).exp());
    assert!(defect(&system, Trapezoidal, h, rational) < 1e-14);
    assert!(defect(&system, Splitting::blanes_moan_6(), h, exact) < 1e-13);
    assert!(defect(&system, FittedTrapezoidal, h, exact) < 1e-14);
    // The control: the other rule's constant, and the midpoint rule.
    assert!(defect(&system, Trapezoidal, h, exact) > 1e-4);
    let best = (0..400)
        .map(|k| defect(&system, Midpoint, h, 0.7 + 0.001 * f64::from(k)))
        .fold(f64::INFINITY, f64::min);
    assert!(best > 1e-4, "{best}");
}

/// A step written by hand, and what is wrong with some.
#[test]
fn hypotheses_that_fail_have_names() {
    let identity = Matrix3::identity();
    let kick = Matrix3::new(1.0, 0.2, 0.0, 0.2, 2.0, 0.3, 0.0, 0.3, 1.0);
    let of = |b: Matrix3<f64>, d: Matrix3<f64>| {
        RayleighStep::of(&[PhaseMatrix { q_by_q: identity, q_by_p: b, p_by_q: identity, p_by_p: d }], None)
    };
    assert!(of(kick, identity).unwrap().is_rayleigh());
    let turned = Matrix3::new(0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let refused = of(kick, turned).unwrap();
    assert!(refused.at_start.vanishes() && !refused.at_end.vanishes() && !refused.is_rayleigh());
    assert!(
        refused.to_string().starts_with("no R_d for any L_d") && refused.to_string().contains("of sample 0")
    );
    assert_eq!(of(Matrix3::zeros(), identity), Err(RayleighStepError::Degenerate { sample: 0 }));
    assert_eq!(of(kick * f64::NAN, identity), Err(RayleighStepError::NonFinite { sample: 0 }));
    assert_eq!(RayleighStep::of::<f64, 2>(&[], None), Err(RayleighStepError::NoSamples));
    let far = [State { q: vector![f64::NAN, 0.0], p: vector![0.0, 0.0] }];
    let error = APART.by(Midpoint, 0.1).rayleigh_step(&far).unwrap_err();
    assert!(
        matches!(error, RayleighStepError::Step { sample: 0, error: StepError::NonFinite { .. } }),
        "{error}"
    );
}
