//! The order of a discretisation, measured against the exact discrete objects.
//!
//! A nonlinear system with q-dependent mass and q-dependent R: midpoint and trapezoidal rule of order 2, a
//! one-sided rectangle rule of order 1.

use dalembert::exact::{Convergence, Exact};
use dalembert::nalgebra::vector;
use dalembert::rules::Quadrature;
use dalembert::rules::{DisplacementRule, Node};
use dalembert::{Discretise, Midpoint, Trapezoidal, rayleigh_system};

#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn bead(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    let inertia = 1.3 + 0.4 * q[0].cos();
    (
        0.5 * inertia * v[0] * v[0] - 0.25 * q[0].powi(4) + q[0].cos(),
        r * (1.0 + q[0] * q[0]) * (0.5 * v[0] * v[0] + 0.1 * v[0].powi(4)),
    )
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Pushed {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }

    fn force(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        [-self.r * (1.0 + q[0] * q[0]) * v[0]]
    }
}

struct Pushed {
    r: f64,
}

/// L and f at q0: order 1.
#[derive(Clone, Copy)]
struct Rectangle;

impl DisplacementRule for Rectangle {
    const NODES: &'static [Node] = &[Node { position: 0.0, weight: 1.0 }];
}

const BEAD: Bead = Bead { r: 0.4 };
const PUSHED: Pushed = Pushed { r: 0.4 };

/// From coarse to far down the round-off plateau.
fn step_sizes() -> Vec<f64> {
    (2..20).map(|k| 0.5_f64.powi(k)).step_by(if cfg!(debug_assertions) { 2 } else { 1 }).collect()
}

fn assert_slope(convergence: &Convergence, expected: f64, what: &str) {
    let (slope, last) = (convergence.slope.unwrap(), convergence.last.unwrap());
    assert!((slope - expected).abs() < 0.1, "{what}: {convergence}");
    assert!((last - expected).abs() < 0.05, "{what}: {convergence}");
}

#[test]
fn midpoint_and_trapezoidal_rule_have_order_two() {
    let exact = Exact::new(&BEAD);
    let midpoint = exact.order(Midpoint, vector![0.5], vector![0.9], &step_sizes()).unwrap();
    let trapezoidal = exact.order(Trapezoidal, vector![0.5], vector![0.9], &step_sizes()).unwrap();
    println!("{midpoint}\n{trapezoidal}");
    for (report, name) in [(&midpoint, "midpoint"), (&trapezoidal, "trapezoidal")] {
        assert_slope(&report.p0, 2.0, name);
        assert_slope(&report.p1, 2.0, name);
        assert_slope(&report.lagrangian, 3.0, name);
        // Each half of the force is off by O(h²), which D L_d makes up for.
        assert_slope(&report.force_minus, 2.0, name);
        assert_slope(&report.force_plus, 2.0, name);
    }
}

#[test]
fn a_one_sided_rule_has_order_one() {
    // Positive control: the measurement tells order 1 from order 2.
    let exact = Exact::new(&PUSHED);
    let report = exact.order(Quadrature(Rectangle), vector![0.5], vector![0.9], &step_sizes()).unwrap();
    assert_slope(&report.p0, 1.0, "p0");
    assert_slope(&report.p1, 1.0, "p1");
    assert_slope(&report.lagrangian, 2.0, "L_d");
    assert_slope(&report.force_minus, 1.0, "f_d-");
}

#[test]
fn the_midpoint_force_is_off_by_a_twelfth() {
    // f_d^± − f_d^ex± = ∓(h²/12)(df/dt − f_v f/m) + O(h³), df/dt along the motion, m = 1: f_v bends ∂q(t)/∂q1
    // too.
    let exact = Exact::new(&PUSHED);
    let (q0, v) = (0.5_f64, 0.3);
    for (h, tolerance) in [(0.02, 2e-2), (0.005, 5e-3)] {
        let q1 = q0 + h * v;
        let segment = exact.segment(vector![q0], vector![q1], h).unwrap();
        let force = PUSHED.by(Midpoint, h).discrete_force(&vector![q0], &vector![q1]);
        let q = 0.5 * (q0 + q1);
        let acceleration = -q.sin() - PUSHED.r * (1.0 + q * q) * v;
        let (force_now, by_v) = (-PUSHED.r * (1.0 + q * q) * v, -PUSHED.r * (1.0 + q * q));
        let rate = -PUSHED.r * 2.0 * q * v * v + by_v * acceleration - by_v * force_now;
        let plus = (force.plus[0] - segment.force.plus[0]) / (h * h * rate);
        let minus = (force.minus[0] - segment.force.minus[0]) / (h * h * rate);
        assert!((12.0 * plus + 1.0).abs() < tolerance, "{plus}");
        assert!((12.0 * minus - 1.0).abs() < tolerance, "{minus}");
    }
}

#[test]
fn the_plateau_is_left_out() {
    let exact = Exact::new(&BEAD);
    let report = exact.order(Midpoint, vector![0.5], vector![0.9], &step_sizes()).unwrap();
    assert!(report.lagrangian.cut > 0 && report.lagrangian.used >= 6, "{report}");
    // With the plateau the slope over the same step sizes is not 3.
    let (first, last) = (report.samples[0], report.samples[report.samples.len() - 1]);
    let naive = (first.lagrangian / last.lagrangian.max(f64::MIN_POSITIVE)).ln() / (first.h / last.h).ln();
    assert!((naive - 3.0).abs() > 0.1, "{naive}");
}

#[test]
fn a_force_left_out_of_the_exact_objects_shows() {
    // The rule discretises R, the exact objects are those of L alone: f_d ≈ (h/2) f is all error.
    let exact = Exact::unforced(&BEAD);
    let steps: Vec<f64> = (4..9).map(|k| 0.5_f64.powi(k)).collect();
    let report = exact.order(Midpoint, vector![0.5], vector![0.9], &steps).unwrap();
    assert!((report.force_plus.last.unwrap() - 1.0).abs() < 0.05, "{report}");
}
