//! The energy ledger: each method's own account of what forces did, against an integration beside it.

use dalembert::nalgebra::{Matrix2, SVector, vector};
use dalembert::rules::Quadrature;
use dalembert::step::{Discretised, EnergyExchange, ForceWork, Quantity};
use dalembert::{
    Composition, Discretise, EnergyLedger, Fitted, FittedTrapezoidal, Gauss, Midpoint, OneSided, Splitting,
    State, StepError, Trapezoidal, rayleigh_system,
};
use dalembert_tests::simpson::Simpson;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// A damped pendulum of unit mass and length.
#[rayleigh_system(rule = [midpoint, gauss])]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// Σ of the ledger over `steps` steps.
fn account<L, M, const N: usize>(
    by: Discretised<'_, L, M, N>,
    start: State<f64, N>,
    steps: usize,
) -> EnergyLedger<f64>
where
    L: ForceWork<M, N, Scalar = f64>,
{
    let (mut sum, mut state) = (EnergyLedger::default(), start);
    for _ in 0..steps {
        let next = by.step(&state).unwrap().state;
        sum += by.ledger(&state, &next).unwrap();
        state = next;
    }
    sum
}

#[test]
fn a_gauss_rule_loses_what_friction_takes() {
    let system = Pendulum { r: 0.3 };
    let start = State::from_velocity(&system, [1.0], [0.0]).unwrap();
    let by = system.by(Gauss::<4>, 0.1);
    let own = account(by, start, 100);
    assert!(own.dissipated > 0.3 && own.remainder().abs() < 1e-9, "{own:?}");
    assert!(account(system.by(Midpoint, 0.1), start, 100).remainder().abs() > 1e-6);

    // The control: the drag at the mean velocities, r h v̄² a step, is low by r h³q̈²/12.
    let (mut low, mut predicted, mut state) = (0.0, 0.0, start);
    for _ in 0..100 {
        let next = by.step(&state).unwrap().state;
        let d = next.q[0] - state.q[0];
        low += 0.3 * d * d / 0.1;
        let middle = by.with_step(0.05).step(&state).unwrap().state;
        predicted -= 0.3 * 1e-3 * (middle.q[0].sin() + 0.3 * middle.p[0]).powi(2) / 12.0;
        state = next;
    }
    let missed = low - own.dissipated;
    assert!(missed < -1e-4 && (missed / predicted - 1.0).abs() < 0.01, "{missed:e} {predicted:e}");
}

/// Two bodies, a nonlinear spring between, linear damping with cross terms, a force that depends on q and on
/// v.
#[derive(Clone, Copy, Debug)]
struct Bodies {
    m: [f64; 2],
    k: [f64; 2],
    c: [f64; 3],
    cubic: f64,
    swirl: f64,
    pump: f64,
}

impl Bodies {
    fn any(random: &mut StdRng) -> Self {
        let mut from = |low: f64, high: f64| random.random_range(low..high);
        let c = [from(0.1, 0.5), from(-0.1, 0.1), from(0.1, 0.5)];
        Self {
            m: [from(0.5, 2.0), from(0.5, 2.0)],
            k: [from(0.5, 1.5), from(0.2, 1.0)],
            c,
            cubic: from(0.05, 0.2),
            swirl: from(0.1, 0.4),
            pump: from(0.05, 0.2),
        }
    }

    /// −∇V, ∂R/∂v, f, by hand; of `model` 0: linear drag alone, 1: f(q) as well, 2: all.
    fn forces(&self, model: usize, q: [f64; 2], v: [f64; 2]) -> [[f64; 2]; 3] {
        let d = self.k[1] * (q[0] - q[1]).powi(3);
        let [a, b, c] = self.c;
        let mut drag = [a * v[0] + b * v[1], b * v[0] + c * v[1]];
        let mut force = [0.0; 2];
        if model > 0 {
            force = [-self.swirl * q[1], self.swirl * q[0]];
        }
        if model > 1 {
            drag[0] += self.cubic * v[0].powi(3);
            force[1] += self.pump * v[0];
        }
        [[-self.k[0] * q[0] - d, -self.k[0] * q[1] + d], drag, force]
    }

    /// dissipated and work over the time T, by the classical Runge–Kutta method for all of (q, v, ∫ v·∂R/∂v,
    /// ∫ v·f).
    fn exact(&self, model: usize, start: &State<f64, 2>, time: f64) -> [f64; 2] {
        const STEPS: usize = 4000;
        let rate = |y: &SVector<f64, 6>| {
            let (q, v) = ([y[0], y[1]], [y[2], y[3]]);
            let [spring, drag, force] = self.forces(model, q, v);
            let a = |i: usize| (spring[i] - drag[i] + force[i]) / self.m[i];
            let along = |f: [f64; 2]| v[0] * f[0] + v[1] * f[1];
            SVector::from([v[0], v[1], a(0), a(1), along(drag), along(force)])
        };
        let h = time / STEPS as f64;
        let v = [start.p[0] / self.m[0], start.p[1] / self.m[1]];
        let mut y = SVector::from([start.q[0], start.q[1], v[0], v[1], 0.0, 0.0]);
        for _ in 0..STEPS {
            let k1 = rate(&y);
            let k2 = rate(&(y + k1 * (h / 2.0)));
            let k3 = rate(&(y + k2 * (h / 2.0)));
            let k4 = rate(&(y + k3 * h));
            y += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
        }
        [y[4], y[5]]
    }
}

#[derive(Clone, Copy)]
struct Damped(Bodies);

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal, one_sided])]
impl Damped {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let d = q[0] - q[1];
        0.5 * (self.0.m[0] * v[0] * v[0] + self.0.m[1] * v[1] * v[1])
            - 0.5 * self.0.k[0] * (q[0] * q[0] + q[1] * q[1])
            - 0.25 * self.0.k[1] * d * d * d * d
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let [a, b, c] = self.0.c;
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1])
    }
}

#[derive(Clone, Copy)]
struct Stirred(Bodies);

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Stirred {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let d = q[0] - q[1];
        0.5 * (self.0.m[0] * v[0] * v[0] + self.0.m[1] * v[1] * v[1])
            - 0.5 * self.0.k[0] * (q[0] * q[0] + q[1] * q[1])
            - 0.25 * self.0.k[1] * d * d * d * d
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let [a, b, c] = self.0.c;
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1])
    }
    fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        [-self.0.swirl * q[1], self.0.swirl * q[0]]
    }
}

#[derive(Clone, Copy)]
struct Pumped(Bodies);

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Pumped {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let d = q[0] - q[1];
        0.5 * (self.0.m[0] * v[0] * v[0] + self.0.m[1] * v[1] * v[1])
            - 0.5 * self.0.k[0] * (q[0] * q[0] + q[1] * q[1])
            - 0.25 * self.0.k[1] * d * d * d * d
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let [a, b, c] = self.0.c;
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1]) + 0.25 * self.0.cubic * v[0].powi(4)
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [-self.0.swirl * q[1], self.0.swirl * q[0] + self.0.pump * v[0]]
    }
}

const TIME: f64 = 2.0;

/// Dissipated and work by `method` fall to those of the motion as h^`order`, and so does the remainder.
fn assert_order<L, M>(
    name: &str,
    system: &L,
    method: M,
    (exact, start): ([f64; 2], State<f64, 2>),
    order: i32,
    steps: usize,
) where
    L: Discretise<2> + ForceWork<M, 2, Scalar = f64>,
    M: Copy,
{
    let missed = |steps: usize| {
        let sum = account(system.by(method, TIME / steps as f64), start, steps);
        [sum.dissipated - exact[0], sum.work - exact[1], sum.remainder()].map(f64::abs)
    };
    let (wide, narrow) = (missed(steps), missed(2 * steps));
    for (what, (wide, narrow)) in ["dissipated", "work", "remainder"].iter().zip(wide.into_iter().zip(narrow))
    {
        // Errors may cancel at one step size; below 1e-11 the reference is no better.
        let bound = wide.max(1e-2 * (TIME / steps as f64).powi(order)) * 0.5_f64.powi(order) * 1.5 + 1e-11;
        assert!(narrow <= bound, "{name}, {what}: {wide:e} at {steps} steps, {narrow:e} at twice as many");
    }
    // No sum of zeros: what friction takes is there.
    assert!(exact[0] > 1e-3 && wide[0] < 0.2 * exact[0], "{name}: {wide:?} of {exact:?}");
}

#[test]
fn every_method_takes_account_to_its_order() {
    let mut random = StdRng::seed_from_u64(20);
    for _ in 0..if cfg!(debug_assertions) { 3 } else { 5 } {
        let bodies = Bodies::any(&mut random);
        let start = State {
            q: vector![random.random_range(-1.0..1.0), random.random_range(-1.0..1.0)],
            p: vector![random.random_range(-1.0..1.0), random.random_range(-1.0..1.0)],
        };
        let reference = [0, 1, 2].map(|model| (bodies.exact(model, &start, TIME), start));
        let (damped, stirred, pumped) = (Damped(bodies), Stirred(bodies), Pumped(bodies));
        macro_rules! orders {
            ($($system:ident, $model:literal: $($method:expr => $order:literal in $steps:literal),+;)*) => {$($(
                let name = concat!(stringify!($system), " by ", stringify!($method));
                assert_order(name, &$system, $method, reference[$model], $order, $steps);
            )+)*};
        }
        orders! {
            damped, 0: Midpoint => 2 in 40, Trapezoidal => 2 in 40, Fitted => 2 in 40, FittedTrapezoidal => 2 in 40,
                OneSided => 1 in 80, Quadrature(Simpson) => 2 in 40, Gauss::<2> => 4 in 10, Gauss::<3> => 6 in 6,
                Splitting::blanes_moan_4() => 4 in 6, Splitting::blanes_moan_6() => 6 in 4,
                Splitting::blanes_casas_escorihuela_8() => 8 in 4,
                Composition::kahan_li_6(Midpoint) => 6 in 10, Composition::kahan_li_6(FittedTrapezoidal) => 6 in 10,
                Composition::kahan_li_8(Trapezoidal) => 8 in 8;
            stirred, 1: Midpoint => 2 in 40, Trapezoidal => 2 in 40, Gauss::<2> => 4 in 10,
                Splitting::blanes_moan_4() => 4 in 6, Splitting::blanes_moan_6() => 6 in 4,
                Splitting::blanes_casas_escorihuela_8() => 8 in 4;
            pumped, 2: Midpoint => 2 in 40, Trapezoidal => 2 in 40, Quadrature(Simpson) => 2 in 40,
                Gauss::<2> => 4 in 10, Gauss::<3> => 6 in 6, Composition::kahan_li_6(Midpoint) => 6 in 10;
        }
    }
}

/// L of second degree, R(v): what the midpoint and the Gauss rules do to the energy is what forces do.
#[rayleigh_system(rule = [midpoint, gauss])]
fn buffer(q: [f64; 1], v: [f64; 1], k: f64, dry: f64) -> (f64, f64) {
    (
        0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0] - 0.3 * q[0],
        dry * (v[0] * v[0] + 0.1).sqrt() + 0.2 * v[0].powi(4),
    )
}

#[test]
fn nothing_remains_where_energy_is_of_second_degree() {
    let system = Buffer { k: 1.7, dry: 0.2 };
    let start = State::from_velocity(&system, [1.0], [0.4]).unwrap();
    macro_rules! nothing_remains {
        ($($method:expr),+) => {$(
            let sum = account(system.by($method, 0.4), start, 50);
            assert!(sum.dissipated > 0.5 && sum.remainder().abs() < 1e-13, "{}: {sum:?}", stringify!($method));
        )+};
    }
    nothing_remains!(
        Midpoint,
        Gauss::<1>,
        Gauss::<2>,
        Gauss::<5>,
        Gauss::<8>,
        Composition::kahan_li_6(Midpoint)
    );
}

/// V = q²/2, R = 0.15(1 + q²)v².
#[rayleigh_system(rule = [midpoint, gauss])]
fn thickening(q: [f64; 1], v: [f64; 1]) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.15 * (1.0 + q[0] * q[0]) * v[0] * v[0])
}

/// Two masses in a well, friction that depends on q, and a force.
#[rayleigh_system(rule = [midpoint, gauss])]
impl Smeared {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.65 * v[0] * v[0] + 0.2 * v[0] * v[1] + 0.45 * v[1] * v[1] - 0.5 * q[0] * q[0] - q[1] * q[1]
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        (0.1 + 0.3 * q[0] * q[0] + 0.2 * q[1].sin()) * (v[0] * v[0] + 0.5 * v[1].powi(4))
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [-0.3 * q[1], 0.3 * q[0] + 0.1 * v[1]]
    }
}
struct Smeared;

/// (h³/4) ∂R/∂q·M⁻¹(∇V + ∂R/∂v − f) a step by the midpoint rule, nothing by Gauss rules.
#[test]
fn friction_that_depends_on_q_leaves_the_midpoint_rule_a_remainder() {
    let start = State::from_velocity(&Thickening {}, [1.0], [0.0]).unwrap();
    for (steps, known) in [(50, 4.520_656_0e-4), (100, 1.135_686e-4), (200, 2.842_701e-5)] {
        let h = 10.0 / steps as f64;
        let remainder = account(Thickening {}.by(Midpoint, h), start, steps).remainder();
        assert!((remainder / known - 1.0).abs() < 1e-6, "{h}: {remainder:e}");
        let remainder = account(Thickening {}.by(Gauss::<1>, h), start, steps).remainder();
        assert!(remainder.abs() < 1e-14, "{h}: {remainder:e}");
    }

    let (h, mut state) = (0.1, State { q: vector![0.7, -0.4], p: vector![0.9, 0.5] });
    let inverse = Matrix2::new(1.3, 0.2, 0.2, 0.9).try_inverse().unwrap();
    for _ in 0..50 {
        let next = Smeared.by(Midpoint, h).step(&state).unwrap().state;
        let (q, v) = ((state.q + next.q) * 0.5, (next.q - state.q) / h);
        let (thickness, speed) =
            (0.1 + 0.3 * q[0] * q[0] + 0.2 * q[1].sin(), v[0] * v[0] + 0.5 * v[1].powi(4));
        let by_q = vector![0.6 * q[0], 0.2 * q[1].cos()] * speed;
        let drag = vector![2.0 * v[0], 2.0 * v[1].powi(3)] * thickness;
        let force = vector![-0.3 * q[1], 0.3 * q[0] + 0.1 * v[1]];
        let expected = 0.25 * h.powi(3) * by_q.dot(&(inverse * (vector![q[0], 2.0 * q[1]] + drag - force)));
        let found = Smeared.by(Midpoint, h).ledger(&state, &next).unwrap().remainder();
        assert!((found - expected).abs() < 1e-15, "{found:e} {expected:e}");
        let gauss = Smeared.by(Gauss::<1>, h).step(&state).unwrap().state;
        let nothing = Smeared.by(Gauss::<1>, h).ledger(&state, &gauss).unwrap().remainder();
        assert!(nothing.abs() < 1e-15 && expected.abs() > 1e-8, "{nothing:e} {expected:e}");
        state = next;
    }
}

/// Remainders of one sign: without friction, over many periods, of a method that drifts; within a period, and
/// with friction for good, of one that does not.
#[test]
fn one_sign_is_a_drift_only_without_friction_over_many_periods() {
    let remainders = |r: f64, h: f64, steps: usize| {
        let system = Pendulum { r };
        let by = system.by(Midpoint, h);
        let mut state = State::from_velocity(&system, [1.0], [0.0]).unwrap();
        let of_step = |_| {
            let next = by.step(&state).unwrap().state;
            let remainder = by.ledger(&state, &next).unwrap().remainder();
            state = next;
            remainder
        };
        (0..steps).map(of_step).collect::<Vec<f64>>()
    };
    let sum = |all: &[f64]| all.iter().sum::<f64>();
    // Overdamped: one sign, and what has added up at t = 40 is all there will be, C h².
    let overdamped = remainders(3.0, 0.1, 80);
    assert!(
        overdamped.iter().all(|remainder| remainder.signum() == overdamped[0].signum()),
        "{overdamped:?}"
    );
    let [wide, longer, narrow] =
        [(0.1, 400), (0.1, 800), (0.05, 800)].map(|(h, n)| sum(&remainders(3.0, h, n)));
    let order = (wide / narrow).log2();
    assert!(
        wide.abs() > 1e-6 && (longer - wide).abs() < 1e-12 && (order - 2.0).abs() < 0.1,
        "{wide:e} {order}"
    );
    // Without friction: one sign for a quarter of the period, 6.7, and no more by the midpoint rule.
    let swinging = remainders(0.0, 0.1, 4000);
    assert!(swinging[1..15].iter().all(|remainder| remainder.signum() == swinging[1].signum()));
    let after = |steps: usize| sum(&swinging[..steps]);
    let largest = |from: usize| (from..from + 400).map(|k| after(k).abs()).fold(0.0, f64::max);
    assert!(largest(3600) < 1.01 * largest(0), "{:e} {:e}", largest(0), largest(3600));
    // The control, the classical Runge–Kutta method: each stretch of many periods loses the same.
    let (system, h) = (Pendulum { r: 0.0 }, 0.2);
    let mut state = State::from_velocity(&system, [1.0], [0.0]).unwrap();
    let rate = |y: [f64; 2]| [y[1], -y[0].sin()];
    let lost = [(); 4].map(|()| {
        let mut ledger = EnergyLedger::default();
        for _ in 0..1000 {
            let y = [state.q[0], state.p[0]];
            let by = |k: [f64; 2], share: f64| rate([y[0] + share * h * k[0], y[1] + share * h * k[1]]);
            let k1 = rate(y);
            let k2 = by(k1, 0.5);
            let k3 = by(k2, 0.5);
            let k4 = by(k3, 1.0);
            let end = |i: usize| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            let next = State { q: vector![end(0)], p: vector![end(1)] };
            ledger += EnergyLedger::of(&system, &state, &next, h).unwrap();
            state = next;
        }
        ledger.remainder()
    });
    assert!(lost.iter().all(|one| *one < -1e-6 && (one / lost[0] - 1.0).abs() < 0.2), "{lost:?}");
}

/// Damping however stiff, a constant force, and friction with a term of first degree.
#[rayleigh_system(rule = [trapezoidal, fitted, fitted_trapezoidal])]
fn sled(q: [f64; 2], v: [f64; 2], r: f64, g: f64, s: f64) -> (f64, f64) {
    let (a, b) = (v[0], v[1]);
    (
        0.5 * (a * a + 0.6 * a * b + 2.0 * b * b) + g * (q[0] - q[1]),
        0.5 * r * (a * a + a * b + 2.0 * b * b) + s * a,
    )
}

#[test]
fn a_drift_takes_what_it_takes_exactly() {
    for r in [1e-6, 0.3, 3.0, 300.0] {
        let free = Sled { r, g: 0.0, s: 0.0 };
        let start = State::from_velocity(&free, [0.0, 0.0], [1.0, -0.4]).unwrap();
        let kinetic = start.energy(&free).unwrap();
        macro_rules! nothing_remains {
            ($system:expr, $($method:expr),+) => {$(
                let sum = account($system.by($method, 0.2), start, 10);
                let size = kinetic + sum.dissipated.abs() + sum.change.abs();
                assert!(sum.remainder().abs() < 1e-13 * size, "{}, r = {r}: {sum:?}", stringify!($method));
            )+};
        }
        nothing_remains!(free, Fitted, FittedTrapezoidal, Splitting::blanes_moan_4());
        if r < 100.0 {
            nothing_remains!(free, Splitting::blanes_moan_6(), Splitting::blanes_casas_escorihuela_8());
        }
        // Under a constant force the fitted midpoint rule is exact too, up to its terminal velocity.
        nothing_remains!(Sled { r, g: 0.7, s: 0.0 }, Fitted);
        nothing_remains!(Sled { r, g: 0.7, s: 0.2 }, Fitted);
        nothing_remains!(Sled { r, g: 0.0, s: 0.0 }, Fitted);
    }
}

#[test]
fn a_composition_adds_up_its_substeps() {
    let system = Pendulum { r: 0.3 };
    let composition = Composition::kahan_li_6(Midpoint);
    let start = State::from_velocity(&system, [1.0], [0.0]).unwrap();
    let by = system.by(composition, 0.5);
    let whole = by.ledger(&start, &by.step(&start).unwrap().state).unwrap();
    let (mut sum, mut state) = (EnergyExchange::zero(), start);
    for share in composition.shares() {
        let part = system.by(Midpoint, 0.5 * share);
        let next = part.step(&state).unwrap().state;
        let entry = part.ledger(&state, &next).unwrap();
        // Backwards, friction gives back.
        assert_eq!(entry.dissipated > 0.0, *share > 0.0);
        sum = sum + EnergyExchange { dissipated: entry.dissipated, work: entry.work };
        state = next;
    }
    assert!((sum.dissipated - whole.dissipated).abs() < 1e-14 && whole.dissipated > 1e-3 && sum.work == 0.0);
}

/// Of steps that are exact to rounding, what the account from the ends alone leaves is its own: h⁴.
#[test]
fn from_the_ends_alone_the_account_is_of_order_4() {
    let mut random = StdRng::seed_from_u64(3);
    let system = Pumped(Bodies::any(&mut random));
    let start = State { q: vector![0.8, -0.3], p: vector![0.2, 0.9] };
    let remainder = |steps: usize| {
        let h = TIME / steps as f64;
        let (mut sum, mut state) = (EnergyLedger::default(), start);
        for _ in 0..steps {
            let next = system.by(Gauss::<8>, h).step(&state).unwrap().state;
            sum += EnergyLedger::of(&system, &state, &next, h).unwrap();
            state = next;
        }
        sum.remainder()
    };
    let order = (remainder(16) / remainder(32)).log2();
    assert!((order - 4.0).abs() < 0.2, "{order}");
}

#[test]
fn bad_input_has_a_name() {
    let system = Pendulum { r: 0.3 };
    let start = State::from_velocity(&system, [1.0], [0.0]).unwrap();
    let end = system.by(Midpoint, 0.1).step(&start).unwrap().state;
    let nan = State { p: vector![f64::NAN], ..end };
    let far = State { q: vector![1e308], p: vector![1e308] };
    assert!(matches!(system.by(Midpoint, 0.0).ledger(&start, &end), Err(StepError::StepSize { .. })));
    assert!(matches!(EnergyLedger::of(&system, &start, &end, f64::NAN), Err(StepError::StepSize { .. })));
    for of in [&nan, &far] {
        let ledgers = [
            system.by(Midpoint, 0.1).ledger(&start, of),
            system.by(Gauss::<2>, 0.1).ledger(&start, of),
            system.by(Gauss::<2>, 0.1).ledger(of, &end),
            EnergyLedger::of(&system, &start, of, 0.1),
        ];
        for ledger in ledgers {
            assert!(
                matches!(ledger, Err(StepError::NonFinite { quantity, .. }) if quantity != Quantity::Velocity),
                "{ledger:?}"
            );
        }
    }
}

#[test]
fn the_reference_is_right_where_there_is_a_closed_form() {
    // One body of mass 1 that nothing but linear drag acts on loses ½(1 − e^{−2ct}).
    let bodies =
        Bodies { m: [1.0, 1.0], k: [0.0, 0.0], c: [0.3, 0.0, 0.2], cubic: 0.0, swirl: 0.0, pump: 0.0 };
    let start = State { q: vector![0.0, 0.0], p: vector![1.0, 0.0] };
    let [dissipated, work] = bodies.exact(0, &start, TIME);
    assert!((dissipated - 0.5 * (1.0 - (-0.6 * TIME).exp())).abs() < 1e-13 && work == 0.0);
}
