//! The step matrix is exact: against central differences of the step, by its determinant, and by what the
//! force makes of the symplectic form, for all rules, a general force and a mass and a Rayleigh function that
//! depend on q.

use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
use dalembert::step::{ClosedForm, DiscreteRayleigh, Linearizable, Segment};
use dalembert::{Discrete, Discretise, Gauss, Midpoint, State, Trapezoidal, rayleigh_system};

/// Nonlinear in everything; `curl` is the strength of a force that is not Rayleigh.
struct Tangle {
    friction: f64,
    curl: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Tangle {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let mass = 1.3 + 0.4 * q[0].sin();
        0.5 * mass * v[0] * v[0] + 0.7 * v[1] * v[1] + 0.2 * v[0] * v[1] * q[1].cos()
            - q[0].powi(4)
            - (q[0] * q[1]).cos()
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.friction
            * (1.0 + q[1] * q[1])
            * (0.5 * v[0] * v[0] + v[0] * v[1] + v[1] * v[1] + 0.1 * v[0].powi(4))
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [self.curl * (q[1] + v[1]), -self.curl * q[0] * v[0]]
    }
}

type Phase = SMatrix<f64, 4, 4>;

const OMEGA: Phase = matrix![
    0.0, 0.0, 1.0, 0.0;
    0.0, 0.0, 0.0, 1.0;
    -1.0, 0.0, 0.0, 0.0;
    0.0, -1.0, 0.0, 0.0
];

const Q0: SVector<f64, 2> = vector![0.4, -0.3];
const Q1: SVector<f64, 2> = vector![0.55, -0.1];
const H: f64 = 0.2;

fn step_matrix<R, L>(system: &L, rule: R) -> Phase
where
    L: Linearizable<R, 2, Scalar = f64>,
{
    system.by(rule, H).segment(&Q0, &Q1).unwrap().linearized().unwrap().by_state().unwrap().assembled()
}

fn by_differences<R, L>(system: &L, rule: R) -> Phase
where
    L: Discrete<R, 2, Scalar = f64>,
{
    let state = system.by(rule, H).segment(&Q0, &Q1).unwrap().legendre_minus().unwrap();
    let step = |component: usize, shift: f64| {
        let mut moved = state;
        if component < 2 {
            moved.q[component] += shift
        } else {
            moved.p[component - 2] += shift
        }
        let State { q, p } = system.step(&moved, H, Some(&((Q1 - Q0) / H))).unwrap().state;
        vector![q[0], q[1], p[0], p[1]]
    };
    let width = 1e-5;
    Phase::from_fn(|i, j| (step(j, width)[i] - step(j, -width)[i]) / (2.0 * width))
}

fn check_against_differences<R: Copy, L>(system: &L, rule: R)
where
    L: Linearizable<R, 2, Scalar = f64>,
{
    let (exact, differences) = (step_matrix(system, rule), by_differences(system, rule));
    let miss = (exact - differences).amax();
    // Truncation (1e-5)² times third derivatives, rounding 1e-16/1e-5.
    assert!(miss < 3e-9 * exact.amax(), "{miss}\n{exact}\n{differences}");
    // Positive control: the transpose is another matrix.
    assert!((exact.transpose() - differences).amax() > 0.1);
}

#[test]
fn it_is_the_derivative_of_the_step() {
    for system in [Tangle { friction: 0.6, curl: 0.8 }, Tangle { friction: 0.0, curl: 0.0 }] {
        check_against_differences(&system, Midpoint);
        check_against_differences(&system, Trapezoidal);
        check_against_differences(&system, Gauss::<1>);
        check_against_differences(&system, Gauss::<2>);
        check_against_differences(&system, Gauss::<3>);
        check_against_differences(&system, Gauss::<8>);
    }
}

fn check_determinant<R: Copy, L>(system: &L, rule: R)
where
    L: DiscreteRayleigh<R, 2, Scalar = f64> + Linearizable<R, 2>,
{
    let determinant = step_matrix(system, rule).determinant();
    let segment = Segment::between(&Q0, &Q1, H);
    let plus = system.modified_plus_derivatives(&segment).d12.determinant();
    let minus = system.modified_minus_derivatives(&segment).d12.determinant();
    assert!((determinant / (minus / plus) - 1.0).abs() < 1e-13);
    // Positive control: friction moves it away from 1, and the ratio upside down is wrong.
    assert!((determinant - 1.0).abs() > 0.05 && (determinant - plus / minus).abs() > 0.05);
}

#[test]
fn its_determinant_is_that_of_the_modified_lagrangians() {
    let system = Tangle { friction: 0.6, curl: 0.0 };
    check_determinant(&system, Midpoint);
    check_determinant(&system, Trapezoidal);
}

/// AᵀΩA − Ω = Tᵀ(F − Fᵀ)T, T = ∂(q0, q1)/∂(q0, p0), F = ∂(f⁻, f⁺)/∂(q0, q1).
#[test]
fn the_force_alone_bends_the_symplectic_form() {
    for (system, bends) in
        [(Tangle { friction: 0.6, curl: 0.8 }, true), (Tangle { friction: 0.0, curl: 0.0 }, false)]
    {
        let step = system.by(Midpoint, H).segment(&Q0, &Q1).unwrap().linearized().unwrap();
        let of_step = step.by_state().unwrap();
        let a: Phase = of_step.assembled();
        let defect = a.transpose() * OMEGA * a - OMEGA;
        let f =
            ClosedForm::<Midpoint, 2>::discrete_force_derivatives(&system, &Segment::between(&Q0, &Q1, H));
        let force = Phase::from_fn(|i, j| {
            let half = if i < 2 { &f.minus } else { &f.plus };
            let block = if j < 2 { &half.d1 } else { &half.d2 };
            block[(i % 2, j % 2)]
        });
        let tangent = Phase::from_fn(|i, j| match (i < 2, j < 2) {
            (true, _) => f64::from(u8::from(i == j)),
            (false, true) => of_step.q_by_q[(i - 2, j)],
            (false, false) => of_step.q_by_p[(i - 2, j - 2)],
        });
        let expected = tangent.transpose() * (force - force.transpose()) * tangent;
        assert!((defect - expected).amax() < 1e-13 * (1.0 + a.amax().powi(2)), "{defect}{expected}");
        assert_eq!(defect.amax() > 1e-2, bends, "{defect}");
    }
}

/// ∂p0/∂q1 = −D1D2 L_d⁺ is singular: the step has no derivative, and the error says where.
#[test]
fn a_singular_transform_is_an_error() {
    // Midpoint: ∂p0/∂q1 = m/h + kh/4 + r/2, which vanishes for the repelling k = −4m/h².
    use dalembert_tests::damped_oscillator::Oscillator;
    let at = |k: f64| {
        let oscillator = Oscillator { m: 1.0, k, r: 0.0 };
        let segment = oscillator.by(Midpoint, 0.5).segment(&vector![0.1], &vector![0.2]).unwrap();
        segment.linearized().and_then(|step| step.by_state())
    };
    assert!(
        matches!(at(-16.0), Err(dalembert::StepError::SingularNewtonMatrix { column: 0, .. })),
        "{:?}",
        at(-16.0)
    );
    assert!(at(-15.9).is_ok());
}
