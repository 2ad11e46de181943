//! The modified Lagrangian and Rayleigh function of the midpoint rule, any V.

use dalembert::nalgebra::{Matrix2, Vector2, vector};
use dalembert::rayleigh::modified::{ModifiedSystem, ModifiedSystemError};
use dalembert::system::Damping;
use dalembert::{Discretise, Gauss, Lagrangian, Midpoint, Rayleigh, State, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// V = x⁴/4 + y² + sin xy; C is no multiple of M, nor is CM⁻¹V″ symmetric.
struct Bent;

#[rayleigh_system(rule = [midpoint, gauss], step_derivatives = second)]
impl Bent {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [x, y] = q;
        0.5 * (1.3 * v[0] * v[0] + 0.4 * v[0] * v[1] + 0.9 * v[1] * v[1])
            - (0.25 * x.powi(4) + y * y + (x * y).sin())
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * (0.4 * v[0] * v[0] + 0.3 * v[0] * v[1] + 0.2 * v[1] * v[1])
    }
}

/// The oracle: L̃ and R̃ written out by hand, with ∇V and V″ on paper, as a system of its own.
struct OnPaper {
    twelfth: f64,
}

#[rayleigh_system(rule = gauss)]
impl OnPaper {
    /// uᵀ M⁻¹ w, M⁻¹ = [[0.9, −0.2], [−0.2, 1.3]]/1.13.
    fn by_inverse(&self, u: [f64; 2], w: [f64; 2]) -> f64 {
        (0.9 * u[0] * w[0] - 0.2 * (u[0] * w[1] + u[1] * w[0]) + 1.3 * u[1] * w[1]) / 1.13
    }
    fn gradient(&self, q: [f64; 2]) -> [f64; 2] {
        let ([x, y], c) = (q, (q[0] * q[1]).cos());
        [x.powi(3) + y * c, 2.0 * y + x * c]
    }
    /// V″v.
    fn hessian(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let ([x, y], (s, c)) = (q, (q[0] * q[1]).sin_cos());
        let mixed = c - x * y * s;
        [(3.0 * x * x - y * y * s) * v[0] + mixed * v[1], mixed * v[0] + (2.0 - x * x * s) * v[1]]
    }
    fn drag(&self, v: [f64; 2]) -> [f64; 2] {
        [0.4 * v[0] + 0.15 * v[1], 0.15 * v[0] + 0.2 * v[1]]
    }
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [x, y] = q;
        let (gradient, hessian, drag) = (self.gradient(q), self.hessian(q, v), self.drag(v));
        0.5 * (1.3 * v[0] * v[0] + 0.4 * v[0] * v[1] + 0.9 * v[1] * v[1])
            - (0.25 * x.powi(4) + y * y + (x * y).sin())
            + 0.5 * self.twelfth * (v[0] * hessian[0] + v[1] * hessian[1] - self.by_inverse(drag, drag))
            + 0.5 * self.twelfth * self.by_inverse(gradient, gradient)
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let (hessian, drag) = (self.hessian(q, v), self.drag(v));
        0.5 * (v[0] * drag[0] + v[1] * drag[1]) - self.twelfth * self.by_inverse(drag, hessian)
    }
}

const Q: [f64; 2] = [0.7, -0.3];
const V: [f64; 2] = [0.4, 0.9];
const T: f64 = 4.0;

/// The states of the midpoint rule's run.
fn run(h: f64) -> Vec<State<f64, 2>> {
    let start = State::from_velocity(&Bent, Q, V).unwrap();
    let steps = Bent.by(Midpoint, h).run(start).take((T / h).round() as usize);
    std::iter::once(start).chain(steps.map(|step| step.unwrap().state)).collect()
}

/// The largest difference of q between the run and the motion of `system` that starts with velocity `v`, by
/// Gauss's rule of order 16.
fn off<L>(system: &L, v: Vector2<f64>, h: f64, states: &[State<f64, 2>]) -> f64
where
    L: dalembert::step::Flow<Gauss<8>, 2, Scalar = f64>,
{
    let start = State::from_velocity(system, Q, v).unwrap();
    let motion = system.by(Gauss::<8>, h).run(start).map(|step| step.unwrap().state.q);
    motion.zip(&states[1..]).map(|(q, state)| (q - state.q).amax()).fold(0.0, f64::max)
}

/// log₂ of the quotients of errors at h, h/2, h/4.
fn slopes(errors: [f64; 3]) -> [f64; 2] {
    [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()]
}

const STEPS: [f64; 3] = [0.1, 0.05, 0.025];

/// The q of the run lie to O(h⁴) on the motion of (L̃, R̃) that starts with the velocity of the formula.
#[test]
fn the_run_lies_on_the_motion_of_the_modified_system() {
    let errors = |of: &dyn Fn(f64, &[State<f64, 2>]) -> f64| STEPS.map(|h| of(h, &run(h)));
    let modified = errors(&|h, states| {
        let velocity = Bent.by(Midpoint, h).modified_system().unwrap().velocity(&states[0]).unwrap();
        off(&OnPaper { twelfth: h * h / 12.0 }, velocity, h, states)
    });
    println!("off the modified motion: {modified:?}");
    for slope in slopes(modified) {
        assert!((slope - 4.0).abs() < 0.1, "{slope}");
    }
    // The controls: the motion of (L, R), and the modified one with the velocity M⁻¹p or with ∂L̃/∂v = p.
    let plain = errors(&|h, states| off(&Bent, V.into(), h, states));
    let by_mass = errors(&|h, states| off(&OnPaper { twelfth: h * h / 12.0 }, V.into(), h, states));
    let by_momentum = errors(&|h, states| {
        let modified = Bent.by(Midpoint, h).modified_system().unwrap();
        let velocity = modified.mass(&states[0].q).try_inverse().unwrap() * states[0].p;
        off(&OnPaper { twelfth: h * h / 12.0 }, velocity, h, states)
    });
    println!("controls: {plain:?} {by_mass:?} {by_momentum:?}");
    for errors in [plain, by_mass, by_momentum] {
        // The last has a small factor before h², and more of h⁴ at first.
        assert!((slopes(errors)[1] - 2.0).abs() < 0.1, "{errors:?}");
        assert!(errors[2] > 10.0 * modified[2], "{errors:?}");
    }
}

/// Along the run Ẽ falls by ∫2R̃ up to h⁴; E, at the velocity M⁻¹p, by ∫2R up to h².
#[test]
fn the_modified_energy_falls_as_the_modified_friction_takes_it() {
    // Boole's rule: an error of h⁶.
    let integral = |values: &[f64], h: f64| {
        let weight = |k: usize| match (k, k % 4) {
            (k, _) if k == 0 || k == values.len() - 1 => 7.0,
            (_, 0) => 14.0,
            (_, 2) => 12.0,
            _ => 32.0,
        };
        let sum: f64 = values.iter().enumerate().map(|(k, value)| weight(k) * value).sum();
        sum * 4.0 * h / 90.0
    };
    let balance = |energies: &[f64], losses: &[f64], h: f64| {
        assert_eq!(energies.len() % 4, 1);
        (energies[energies.len() - 1] - energies[0] + integral(losses, h)).abs()
    };
    let modified = STEPS.map(|h| {
        let modified = Bent.by(Midpoint, h).modified_system().unwrap();
        let (energies, losses): (Vec<_>, Vec<_>) = run(h)
            .iter()
            .map(|state| {
                let v = modified.velocity(state).unwrap();
                (modified.energy(&state.q, &v), 2.0 * modified.rayleigh(&state.q, &v))
            })
            .unzip();
        assert!(losses.iter().all(|&loss| loss > 0.0));
        balance(&energies, &losses, h)
    });
    let plain = STEPS.map(|h| {
        let (energies, losses): (Vec<_>, Vec<_>) = run(h)
            .iter()
            .map(|state| {
                let v = state.velocity(&Bent).unwrap();
                (Bent.energy(&state.q, &v), 2.0 * Bent.rayleigh(v.into()))
            })
            .unzip();
        balance(&energies, &losses, h)
    });
    println!("Ẽ: {modified:?}, E: {plain:?}");
    for (slope, plain) in slopes(modified).into_iter().zip(slopes(plain)) {
        assert!((slope - 4.0).abs() < 0.15 && (plain - 2.0).abs() < 0.15, "{slope} {plain}");
    }
}

/// Values and derivatives against the functions written out by hand.
#[test]
fn the_functions_are_those_on_paper() {
    let mut random = StdRng::seed_from_u64(21);
    for _ in 0..50 {
        let h = random.random_range(0.05..0.5);
        let paper = OnPaper { twelfth: h * h / 12.0 };
        let modified = Bent.by(Midpoint, h).modified_system().unwrap();
        let mut point = || vector![random.random_range(-1.0..1.0), random.random_range(-1.0..1.0)];
        let (q, v) = (point(), point());
        let (l, r) = (paper.lagrangian_derivatives(&q, &v), paper.rayleigh_derivatives(&q, &v));
        let found = modified.lagrangian_gradient(&q, &v);
        assert!(
            (found.value - l.value).abs() < 1e-14 && (modified.lagrangian(&q, &v) - l.value).abs() < 1e-14
        );
        assert!((found.d1 - l.d1).amax() < 1e-13 && (found.d2 - l.d2).amax() < 1e-13);
        assert!((modified.mass(&q) - l.d22).amax() < 1e-13 && (modified.damping(&q) - r.d22).amax() < 1e-13);
        assert!((modified.rayleigh(&q, &v) - r.value).abs() < 1e-14);
        assert!((modified.friction(&q, &v) - r.d2).amax() < 1e-14);
        assert!((modified.energy(&q, &v) - paper.energy(&q, &v)).abs() < 1e-14);
        let acceleration = l.d22.try_inverse().unwrap() * (l.d1 - l.d12.transpose() * v - r.d2);
        assert!((modified.acceleration(&q, &v).unwrap() - acceleration).amax() < 1e-12);
        // The energy falls at the rate 2R̃: dẼ/dt = v·(d/dt ∂L̃/∂v − ∂L̃/∂q).
        let rate = v.dot(&(l.d22 * acceleration + l.d12.transpose() * v - l.d1));
        assert!((rate + 2.0 * modified.rayleigh(&q, &v)).abs() < 1e-13);
    }
}

/// A potential ½qᵀKq + quartic and any friction.
struct Well {
    m: [f64; 3],
    c: [f64; 3],
    k: [f64; 3],
}

#[rayleigh_system]
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
