//! Damped motion to its end by Gauss rules: forces that cancel between the springs of three coupled masses,
//! drawn at random.

use dalembert::nalgebra::{SVector, Vector3};
use dalembert::step::Flow;
use dalembert::{Discretise, Gauss, State, rayleigh_system};
use dalembert_tests::draws::Draws;

/// Masses, each between two springs to either side, with springs and drag between them.
#[derive(Debug)]
struct Masses {
    m: [f64; 3],
    k: [f64; 5],
    /// How far apart the ends of the springs are; as many as 1 000.
    a: [f64; 5],
    gravity: f64,
    c: [f64; 3],
    /// Of drag that grows with the square of the velocity.
    d: f64,
}

#[rayleigh_system(rule = gauss)]
impl Masses {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let mut sum = 0.0;
        for i in 0..3 {
            sum += 0.5 * self.m[i] * v[i] * v[i]
                - 0.5 * self.k[i] * (q[i] - self.a[i]).powi(2)
                - 0.5 * self.k[i] * (q[i] + self.a[i]).powi(2);
        }
        sum - 0.5 * self.k[3] * (q[1] - q[0] - self.a[3]).powi(2)
            - 0.5 * self.k[4] * (q[2] - q[1] + self.a[4]).powi(2)
            + self.gravity * (q[0] - 0.4).cos()
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * (self.c[0] * v[0] * v[0] + self.c[1] * v[1] * v[1] + self.c[2] * v[2] * v[2])
            + self.d * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).powf(1.5) / 3.0
    }
}

impl Masses {
    fn drawn(draws: &mut Draws) -> Self {
        let mut far = || match draws.between(0.0, 4.0) {
            share if share < 1.0 => 10_f64.powf(draws.between(0.0, 3.0)),
            _ => draws.between(-1.5, 1.5),
        };
        let a = [far(), far(), far(), far(), far()];
        let mut each = |low: f64, high: f64| draws.between(low, high);
        Self {
            m: [each(0.3, 3.0), each(0.3, 3.0), each(0.3, 3.0)],
            k: [each(0.1, 2.0), each(0.1, 2.0), each(0.1, 2.0), each(0.1, 2.0), each(0.1, 2.0)],
            a,
            gravity: each(0.0, 2.0),
            c: [each(0.2, 0.8), each(0.2, 0.8), each(0.2, 0.8)],
            d: each(-0.2, 0.2).max(0.0),
        }
    }

    /// The equilibrium, by Newton's method on the forces; the potential is nearly quadratic.
    fn equilibrium(&self) -> SVector<f64, 3> {
        use dalembert::Lagrangian as _;
        let mut q = Vector3::zeros();
        for _ in 0..60 {
            let l = self.lagrangian_derivatives(&q, &Vector3::zeros());
            q -= l.d11.lu().solve(&l.d1).unwrap();
        }
        q
    }

    /// The first step that is refused, from next to the equilibrium on.
    fn refused<M: Copy>(&self, method: M, steps: usize) -> Option<String>
    where
        Self: Flow<M, 3, Scalar = f64>,
    {
        let start = State { q: self.equilibrium(), p: Vector3::new(1e-14, -3e-15, 1e-16) };
        let mut run = self.by(method, 0.04).run(start);
        (0..steps).find_map(|index| run.next()?.err().map(|error| format!("step {index}: {error}")))
    }
}

#[test]
fn three_masses_between_springs_come_to_rest() {
    let (all, steps) = if cfg!(debug_assertions) { (20, 1_300) } else { (300, 10_000) };
    let mut draws = Draws::new(39);
    for _ in 0..all {
        let masses = Masses::drawn(&mut draws);
        for refused in [
            masses.refused(Gauss::<2>, steps),
            masses.refused(Gauss::<3>, steps / 4),
            masses.refused(Gauss::<5>, steps / 16),
        ] {
            assert_eq!(refused, None, "{masses:?}");
        }
    }
}
