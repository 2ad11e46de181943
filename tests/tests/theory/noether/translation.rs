//! Drag along one axis keeps the momentum along the other.

use dalembert::nalgebra::Vector2;
use dalembert::noether::Generator;
use dalembert::{Discrete, Discretise, Gauss, Midpoint, State, Trapezoidal, rayleigh_system, samples};

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

/// Even drag on a plane in a magnetic field, the latter in L: no translation is a symmetry, and each is one
/// up to a difference, by every rule.
#[derive(Clone, Copy)]
struct Charge {
    r: f64,
    field: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Charge {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) + 0.5 * self.field * (q[0] * v[1] - q[1] * v[0])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + v[1] * v[1])
    }
}

/// ξ(L_d) + f_d(ξ) = F(q1) − F(q0) keeps J − F (an answer to the paper's question of other symmetries).
#[test]
fn a_symmetry_up_to_a_difference_keeps_the_momentum_less_the_function() {
    fn holds<R: Copy>(rule: R)
    where
        Charge: Discrete<R, 2, Scalar = f64>,
    {
        let (system, h) = (Charge { r: 0.3, field: 0.7 }, 0.2);
        let noether = system.by(rule, h).noether();
        let segments = samples::segments([-1.0; 2], [1.0; 2], [0.3; 2], 40);
        let along = Generator::translation("x", [1.0, 0.0]);
        let function = |q: &Vector2<f64>| -system.r * q[0] + 0.5 * system.field * q[1];
        let found = noether.symmetry_up_to(&along, function, &segments).unwrap();
        assert!(found.is_conserved() && found.is_consistent(), "{found}");
        // The controls: without the function, with a part of it, and with another sign.
        assert!(!noether.symmetry(&along, &segments).unwrap().is_conserved());
        let others: [fn(&Vector2<f64>) -> f64; 2] = [|q| -0.3 * q[0], |q| -0.3 * q[0] - 0.35 * q[1]];
        for other in others {
            let found = noether.symmetry_up_to(&along, other, &segments).unwrap();
            assert!(!found.is_conserved() && found.is_consistent(), "{found}");
        }
        let start = State::from_velocity(&system, [0.1, -0.2], [1.0, 0.4]).unwrap();
        let kept = |state: &State<f64, 2>| state.p[0] - function(&state.q);
        let end = system.by(rule, h).run(start).take(100).last().unwrap().unwrap().state;
        assert!((kept(&end) - kept(&start)).abs() < 1e-13 && (end.p[0] - start.p[0]).abs() > 0.1);
    }
    holds(Midpoint);
    holds(Trapezoidal);
    holds(Gauss::<2>);
}
