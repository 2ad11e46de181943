//! Random systems over many decades, random states and steps: what holds exactly, to rounding.
//!
//! Where a property needs a bound, it is the rounding of what goes in, carried on by the exact derivatives of
//! the step. Each has a control: a system, or a change, for which the same check fails.

use dalembert::nalgebra::{Matrix2, Matrix4, SVector, Vector4};
use dalembert::step::{DiscreteRayleigh, Fused, Linearizable, NewtonMatrix, Segment, Step};
use dalembert::{
    Discrete, Discretise, EnergyLedger, Gauss, Midpoint, State, StepError, Trajectory, Trapezoidal,
    rayleigh_system,
};
use proptest::prelude::*;
use proptest::test_runner::{FailurePersistence, FileFailurePersistence};

/// Two masses on springs of degree 2 and 4 between each other and to walls, coupled in the mass matrix;
/// friction that is linear, depends on the place, or is dry but for a width.
#[derive(Clone, Copy, Debug)]
struct Masses {
    m: [f64; 2],
    /// Coupling of the mass matrix, by the cosine of the distance.
    c: f64,
    /// Springs to the walls and between the masses.
    k: [f64; 3],
    /// The one between them, of degree 4.
    quartic: f64,
    /// Linear friction against the wall and between them.
    r: [f64; 2],
    /// How the first grows with q₀².
    g: f64,
    /// Dry friction, and below which velocity it is not.
    dry: [f64; 2],
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Masses {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let d = q[0] - q[1];
        0.5 * self.m[0] * v[0] * v[0] + 0.5 * self.m[1] * v[1] * v[1] + self.c * d.cos() * v[0] * v[1]
            - 0.5 * self.k[0] * q[0] * q[0]
            - 0.5 * self.k[1] * q[1] * q[1]
            - 0.5 * self.k[2] * d * d
            - 0.25 * self.quartic * d * d * d * d
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [dry, width] = self.dry;
        let relative = v[1] - v[0];
        0.5 * self.r[0] * (1.0 + self.g * q[0] * q[0]) * v[0] * v[0]
            + 0.5 * self.r[1] * relative * relative
            + dry * (v[0] * v[0] + width * width).sqrt()
    }
}

impl Masses {
    /// ∂R/∂q and ∂R/∂v, on paper.
    fn friction(&self, q: &SVector<f64, 2>, v: &SVector<f64, 2>) -> [SVector<f64, 2>; 2] {
        let [dry, width] = self.dry;
        let between = self.r[1] * (v[1] - v[0]);
        let wall = self.r[0] * (1.0 + self.g * q[0] * q[0]) * v[0] + dry * v[0] / v[0].hypot(width);
        [[self.r[0] * self.g * q[0] * v[0] * v[0], 0.0].into(), [wall - between, between].into()]
    }

    fn frictionless(self) -> Self {
        Self { r: [0.0; 2], g: 0.0, dry: [0.0, 1.0], ..self }
    }
}

/// 10 to a power between two.
fn decades(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from..to).prop_map(|power| 10_f64.powf(power))
}

/// Of any sign, over decades, or 0.
fn signed(from: f64, to: f64) -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 8 => decades(from, to), 8 => decades(from, to).prop_map(|x| -x)]
}

fn pair(from: f64, to: f64) -> impl Strategy<Value = SVector<f64, 2>> {
    [signed(from, to), signed(from, to)].prop_map(SVector::from)
}

/// Parameters over as many decades as said, around 1.
fn masses(decades_of: f64) -> impl Strategy<Value = Masses> {
    let positive = move || decades(-decades_of, decades_of);
    let friction = move || prop_oneof![1 => Just(0.0), 3 => decades(-decades_of, decades_of)];
    (
        [positive(), positive()],
        -0.9..0.9,
        [friction(), friction(), friction()],
        friction(),
        [friction(), friction()],
        friction(),
        (friction(), decades(-3.0, 0.0)),
    )
        .prop_map(|(m, share, k, quartic, r, g, (dry, width))| {
            let c: f64 = share;
            Masses { m, c: c * (m[0] * m[1]).sqrt(), k, quartic, r, g, dry: [dry, width] }
        })
}

/// A step that resolves the motion, so that its equation has one root in reach: no spring, nor the quartic
/// one, goes through much of its period, and the distance changes little on the scale of its cosine.
fn resolved(system: &Masses, q: &SVector<f64, 2>, p: &SVector<f64, 2>, share: f64) -> f64 {
    let mass = system.m[0].min(system.m[1]) * 0.1;
    let speed = p.amax() / mass;
    let d = (q[0] - q[1]).abs() + 1.0;
    let stiffness = system.k.iter().sum::<f64>() + 3.0 * system.quartic * d * d;
    share / (stiffness / mass).sqrt().max(speed).max(1.0)
}

fn largest(vector: &SVector<f64, 2>) -> f64 {
    vector.amax()
}

/// What rounding of state and solver at (q, p) makes after the step that `a` linearises, times `factor`.
fn carried(a: &Matrix4<f64>, state: &State<f64, 2>, step: &Step<f64, 2>, factor: f64) -> Vector4<f64> {
    let left = step.report.residual + step.report.floor;
    let of = |x: f64| f64::EPSILON * x;
    let made = Vector4::from_fn(|i, _| match i {
        0 | 1 => of(state.q[i].abs().max((state.q[i] - step.state.q[i]).abs())),
        _ => of(state.p[i - 2].abs().max(largest(&state.p))) + left,
    });
    a.abs() * made * factor
}

/// A step or a named `StepError`; after an error the run is where it was, and goes on with smaller steps.
fn taken_or_named<R: Copy>(
    system: &Masses,
    rule: R,
    h: f64,
    start: State<f64, 2>,
) -> Result<u32, TestCaseError>
where
    Masses: Discrete<R, 2, Scalar = f64>,
{
    let mut run = system.by(rule, h).run(start);
    let mut taken = 0;
    for _ in 0..4 {
        let (before, time) = (*run.state(), run.time());
        match run.next() {
            Some(Ok(step)) => {
                taken += 1;
                let all = step.state.q.iter().chain(&step.state.p).chain(&step.velocity);
                prop_assert!(all.clone().all(|entry| entry.is_finite()), "{:?}", step);
                prop_assert!(step.report.residual <= 4096.0 * step.report.floor, "{:?}", step);
                prop_assert_eq!(run.state(), &step.state);
            }
            Some(Err(error)) => {
                prop_assert_eq!((*run.state(), run.time()), (before, time));
                prop_assert!(run.next().is_none(), "goes on after {}", error);
                run.change_step_size(0.5 * run.step_size());
            }
            None => prop_assert!(false, "ended without an error"),
        }
    }
    Ok(taken)
}

const MANY: u32 = 1_000;

fn config(cases: u32) -> ProptestConfig {
    let failure_persistence: Box<dyn FailurePersistence> =
        Box::new(FileFailurePersistence::WithSource("failures"));
    ProptestConfig { cases, failure_persistence: Some(failure_persistence), ..ProptestConfig::default() }
}

proptest! {
    // These take long without optimisation.
    #![proptest_config(config(if cfg!(debug_assertions) { 24 } else { MANY.max(ProptestConfig::default().cases) }))]

    #[test]
    fn a_step_is_taken_or_named(
        system in masses(6.0), q in pair(-6.0, 6.0), p in pair(-6.0, 6.0), h in signed(-6.0, 3.0),
    ) {
        let start = State { q, p };
        if h == 0.0 {
            prop_assert_eq!(system_step(&system, &start, h), Err(StepError::StepSize { h }));
            return Ok(());
        }
        taken_or_named(&system, Midpoint, h, start)?;
        taken_or_named(&system, Trapezoidal, h, start)?;
        taken_or_named(&system, Gauss::<3>, h, start)?;
    }

    /// In units that are powers of two of q, of time and of mass, every bit of a run is the same.
    #[test]
    fn units_change_no_bit(
        system in masses(6.0), q in pair(-4.0, 4.0), p in pair(-4.0, 4.0), h in decades(-6.0, 2.0),
        units in [-40_i32..40, -20..20, -40..40],
    ) {
        // The cosine has a unit.
        let system = Masses { c: 0.0, ..system };
        let units = units.map(|power| 2_f64.powi(power));
        prop_assert_eq!(run(&system, State { q, p }, h, [1.0; 3], Midpoint), run(&system, State { q, p }, h, units, Midpoint));
        prop_assert_eq!(
            run(&system, State { q, p }, h, [1.0; 3], Trapezoidal),
            run(&system, State { q, p }, h, units, Trapezoidal)
        );
    }
}

proptest! {
    #![proptest_config(config(MANY.max(ProptestConfig::default().cases)))]

    /// Without friction (q, −p) runs the motion backwards.
    #[test]
    fn time_is_reversed_without_friction(
        system in masses(3.0), q in pair(-2.0, 0.5), p in pair(-2.0, 0.5), share in 0.01..0.5,
    ) {
        let system = system.frictionless();
        let h = resolved(&system, &q, &p, share);
        for (missed, bound) in [
            reversal(&system, Midpoint, State { q, p }, h),
            reversal(&system, Trapezoidal, State { q, p }, h),
            reversal(&system, Gauss::<2>, State { q, p }, h),
        ].into_iter().flatten() {
            prop_assert!((0..4).all(|i| missed[i] <= bound[i]), "{:?} {:?}", missed, bound);
        }
    }

    /// AᵀΩA = Ω without friction; det A = det D1D2 L_d⁻ / det D1D2 L_d⁺ with it.
    #[test]
    fn the_step_is_symplectic(
        system in masses(3.0), q in pair(-2.0, 0.5), p in pair(-2.0, 0.5), share in 0.01..0.5,
    ) {
        let h = resolved(&system, &q, &p, share);
        for (missed, bound) in [
            symplecticity(&system.frictionless(), Midpoint, State { q, p }, h),
            symplecticity(&system.frictionless(), Trapezoidal, State { q, p }, h),
            determinant(&system, Midpoint, State { q, p }, h),
            determinant(&system, Trapezoidal, State { q, p }, h),
        ].into_iter().flatten() {
            prop_assert!(missed <= bound, "{:e} {:e}", missed, bound);
        }
    }

    /// Without springs to the walls p₀ + p₁ changes by what friction against the wall takes, h ∂R/∂v(v̄), and
    /// by nothing else.
    #[test]
    fn the_total_momentum_balances(
        system in masses(3.0), q in pair(-2.0, 0.5), p in pair(-2.0, 0.5), share in 0.01..0.5,
    ) {
        let h = resolved(&system, &q, &p, share);
        let system = Masses { k: [0.0, 0.0, system.k[2]], g: 0.0, ..system };
        let (missed, bound) = momentum_balance(&system, State { q, p }, h)?;
        prop_assert!(missed <= bound, "{:e} {:e}", missed, bound);
    }

    /// By the midpoint rule the ledger of a linear system has no remainder; of any system, its entries add
    /// up.
    #[test]
    fn the_energy_ledger_adds_up(
        system in masses(3.0), q in pair(-2.0, 0.5), p in pair(-2.0, 0.5), share in 0.01..0.5,
    ) {
        let h = resolved(&system, &q, &p, share);
        let linear = Masses { c: 0.0, quartic: 0.0, g: 0.0, dry: [0.0, 1.0], ..system };
        let (remainder, bound) = remainder(&linear, State { q, p }, h)?;
        prop_assert!(remainder <= bound, "{:e} {:e}", remainder, bound);
    }

    /// f_d^∓ = ±(h²/4) ∂R/∂q − (h/2) ∂R/∂v at (q̄, v̄), and L_d^± = L_d ± R_d.
    #[test]
    fn discrete_forces_are_those_on_paper(
        system in masses(3.0), q0 in pair(-2.0, 0.5), q1 in pair(-2.0, 0.5), h in decades(-3.0, 1.0),
    ) {
        let (missed, bound) = force_mismatch(&system, &system, [q0, q1], h);
        prop_assert!(missed <= bound, "{:e} {:e}", missed, bound);
        let l = system_lagrangian(&system, &q0, &q1, h);
        let r = system.by(Midpoint, h).discrete_rayleigh(&q0, &q1);
        prop_assert_eq!(system.by(Midpoint, h).modified_plus(&q0, &q1), l + r);
        prop_assert_eq!(system.by(Midpoint, h).modified_minus(&q0, &q1), l - r);
    }
}

fn system_step(system: &Masses, state: &State<f64, 2>, h: f64) -> Result<Step<f64, 2>, StepError> {
    system.by(Midpoint, h).step(state)
}

fn system_lagrangian(system: &Masses, q0: &SVector<f64, 2>, q1: &SVector<f64, 2>, h: f64) -> f64 {
    system.by(Midpoint, h).discrete_lagrangian(q0, q1)
}

/// How far (q, −p) of the next state leads past (q, −p) of this one, and what rounding allows. Nothing where
/// no step is taken.
fn reversal<R: Copy>(
    system: &Masses,
    rule: R,
    start: State<f64, 2>,
    h: f64,
) -> Option<(Vector4<f64>, Vector4<f64>)>
where
    Masses: Linearizable<R, 2, Scalar = f64>,
{
    let there = system.by(rule, h).step(&start).ok()?;
    let turned = State { q: there.state.q, p: -there.state.p };
    let back = system.by(rule, h).step(&turned).ok()?;
    let a = system.by(rule, h).segment(&turned.q, &back.state.q).ok()?.linearized().ok()?.by_state().ok()?;
    let (q, p) = (back.state.q - start.q, back.state.p + start.p);
    let bound = carried(&a.assembled::<4>(), &turned, &back, 64.0)
        + carried(&Matrix4::identity(), &start, &there, 64.0);
    Some((Vector4::new(q[0], q[1], p[0], p[1]).abs(), bound))
}

fn omega() -> Matrix4<f64> {
    Matrix4::from_fn(|i, j| {
        if j == i + 2 {
            1.0
        } else if i == j + 2 {
            -1.0
        } else {
            0.0
        }
    })
}

/// Condition of the step's matrix, in units of the coordinates as they are.
fn condition<R>(system: &Masses, q0: &SVector<f64, 2>, v: &SVector<f64, 2>, h: f64) -> Option<f64>
where
    Masses: Fused<R, 2, Scalar = f64>,
{
    let matrix = system.step_kernel(&Segment { q0: *q0, v: *v, h }).matrix.dense();
    Some(matrix.norm() * matrix.try_inverse()?.norm())
}

/// Largest entry of AᵀΩA − Ω, momenta in units of m/h, and what rounding allows.
fn symplecticity<R: Copy>(system: &Masses, rule: R, start: State<f64, 2>, h: f64) -> Option<(f64, f64)>
where
    Masses: Fused<R, 2, Scalar = f64> + Linearizable<R, 2>,
{
    let step = system.by(rule, h).step(&start).ok()?;
    let a = system.by(rule, h).segment(&start.q, &step.state.q).ok()?.linearized().ok()?.by_state().ok()?;
    let unit = system.m[0].max(system.m[1]) / h;
    let units = Vector4::new(1.0, 1.0, unit, unit);
    let a = a.assembled::<4>().map_with_location(|i, j, entry| entry * units[j] / units[i]);
    let condition = condition::<R>(system, &start.q, &step.velocity, h)?;
    let defect = a.transpose() * omega() * a - omega();
    Some((defect.amax(), 64.0 * f64::EPSILON * condition * (1.0 + a.norm()).powi(2)))
}

/// How far det A is from det D1D2 L_d⁻ / det D1D2 L_d⁺, as a share, and what rounding allows.
fn determinant<R: Copy>(system: &Masses, rule: R, start: State<f64, 2>, h: f64) -> Option<(f64, f64)>
where
    Masses: DiscreteRayleigh<R, 2, Scalar = f64> + Linearizable<R, 2>,
{
    let step = system.by(rule, h).step(&start).ok()?;
    let (q0, q1) = (&start.q, &step.state.q);
    let a = system.by(rule, h).segment(q0, q1).ok()?.linearized().ok()?.by_state().ok()?.assembled::<4>();
    let minus = system.modified_minus_derivatives(&Segment::between(q0, q1, h)).d12;
    let plus = system.modified_plus_derivatives(&Segment::between(q0, q1, h)).d12;
    // Each determinant to the rounding of its products, which may cancel.
    let products = |m: &Matrix2<f64>| (m[(0, 0)] * m[(1, 1)]).abs() + (m[(0, 1)] * m[(1, 0)]).abs();
    let of_plus = plus.determinant().abs();
    let expected = minus.determinant() / plus.determinant();
    let size = a.abs().column_iter().map(|column| column.sum()).product::<f64>();
    let condition = condition::<R>(system, q0, &step.velocity, h)?;
    let bound = size * condition + products(&minus) / of_plus * (1.0 + products(&plus) / of_plus);
    Some(((a.determinant() - expected).abs(), 64.0 * f64::EPSILON * bound))
}

/// |Δ(p₀ + p₁) + h ∂R/∂v| and what rounding allows.
fn momentum_balance(system: &Masses, start: State<f64, 2>, h: f64) -> Result<(f64, f64), TestCaseError> {
    let Ok(step) = system_step(system, &start, h) else { return Ok((0.0, 0.0)) };
    let middle = (start.q + step.state.q) * 0.5;
    let [_, friction] = system.friction(&middle, &step.velocity);
    let change = step.state.p.sum() - start.p.sum();
    // What the forces between the masses, which cancel, and the momenta lose in their last places.
    let exchanged = (step.state.p - start.p).abs().sum() + h * friction.abs().sum();
    let sizes = start.p.abs().sum() + step.state.p.abs().sum() + exchanged;
    let kinetic = (system.m[0] + system.m[1] + 2.0 * system.c.abs()) * step.velocity.abs().sum();
    let d = (middle[0] - middle[1]).abs() + start.q.abs().sum() + step.state.q.abs().sum();
    let spring =
        h * (system.k[2] * d + system.quartic * d.powi(3) + system.c.abs() * step.velocity.norm_squared());
    Ok((
        (change + h * friction.sum()).abs(),
        64.0 * f64::EPSILON * (sizes + kinetic + spring) + 4.0 * step.report.residual,
    ))
}

/// |remainder| of the ledger over 10 steps, after checking that the steps add up to the whole; and what rounding allows.
fn remainder(system: &Masses, start: State<f64, 2>, h: f64) -> Result<(f64, f64), TestCaseError> {
    let (mut state, mut ledger, mut size) = (start, EnergyLedger::default(), 0.0);
    for _ in 0..10 {
        let Ok(step) = system_step(system, &state, h) else { break };
        let entry = system.by(Midpoint, h).ledger(&state, &step.state);
        let entry = entry.map_err(|error| TestCaseError::fail(error.to_string()))?;
        for at in [&state, &step.state] {
            let v = at.velocity(system).map_err(|error| TestCaseError::fail(error.to_string()))?;
            let d = at.q[0] - at.q[1];
            size += (0..2).map(|i| system.m[i] * v[i] * v[i] + system.k[i] * at.q[i] * at.q[i]).sum::<f64>()
                + system.k[2] * (at.q[0].abs() + at.q[1].abs()) * d.abs();
            // The mean velocity is a difference of configurations.
            size += (system.r[0] + 2.0 * system.r[1]) * v.abs().sum() * at.q.abs().sum();
        }
        // The residual that the solver leaves does work too.
        size += entry.dissipated.abs()
            + (step.report.residual + step.report.floor) * step.velocity.abs().sum() * h / f64::EPSILON;
        ledger += entry;
        state = step.state;
    }
    Ok((ledger.remainder().abs(), 64.0 * f64::EPSILON * size))
}

/// Eight steps in units of [q, time, mass], as bits in the units of the start.
fn run<R: Copy>(system: &Masses, start: State<f64, 2>, h: f64, [x, t, m]: [f64; 3], rule: R) -> Vec<[u64; 4]>
where
    Masses: Discrete<R, 2, Scalar = f64>,
{
    let system = Masses {
        m: system.m.map(|mass| mass * m),
        c: 0.0,
        k: system.k.map(|k| k * m / (t * t)),
        quartic: system.quartic * m / (t * t) / (x * x),
        r: system.r.map(|r| r * m / t),
        g: system.g / (x * x),
        dry: [system.dry[0] * m * x / (t * t), system.dry[1] * x / t],
    };
    let start = State { q: start.q * x, p: start.p * (m * x / t) };
    let mut run = system.by(rule, h * t).run(start);
    // Only as far as nothing can overflow in any units.
    let next = |run: &mut Trajectory<'_, Masses, R, 2>| {
        let state = run.next()?.ok()?.state;
        let [q, p] = [state.q / x, state.p / (m * x / t)];
        let all = [q[0], q[1], p[0], p[1]];
        all.iter().all(|entry| entry.abs() < 1e40).then(|| all.map(f64::to_bits))
    };
    std::iter::from_fn(|| next(&mut run)).take(8).collect()
}

/// How far the discrete forces of `system` are from those of `on_paper`, and what rounding allows.
fn force_mismatch(system: &Masses, on_paper: &Masses, [q0, q1]: [SVector<f64, 2>; 2], h: f64) -> (f64, f64) {
    let force = system.by(Midpoint, h).discrete_force(&q0, &q1);
    let (q, v) = ((q0 + q1) * 0.5, (q1 - q0) / h);
    let [by_q, by_v] = on_paper.friction(&q, &v);
    let minus = by_q * (h * h / 4.0) - by_v * (h / 2.0);
    let plus = by_q * (-h * h / 4.0) - by_v * (h / 2.0);
    let missed = largest(&(force.minus - minus)).max(largest(&(force.plus - plus)));
    // The differences of q and v cancel.
    let speed = (largest(&q0) + largest(&q1)) / h;
    let at_most = on_paper.friction(&[largest(&q); 2].into(), &[speed, -speed].into());
    let size =
        largest(&at_most[0]) * h * h + (largest(&at_most[1]) + on_paper.dry[0] * speed / on_paper.dry[1]) * h;
    (missed, 64.0 * f64::EPSILON * size)
}

/// A system for the controls, of the kind that the properties draw.
const EXAMPLE: Masses = Masses {
    m: [1.3, 0.7],
    c: 0.2,
    k: [0.9, 0.4, 1.1],
    quartic: 0.6,
    r: [0.3, 0.2],
    g: 0.5,
    dry: [0.1, 0.05],
};

/// The same checks where what they check does not hold.
#[test]
fn every_check_can_fail() {
    let start = State { q: SVector::from([0.4, -0.3]), p: SVector::from([0.5, 0.8]) };
    let h = 0.2;
    // Friction has a direction in time.
    let (missed, bound) = reversal(&EXAMPLE, Midpoint, start, h).unwrap();
    assert!(missed.max() > 1e6 * bound.max(), "{missed} {bound}");
    // It contracts the phase space, and by another factor with other friction.
    let (missed, bound) = symplecticity(&EXAMPLE, Midpoint, start, h).unwrap();
    assert!(missed > 1e6 * bound);
    // Springs to the walls change the total momentum.
    let (missed, bound) = momentum_balance(&EXAMPLE, start, h).unwrap();
    assert!(missed > 1e6 * bound);
    // The midpoint rule has a remainder where V is of degree 4.
    let (missed, bound) = remainder(&EXAMPLE, start, h).unwrap();
    assert!(missed > 1e6 * bound);
    // Units that are no powers of two round differently; a power of two does not.
    let plain = run(&EXAMPLE, start, h, [1.0; 3], Midpoint);
    assert_ne!(plain, run(&EXAMPLE, start, h, [3.0, 1.0, 1.0], Midpoint));
    assert_eq!(plain, run(&EXAMPLE, start, h, [8.0, 0.5, 4.0], Midpoint));
    assert_eq!(plain.len(), 8);
    // Without the term of ∂R/∂q the forces are others.
    let flat = Masses { g: 0.0, ..EXAMPLE };
    let (missed, bound) = force_mismatch(&EXAMPLE, &flat, [start.q, start.p], h);
    assert!(missed > 1e6 * bound);
    // The determinant of another system's L_d.
    let (_, bound) = determinant(&EXAMPLE, Midpoint, start, h).unwrap();
    let of = |system: &Masses| {
        let step = system_step(system, &start, h).unwrap();
        let a = system
            .by(Midpoint, h)
            .segment(&start.q, &step.state.q)
            .unwrap()
            .linearized()
            .unwrap()
            .by_state()
            .unwrap();
        a.assembled::<4>().determinant()
    };
    assert!((of(&EXAMPLE) - of(&EXAMPLE.frictionless())).abs() > 1e6 * bound);
    // Nearly all of the steps that the properties draw within their period are taken, so that something is
    // checked.
    assert!(taken_or_named(&EXAMPLE, Midpoint, h, start).unwrap() == 4);
    let broken = Masses { m: [f64::NAN, 1.0], ..EXAMPLE };
    assert!(taken_or_named(&broken, Midpoint, h, start).unwrap() == 0);
}
