//! The exact discrete objects of the damped oscillator m q″ + r q′ + k q = 0 have the closed forms of section
//! 3.4 with a = r/2m and, underdamped, b = √(4km − r²)/2m:
//!
//! ```text
//! L_d^ex = (mb/2)[(q0² + q1²) cot bh − 2 q0q1 cosh(ah)/sin bh]
//! f_d^ex+ = (r/2)(b q0 sinh(ah)/(a sin bh) − q1),   f_d^ex− = (r/2)(q0 − b q1 sinh(ah)/(a sin bh))
//! R_d^ex = (r/4)(q0² + q1²) − r b q0q1 sinh(ah)/(2a sin bh)
//! ```
//!
//! The paper prints sinh bh for sin bh in R_d^ex, and an L_d with coth bh: these hold for b = √(r² − 4km)/2m,
//! overdamped.

use dalembert::exact::{Exact, ExactError};
use dalembert::nalgebra::vector;
use dalembert::rayleigh_system;

#[rayleigh_system]
fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

const UNDERDAMPED: Oscillator = Oscillator { m: 1.3, k: 2.1, r: 0.7 };
const OVERDAMPED: Oscillator = Oscillator { m: 1.3, k: 2.1, r: 4.9 };

/// Points and step sizes, the third small, the last beyond half a period.
const POINTS: [(f64, f64, f64); 5] =
    [(0.4, 0.9, 0.5), (-1.2, 0.3, 1.0), (2.0, 2.1, 0.05), (0.7, -0.8, 2.0), (0.3, 0.5, 3.0)];

/// Second derivatives are at every other of them without optimisation.
const EVERY: usize = if cfg!(debug_assertions) { 2 } else { 1 };

impl Oscillator {
    fn a(&self) -> f64 {
        self.r / (2.0 * self.m)
    }

    /// √|4km − r²|/2m.
    fn b(&self) -> f64 {
        (4.0 * self.k * self.m - self.r * self.r).abs().sqrt() / (2.0 * self.m)
    }

    /// L_d^ex, underdamped.
    fn closed_lagrangian(&self, q0: f64, q1: f64, h: f64) -> f64 {
        let (a, b) = (self.a(), self.b());
        0.5 * self.m
            * b
            * ((q0 * q0 + q1 * q1) / (b * h).tan() - 2.0 * q0 * q1 * (a * h).cosh() / (b * h).sin())
    }

    /// b sinh(ah)/(a sin bh).
    fn coupling(&self, h: f64) -> f64 {
        let (a, b) = (self.a(), self.b());
        b * (a * h).sinh() / (a * (b * h).sin())
    }

    /// L_d as the paper prints it.
    fn printed_lagrangian(&self, q0: f64, q1: f64, h: f64) -> f64 {
        let Self { m, k, .. } = *self;
        let (a, b) = (self.a(), self.b());
        let e = |x: f64| x.exp();
        let left = q0 * e(2.0 * b * h) - q1 * e(h * (a + b));
        let right = q0 - q1 * e(h * (a + b));
        let mixed = m * (b * b - a * a) + k;
        let (slow, fast) = (m * (a - b).powi(2) - k, m * (a + b).powi(2) - k);
        let inner = -2.0 * e(3.0 * b * h) * mixed * (q0 * e(b * h) - q1 * e(a * h)) * right / a
            + e(4.0 * b * h) * -slow * right.powi(2) / (a - b)
            + -fast * left.powi(2) / (a + b);
        let outer = 2.0 * mixed * left * right / a
            + e(-2.0 * h * (a + b)) * inner
            + slow * right.powi(2) / (a - b)
            + fast * left.powi(2) / (a + b);
        ((b * h).cosh() / (b * h).sinh() - 1.0).powi(2) * outer / 16.0
    }

    /// Mixed derivative of the printed R_d: −r b sinh(ah) csch(bh)/2a.
    fn printed_rayleigh_d12(&self, h: f64) -> f64 {
        let (a, b) = (self.a(), self.b());
        -self.r * b * (a * h).sinh() / (2.0 * a * (b * h).sinh())
    }
}

/// |value − expected| relative to `size`.
fn assert_close(value: f64, expected: f64, size: f64, tolerance: f64, what: &str) {
    let error = (value - expected).abs() / size;
    assert!(error <= tolerance, "{what}: {value:.16e}, expected {expected:.16e}, relative error {error:.1e}");
}

#[test]
fn the_corrected_closed_forms_hold_to_rounding() {
    let system = UNDERDAMPED;
    for (q0, q1, h) in POINTS {
        let segment = Exact::new(&system).segment(vector![q0], vector![q1], h).unwrap();
        let lagrangian = system.closed_lagrangian(q0, q1, h);
        let (a, b, c) = (system.a(), system.b(), system.coupling(h));
        let scale = system.m * b * (q0 * q0 + q1 * q1) / (b * h).sin().abs();
        assert_close(segment.lagrangian.value, lagrangian, scale, 2e-14, "L_d");

        let mb = system.m * b;
        let (cot, secant) = (1.0 / (b * h).tan(), (a * h).cosh() / (b * h).sin());
        let scale = mb * (q0.abs() + q1.abs()) / (b * h).sin().abs();
        assert_close(segment.lagrangian.d1[0], mb * (q0 * cot - q1 * secant), scale, 2e-14, "D1 L_d");
        assert_close(segment.lagrangian.d2[0], mb * (q1 * cot - q0 * secant), scale, 2e-14, "D2 L_d");

        let scale = system.r * (q0.abs() + q1.abs()) * c.abs().max(1.0);
        assert_close(segment.force.plus[0], 0.5 * system.r * (c * q0 - q1), scale, 2e-14, "f_d+");
        assert_close(segment.force.minus[0], 0.5 * system.r * (q0 - c * q1), scale, 2e-14, "f_d-");
    }
}

#[test]
fn second_derivatives_are_those_of_the_closed_forms() {
    let system = UNDERDAMPED;
    for (q0, q1, h) in POINTS.into_iter().step_by(EVERY) {
        let exact = Exact::new(&system);
        let segment = exact.segment(vector![q0], vector![q1], h).unwrap();
        let second = exact.second_derivatives(&segment).unwrap();
        let (a, b, c) = (system.a(), system.b(), system.coupling(h));
        let mb = system.m * b;
        let scale = mb / (b * h).sin().abs();
        assert_close(second.lagrangian.d11[0], mb / (b * h).tan(), scale, 1e-13, "D11 L_d");
        assert_close(second.lagrangian.d22[0], mb / (b * h).tan(), scale, 1e-13, "D22 L_d");
        assert_close(second.lagrangian.d12[0], -mb * (a * h).cosh() / (b * h).sin(), scale, 1e-13, "D12 L_d");
        let half = 0.5 * system.r;
        let scale = half * c.abs().max(1.0);
        // f− = D1 R_d and f+ = −D2 R_d.
        assert_close(second.force.minus.d1[0], half, scale, 1e-13, "D1 f-");
        assert_close(second.force.minus.d2[0], -half * c, scale, 1e-13, "D2 f-");
        assert_close(second.force.plus.d1[0], half * c, scale, 1e-13, "D1 f+");
        assert_close(second.force.plus.d2[0], -half, scale, 1e-13, "D2 f+");
        assert!(second.force_error < 1e-12 * scale, "{:e}", second.force_error);
    }
}

#[test]
fn the_printed_forms_hold_overdamped_only() {
    for (q0, q1, h) in POINTS.into_iter().step_by(EVERY) {
        // Overdamped, b = √(r² − 4km)/2m: the printed hyperbolic functions are right.
        let system = OVERDAMPED;
        let exact = Exact::new(&system);
        let segment = exact.segment(vector![q0], vector![q1], h).unwrap();
        let second = exact.second_derivatives(&segment).unwrap();
        let printed = system.printed_lagrangian(q0, q1, h);
        let scale = system.m * (q0 * q0 + q1 * q1) / h;
        assert_close(segment.lagrangian.value, printed, scale, 1e-11, "printed L_d, overdamped");
        let d12 = system.printed_rayleigh_d12(h);
        assert_close(second.force.minus.d2[0], d12, d12.abs(), 1e-12, "printed D12 R_d, overdamped");

        // With the printed b = √(4km − r²)/2m they are not.
        let system = UNDERDAMPED;
        let exact = Exact::new(&system);
        let segment = exact.segment(vector![q0], vector![q1], h).unwrap();
        let second = exact.second_derivatives(&segment).unwrap();
        let scale = system.m * (q0 * q0 + q1 * q1) / h;
        // The two differ by O(h²) of the action: little at h = 0.05, but 10⁴ times what the overdamped
        // comparison allows.
        let least = if h < 0.1 { 1e-7 } else { 1e-3 };
        let apart = (segment.lagrangian.value - system.printed_lagrangian(q0, q1, h)).abs() / scale;
        assert!(apart > least, "{q0} {q1} {h}: {apart}");
        let d12 = system.printed_rayleigh_d12(h);
        let apart = (second.force.minus.d2[0] - d12).abs() / d12.abs();
        assert!(apart > least, "{q0} {q1} {h}: {apart}");
    }
}

#[test]
fn half_a_period_apart_points_are_conjugate() {
    let system = UNDERDAMPED;
    let half_period = std::f64::consts::PI / system.b();
    let exact = Exact::new(&system);
    let error = exact.segment(vector![0.4], vector![0.9], half_period).unwrap_err();
    let ExactError::ConjugatePoints { h, growth } = error else { panic!("{error}") };
    println!("{error}");
    assert!((h / half_period - 1.0).abs() < 1e-2 && growth > 100.0, "{h} {growth}");
    // Positive control: a little before and after, the motion exists and the report shows how near it is to
    // failing.
    for share in [0.999, 1.001] {
        let segment = exact.segment(vector![0.4], vector![0.9], share * half_period).unwrap();
        assert!(segment.report.growth > 100.0 && segment.report.error() < 1e-10, "{}", segment.report);
        let expected = system.closed_lagrangian(0.4, 0.9, share * half_period);
        assert_close(segment.lagrangian.value, expected, expected.abs(), 1e-11, "L_d near conjugate points");
    }
}
