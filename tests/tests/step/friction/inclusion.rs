//! Random systems whose masses, slips and limits depend on q: both lines of the rule as inclusions, where the
//! smooth part is that of the midpoint rule on a system without kinks.

use dalembert::nalgebra::{Matrix3, Vector3, vector};
use dalembert::step::{Fused, Segment};
use dalembert::{Discretise, Midpoint, Proximal, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;

const TURN: f64 = 0.5;

#[derive(Clone, Copy, Debug)]
struct Linked {
    mu: f64,
    nu: f64,
    arm: f64,
    k: f64,
    c: f64,
    push: f64,
}

#[rayleigh_system(rule = proximal)]
impl Linked {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let heavy = 1.0 + TURN * q[1].sin() * q[1].sin();
        let kinetic = 0.5 * (heavy * v[0] * v[0] + v[1] * v[1] + 0.8 * v[2] * v[2]);
        let springs = self.k * (1.0 - q[0].cos()) + 0.5 * self.k * (q[1] - q[2]) * (q[1] - q[2]);
        kinetic + 0.3 * q[0].cos() * v[0] * v[1] - springs + self.push * q[2]
    }

    /// A joint whose arm turns, and a ball that is rolled over ground that gets rougher.
    fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let joint = (v[0] - self.arm * q[1].cos() * v[1]).abs();
        let ball = v[1].hypot(v[2] * (1.0 + q[0] * q[0]));
        let drag = 0.5 * self.c * (v[0] * v[0] + v[2] * v[2]);
        self.mu * (1.0 + TURN * q[0].cos()) * joint + self.nu * ball + drag
    }
}

/// [`Linked`] without its kinks.
struct Smooth(Linked);

#[rayleigh_system(rule = midpoint)]
impl Smooth {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let (k, push) = (self.0.k, self.0.push);
        let heavy = 1.0 + TURN * q[1].sin() * q[1].sin();
        let kinetic = 0.5 * (heavy * v[0] * v[0] + v[1] * v[1] + 0.8 * v[2] * v[2]);
        let springs = k * (1.0 - q[0].cos()) + 0.5 * k * (q[1] - q[2]) * (q[1] - q[2]);
        kinetic + 0.3 * q[0].cos() * v[0] * v[1] - springs + push * q[2]
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * self.0.c * (v[0] * v[0] + v[2] * v[2])
    }
}

/// How far `impulse` is from (h/2) ∂R_k(q, v), in units of `rounding` of it.
fn off(system: &Linked, [q, v, impulse]: [&Vector3<f64>; 3], h: f64, rounding: f64) -> f64 {
    let limits = [system.mu * (1.0 + TURN * q[0].cos()), system.nu];
    let (arm, ratio) = (system.arm * q[1].cos(), 1.0 + q[0] * q[0]);
    // The impulse is (h/2) D s.
    let directions = Matrix3::from_columns(&[
        vector![1.0, -arm, 0.0] * limits[0],
        vector![0.0, 1.0, 0.0] * limits[1],
        vector![0.0, 0.0, ratio] * limits[1],
    ]);
    let s = directions.try_inverse().unwrap() * impulse * (2.0 / h);
    let most = v.amax();
    let element = |force: &[f64], slip: &[f64], limit: f64| {
        let length = |of: &[f64]| of.iter().fold(0.0, |length: f64, of| length.hypot(*of));
        let (known, slips) = (rounding * 2.0 / (h * limit) + f64::EPSILON, length(slip));
        if slips <= 64.0 * f64::EPSILON * most * (1.0 + ratio) {
            return (length(force) - 1.0) / known;
        }
        // Directions of short slips are known less.
        let known = known + f64::EPSILON * most * (1.0 + ratio) / slips;
        let apart = force.iter().zip(slip).map(|(force, slip)| (force - slip / slips).abs());
        apart.fold(0.0, f64::max) / known
    };
    let joint = element(&[s[0]], &[v[0] - arm * v[1]], limits[0]);
    joint.max(element(&[s[1], s[2]], &[v[1], v[2] * ratio], limits[1]))
}

/// Both ends of a step, in roundings; of a system that takes itself for `taken`.
fn of_step(system: &Linked, taken: &Linked, state: &State<f64, 3>, h: f64) -> Result<[f64; 2], StepError> {
    let step = taken.by(Proximal, h).step(state)?;
    let (q0, v) = (state.q, step.velocity);
    let smooth = <Smooth as Fused<Midpoint, 3>>::momenta(&Smooth(*system), &Segment { q0, v, h });
    let forces = 10.0 * system.k + system.mu + system.nu + system.push.abs();
    let rounding = (state.p.amax() + smooth.p0.amax() + smooth.p1.amax() + h * forces) * f64::EPSILON;
    let (middle, v1) = (q0 + v * (0.5 * h), step.state.velocity(taken)?);
    let ends = [(v, state.p - smooth.p0), (v1, smooth.p1 - step.state.p)];
    Ok(ends.map(|(v, impulse)| off(system, [&middle, &v, &impulse], h, rounding)))
}

#[test]
fn both_ends_of_steps_solve_their_inclusions() {
    let mut draws = Draws::new(41);
    let (mut worst, mut told, mut still) = ([0.0_f64; 2], 0, 0);
    let cases = if cfg!(debug_assertions) { 400 } else { 100_000 };
    for case in 0..cases {
        let system = Linked {
            mu: draws.scale(1e-3, 10.0),
            nu: draws.scale(1e-3, 10.0),
            arm: draws.between(0.0, 2.0),
            k: draws.scale(0.03, 30.0),
            c: draws.between(0.0, 1.0),
            push: draws.between(-2.0, 2.0),
        };
        let mut any = |size: f64| match draws.below(5) {
            0 => 0.0,
            _ => draws.between(-size, size),
        };
        let q = Vector3::from_fn(|_, _| any(1.5));
        let p = Vector3::from_fn(|_, _| any(1.0));
        let p = p * draws.scale(1e-4, 1.0);
        let (state, h) = (State { q, p }, draws.scale(1e-4, 0.03));
        let both = of_step(&system, &system, &state, h);
        let both = both.unwrap_or_else(|error| panic!("{case}: {system:?} {state:?} h = {h}: {error}"));
        worst = [worst[0].max(both[0]), worst[1].max(both[1])];
        assert!(both.iter().all(|off| *off < 64.0), "{case}: {both:?} of {system:?} {state:?} h = {h}");
        // Positive control: a limit that is off by 10⁻⁶, where an element slides.
        let other = Linked { mu: system.mu * (1.0 + 1e-6), nu: system.nu * (1.0 + 1e-6), ..system };
        told += usize::from(of_step(&system, &other, &state, h).is_ok_and(|both| both[0] > 64.0));
        still += usize::from(q == system.by(Proximal, h).step(&state).unwrap().state.q);
    }
    println!("{cases} steps: {worst:?} roundings at most, {told} told, {still} at rest");
    assert!(2 * told > cases && still > 0 && 2 * told < 2 * cases, "{told} told, {still} at rest of {cases}");
}
