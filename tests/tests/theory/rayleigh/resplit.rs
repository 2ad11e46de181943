//! Every forced system with n = 1 is a Rayleigh one in other L_d^±: −D1 L_d⁺ = p0, D2 L_d⁻ = p1. For n > 1
//! iff D1 f⁻ and D2 f⁺ are symmetric.

use dalembert::nalgebra::{SVector, vector};
use dalembert::rayleigh::Resplit;
use dalembert::{Discrete, Discretise, Midpoint, Trapezoidal, rayleigh_system, samples};

/// Friction that depends on q and a force that drives: not Rayleigh.
#[derive(Clone, Copy)]
struct DrivenOscillator {
    m: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl DrivenOscillator {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * (1.0 + q[0] * q[0]) * v[0] * v[0] + q[0].cos()
    }
    fn force(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        [0.5 * (1.0 - q[0] * q[0]) * v[0] - 0.1 * v[0].powi(3)]
    }
}

/// Friction of each coordinate by its own position, and a gyroscopic force.
#[derive(Clone, Copy)]
struct Plane {
    gyroscopic: f64,
}

#[rayleigh_system]
impl Plane {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - (q[0] * q[1]).sin()
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [
            -(1.0 + q[0] * q[0]) * v[0] + self.gyroscopic * v[1],
            -(1.0 + q[1] * q[1]) * v[1] - self.gyroscopic * v[0],
        ]
    }
}

/// −D1 L_d⁺ and D2 L_d⁻ by central differences of order 4, whose error is about 1e-12 here.
fn momenta<L: Discrete<R, N, Scalar = f64>, R, const N: usize>(
    resplit: &Resplit<'_, L, R, N>,
    q0: &SVector<f64, N>,
    q1: &SVector<f64, N>,
) -> (SVector<f64, N>, SVector<f64, N>) {
    let slope = |f: &dyn Fn(&SVector<f64, N>) -> f64| {
        SVector::from_fn(|i, _| {
            let e = 1e-3;
            let at = |k: f64| {
                let mut shift = SVector::zeros();
                shift[i] = k * e;
                f(&shift)
            };
            (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * e)
        })
    };
    (
        -slope(&|shift| resplit.modified_plus(&(q0 + shift), q1).value),
        slope(&|shift| resplit.modified_minus(q0, &(q1 + shift)).value),
    )
}

fn driven_has_one<R: Copy>(rule: R)
where
    DrivenOscillator: Discrete<R, 1, Scalar = f64>,
{
    let (system, h) = (DrivenOscillator { m: 1.4 }, 0.2);
    let resplit = Resplit::new(&system, rule, h, [0.1]);
    let segments = samples::segments([-1.5], [1.5], [0.4], 40);
    let report = resplit.check(&segments).unwrap();
    assert!(report.exists() && !report.structure.is_rayleigh(), "{report}");
    for segment in &segments {
        let (q0, q1) = (segment.q0, segment.q1);
        let (p0, p1) = momenta(&resplit, &q0, &q1);
        let of_rule = system.by(rule, h).segment(&q0, &q1).unwrap().momenta().unwrap();
        assert!((p0 - of_rule.p0).amax() < 1e-10 && (p1 - of_rule.p1).amax() < 1e-10);
        let (l, r) = (resplit.discrete_lagrangian(&q0, &q1), resplit.discrete_rayleigh(&q0, &q1));
        assert!((l.value + r.value - resplit.modified_plus(&q0, &q1).value).abs() < 1e-14);
        assert!((l.value - r.value - resplit.modified_minus(&q0, &q1).value).abs() < 1e-14);
    }
}

#[test]
fn one_degree_of_freedom_always_has_one() {
    driven_has_one(Midpoint);
    // Here f⁻ and f⁺ differ.
    driven_has_one(Trapezoidal);
}

#[test]
fn two_degrees_of_freedom_have_one_iff_two_blocks_are_symmetric() {
    let h = 0.2;
    let segments = samples::segments([-1.0; 2], [1.0; 2], [0.4; 2], 40);
    let friction = Plane { gyroscopic: 0.0 };
    let resplit = Resplit::new(&friction, Midpoint, h, [0.1, 0.2]);
    let report = resplit.check(&segments).unwrap();
    assert!(report.exists() && !report.structure.is_rayleigh(), "{report}");
    let (q0, q1) = (vector![0.7, -0.4], vector![0.5, -0.1]);
    let (p0, p1) = momenta(&resplit, &q0, &q1);
    assert!((p0 - friction.by(Midpoint, h).legendre_minus(&q0, &q1).p).amax() < 1e-10);
    assert!((p1 - friction.by(Midpoint, h).legendre_plus(&q0, &q1).p).amax() < 1e-10);

    // Positive control: a gyroscopic force has none, and the momenta of the attempt are off by its share.
    let turning = Plane { gyroscopic: 0.5 };
    let resplit = Resplit::new(&turning, Midpoint, h, [0.1, 0.2]);
    let report = resplit.check(&segments).unwrap();
    assert!(!report.exists() && !report.plus.vanishes() && !report.minus.vanishes(), "{report}");
    let (p0, _) = momenta(&resplit, &q0, &q1);
    assert!((p0 - turning.by(Midpoint, h).legendre_minus(&q0, &q1).p).amax() > 1e-2);
}
