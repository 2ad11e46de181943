//! Sections that are no differentials solve the corrected problem as well: two degrees of freedom, friction
//! and a force with curl, sections γ_k(q) = M_k q + l_k from the carried frames. And what cannot be evaluated
//! is a typed error.

use dalembert::hamilton_jacobi::{ConfigurationMap, HamiltonJacobiError, Section};
use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::{Discrete, Discretise, Midpoint, Trapezoidal, rayleigh_system};
use dalembert_tests::damped_oscillator::{CompleteSolution, DAMPED};
use dalembert_tests::sections::Constant;

struct Whirl;

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Whirl {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * v[0] * v[0] + 0.8 * v[1] * v[1] + 0.1 * v[0] * v[1] - 0.6 * q[0] * q[0] - 0.4 * q[1] * q[1]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.1 * v[0] * v[0] + 0.3 * v[1] * v[1]
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [0.5 * q[1] + 0.1 * v[1], -0.5 * q[0]]
    }
}

/// q ↦ M q + l, as a section or as a map.
#[derive(Clone, Copy)]
struct Affine {
    matrix: SMatrix<f64, 2, 2>,
    shift: SVector<f64, 2>,
}

impl Section<2> for Affine {
    type Scalar = f64;

    fn covector(&self, q: &SVector<f64, 2>) -> SVector<f64, 2> {
        self.matrix * q + self.shift
    }

    fn jacobian(&self, _q: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
        self.matrix
    }
}

impl ConfigurationMap<2> for Affine {
    type Scalar = f64;

    fn image(&self, q: &SVector<f64, 2>) -> SVector<f64, 2> {
        self.matrix * q + self.shift
    }

    fn jacobian(&self, _q: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
        self.matrix
    }
}

const H: f64 = 0.2;

fn check<R: Copy>(rule: R)
where
    Whirl: Discrete<R, 2, Scalar = f64>,
{
    let theory = Whirl.by(rule, H).hamilton_jacobi();
    let start = Affine { matrix: SMatrix::from_row_slice(&[0.2, 0.3, 0.3, -0.1]), shift: vector![0.4, -0.2] };
    let carried = theory.carry(&start, &vector![0.3, 0.7], 6).unwrap();
    let mut sections: Vec<Affine> = carried
        .frames
        .iter()
        .zip(&carried.states)
        .map(|(frame, state)| {
            let matrix = frame.p * frame.q.try_inverse().unwrap();
            Affine { matrix, shift: state.p - matrix * state.q }
        })
        .collect();
    let maps: Vec<Affine> = carried
        .frames
        .windows(2)
        .zip(carried.states.windows(2))
        .map(|(frames, states)| {
            let matrix = frames[1].q * frames[0].q.try_inverse().unwrap();
            Affine { matrix, shift: states[1].q - matrix * states[0].q }
        })
        .collect();
    // Samples off the characteristic: the system is affine, so is the solution.
    let samples = [vector![1.3, -0.8], vector![-0.6, 0.1], vector![0.0, 2.0]];
    let by_minus = theory.check_sections(&sections, &samples).unwrap();
    let with_maps = theory.check_solution(&maps, &sections, &samples).unwrap();
    for report in [by_minus, with_maps] {
        assert!(report.is_solution() && report.work.unwrap().holds(), "{report}");
        assert!(!report.closed_sections.unwrap().holds() && !report.closed_work.unwrap().holds(), "{report}");
        assert_eq!(report.singular_maps, 0);
    }
    // Positive control: symmetrised, the sections are closed and no solution.
    for section in &mut sections {
        section.matrix = (section.matrix + section.matrix.transpose()) * 0.5;
    }
    let report = theory.check_sections(&sections, &samples).unwrap();
    assert!(report.closed_sections.unwrap().holds() && !report.is_solution(), "{report}");
}

#[test]
fn sections_that_are_not_closed_solve_it() {
    check(Midpoint);
    check(Trapezoidal);
}

/// The same in single precision: tolerances follow the scalar.
#[test]
fn single_precision_is_held_against_its_own_rounding() {
    #[rayleigh_system]
    fn single(q: [f32; 1], v: [f32; 1], r: f32) -> (f32, f32) {
        (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0])
    }
    struct Rest;
    impl Section<1> for Rest {
        type Scalar = f32;
        fn covector(&self, _q: &SVector<f32, 1>) -> SVector<f32, 1> {
            vector![0.3]
        }
        fn jacobian(&self, _q: &SVector<f32, 1>) -> SMatrix<f32, 1, 1> {
            SMatrix::zeros()
        }
    }
    let system = Single { r: 0.5 };
    let theory = system.by(Midpoint, 0.25).hamilton_jacobi();
    let report = theory.hamilton_equations(&[vector![0.3], vector![0.5]]).unwrap();
    assert!(report.right_momentum.corrected.unwrap().holds(), "{report}");
    assert!(!report.right_momentum.printed.unwrap().holds(), "{report}");
    assert!(report.relative > 1e-5);
    let caustics = theory.carry(&Rest, &vector![0.9], 20).unwrap().caustics;
    let double = DAMPED.by(Midpoint, 0.25).hamilton_jacobi();
    let rest = Constant(0.3);
    let expected = double.carry(&rest, &vector![0.9], 20).unwrap().caustics;
    assert_eq!((caustics.len(), expected.len()), (1, 1));
    assert_eq!(caustics[0].step, expected[0].step);
    assert!((caustics[0].fraction - expected[0].fraction).abs() < 1e-4);
}

#[test]
fn what_cannot_be_evaluated_is_a_typed_error() {
    let theory = DAMPED.by(Midpoint, 0.25).hamilton_jacobi();
    let family = CompleteSolution::new(&DAMPED, 0.25, -0.4, 0.7).family(3);
    let q = [vector![0.1], vector![0.2], vector![0.3], vector![0.4], vector![0.5]];
    assert_eq!(
        theory.as_printed(&family, &q[..2]),
        Err(HamiltonJacobiError::TooFewPoints { needed: 3, found: 2 })
    );
    assert_eq!(
        theory.as_printed(&family, &q),
        Err(HamiltonJacobiError::FamilyLength { needed: 5, found: 4 })
    );
    assert_eq!(
        theory.check_sections(&family[..1], &q),
        Err(HamiltonJacobiError::FamilyLength { needed: 2, found: 1 })
    );
    assert_eq!(
        theory.check_sections(&family, &[]),
        Err(HamiltonJacobiError::TooFewPoints { needed: 1, found: 0 })
    );

    // Cubic drag R = r v³/3 from a momentum that no real step has: an error with its place, and an outcome in
    // the report.
    #[rayleigh_system]
    fn cubic(_q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
        (0.5 * v[0] * v[0], r * v[0].powi(3) / 3.0)
    }
    let system = Cubic { r: 1.0 };
    let theory = system.by(Midpoint, 1.0).hamilton_jacobi();
    // p0 = v + v²/2 ≥ −½.
    let error = theory.carry(&Constant(-0.6), &vector![0.0], 3).unwrap_err();
    assert!(matches!(error, HamiltonJacobiError::Implicit { step: 0, .. }), "{error}");
    let report = theory.check_sections(&[Constant(-0.6), Constant(-0.6)], &[vector![0.0]]).unwrap();
    assert!(report.plus.is_err() && !report.is_solution(), "{report}");
    assert!(report.to_string().contains("not evaluated"), "{report}");
    // Positive control: just inside it evaluates.
    assert!(theory.carry(&Constant(-0.49), &vector![0.0], 1).is_ok());
}
