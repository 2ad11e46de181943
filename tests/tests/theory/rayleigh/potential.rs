//! R_d is recovered from f_d alone; for the midpoint rule it is (h²/2) R(q̄, v̄), not (h/2) R as the paper
//! prints (section 3.5).

use dalembert::rayleigh::Potential;
use dalembert::samples::{self, Pair};
use dalembert::{Discretise, Midpoint, Trapezoidal, rayleigh_system};

/// R depends on q, is not quadratic in v, and vanishes at v = 0.
#[derive(Clone, Copy)]
struct Involved {
    m: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Involved {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.m * (v[0] * v[0] + v[1] * v[1]) - (q[0] * q[1]).cos()
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (2.0 + q[0].sin()) * (v[0] * v[0] + v[0] * v[1] + v[1] * v[1]) + 0.1 * q[1].exp() * v[1].powi(4)
    }
}

/// The force −∂R/∂v of R = ½(vx² + vx vy + vy²) + ¼ vy⁴, given as a force.
#[derive(Clone, Copy)]
struct ForceAlone {
    m: f64,
}

#[rayleigh_system]
impl ForceAlone {
    fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.m * (v[0] * v[0] + v[1] * v[1])
    }
    fn force(&self, _q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [-v[0] - 0.5 * v[1], -0.5 * v[0] - v[1] - v[1].powi(3)]
    }
}

fn plane() -> Vec<Pair<f64, 2>> {
    samples::segments([-1.0; 2], [1.0; 2], [0.3; 2], 40)
}

#[test]
fn the_midpoint_potential_is_half_h_squared_times_r() {
    let system = ForceAlone { m: 1.3 };
    for h in [0.5, 0.1, 0.02] {
        let potential = Potential::new(&system, Midpoint, h, Pair::new([0.3, 0.1], [0.3, 0.1]));
        let recovery = potential.check(&plane()).unwrap();
        assert!(recovery.exists(), "{recovery}");
        for (segment, value) in plane().iter().zip(&recovery.values) {
            let v = (segment.q1 - segment.q0) / h;
            let r = 0.5 * (v[0] * v[0] + v[0] * v[1] + v[1] * v[1]) + 0.25 * v[1].powi(4);
            let scale = 0.5 * h * h * r.max(1.0);
            assert!((value - 0.5 * h * h * r).abs() < 1e-13 * scale, "{value} {r}");
            // Positive control: the printed factor is off by 1/h.
            assert!((value - 0.5 * h * r).abs() > 0.5 * value.abs());
        }
    }
}

#[test]
fn the_potential_of_a_general_rayleigh_function_is_recovered_for_both_rules() {
    let (system, h) = (Involved { m: 0.8 }, 0.2);
    let base = Pair::new([0.2, -0.1], [0.2, -0.1]);
    let midpoint = Potential::new(&system, Midpoint, h, base).check(&plane()).unwrap();
    let trapezoidal = Potential::new(&system, Trapezoidal, h, base).check(&plane()).unwrap();
    assert!(midpoint.exists() && trapezoidal.exists(), "{midpoint}\n{trapezoidal}");
    assert!(midpoint.quadrature_error < 1e-13);
    for (index, segment) in plane().iter().enumerate() {
        let (q0, q1) = (segment.q0, segment.q1);
        let v: [f64; 2] = ((q1 - q0) / h).into();
        let at = |q: dalembert::nalgebra::SVector<f64, 2>| system.rayleigh(q.into(), v);
        let expected = 0.5 * h * h * at((q0 + q1) * 0.5);
        assert!((midpoint.values[index] - expected).abs() < 1e-14 + 1e-13 * expected.abs());
        let expected = 0.25 * h * h * (at(q0) + at(q1));
        assert!((trapezoidal.values[index] - expected).abs() < 1e-14 + 1e-13 * expected.abs());
        let own = system.by(Trapezoidal, h).discrete_rayleigh(&q0, &q1);
        assert!((own - expected).abs() < 1e-15 + 1e-14 * expected.abs());
    }
}
