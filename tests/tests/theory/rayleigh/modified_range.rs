//! The range of the modified system: the largest step with R̃ ≥ 0, and systems that have no such formulas.

use dalembert::nalgebra::{Matrix2, vector};
use dalembert::rayleigh::modified::{ModifiedSystem, ModifiedSystemError};
use dalembert::system::Damping;
use dalembert::{Discretise, Midpoint, State, Trapezoidal, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// A potential ½qᵀKq + quartic and any friction.
struct Well {
    m: [f64; 3],
    c: [f64; 3],
    k: [f64; 3],
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Well {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let ([a, b, c], [d, e, f]) = (self.m, self.k);
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1])
            - 0.5 * (d * q[0] * q[0] + 2.0 * e * q[0] * q[1] + f * q[1] * q[1])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let [a, b, c] = self.c;
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1])
    }
}

/// The least eigenvalue of C̃ by the quadratic formula.
fn least(damping: &Matrix2<f64>) -> f64 {
    let (half, product) = (0.5 * damping.trace(), damping.determinant());
    half - (half * half - product).max(0.0).sqrt()
}

/// √(6m/V″) in one dimension, and where C̃ loses its definiteness in two.
#[test]
fn the_largest_step_with_modified_friction() {
    #[rayleigh_system]
    fn pendulum(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
        (0.5 * m * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
    }
    let largest = |m: f64, q: f64| {
        Pendulum { m, r: 0.3 }.by(Midpoint, 0.1).modified_system().unwrap().largest_step(&vector![q]).unwrap()
    };
    for (m, q) in [(1.0, 0.0), (2.5, 0.0), (0.7, 1.2_f64)] {
        assert!((largest(m, q) - (6.0 * m / q.cos()).sqrt()).abs() < 1e-14);
    }
    assert_eq!(largest(1.0, 3.0), f64::INFINITY);

    let mut random = StdRng::seed_from_u64(22);
    let mut limited = 0;
    for _ in 0..100 {
        let mut definite = || {
            let [a, b, c] = [0.4..1.5, -0.5..0.5, 0.4..1.5].map(|range| random.random_range(range));
            [a * a, a * b, b * b + c * c]
        };
        let (m, c, mut k) = (definite(), definite(), definite());
        k[1] *= 3.0;
        let (well, q) = (Well { m, c, k }, vector![0.0, 0.0]);
        let largest = well.by(Midpoint, 1.0).modified_system().unwrap().largest_step(&q).unwrap();
        let damping = |h: f64| {
            let full = |[a, b, c]: [f64; 3]| Matrix2::new(a, b, b, c);
            let product = full(c) * full(m).try_inverse().unwrap() * full(k);
            full(c) - (product + product.transpose()) * (h * h / 12.0)
        };
        if largest.is_finite() {
            limited += 1;
            assert!(least(&damping(largest)).abs() < 1e-12 * largest * largest, "{largest}");
            assert!(least(&damping(0.99 * largest)) > 0.0 && least(&damping(1.01 * largest)) < 0.0);
            let modified = well.by(Midpoint, largest).modified_system().unwrap();
            assert!((modified.damping(&q) - damping(largest)).amax() < 1e-12 * largest * largest);
            let of_another = well.by(Trapezoidal, 1.0).modified_system().unwrap();
            assert_eq!(of_another.largest_step(&q), Ok(largest));
        } else {
            assert!(least(&damping(100.0)) > 0.0);
        }
    }
    assert!(limited > 50);
    // Friction on one coordinate: none where springs couple it, its own where they do not.
    let largest = |c: [f64; 3], k: [f64; 3]| {
        let well = Well { m: [1.0, 0.0, 1.0], c, k };
        well.by(Midpoint, 0.1).modified_system().unwrap().largest_step(&vector![0.0, 0.0])
    };
    assert_eq!(largest([0.3, 0.0, 0.0], [1.0, 0.2, 1.0]), Ok(0.0));
    assert!((largest([0.3, 0.0, 0.0], [1.5, 0.0, 9.0]).unwrap() - 2.0).abs() < 1e-14);
    assert_eq!(largest([0.0; 3], [1.5, 0.0, 9.0]), Ok(f64::INFINITY));
    assert_eq!(largest([-0.3, 0.0, 1.0], [1.5, 0.0, 9.0]), Err(ModifiedSystemError::NotDissipative));
    assert_eq!(largest([0.3, 0.0, 1.0], [f64::NAN, 0.0, 9.0]), Err(ModifiedSystemError::NonFinite));
}

/// Systems of other kinds, and steps that are too long.
#[test]
fn systems_without_these_formulas_have_names() {
    use ModifiedSystemError as Error;
    type Found<E> = Result<(), E>;
    fn of<L: dalembert::system::ActingForce<1, Scalar = f64> + dalembert::step::Flow<Midpoint, 1>>(
        system: &L,
        h: f64,
    ) -> Found<Error> {
        system.by(Midpoint, h).modified_system().map(|_: ModifiedSystem<'_, L, 1>| ())
    }
    #[rayleigh_system]
    fn moving(q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] * (1.0 + q[0] * q[0])
    }
    #[rayleigh_system]
    fn dragged(q: [f64; 1], v: [f64; 1], c: f64) -> (f64, f64) {
        (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.1 * v[0].powi(4) + c * v[0])
    }
    #[rayleigh_system]
    fn pushed(q: [f64; 1], v: [f64; 1], m: f64, c: f64, k: f64) -> (f64, f64) {
        (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.1 * v[0] * v[0] + c * v[0])
    }
    struct Forced;
    #[rayleigh_system]
    impl Forced {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
        }
        fn force(&self, _q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
            [-v[0]]
        }
    }
    struct Timed;
    #[rayleigh_system]
    impl Timed {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
            0.5 * v[0] * v[0] - 0.5 * q[0] * q[0] * (1.0 + t.sin())
        }
    }
    let plain = Pushed { m: 1.0, c: 0.0, k: 1.0 };
    assert_eq!(of(&plain, 0.1), Ok(()));
    assert_eq!(of(&plain, 0.0), Err(Error::StepSize { h: 0.0 }));
    assert_eq!(of(&Moving {}, 0.1), Err(Error::Lagrangian));
    assert_eq!(of(&Dragged { c: 0.0 }, 0.1), Err(Error::Friction { damping: Damping::Nonlinear }));
    assert_eq!(of(&Pushed { c: 0.5, ..plain }, 0.1), Err(Error::Thrust));
    assert_eq!(of(&Forced, 0.1), Err(Error::GeneralForce));
    assert_eq!(of(&Timed.at_time(0.0), 0.1), Err(Error::Timed));
    assert!(matches!(of(&Pushed { m: -1.0, ..plain }, 0.1), Err(Error::Mass(_))));
    // m + (h²/12)(k − r²/m) = 0 at k = −12/h² + r²/m.
    let falling = Pushed { k: -1200.0 + 0.04, ..plain };
    let modified = falling.by(Midpoint, 0.1).modified_system().unwrap();
    let state = State { q: vector![0.1], p: vector![0.2] };
    assert!(modified.mass(&state.q)[0].abs() < 1e-12);
    assert!(modified.velocity(&State { q: vector![f64::NAN], ..state }).is_err());
}
