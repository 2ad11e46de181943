//! The checkers take plain functions of the user: generators and generating functions under
//! `#[differentiable]`.

use dalembert::nalgebra::vector;
use dalembert::noether::Generator;
use dalembert::{Discretise, Midpoint, differentiable, rayleigh_system, samples};
use dalembert_tests::damped_oscillator::{CompleteSolution, DAMPED, H};

/// A particle in a central potential with drag along one axis.
#[rayleigh_system]
fn particle(q: [f64; 2], v: [f64; 2], c: f64) -> (f64, f64) {
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - (q[0] * q[0] + q[1] * q[1]).powi(2), 0.5 * c * v[0] * v[0])
}

/// The generator of rotations, as a user writes it.
#[differentiable]
fn turn(q: [f64; 2], rate: f64) -> [f64; 2] {
    [-rate * q[1], rate * q[0]]
}

/// S(q) = ½ s q² + λ q.
#[differentiable]
fn generating(q: [f64; 1], s: f64, lambda: f64) -> f64 {
    0.5 * s * q[0] * q[0] + lambda * q[0]
}

#[test]
fn a_generator_written_as_a_function_is_the_built_in_one() {
    let system = Particle { c: 0.1 };
    let theory = system.by(Midpoint, 0.1).noether();
    let segments = samples::segments([-1.0, -1.0], [1.0, 1.0], [0.1, 0.1], 50);
    let built_in = Generator::rotation(0, 1);
    let own = |rate: f64| Generator::from_field("turn", Turn { rate });
    let defect = |generator: &Generator<f64, 2>, index: usize| {
        theory.defect(generator, &segments[index].q0, &segments[index].q1)
    };
    let mut largest = 0.0_f64;
    for index in 0..segments.len() {
        let (expected, found) = (defect(&built_in, index), defect(&own(1.0), index));
        assert!((found.lagrangian - expected.lagrangian).abs() < 1e-15);
        assert!((found.force - expected.force).abs() < 1e-16);
        // Positive control: twice the field, twice the defect.
        assert!((defect(&own(2.0), index).force - 2.0 * expected.force).abs() < 1e-16);
        largest = largest.max(expected.force.abs());
    }
    assert!(largest > 1e-4);
    assert!(!theory.symmetry(&own(1.0), &segments).unwrap().is_conserved());
}

#[test]
fn generating_functions_written_as_a_function_solve_the_corrected_equations() {
    const STEPS: usize = 6;
    let closed = CompleteSolution::new(&DAMPED, H, -0.2, 0.7);
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let points = [-1.7, 0.0, 2.1].map(|q| vector![q]);
    let family = |error: f64| -> Vec<Generating> {
        closed.family(STEPS).iter().map(|s| Generating { s: s.s + error, lambda: s.lambda }).collect()
    };
    let report = theory.check_generating_functions(&family(0.0), &points).unwrap();
    assert!(report.is_solution(), "{report}");
    // Positive control.
    let report = theory.check_generating_functions(&family(1e-6), &points).unwrap();
    assert!(!report.is_solution(), "{report}");
}
