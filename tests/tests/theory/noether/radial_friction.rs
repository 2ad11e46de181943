//! Friction of the radial motion alone, R = ½ k(r) ṙ², keeps the angular momentum of a central potential:
//! exactly in polar coordinates (R_d then depends on the radii alone) and as a midpoint force; the midpoint
//! R_d of R(q, v) in Cartesian coordinates loses it at order h³ a step, through ∂R/∂q.

use dalembert::nalgebra::vector;
use dalembert::noether::Generator;
use dalembert::{Discretise, Midpoint, rayleigh_system, samples};

/// k(r) = c (1 + r²).
#[derive(Clone, Copy)]
struct Polar {
    c: f64,
}

#[rayleigh_system]
impl Polar {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + q[0] * q[0] * v[1] * v[1]) + 1.0 / q[0]
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.c * (1.0 + q[0] * q[0]) * v[0] * v[0]
    }
}

#[derive(Clone, Copy)]
struct CartesianForce {
    c: f64,
}

#[rayleigh_system]
impl CartesianForce {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / q[0].hypot(q[1])
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let s = q[0] * q[0] + q[1] * q[1];
        let factor = -self.c * (1.0 + s) * (q[0] * v[0] + q[1] * v[1]) / s;
        [factor * q[0], factor * q[1]]
    }
}

#[derive(Clone, Copy)]
struct CartesianRayleigh {
    c: f64,
}

#[rayleigh_system]
impl CartesianRayleigh {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / q[0].hypot(q[1])
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * self.c * (1.0 + s) * (q[0] * v[0] + q[1] * v[1]).powi(2) / s
    }
}

#[test]
fn in_polar_coordinates_it_keeps_rotation() {
    let system = Polar { c: 0.3 };
    let segments = samples::segments([0.5, -3.0], [2.0, 3.0], [0.2, 0.4], 200);
    let noether = system.by(Midpoint, 0.1).noether();
    let report = noether.symmetry(&Generator::translation("θ", [0.0, 1.0]), &segments).unwrap();
    assert!(
        report.is_conserved() && report.is_symmetry_of_lagrangian() && !report.force_does_work(),
        "{report}"
    );
    // Positive control: it does brake the radial motion.
    let radial = noether.symmetry(&Generator::translation("r", [1.0, 0.0]), &segments).unwrap();
    assert!(radial.force_does_work(), "{radial}");
}

#[test]
fn as_a_midpoint_force_it_keeps_rotation() {
    let system = CartesianForce { c: 0.3 };
    let segments = samples::segments([0.5, 0.5], [2.0, 2.0], [0.2; 2], 200);
    let report = system.by(Midpoint, 0.1).noether().symmetry(&Generator::rotation(0, 1), &segments).unwrap();
    assert!(
        report.is_conserved() && report.is_symmetry_of_lagrangian() && !report.force_does_work(),
        "{report}"
    );
}

/// f_d(ξ) = −(h³/4) ∂R/∂q(q̄, v̄)·J v̄, worked out by hand from R_d = (h²/2) R(q̄, v̄).
#[test]
fn as_a_cartesian_rayleigh_function_it_loses_h_cubed_a_step() {
    let c = 0.3;
    let system = CartesianRayleigh { c };
    let rotation = Generator::rotation(0, 1);
    let (middle, velocity) = (vector![0.8, 0.9], vector![0.4, -0.7]);
    for h in [0.2, 0.1, 0.05] {
        let (q0, q1) = (middle - velocity * (h / 2.0), middle + velocity * (h / 2.0));
        let defect = system.by(Midpoint, h).noether().defect(&rotation, &q0, &q1);
        // R = ½ c (1/s + 1) w², s = |q|², w = q·v:  ∂R/∂q = −c w²/s² q + c (1/s + 1) w v, and v·Jv = 0.
        let (s, w) = (middle.norm_squared(), middle.dot(&velocity));
        let turned = vector![-velocity[1], velocity[0]];
        let expected = -h.powi(3) / 4.0 * (-c * w * w / (s * s)) * middle.dot(&turned);
        assert!((defect.force - expected).abs() < 1e-15, "{} {expected}", defect.force);
        assert!(expected.abs() > 1e-7);
        assert!(defect.lagrangian.abs() < 1e-15);
    }
}
