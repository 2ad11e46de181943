//! The modified Lagrangian and Rayleigh function of the midpoint, the trapezoidal and Simpson's rule, any V.

use dalembert::nalgebra::{Vector2, vector};
use dalembert::rules::{DisplacementRule, Node, Quadrature, SelfAdjoint};
use dalembert::step::Flow;
use dalembert::{Discretise, Gauss, Lagrangian, Midpoint, Rayleigh, State, Trapezoidal, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// V = x⁴/4 + y² + sin xy; C is no multiple of M, nor is CM⁻¹V″ symmetric.
struct Bent;

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], step_derivatives = second)]
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

/// Weights ⅙, ⅔, ⅙.
#[derive(Clone, Copy)]
struct Simpson;

impl DisplacementRule for Simpson {
    const NODES: &'static [Node] = &[
        Node { position: 0.0, weight: 1.0 / 6.0 },
        Node { position: 0.5, weight: 2.0 / 3.0 },
        Node { position: 1.0, weight: 1.0 / 6.0 },
    ];
}

impl SelfAdjoint for Simpson {}

/// A rule with the weight of V″ in its M̃ on paper.
trait Known: DisplacementRule + SelfAdjoint {
    const RULE: Self;
    const WEIGHT: f64;
}

impl Known for Midpoint {
    const RULE: Self = Self;
    const WEIGHT: f64 = 1.0;
}

impl Known for Trapezoidal {
    const RULE: Self = Self;
    const WEIGHT: f64 = -2.0;
}

impl Known for Quadrature<Simpson> {
    const RULE: Self = Self(Simpson);
    const WEIGHT: f64 = 0.0;
}

/// The oracle: L̃ and R̃ written out by hand, with ∇V and V″ on paper, as a system of its own.
struct OnPaper {
    twelfth: f64,
    weight: f64,
}

impl OnPaper {
    fn of<M: Known>(h: f64) -> Self {
        Self { twelfth: h * h / 12.0, weight: M::WEIGHT }
    }
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
            + 0.5 * self.twelfth * self.weight * (v[0] * hessian[0] + v[1] * hessian[1])
            - 0.5 * self.twelfth * self.by_inverse(drag, drag)
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

/// The states of a rule's run.
fn run<M: Known>(h: f64) -> Vec<State<f64, 2>>
where
    Bent: Flow<M, 2, Scalar = f64>,
{
    let start = State::from_velocity(&Bent, Q, V).unwrap();
    let steps = Bent.by(M::RULE, h).run(start).take((T / h).round() as usize);
    std::iter::once(start).chain(steps.map(|step| step.unwrap().state)).collect()
}

/// The largest difference of q between the run and the motion of `system` that starts with velocity `v`, by
/// Gauss's rule of order 12.
fn off<L>(system: &L, v: Vector2<f64>, h: f64, states: &[State<f64, 2>]) -> f64
where
    L: Flow<Gauss<6>, 2, Scalar = f64>,
{
    let start = State::from_velocity(system, Q, v).unwrap();
    let motion = system.by(Gauss::<6>, h).run(start).map(|step| step.unwrap().state.q);
    motion.zip(&states[1..]).map(|(q, state)| (q - state.q).amax()).fold(0.0, f64::max)
}

/// log₂ of the quotients of errors at h, h/2, h/4.
fn slopes(errors: [f64; 3]) -> [f64; 2] {
    [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()]
}

const STEPS: [f64; 3] = [0.1, 0.05, 0.025];

fn assert_lies_on_the_modified_motion<M: Known>()
where
    Bent: Flow<M, 2, Scalar = f64>,
{
    let errors = |of: &dyn Fn(f64, &[State<f64, 2>]) -> f64| STEPS.map(|h| of(h, &run::<M>(h)));
    let start = |h: f64, states: &[State<f64, 2>]| {
        Bent.by(M::RULE, h).modified_system().unwrap().velocity(&states[0]).unwrap()
    };
    let modified = errors(&|h, states| off(&OnPaper::of::<M>(h), start(h, states), h, states));
    println!("off the modified motion: {modified:?}");
    for slope in slopes(modified) {
        assert!((slope - 4.0).abs() < 0.1, "{slope}");
    }
    // The controls: the motion of (L, R), the modified one with the velocity M⁻¹p or with ∂L̃/∂v = p, and
    // that of another rule.
    let plain = errors(&|h, states| off(&Bent, V.into(), h, states));
    let by_mass = errors(&|h, states| off(&OnPaper::of::<M>(h), V.into(), h, states));
    let by_momentum = errors(&|h, states| {
        let modified = Bent.by(M::RULE, h).modified_system().unwrap();
        let velocity = modified.mass(&states[0].q).try_inverse().unwrap() * states[0].p;
        off(&OnPaper::of::<M>(h), velocity, h, states)
    });
    let of_another = errors(&|h, states| {
        let other = OnPaper { weight: -1.0 - M::WEIGHT, ..OnPaper::of::<M>(h) };
        off(&other, start(h, states), h, states)
    });
    println!("controls: {plain:?} {by_mass:?} {by_momentum:?} {of_another:?}");
    for errors in [plain, by_mass, by_momentum, of_another] {
        // The third has a small factor before h², and more of h⁴ at first.
        assert!((slopes(errors)[1] - 2.0).abs() < 0.1, "{errors:?}");
        assert!(errors[2] > 10.0 * modified[2], "{errors:?}");
    }
}

/// The q of the run lie to O(h⁴) on the motion of (L̃, R̃) that starts with the velocity of the formula; not
/// on that of another rule's, the midpoint's for the trapezoidal rule.
#[test]
fn the_run_lies_on_the_motion_of_the_modified_system() {
    assert_lies_on_the_modified_motion::<Midpoint>();
    assert_lies_on_the_modified_motion::<Trapezoidal>();
    assert_lies_on_the_modified_motion::<Quadrature<Simpson>>();
}

fn assert_velocity_at_nodes<M: Known>()
where
    Bent: Flow<M, 2, Scalar = f64>,
{
    let [by_formula, by_mass] = [true, false].map(|by_formula| {
        STEPS.map(|h| {
            let (paper, modified) = (OnPaper::of::<M>(h), Bent.by(M::RULE, h).modified_system().unwrap());
            let states = run::<M>(h);
            let start = State::from_velocity(&paper, Q, modified.velocity(&states[0]).unwrap()).unwrap();
            let motion = paper.by(Gauss::<6>, h).run(start).map(|step| step.unwrap().state);
            let off = motion.zip(&states[1..]).map(|(exact, state)| {
                let v =
                    if by_formula { modified.velocity(state) } else { Ok(state.velocity(&Bent).unwrap()) };
                (exact.velocity(&paper).unwrap() - v.unwrap()).amax()
            });
            off.fold(0.0, f64::max)
        })
    });
    println!("velocities: {by_formula:?}, of M⁻¹p {by_mass:?}");
    for (slope, plain) in slopes(by_formula).into_iter().zip(slopes(by_mass)) {
        assert!((slope - 4.0).abs() < 0.1 && (plain - 2.0).abs() < 0.1, "{slope} {plain}");
    }
}

/// M̃⁻¹(p + (h²/12) CM⁻¹∇V) is the velocity of the modified motion to O(h⁴) at every node, M⁻¹p to O(h²).
#[test]
fn the_velocity_at_the_nodes() {
    assert_velocity_at_nodes::<Midpoint>();
    assert_velocity_at_nodes::<Trapezoidal>();
    assert_velocity_at_nodes::<Quadrature<Simpson>>();
}

fn assert_modified_energy_falls<M: Known>()
where
    Bent: Flow<M, 2, Scalar = f64>,
{
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
        let modified = Bent.by(M::RULE, h).modified_system().unwrap();
        let (energies, losses): (Vec<_>, Vec<_>) = run::<M>(h)
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
        let (energies, losses): (Vec<_>, Vec<_>) = run::<M>(h)
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
        assert!((slope - 4.0).abs() < 0.2 && (plain - 2.0).abs() < 0.15, "{slope} {plain}");
    }
}

/// Along the run Ẽ falls by ∫2R̃ up to h⁴; E, at the velocity M⁻¹p, by ∫2R up to h².
#[test]
fn the_modified_energy_falls_as_the_modified_friction_takes_it() {
    assert_modified_energy_falls::<Midpoint>();
    assert_modified_energy_falls::<Trapezoidal>();
}

fn assert_functions_on_paper<M: Known>()
where
    Bent: Flow<M, 2, Scalar = f64>,
{
    let mut random = StdRng::seed_from_u64(21);
    for _ in 0..50 {
        let h = random.random_range(0.05..0.5);
        let paper = OnPaper::of::<M>(h);
        let modified = Bent.by(M::RULE, h).modified_system().unwrap();
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

/// Values and derivatives against the functions written out by hand.
#[test]
fn the_functions_are_those_on_paper() {
    assert_functions_on_paper::<Midpoint>();
    assert_functions_on_paper::<Trapezoidal>();
    assert_functions_on_paper::<Quadrature<Simpson>>();
}
