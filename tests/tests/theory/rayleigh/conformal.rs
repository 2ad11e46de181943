//! Steps that multiply the symplectic form by a constant: the equivalence of three statements on random
//! systems, α, β and G of a pair, and order above 2 with an R_d.

use dalembert::derivative::PhaseMatrix;
use dalembert::hamilton_jacobi::Frame;
use dalembert::nalgebra::{Matrix1, Matrix2, SVector, Vector2, vector};
use dalembert::rayleigh::{ConformalStep, ConformalStepError, Proportion, ProportionError};
use dalembert::samples::{self, SampleError, segments};
use dalembert::step::{DiscreteRayleigh, Flow};
use dalembert::{
    Composition, Discretise, Fitted, FittedTrapezoidal, Gauss, Midpoint, OneSided, Splitting, State,
    StepError, Trapezoidal, rayleigh_system,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// M q̈ + C q̇ + Kq = 0, and bend (sin q₀q₁ + ¼q₀⁴) in the potential.
#[derive(Clone, Copy, Debug)]
struct Pair {
    m: [f64; 3],
    c: [f64; 3],
    k: [f64; 3],
    bend: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal, one_sided])]
impl Pair {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [m, k] = [self.m, self.k];
        0.5 * (m[0] * v[0] * v[0] + 2.0 * m[1] * v[0] * v[1] + m[2] * v[1] * v[1])
            - 0.5 * (k[0] * q[0] * q[0] + 2.0 * k[1] * q[0] * q[1] + k[2] * q[1] * q[1])
            - self.bend * ((q[0] * q[1]).sin() + 0.25 * q[0] * q[0] * q[0] * q[0])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let c = self.c;
        0.5 * (c[0] * v[0] * v[0] + 2.0 * c[1] * v[0] * v[1] + c[2] * v[1] * v[1])
    }
}

/// What is asked of C, K and V.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Class {
    /// C = 2aM, V neither quadratic nor separable.
    Proportional,
    /// C = 2aM, V = ½qᵀKq.
    Quadratic,
    /// C = 2aM, V = ½ω²qᵀMq: n equal oscillators.
    Isotropic,
    /// C of its own.
    Apart,
    /// C = 0.
    Frictionless,
}

const CLASSES: [Class; 5] =
    [Class::Proportional, Class::Quadratic, Class::Isotropic, Class::Apart, Class::Frictionless];

impl Class {
    /// A system of the class, and its a.
    fn draw(self, random: &mut StdRng) -> (Pair, f64) {
        let mut draw = |low: f64, high: f64| random.random_range(low..high);
        let m = [draw(0.6, 2.0), draw(-0.3, 0.3), draw(0.6, 2.0)];
        let k = [draw(0.5, 3.0), draw(-0.5, 0.5), draw(0.5, 3.0)];
        let (a, bend) = (draw(0.2, 0.6), draw(0.5, 1.5));
        let proportional = m.map(|entry| 2.0 * a * entry);
        let apart = [draw(0.3, 0.5), draw(0.1, 0.2), draw(0.8, 1.2)];
        let of = |c, k, bend| Pair { m, c, k, bend };
        let pair = match self {
            Self::Proportional => of(proportional, k, bend),
            Self::Quadratic => of(proportional, k, 0.0),
            Self::Isotropic => of(proportional, m.map(|entry| 1.7 * entry), 0.0),
            Self::Apart => of(apart, k, bend),
            Self::Frictionless => of([0.0; 3], k, bend),
        };
        (pair, a)
    }
}

/// What was found by one method.
struct Found {
    name: &'static str,
    /// Whether the theorem's premises are met, and the c known beforehand where it has a closed form.
    expected: (bool, Option<f64>),
    /// (i): the closedness defect of closed sections, relative to its terms.
    opened: f64,
    /// (ii).
    conformal: ConformalStep,
    /// (iii), from A: D1D2R_d − κ D1D2L_d relative to D1D2L_d, infinite if there is no R_d.
    disproportion: f64,
    /// (iii), from R_d and L_d where a rule has them.
    proportion: Option<Proportion<2>>,
}

/// D1D2L_d and D1D2R_d from A: −b⁻¹ = D1D2L_d⁺, (c − d b⁻¹a)ᵀ = D1D2L_d⁻.
fn mixed(a: &PhaseMatrix<f64, 2>) -> [Matrix2<f64>; 2] {
    let b = a.q_by_p.try_inverse().unwrap();
    let [plus, minus] = [-b, (a.p_by_q - a.p_by_p * b * a.q_by_q).transpose()];
    [(plus + minus) * 0.5, (plus - minus) * 0.5]
}

fn asymmetry(matrix: &Matrix2<f64>, terms: f64) -> f64 {
    (matrix[(0, 1)] - matrix[(1, 0)]).abs() / terms
}

fn look<M>(name: &'static str, pair: &Pair, method: M, h: f64, expected: (bool, Option<f64>)) -> Found
where
    Pair: Flow<M, 2, Scalar = f64>,
{
    let mut random = StdRng::seed_from_u64(5);
    let mut draw = || random.random_range(-1.0..1.0);
    let states: Vec<State<f64, 2>> =
        (0..4).map(|_| State { q: vector![draw(), draw()], p: vector![draw(), draw()] }).collect();
    let by = pair.by(method, h);
    let derivatives: Vec<_> = states.iter().map(|state| by.linearized_step(state).unwrap().1).collect();
    let mut opened = 0.0_f64;
    for a in &derivatives {
        for _ in 0..3 {
            let (x, y, z) = (draw(), draw(), draw());
            let frame = Frame { q: Matrix2::identity(), p: Matrix2::new(x, y, y, z) }.carried(a);
            let terms = frame.q.tr_mul(&frame.p).abs().max() + frame.q.abs().tr_mul(&frame.p.abs()).max();
            opened = opened.max(asymmetry(&frame.q.tr_mul(&frame.p), terms));
        }
    }
    let conformal = by.conformal_step(&states).unwrap();
    let kappa = {
        let [l, r] = mixed(&derivatives[0]);
        r.dot(&l) / l.norm_squared()
    };
    let disproportion = derivatives.iter().fold(0.0_f64, |worst, a| {
        let [l, r] = mixed(a);
        let has_one = asymmetry(&(a.q_by_q * a.q_by_p.transpose()), 1.0) < 1e-13
            && asymmetry(&(a.q_by_p.transpose() * a.p_by_p), 1.0) < 1e-13;
        if has_one { worst.max((r - l * kappa).amax() / l.amax()) } else { f64::INFINITY }
    });
    Found { name, expected, opened, conformal, disproportion, proportion: None }
}

/// The same of a rule with L_d and R_d.
fn look_at_rule<R: Copy>(
    name: &'static str,
    pair: &Pair,
    rule: R,
    h: f64,
    expected: (bool, Option<f64>),
) -> Found
where
    Pair: DiscreteRayleigh<R, 2, Scalar = f64>,
{
    let segments = segments([-1.0; 2], [1.0; 2], [0.3; 2], 6);
    let proportion = Some(pair.by(rule, h).proportion(&segments).unwrap());
    Found { proportion, ..look(name, pair, rule, h, expected) }
}

fn all(class: Class, pair: &Pair, a: f64, h: f64) -> Vec<Found> {
    let (rational, exact) = match class {
        Class::Frictionless => (1.0, 1.0),
        _ => ((1.0 - a * h) / (1.0 + a * h), (-2.0 * a * h).exp()),
    };
    let proportional = class != Class::Apart;
    let decoupled = matches!(class, Class::Isotropic | Class::Frictionless);
    vec![
        look_at_rule("trapezoidal", pair, Trapezoidal, h, (proportional, Some(rational))),
        look_at_rule("fitted trapezoidal", pair, FittedTrapezoidal, h, (proportional, Some(exact))),
        look("one-sided", pair, OneSided, h, (decoupled, None)),
        look_at_rule("midpoint", pair, Midpoint, h, (decoupled, None)),
        look("fitted", pair, Fitted, h, (decoupled, None)),
        look("Gauss 2", pair, Gauss::<2>, h, (decoupled, None)),
        look("Blanes–Moan 4", pair, Splitting::blanes_moan_4(), h, (proportional, Some(exact))),
        look("Blanes–Moan 6", pair, Splitting::blanes_moan_6(), h, (proportional, Some(exact))),
        look(
            "Kahan–Li 6 of trapezoidal",
            pair,
            Composition::kahan_li_6(Trapezoidal),
            h,
            (proportional, None),
        ),
        look(
            "Kahan–Li 6 of fitted",
            pair,
            Composition::kahan_li_6(FittedTrapezoidal),
            h,
            (proportional, Some(exact)),
        ),
        look("Kahan–Li 6 of midpoint", pair, Composition::kahan_li_6(Midpoint), h, (decoupled, None)),
    ]
}

/// (i) closed sections stay closed, (ii) AᵀΩA = cΩ, (iii) D1D2R_d = κ D1D2L_d: all or none, over random
/// systems and all methods, with c = (1 − κ)/(1 + κ) and the closed forms. The exact motion has them for C =
/// 2aM, so that a method of order 6 which has not misses by little.
#[test]
fn closed_sections_conformal_steps_and_proportional_pairs_are_the_same() {
    let mut random = StdRng::seed_from_u64(21);
    let (mut holds, mut fails, mut pairs) = (0, 0, 0);
    let (mut largest_held, mut smallest_missed) = (0.0_f64, f64::INFINITY);
    let systems = if cfg!(debug_assertions) { 20 } else { 60 };
    for case in 0..systems {
        let class = CLASSES[case % CLASSES.len()];
        let (pair, a) = class.draw(&mut random);
        for found in all(class, &pair, a, 0.3) {
            let at = format!("{} of {class:?}, {pair:?}: {}", found.name, found.conformal);
            let (expected, c) = found.expected;
            assert_eq!(found.conformal.is_conformal(), expected, "(ii) {at}");
            for (name, size) in [("(i)", found.opened), ("(iii)", found.disproportion)] {
                assert!(if expected { size < 1e-12 } else { size > 1e-10 }, "{name} {size:e} {at}");
                if expected {
                    largest_held = largest_held.max(size);
                } else {
                    smallest_missed = smallest_missed.min(size);
                }
            }
            if let Some(proportion) = found.proportion {
                pairs += 1;
                assert_eq!(proportion.is_constant(), expected, "{proportion}\n{at}");
                if expected {
                    assert!((proportion.kappa - found.conformal.kappa()).abs() < 1e-13, "{proportion}\n{at}");
                    assert!(
                        (proportion.factor() - found.conformal.factor).abs() < 1e-13,
                        "{proportion}\n{at}"
                    );
                }
            }
            if let (true, Some(c)) = (expected, c) {
                assert!((found.conformal.factor - c).abs() < 1e-13, "{c} {at}");
            }
            *(if expected { &mut holds } else { &mut fails }) += 1;
        }
    }
    assert!(3 * holds > 10 * systems && 3 * fails > 10 * systems, "{holds} {fails}");
    println!(
        "{systems} systems, 11 methods: all three hold of {holds}, none of {fails}; {pairs} pairs (L_d, R_d); \
         largest where they hold {largest_held:.1e}, smallest where they fail {smallest_missed:.1e}"
    );
}

/// κ of the midpoint rule for n = 1 and V = ½kq²: ρ/β of the closed form, c = (β − ρ)/(β + ρ). With another
/// potential κ is no constant.
#[test]
fn one_coordinate_by_the_midpoint_rule() {
    #[rayleigh_system]
    fn spring(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64, bend: f64) -> (f64, f64) {
        let potential = 0.5 * k * q[0] * q[0] + bend * q[0].powi(4);
        (0.5 * m * v[0] * v[0] - potential, 0.5 * r * v[0] * v[0])
    }
    let (m, k, r, h) = (1.3, 2.0, 0.7, 0.3);
    let segments = segments([-1.0], [1.0], [0.3], 10);
    let states: Vec<_> = segments.iter().map(|s| State { q: s.q0, p: (s.q1 - s.q0) * (m / h) }).collect();
    let spring = Spring { m, k, r, bend: 0.0 };
    let by = spring.by(Midpoint, h);
    let (beta, rho) = (m / h + k * h / 4.0, r / 2.0);
    let proportion = by.proportion(&segments).unwrap();
    assert!(proportion.is_constant() && (proportion.kappa - rho / beta).abs() < 1e-15, "{proportion}");
    let conformal = by.conformal_step(&states).unwrap();
    assert!(conformal.is_conformal(), "{conformal}");
    assert!((conformal.factor - (beta - rho) / (beta + rho)).abs() < 1e-15, "{conformal}");

    let bent = Spring { bend: 0.5, ..spring };
    assert!(!bent.by(Midpoint, h).proportion(&segments).unwrap().is_constant());
    assert!(!bent.by(Midpoint, h).conformal_step(&states).unwrap().is_conformal());
    // One state or segment tells nothing: every A has AᵀΩA = det A Ω.
    let error = by.conformal_step(&states[..1]).unwrap_err();
    assert_eq!(error, ConformalStepError::TooFewSamples { given: 1, needed: 2 });
    assert!(error.to_string().contains("det A"), "{error}");
    assert_eq!(
        by.proportion(&segments[..1]),
        Err(ProportionError::Samples(SampleError::TooFew { given: 1, needed: 2 }))
    );
}

/// R_d = κL_d + α(q0) + β(q1), p1 = D2G and c p0 = −D1G by differences of order 8, for C = 2aM. A pair that
/// is not proportional has no split.
#[test]
fn the_split_gives_back_r_d_and_generates_the_step() {
    fn check<R: Copy>(pair: &Pair, rule: R, h: f64)
    where
        Pair: DiscreteRayleigh<R, 2, Scalar = f64>,
    {
        let by = pair.by(rule, h);
        let segments = segments([-1.0; 2], [1.0; 2], [0.3; 2], 8);
        let split = by.proportional_split(&by.proportion(&segments).unwrap(), [0.1, -0.2]).unwrap();
        for samples::Pair { q0, q1 } in &segments {
            let (l, r) = (by.discrete_lagrangian(q0, q1), by.discrete_rayleigh(q0, q1));
            assert!((split.kappa() * l + split.alpha(q0) + split.beta(q1) - r).abs() < 1e-13);
            let (minus, plus) = (by.legendre_minus(q0, q1), by.legendre_plus(q0, q1));
            let slope = |of: &dyn Fn(Vector2<f64>) -> f64| {
                SVector::<f64, 2>::from_fn(|i, _| {
                    let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
                    let mut shift = Vector2::zeros();
                    let difference = |m: usize, shift: &mut Vector2<f64>| {
                        shift[i] = 0.02 * (m + 1) as f64;
                        (of(*shift) - of(-*shift)) / 0.02
                    };
                    (0..4).map(|m| weights[m] * difference(m, &mut shift)).sum()
                })
            };
            let by_q1 = slope(&|shift| split.generating_function(q0, &(q1 + shift)));
            let by_q0 = slope(&|shift| split.generating_function(&(q0 + shift), q1));
            assert!((by_q1 - plus.p).amax() < 1e-11, "{by_q1} {}", plus.p);
            assert!((by_q0 + minus.p * split.factor()).amax() < 1e-11, "{by_q0} {}", minus.p);
        }
    }
    let mut random = StdRng::seed_from_u64(3);
    let (pair, _) = Class::Proportional.draw(&mut random);
    check(&pair, Trapezoidal, 0.3);
    check(&pair, FittedTrapezoidal, 0.3);
    let by = pair.by(Midpoint, 0.3);
    let none = by.proportion(&segments([-1.0; 2], [1.0; 2], [0.3; 2], 8)).unwrap();
    assert!(by.proportional_split(&none, [0.0, 0.0]).is_none(), "{none}");
}

/// Order 6 and an R_d: for C = 2aM and a nonlinear V, the splitting has R_d = tanh(ah) L_d up to functions of
/// one end. L_d^± are integrated from the step's momenta alone, at fixed q1 and at fixed q0.
#[test]
fn the_splitting_of_order_6_has_tanh_ah_times_l_d() {
    let mut random = StdRng::seed_from_u64(4);
    let (pair, a) = Class::Proportional.draw(&mut random);
    let (h, method) = (0.4, Splitting::blanes_moan_6());
    let by = pair.by(method, h);
    let kappa = (a * h).tanh();
    let states: Vec<_> = (0..8)
        .map(|i| 0.7 * f64::from(i))
        .map(|t| State { q: vector![t.sin(), (1.3 * t).cos()], p: vector![0.5 * t.cos(), 0.3] })
        .collect();
    let conformal = by.conformal_step(&states).unwrap();
    assert!(conformal.is_conformal() && (conformal.kappa() - kappa).abs() < 1e-14, "{conformal}");
    assert!(by.rayleigh_step(&states).unwrap().is_rayleigh());

    // (p0, p1) of the segment, by Newton's method on b.
    let momenta = |q0: &Vector2<f64>, q1: &Vector2<f64>| {
        let mut p = Matrix2::new(pair.m[0], pair.m[1], pair.m[1], pair.m[2]) * (q1 - q0) / h;
        for _ in 0..20 {
            let (step, linear) = by.linearized_step(&State { q: *q0, p }).unwrap();
            let miss = q1 - step.state.q;
            if miss.amax() < 1e-15 {
                break;
            }
            p += linear.q_by_p.try_inverse().unwrap() * miss;
        }
        (p, by.step(&State { q: *q0, p }).unwrap().state.p)
    };
    // ∫ by Boole's rule.
    let integral = |of: &dyn Fn(f64) -> f64| {
        let cells = if cfg!(debug_assertions) { 16 } else { 32 };
        let at = |i: usize| of(i as f64 / (4 * cells) as f64);
        let boole = |i: usize| 7.0 * (at(i) + at(i + 4)) + 32.0 * (at(i + 1) + at(i + 3)) + 12.0 * at(i + 2);
        (0..cells).map(|cell| boole(4 * cell)).sum::<f64>() / (90 * cells) as f64
    };
    // Over the rectangle between a and b in Q×Q the mixed difference of L⁺ is that of ∫ −p0·dq0 at both q1,
    // and of L⁻ that of ∫ p1·dq1 at both q0.
    let (a0, b0, a1, b1) = (vector![0.1, 0.2], vector![0.4, -0.1], vector![0.3, 0.1], vector![0.0, 0.5]);
    let plus_along = |q1: Vector2<f64>| integral(&|s| -momenta(&(a0 + (b0 - a0) * s), &q1).0.dot(&(b0 - a0)));
    let minus_along = |q0: Vector2<f64>| integral(&|s| momenta(&q0, &(a1 + (b1 - a1) * s)).1.dot(&(b1 - a1)));
    let plus = plus_along(b1) - plus_along(a1);
    let minus = minus_along(b0) - minus_along(a0);
    let (l, r) = (0.5 * (plus + minus), 0.5 * (plus - minus));
    assert!(l.abs() > 0.1 && (r - kappa * l).abs() < 1e-13, "{l} {r}");
    // The control: κ of the trapezoidal rule.
    assert!((r - a * h * l).abs() > 1e-4, "{l} {r}");
    // And of a C of its own there is none.
    let (apart, _) = Class::Apart.draw(&mut random);
    assert!(!apart.by(method, h).rayleigh_step(&states).unwrap().is_rayleigh());
}

#[test]
fn hypotheses_that_fail_have_names() {
    let one = Matrix2::identity();
    let of = |q_by_p: Matrix2<f64>, p_by_p: Matrix2<f64>, relative| {
        ConformalStep::of(&[PhaseMatrix { q_by_q: one, q_by_p, p_by_q: one * 0.0, p_by_p }], relative)
    };
    // q ↦ q + 0.2 p, p ↦ 0.7 p, and what is not.
    let found = of(one * 0.2, one * 0.7, None).unwrap();
    assert!(found.is_conformal() && found.factor == 0.7, "{found}");
    assert!(found.to_string().starts_with("conformally symplectic, c = 0.700000000000000"), "{found}");
    let none = of(one * 0.2, Matrix2::new(0.7, 0.0, 0.0, 0.8), None).unwrap();
    assert!(!none.is_conformal() && (none.defect.value.abs() - 0.05).abs() < 1e-15, "{none}");
    assert!(none.to_string().contains("no: ") && none.to_string().contains("of sample 0"), "{none}");
    for relative in [1.0, f64::INFINITY, f64::NAN] {
        assert!(!of(one * 0.2, one * 0.7, Some(relative)).unwrap().is_conformal(), "{relative}");
    }
    for poison in [f64::NAN, f64::INFINITY] {
        assert_eq!(of(one * poison, one, None), Err(ConformalStepError::NonFinite { sample: 0 }));
    }
    let none: [PhaseMatrix<f64, 2>; 0] = [];
    let too_few = ConformalStepError::TooFewSamples { given: 0, needed: 1 };
    assert_eq!(ConformalStep::of(&none, None), Err(too_few));
    // For n = 1 the factor has to be one and the same.
    let scaled = |c: f64| PhaseMatrix {
        q_by_q: Matrix1::new(1.0),
        q_by_p: Matrix1::new(0.3),
        p_by_q: Matrix1::new(0.0),
        p_by_p: Matrix1::new(c),
    };
    assert!(ConformalStep::of(&[scaled(0.9), scaled(0.9)], None).unwrap().is_conformal());
    assert!(!ConformalStep::of(&[scaled(0.9), scaled(0.8)], None).unwrap().is_conformal());

    let mut random = StdRng::seed_from_u64(1);
    let (pair, _) = Class::Proportional.draw(&mut random);
    let far = [State { q: vector![f64::NAN, 0.0], p: vector![0.0, 0.0] }];
    let error = pair.by(Trapezoidal, 0.1).conformal_step(&far).unwrap_err();
    assert!(
        matches!(error, ConformalStepError::Step { sample: 0, error: StepError::NonFinite { .. } }),
        "{error}"
    );
    let proportion =
        |segments: &[samples::Pair<f64, 2>]| pair.by(Trapezoidal, 0.1).proportion(segments).unwrap_err();
    assert_eq!(proportion(&[]), SampleError::TooFew { given: 0, needed: 1 }.into());
    let still = samples::Pair::new([0.1, 0.2], [0.1, 0.2]);
    assert_eq!(proportion(&[still]), SampleError::Uninformative { given: 1 }.into());
    let lost = samples::Pair::new([0.1, 0.2], [f64::NAN, 0.2]);
    assert_eq!(proportion(&[lost]), SampleError::NonFinite { index: 0 }.into());

    // A force beside R, of which R_d knows nothing.
    struct Pushed;
    #[rayleigh_system]
    impl Pushed {
        fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
            0.5 * (v[0] * v[0] + v[1] * v[1])
        }
        fn rayleigh(&self, v: [f64; 2]) -> f64 {
            0.1 * (v[0] * v[0] + v[1] * v[1])
        }
        fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
            [-q[1], q[0]]
        }
    }
    let moving = samples::Pair::new([0.1, 0.2], [0.2, 0.1]);
    let error = Pushed.by(Midpoint, 0.1).proportion(&[moving]).unwrap_err();
    assert_eq!(error, ProportionError::OtherForce { index: 0 });
}
