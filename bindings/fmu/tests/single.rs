//! A unit in single precision, without an input.

mod importer;

use dalembert::{Discretise, Midpoint, State, rayleigh_system};
use dalembert_fmu::boundary::Status;
use importer::Imported;

dalembert_fmu::parameters! {
    /// A particle in a ring, with drag.
    pub struct Ring {
        /// Mass.
        pub m: f32,
        /// Drag.
        pub k: f32,
    }
}

#[rayleigh_system]
impl Ring {
    fn lagrangian(&self, q: [f32; 2], v: [f32; 2]) -> f32 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * self.m * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0) * (s - 1.0)
    }

    fn rayleigh(&self, v: [f32; 2]) -> f32 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }

    /// - `y[0]` s: square of the radius
    fn outputs(&self, q: [f32; 2], _v: [f32; 2]) -> [f32; 1] {
        [q[0] * q[0] + q[1] * q[1]]
    }
}

dalembert_fmu::fmu! { ring: Ring, rule: Midpoint, step_size: 0.1, parameters: Ring { m: 1.0, k: 0.05 }, q: [0.0, 1.2], v: [0.5, 0.0] }

#[test]
fn a_unit_in_single_precision_steps_as_rust_does() {
    let mut unit = Imported::new(UNIT.description(), &UNIT.token());
    assert!(UNIT.description().contains(r#"<Float32 name="q[1]""#));
    unit.set_single("k", 0.2).unwrap();
    assert_eq!(unit.set_double("k", 0.2), Err(Status::Error), "of another type");
    unit.start_at(0.0).unwrap();
    let system = Ring { m: 1.0, k: 0.2 };
    let start = State::from_velocity(&system, [0.0, 1.2], [0.5, 0.0]).unwrap();
    let mut run = system.by(Midpoint, 0.1).run_with_inputs(start);
    for k in 0..50 {
        // The importer's h is that of f64, the unit's that of f32.
        unit.step(0.1 * f64::from(k), 0.1).unwrap();
        let State { q, p } = run.advance(&system).unwrap().state;
        assert_eq!(unit.single(["q[0]", "q[1]", "p[0]", "p[1]"]), Ok([q[0], q[1], p[0], p[1]]), "step {k}");
    }
    assert_ne!(unit.single(["q[0]"]), Ok([0.0]), "the control: it moves");
    let [x, y] = unit.single(["q[0]", "q[1]"]).unwrap();
    assert_eq!((unit.single(["s"]), unit.double(["s"])), (Ok([x * x + y * y]), Err(Status::Error)));
    unit.through_bytes().unwrap();
    unit.step(5.0, 0.1).unwrap();
}

/// Without mass it follows the slope of the potential, v = −∇V/k: on the axis of q₁ it comes to rest at 1.
#[test]
fn a_unit_without_mass_steps() {
    let mut unit = Imported::new(UNIT.description(), &UNIT.token());
    unit.set_single("m", 0.0).unwrap();
    unit.set_single("k", 2.0).unwrap();
    unit.start_at(0.0).unwrap();
    let slope = |q: f32| 2.0 * q * (q * q - 1.0) * (3.0 * q * q - 1.0);
    let [v] = unit.single(["v[1]"]).unwrap();
    assert!((v + slope(1.2) / 2.0).abs() < 1e-5, "{v}");
    for k in 0..100 {
        unit.step(0.1 * f64::from(k), 0.1).unwrap();
    }
    let [q, v] = unit.single(["q[1]", "v[1]"]).unwrap();
    assert!((q - 1.0).abs() < 1e-5 && v.abs() < 1e-5, "{q} {v}");
    unit.through_bytes().unwrap();
}
