//! Discrete Helmholtz conditions: which equations of motion, of the configurations alone, have an R_d.

use dalembert::derivative::PhaseMatrix;
use dalembert::nalgebra::{DMatrix, DVector, Matrix2, SMatrix, Vector2, vector};
use dalembert::rayleigh::{NodeSteps, RayleighEquation, RayleighStep, RayleighStepError};
use dalembert::step::Flow;
use dalembert::{Composition, Discretise, Gauss, Midpoint, Splitting, State, Trapezoidal, rayleigh_system};
use dalembert_tests::draws::Draws;

/// M = I, C = [[0.7, 0.2], [0.2, 0.1]], K = [[1, 0.4], [0.4, 2]], a quartic potential of q0 − q1/2, and a
/// circulatory force.
#[derive(Clone, Copy, Debug)]
struct Springs {
    quartic: f64,
    circulatory: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Springs {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let springs = 0.5 * q[0] * q[0] + 0.4 * q[0] * q[1] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - springs - self.quartic * (q[0] - 0.5 * q[1]).powi(4)
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.35 * v[0] * v[0] + 0.2 * v[0] * v[1] + 0.05 * v[1] * v[1]
    }
    fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        [self.circulatory * q[1], -self.circulatory * q[0]]
    }
}

const LINEAR: Springs = Springs { quartic: 0.0, circulatory: 0.0 };
const BENT: Springs = Springs { quartic: 0.6, ..LINEAR };
const TURNED: Springs = Springs { circulatory: 0.3, ..LINEAR };

const STATES: [State<f64, 2>; 2] = [
    State { q: vector![0.3, -0.4], p: vector![0.1, 0.2] },
    State { q: vector![-0.5, 0.2], p: vector![0.4, -0.3] },
];

/// Whether the method is a Rayleigh step, and whether its equation is a Rayleigh equation.
fn verdicts<M: Copy>(system: &Springs, method: M) -> (bool, bool)
where
    Springs: Flow<M, 2, Scalar = f64>,
{
    let by = system.by(method, 0.3);
    let step = by.rayleigh_step(&STATES).unwrap().is_rayleigh();
    (step, by.rayleigh_equation(&STATES).unwrap().is_rayleigh())
}

#[test]
fn methods_of_linear_systems_have_equations_with_an_r_d() {
    // Of order 2 with an R_d for (q, p), and so for q.
    for system in [&LINEAR, &BENT] {
        assert_eq!(verdicts(system, Midpoint), (true, true));
        assert_eq!(verdicts(system, Trapezoidal), (true, true));
    }
    // Of higher order: for q where the potential is quadratic, and there alone.
    for (system, expected) in [(&LINEAR, (false, true)), (&BENT, (false, false))] {
        assert_eq!(verdicts(system, Gauss::<2>), expected);
        assert_eq!(verdicts(system, Gauss::<4>), expected);
        assert_eq!(verdicts(system, Splitting::blanes_moan_6()), expected);
        assert_eq!(verdicts(system, Composition::kahan_li_6(Midpoint)), expected);
    }
    // The control: a force that is no friction is no R_d's by any method.
    assert_eq!(verdicts(&TURNED, Midpoint), (false, false));
    assert_eq!(verdicts(&TURNED, Gauss::<2>), (false, false));
}

/// exp(hX) of M q̈ + D q̇ + K q = 0 in its blocks; D and K need not be symmetric.
fn exact<const N: usize>([m, d, k]: &[SMatrix<f64, N, N>; 3], h: f64) -> (PhaseMatrix<f64, N>, DMatrix<f64>) {
    let inverse = m.try_inverse().unwrap();
    let mut x = DMatrix::<f64>::zeros(2 * N, 2 * N);
    x.view_mut((0, N), (N, N)).copy_from(&inverse);
    x.view_mut((N, 0), (N, N)).copy_from(&-k);
    x.view_mut((N, N), (N, N)).copy_from(&-(d * inverse));
    let a = (x * h).exp();
    let block = |i: usize, j: usize| a.fixed_view::<N, N>(i * N, j * N).into_owned();
    (PhaseMatrix { q_by_q: block(0, 0), q_by_p: block(0, 1), p_by_q: block(1, 0), p_by_p: block(1, 1) }, a)
}

fn symmetric<const N: usize>(draws: &mut Draws, diagonal: f64) -> SMatrix<f64, N, N> {
    let a = SMatrix::<f64, N, N>::from_fn(|_, _| draws.between(-1.0, 1.0));
    a * a.transpose() / N as f64 + SMatrix::identity() * diagonal
}

/// The exact motions of random systems: judged by their derivatives, and followed by the equation that is
/// made of symmetric matrices alone.
fn exact_motions<const N: usize>(draws: &mut Draws, systems: usize) {
    let h = 0.4;
    for _ in 0..systems {
        let system = [symmetric::<N>(draws, 0.5), symmetric(draws, 0.1), symmetric(draws, 0.2)];
        let (a, whole) = exact(&system, h);
        let found = RayleighEquation::of(&[NodeSteps { before: a, after: a }], None).unwrap();
        assert!(found.is_rayleigh() && found.at_node.value.abs() < 1e-13, "{found}");
        let step = RayleighStep::of(&[a], None).unwrap();
        assert!(!step.is_rayleigh() && step.at_end.value.abs() > 1e-7, "{step}");

        let PhaseMatrix { q_by_q, q_by_p, p_by_q, p_by_p } = a;
        let inverse = q_by_p.try_inverse().unwrap();
        let k10 = p_by_q - p_by_p * inverse * q_by_q;
        let k11_less_k00 = p_by_p * inverse + inverse * q_by_q;
        let halves = (k11_less_k00 + k11_less_k00.transpose()) * 0.5;
        let mut z = DVector::from_fn(2 * N, |_, _| draws.between(-1.0, 1.0));
        let q = |z: &DVector<f64>| z.fixed_rows::<N>(0).into_owned();
        let mut run = vec![q(&z)];
        for _ in 0..8 {
            z = &whole * z;
            run.push(q(&z));
        }
        let mut of_pair = run[..2].to_vec();
        for k in 1..8 {
            of_pair.push(q_by_p * (k10 * of_pair[k - 1] + halves * of_pair[k]));
        }
        assert!((of_pair[8] - run[8]).amax() < 1e-10);

        // The controls: a gyroscopic and a circulatory force.
        let turn = SMatrix::<f64, N, N>::from_fn(|i, j| 0.1 * f64::from(i32::from(i < j) - i32::from(i > j)));
        for (damping, springs) in [(turn, SMatrix::zeros()), (SMatrix::zeros(), turn)] {
            let (a, _) = exact(&[system[0], system[1] + damping, system[2] + springs], h);
            assert!(!RayleighEquation::of(&[NodeSteps { before: a, after: a }], None).unwrap().is_rayleigh());
        }
    }
}

/// Corollary: of linear systems the paper's conjecture holds for q, at every damping.
#[test]
fn exact_motions_of_linear_systems_are_discrete_rayleigh_in_q() {
    let mut draws = Draws::new(46);
    exact_motions::<2>(&mut draws, 40);
    exact_motions::<3>(&mut draws, 40);
    exact_motions::<4>(&mut draws, 40);
}

/// The asymmetry at a node with this configuration and velocity, by a method of order 6 that is its own
/// adjoint.
fn at_node(system: &Springs, node: &State<f64, 2>, h: f64) -> f64 {
    let after = system.by(Gauss::<3>, h).linearized_step(node).unwrap().1;
    let back = system.by(Gauss::<3>, -h).linearized_step(node).unwrap().1.assembled::<4>();
    let before = back.try_inverse().unwrap();
    let block = |i: usize, j: usize| before.fixed_view::<2, 2>(2 * i, 2 * j).into_owned();
    let before =
        PhaseMatrix { q_by_q: block(0, 0), q_by_p: block(0, 1), p_by_q: block(1, 0), p_by_p: block(1, 1) };
    RayleighEquation::of(&[NodeSteps { before, after }], None).unwrap().at_node.value
}

/// ∂E/∂y − (∂E/∂y)ᵀ = −(h³/15) [C, V‴(v)] + …, where V is not quadratic.
#[test]
fn the_obstruction_of_a_nonlinear_potential_is_a_fifteenth_of_the_bracket() {
    let node = State { q: vector![0.5, -0.3], p: vector![0.8, -0.6] };
    let along = Vector2::new(1.0, -0.5);
    let third = along * along.transpose() * (24.0 * BENT.quartic * along.dot(&node.q) * along.dot(&node.p));
    let c = Matrix2::new(0.7, 0.2, 0.2, 0.1);
    let bracket = c * third - third * c;
    let ratio = |h: f64| at_node(&BENT, &node, h) / (bracket[(1, 0)] * h.powi(3));
    let limit = (4.0 * ratio(0.03) - ratio(0.06)) / 3.0;
    assert!((limit * -15.0 - 1.0).abs() < 1e-3, "{limit}");
    // The controls: no velocity, and no third derivative.
    let at_rest = State { p: vector![0.0, 0.0], ..node };
    assert!((at_node(&BENT, &at_rest, 0.03) / at_node(&BENT, &node, 0.03)).abs() < 1e-3);
    assert!((at_node(&LINEAR, &node, 0.03) / at_node(&BENT, &node, 0.03)).abs() < 1e-6);
}

#[test]
fn hypotheses_that_fail_have_names() {
    assert_eq!(LINEAR.by(Midpoint, 0.3).rayleigh_equation(&[]), Err(RayleighStepError::NoSamples));
    let rest = [State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] }];
    assert_eq!(BENT.by(Midpoint, 0.3).rayleigh_equation(&rest), Err(RayleighStepError::AtRest));
    let lost = [State { q: vector![f64::NAN, 0.0], p: vector![0.0, 0.0] }];
    let error = BENT.by(Midpoint, 0.3).rayleigh_equation(&lost).unwrap_err();
    assert!(matches!(error, RayleighStepError::Step { sample: 0, .. }), "{error}");

    let sound = exact(&[Matrix2::identity(); 3], 0.3).0;
    let flat = PhaseMatrix { q_by_p: Matrix2::zeros(), ..sound };
    let of = |before, after| RayleighEquation::of(&[NodeSteps { before, after }], None);
    assert_eq!(of(sound, flat), Err(RayleighStepError::Degenerate { sample: 0 }));
    let broken = PhaseMatrix { p_by_q: Matrix2::from_element(f64::NAN), ..sound };
    assert_eq!(of(broken, sound), Err(RayleighStepError::NonFinite { sample: 0 }));
    // One coordinate always has one.
    let one = exact(&[SMatrix::<f64, 1, 1>::identity(); 3], 0.3).0;
    assert!(RayleighEquation::of(&[NodeSteps { before: one, after: one }], None).unwrap().is_rayleigh());
}
