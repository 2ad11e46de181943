//! Linear systems M q̈ + C q̇ + K q = 0 with symmetric M, C, K: BA is symmetric, B = [[C, I], [I, 0]], for
//! every method but the fitted rule. Its block b = ∂q1/∂p0 is reciprocity; together they make the modified
//! system a Rayleigh system.

use dalembert::nalgebra::{Matrix4, vector};
use dalembert::step::Flow;
use dalembert::{
    Composition, Discretise, Fitted, FittedTrapezoidal, Gauss, Midpoint, OneSided, Splitting, State,
    Trapezoidal, rayleigh_system,
};
use dalembert_tests::draws::Draws;

#[derive(Clone, Copy, Debug)]
struct Linear {
    m: [f64; 3],
    c: [f64; 3],
    k: [f64; 3],
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal, one_sided])]
impl Linear {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let form =
            |[a, b, c]: [f64; 3], x: [f64; 2]| 0.5 * (a * x[0] * x[0] + c * x[1] * x[1]) + b * x[0] * x[1];
        form(self.m, v) - form(self.k, q)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * (self.c[0] * v[0] * v[0] + self.c[2] * v[1] * v[1]) + self.c[1] * v[0] * v[1]
    }
}

/// The same with forces that are not reciprocal: circulatory, κ(−y, x), and gyroscopic, in L.
#[derive(Clone, Copy, Debug)]
struct Turned {
    linear: Linear,
    circulatory: f64,
    gyroscopic: f64,
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Turned {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let ([a, b, c], [d, e, f]) = (self.linear.m, self.linear.k);
        0.5 * (a * v[0] * v[0] + c * v[1] * v[1]) + b * v[0] * v[1]
            - 0.5 * (d * q[0] * q[0] + f * q[1] * q[1])
            - e * q[0] * q[1]
            + self.gyroscopic * (q[0] * v[1] - q[1] * v[0])
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let [a, b, c] = self.linear.c;
        0.5 * (a * v[0] * v[0] + c * v[1] * v[1]) + b * v[0] * v[1]
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        [-self.circulatory * q[1], self.circulatory * q[0]]
    }
}

impl Linear {
    fn random(draws: &mut Draws) -> Self {
        let mut form = |low: f64, high: f64, off: f64| {
            [draws.between(low, high), draws.between(-off, off), draws.between(low, high)]
        };
        Self { m: form(0.6, 2.0, 0.3), c: form(0.2, 1.0, 0.15), k: form(1.0, 3.0, 0.8) }
    }
}

/// The largest entry of BA − (BA)ᵀ.
fn asymmetry<L, M>(system: &L, c: [f64; 3], method: M) -> f64
where
    L: Flow<M, 2, Scalar = f64>,
{
    let state = State { q: vector![0.3, -0.4], p: vector![0.1, 0.2] };
    let a: Matrix4<f64> = system.by(method, 0.4).linearized_step(&state).unwrap().1.assembled();
    let b = Matrix4::new(c[0], c[1], 1.0, 0.0, c[1], c[2], 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
    let product = b * a;
    (product - product.transpose()).amax()
}

#[test]
fn all_methods_but_the_fitted_and_the_one_sided_rule_are_reciprocal() {
    let mut draws = Draws::new(35);
    for _ in 0..10 {
        let system = Linear::random(&mut draws);
        let c = system.c;
        for found in [
            asymmetry(&system, c, Midpoint),
            asymmetry(&system, c, Trapezoidal),
            asymmetry(&system, c, FittedTrapezoidal),
            asymmetry(&system, c, Gauss::<2>),
            asymmetry(&system, c, Gauss::<5>),
            asymmetry(&system, c, Splitting::blanes_moan_4()),
            asymmetry(&system, c, Splitting::blanes_moan_6()),
            asymmetry(&system, c, Composition::kahan_li_6(Midpoint)),
            asymmetry(&system, c, Composition::kahan_li_8(Trapezoidal)),
        ] {
            assert!(found < 1e-13, "{found} of {system:?}");
        }
        // Controls: the rules whose damping changes what forces do, and other forces.
        assert!(asymmetry(&system, c, Fitted) > 1e-6, "{system:?}");
        assert!(asymmetry(&system, c, OneSided) > 1e-6, "{system:?}");
        let turned = |circulatory, gyroscopic| Turned { linear: system, circulatory, gyroscopic };
        assert!(asymmetry(&turned(0.0, 0.0), c, Gauss::<2>) < 1e-13);
        assert!(asymmetry(&turned(0.3, 0.0), c, Gauss::<2>) > 1e-3);
        assert!(asymmetry(&turned(0.0, 0.3), c, Gauss::<2>) > 1e-3);
        assert!(asymmetry(&turned(0.3, 0.0), c, Midpoint) > 1e-3);
    }
}
