//! The midpoint flow of the damped oscillator is its closed form, and so is the determinant of its step
//! matrix.
//!
//! ```text
//! q1 = (4hp + (4m − kh² + 2hr) q)/D,   p1 = (4mp − h²kp − 2hrp − 4hkm q)/D,   D = 4m + h²k + 2hr
//! det = (4m + h²k − 2hr)/D
//! ```

use dalembert::nalgebra::{Matrix2, vector};
use dalembert::{Discretise, Midpoint, State, rayleigh_system};

/// The damped oscillator m q̈ + r q̇ + k q = 0.
#[rayleigh_system]
fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// The closed form, as a matrix that acts on (q, p).
fn closed_form(Oscillator { m, k, r }: Oscillator, h: f64) -> Matrix2<f64> {
    let d = 4.0 * m + h * h * k + 2.0 * h * r;
    let (qq, qp) = (4.0 * m - k * h * h + 2.0 * h * r, 4.0 * h);
    let (pq, pp) = (-4.0 * h * k * m, 4.0 * m - h * h * k - 2.0 * h * r);
    Matrix2::new(qq, qp, pq, pp) / d
}

fn step(system: Oscillator, h: f64, q: f64, p: f64) -> State<f64, 1> {
    system.by(Midpoint, h).step(&State { q: vector![q], p: vector![p] }).unwrap().state
}

const SYSTEMS: [Oscillator; 5] = [
    Oscillator { m: 1.0, k: 1.0, r: 0.5 },
    Oscillator { m: 1.7, k: 0.6, r: 0.3 },
    // Without friction, overdamped, and accelerated.
    Oscillator { m: 0.4, k: 2.3, r: 0.0 },
    Oscillator { m: 0.8, k: 0.2, r: 9.0 },
    Oscillator { m: 1.2, k: 3.0, r: -0.4 },
];

/// Largest deviation of a step from `flow`, in units of the state's size, over states, systems and step
/// sizes.
fn deviation(flow: impl Fn(Oscillator, f64) -> Matrix2<f64>) -> f64 {
    let mut largest = 0.0_f64;
    for system in SYSTEMS {
        for h in [-0.3, 1e-3, 0.25, 1.0, 4.0] {
            for (q, p) in [(0.0, 1.0), (1.0, 0.0), (0.7, -1.9), (-3.1, 0.2)] {
                let state = step(system, h, q, p);
                let expected = flow(system, h) * vector![q, p];
                let scale = expected.amax().max(q.abs()).max(p.abs());
                let off = (vector![state.q[0], state.p[0]] - expected).amax() / scale;
                assert!(off.is_finite());
                largest = largest.max(off);
            }
        }
    }
    largest
}

#[test]
fn is_the_closed_form() {
    let deviation = deviation(closed_form);
    assert!(deviation <= 1e-14, "{deviation:e}");
}

/// Positive control: the closed form with the (m − r)/h that the paper prints for 𝔽⁻ in place of m/h.
#[test]
fn is_not_the_closed_form_from_the_printed_legendre_transform() {
    // p0 = (m − r)/h (q1 − q0) + hk/4 (q0 + q1) + r/2 (q1 − q0), solved for q1.
    let printed = |Oscillator { m, k, r }: Oscillator, h: f64| {
        let (a, b) = ((m - r) / h + r / 2.0, h * k / 4.0);
        let (qq, qp) = ((a - b) / (a + b), 1.0 / (a + b));
        // p1 = m/h (q1 − q0) − hk/4 (q0 + q1) − r/2 (q1 − q0)
        let (c, d) = (m / h - r / 2.0 - b, -m / h + r / 2.0 - b);
        Matrix2::new(qq, qp, c * qq + d, c * qp)
    };
    assert!(deviation(printed) > 1e-3);
}

#[test]
fn determinant_of_the_step_matrix() {
    for system @ Oscillator { m, k, r } in SYSTEMS {
        for h in [1e-3, 0.25, 1.0, 4.0] {
            // The flow is linear: its columns are the images of the unit vectors.
            let (first, second) = (step(system, h, 1.0, 0.0), step(system, h, 0.0, 1.0));
            let matrix = Matrix2::new(first.q[0], second.q[0], first.p[0], second.p[0]);
            let expected = (4.0 * m + h * h * k - 2.0 * h * r) / (4.0 * m + h * h * k + 2.0 * h * r);
            let scale = matrix.abs().max().powi(2);
            assert!((matrix.determinant() - expected).abs() <= 1e-14 * scale, "{system:?} {h}");
            // Positive control: friction is what keeps it from 1.
            assert_eq!((expected - 1.0).abs() < 1e-12, r == 0.0);
        }
    }
}

/// Damped free mass: v̄ shrinks by (2m − hr)/(2m + hr) a step, and changes sign when hr > 2m.
#[test]
fn free_mass_rings_when_the_step_is_long() {
    let (m, r) = (1.3, 0.9);
    let system = Oscillator { m, k: 0.0, r };
    for (h, rings) in [(0.2, false), (2.0, false), (3.5, true), (50.0, true)] {
        let first = system.by(Midpoint, h).step(&State { q: vector![0.4], p: vector![1.0] });
        let first = first.unwrap();
        let second = system.by(Midpoint, h).step(&first.state).unwrap();
        let ratio = second.velocity[0] / first.velocity[0];
        assert!((ratio - (2.0 * m - h * r) / (2.0 * m + h * r)).abs() <= 1e-14, "{ratio}");
        assert_eq!(ratio < 0.0, rings);
    }
}
