//! Drag along one axis keeps the momentum along the other.

use dalembert::noether::Generator;
use dalembert::{Discretise, Midpoint, State, rayleigh_system, samples};

#[derive(Clone, Copy)]
struct Channel {
    r: f64,
    along: f64,
}

#[rayleigh_system]
impl Channel {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1] + v[0] * v[1]) - q[1].powi(4)
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (1.0 + q[1] * q[1]) * self.r * v[1] * v[1] + 0.5 * self.along * v[0] * v[0]
    }
}

#[test]
fn drag_across_keeps_the_momentum_along() {
    let system = Channel { r: 0.4, along: 0.0 };
    let noether = system.by(Midpoint, 0.05).noether();
    let segments = samples::segments([-1.0; 2], [1.0; 2], [0.2; 2], 100);
    let x = Generator::translation("x", [1.0, 0.0]);
    let report = noether.symmetry(&x, &segments).unwrap();
    assert!(
        report.is_symmetry_of_lagrangian() && !report.force_does_work() && report.is_conserved(),
        "{report}"
    );
    let start = State::from_velocity(&system, [0.0, 0.8], [1.0, 0.0]).unwrap();
    let mut trajectory = system.by(Midpoint, 0.05).run(start);
    let account = noether.balance(&x, &start, trajectory.by_ref().take(5000)).unwrap();
    assert!(account.is_balanced(), "{account}");
    assert!((account.end - account.start).abs() < 1e-12, "{account}");

    let y = noether.symmetry(&Generator::translation("y", [0.0, 1.0]), &segments).unwrap();
    assert!(!y.is_symmetry_of_lagrangian() && y.force_does_work() && !y.is_conserved(), "{y}");
}

/// Positive control: a trace of drag along the channel is seen, one below rounding is not.
#[test]
fn a_trace_of_drag_along_is_seen() {
    let x = Generator::translation("x", [1.0, 0.0]);
    let segments = samples::segments([-1.0; 2], [1.0; 2], [0.2; 2], 100);
    let conserved = |along: f64| {
        let system = Channel { r: 0.4, along };
        system.by(Midpoint, 0.05).noether().symmetry(&x, &segments).unwrap().is_conserved()
    };
    assert!(!conserved(1e-9));
    assert!(conserved(1e-17));
}
