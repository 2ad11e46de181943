//! Optimal control of a plant with friction is an unforced discrete Lagrangian system on (q, λ).
//!
//! ```text
//! minimise Σ h ℓ(q̄, v̄, u)  along  D2L_d⁻ + D1L_d⁺ + (h/2)(Bu_{k−1} + Bu_k) = 0
//! 𝓛_d = λ1·D2L_d⁻ + λ0·D1L_d⁺ + min_u h [ℓ + λ̄·Bu]
//! ```
//!
//! By the midpoint and the trapezoidal rule 𝓛_d is the discrete Lagrangian of λ̇·∂L/∂v + λ·(∂L/∂q − ∂R/∂v) +
//! min_u [ℓ + λ·Bu], so that the doubled step is generated as any other.

use dalembert::derivative::PhaseMatrix;
use dalembert::nalgebra::{Matrix2, Vector1, Vector2, vector};
use dalembert::rayleigh::ConformalStep;
use dalembert::step::Flow;
use dalembert::{Discrete, Discretise, Midpoint, State, StepError, Trapezoidal, rayleigh_system};

/// A pendulum with drag, driven by a torque u held over each step.
#[derive(Clone, Copy)]
struct Plant {
    u: f64,
}

const R: f64 = 0.3;
const R3: f64 = 0.1;

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Plant {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos() + self.u * q[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * R * v[0] * v[0] + 0.25 * R3 * v[0].powi(4)
    }
}

const WEIGHT: f64 = 4.0;

/// The doubled system of ℓ = ½ WEIGHT q² + ½ u², so that u = −λ. The configuration is (q, λ).
#[derive(Clone, Copy)]
struct Doubled {
    /// How much of ∂R/∂v the costate feels: 1, or less as a control.
    share: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Doubled {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let ([q, lambda], [v, rate]) = (q, v);
        let friction = R * v + R3 * v * v * v;
        rate * v - lambda * (q.sin() + self.share * friction) + 0.5 * WEIGHT * q * q - 0.5 * lambda * lambda
    }
}

const H: f64 = 0.2;
const STEPS: usize = 12;
const START: State<f64, 1> = State { q: vector![1.2], p: vector![0.5] };

/// The inputs and configurations that SciPy's BFGS finds (1.17, gradients by differences of order 4 to
/// 5e-9), with a plant of its own: q1 by bracketing from v − (h/2)(−sin q̄ − Rv − R₃v³ + u) = p0.
const INPUTS: [f64; STEPS] = [
    -1.86182118,
    -1.18560403,
    -0.65158,
    -0.25909491,
    0.01085895,
    0.17599274,
    0.25178115,
    0.25517503,
    0.20718499,
    0.13285225,
    0.05928513,
    0.01306481,
];
const END: f64 = -0.3946961032896982;

/// The states of the doubled system from the plant's start with λ_0 and the momentum of q, and what is
/// missed at their end, λ_N = 0 as the last momentum is free and no momentum of q_N, with its derivative.
type Shot = (Vec<State<f64, 2>>, Vector2<f64>, Matrix2<f64>);

fn shot<M: Copy>(system: &Doubled, rule: M, steps: usize, free: Vector2<f64>) -> Result<Shot, StepError>
where
    Doubled: Flow<M, 2, Scalar = f64>,
{
    // The momentum of λ is the plant's p.
    let mut states = vec![State { q: vector![START.q[0], free[0]], p: vector![free[1], START.p[0]] }];
    let mut whole = PhaseMatrix::identity();
    for k in 0..steps {
        let (step, a) = system.by(rule, H).linearized_step(&states[k])?;
        states.push(step.state);
        whole = a * whole;
    }
    let end = states[steps];
    let PhaseMatrix { q_by_q, q_by_p, p_by_q, p_by_p } = whole;
    let by_free = Matrix2::new(q_by_q[(1, 1)], q_by_p[(1, 0)], p_by_q[(0, 1)], p_by_p[(0, 0)]);
    Ok((states, vector![end.q[1], end.p[0]], by_free))
}

/// The optimal run, by shooting with shortened Newton steps: over one step, then from its answer over two,
/// and on.
fn optimal<M: Copy>(system: &Doubled, rule: M) -> Vec<State<f64, 2>>
where
    Doubled: Flow<M, 2, Scalar = f64>,
{
    let mut free = vector![0.0, 0.0];
    for steps in 1..=STEPS {
        let (mut states, mut missed, mut by_free) = shot(system, rule, steps, free).unwrap();
        while missed.amax() > 1e-12 {
            let correction = by_free.try_inverse().unwrap() * missed;
            let shorter = (0..20).map(|k| free - correction * 0.5_f64.powi(k));
            let (at, next) = shorter
                .filter_map(|at| Some((at, shot(system, rule, steps, at).ok()?)))
                .find(|(_, next)| next.1.norm() < missed.norm())
                .expect("a shorter step misses by less");
            (free, (states, missed, by_free)) = (at, next);
        }
        if steps == STEPS {
            return states;
        }
    }
    unreachable!("the last of the steps returns")
}

fn inputs(states: &[State<f64, 2>]) -> Vec<f64> {
    states.windows(2).map(|pair| -0.5 * (pair[0].q[1] + pair[1].q[1])).collect()
}

#[test]
fn the_doubled_equations_are_those_of_a_direct_optimisation() {
    let states = optimal(&Doubled { share: 1.0 }, Midpoint);
    for (found, expected) in inputs(&states).iter().zip(INPUTS) {
        assert!((found - expected).abs() < 5e-8, "{found} {expected}");
    }
    assert!((states[STEPS].q[0] - END).abs() < 5e-9);
    // The control: a costate that does not feel the friction is another's optimum.
    let other = optimal(&Doubled { share: 0.9 }, Midpoint);
    assert!((inputs(&other)[0] - INPUTS[0]).abs() > 1e-3);
}

/// The plant's equations with the optimal inputs are among the doubled ones, by both rules. The input of the
/// trapezoidal rule is λ at either end.
#[test]
fn the_plant_follows_its_own_equations_and_its_momentum_is_that_of_the_costate() {
    let states = optimal(&Doubled { share: 1.0 }, Midpoint);
    let mut plant = START;
    for (u, expected) in inputs(&states).into_iter().zip(&states[1..]) {
        plant = Plant { u }.by(Midpoint, H).step(&plant).unwrap().state;
        assert!((plant.q[0] - expected.q[0]).abs() < 1e-12 && (plant.p[0] - expected.p[1]).abs() < 1e-12);
    }
}

/// 𝓛_d from the plant's objects and from the doubled system's.
#[test]
fn the_doubled_discrete_lagrangian_is_made_of_the_plants_modified_ones() {
    fn agrees<M: Copy>(rule: M, at_ends: bool)
    where
        Plant: Discrete<M, 1, Scalar = f64>,
        Doubled: Discrete<M, 2, Scalar = f64>,
    {
        let ([q0, l0], [q1, l1]) = ([0.4, -0.7], [0.6, 0.3]);
        let plant = Plant { u: 0.0 };
        let segment = plant.by(rule, H);
        // p0 = −D1L_d⁺ and p1 = D2L_d⁻.
        let momenta = segment.segment(&Vector1::new(q0), &Vector1::new(q1)).unwrap().momenta().unwrap();
        let along = l1 * momenta.p1[0] - l0 * momenta.p0[0];
        let mean = |f: fn(f64) -> f64, a: f64, b: f64| {
            if at_ends { 0.5 * (f(a) + f(b)) } else { f(0.5 * (a + b)) }
        };
        let cost = H * (mean(|q| 0.5 * WEIGHT * q * q, q0, q1) - mean(|l| 0.5 * l * l, l0, l1));
        let system = Doubled { share: 1.0 };
        let by = system.by(rule, H);
        let doubled = by.segment(&vector![q0, l0], &vector![q1, l1]).unwrap().discrete_lagrangian().unwrap();
        assert!((doubled - along - cost).abs() < 1e-14, "{doubled} {along} {cost}");
        // The control: L_d⁺ and L_d⁻ exchanged.
        let exchanged = l1 * momenta.p0[0] - l0 * momenta.p1[0];
        assert!((doubled - exchanged - cost).abs() > 1e-3);
    }
    agrees(Midpoint, false);
    agrees(Trapezoidal, true);
}

/// AᵀΩA = Ω of the doubled step at any friction; the plant's own is no such.
#[test]
fn the_optimal_flow_is_symplectic_at_any_friction() {
    let states = optimal(&Doubled { share: 1.0 }, Midpoint);
    let system = Doubled { share: 1.0 };
    let derivative = |state: &State<f64, 2>| system.by(Midpoint, H).linearized_step(state).unwrap().1;
    let found = ConformalStep::of(&states.iter().map(derivative).collect::<Vec<_>>(), None).unwrap();
    assert!(found.defect.vanishes() && (found.factor - 1.0).abs() < 1e-13, "{found}");
    let of_plant = |state: &State<f64, 2>| {
        let plant = State { q: vector![state.q[0]], p: vector![state.p[1]] };
        Plant { u: 0.0 }.by(Midpoint, H).linearized_step(&plant).unwrap().1
    };
    let found = ConformalStep::of(&states.iter().map(of_plant).collect::<Vec<_>>(), None).unwrap();
    assert!(!found.defect.vanishes() && found.factor < 0.95, "{found}");
}
