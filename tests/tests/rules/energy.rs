//! Without force the energy neither drifts nor grows over a million steps; and what "energy" means at nodes
//! and segments.

use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::{Discrete, Discretise, Midpoint, State, Trapezoidal, rayleigh_system};
use dalembert_tests::by_hand::ByHand;
use dalembert_tests::systems::{Bead, DoublePendulum, FreePendulum, Pendulum};
use differential_equations::prelude::{ExplicitRungeKutta, IVP, ODE};

/// How the energy error behaves over a run: amplitude and mean over its first and its last fifth.
#[derive(Debug)]
struct Account {
    amplitudes: [f64; 2],
    means: [f64; 2],
}

impl Account {
    fn of(energies: &[f64]) -> Self {
        let start = energies[0];
        let fifth = energies.len() / 5;
        let parts = [&energies[..fifth], &energies[energies.len() - fifth..]];
        Self {
            amplitudes: parts.map(|part| part.iter().map(|e| (e - start).abs()).fold(0.0, f64::max)),
            means: parts.map(|part| part.iter().map(|e| e - start).sum::<f64>() / fifth as f64),
        }
    }

    /// Shift of the mean over the run, in units of the amplitude at its beginning.
    fn drift(&self) -> f64 {
        (self.means[1] - self.means[0]).abs() / self.amplitudes[0]
    }

    /// Amplitude at the end in units of that at the beginning.
    fn growth(&self) -> f64 {
        self.amplitudes[1] / self.amplitudes[0]
    }
}

/// Node energies of every `stride`-th state over `steps` steps.
fn energies<S, R: Copy, const N: usize>(
    system: &S,
    rule: R,
    h: f64,
    start: State<f64, N>,
    [steps, stride]: [u64; 2],
) -> Vec<f64>
where
    S: Discrete<R, N, Scalar = f64>,
{
    let mut trajectory = system.by(rule, h).run(start);
    trajectory
        .sample_every(stride)
        .take((steps / stride) as usize)
        .map(|sample| sample.unwrap().state.energy(system).unwrap())
        .collect()
}

/// A million with optimisation.
const STEPS: u64 = if cfg!(debug_assertions) { 25_000 } else { 1_000_000 };

/// A large swing, |q| up to 2.4.
const SWING: FreePendulum = FreePendulum { m: 1.3, g: 1.0 };

fn swing_start() -> State<f64, 1> {
    State { q: vector![2.4], p: vector![0.1] }
}

#[test]
fn of_the_pendulum_is_bounded_over_many_steps_by_the_midpoint_rule() {
    let account = Account::of(&energies(&SWING, Midpoint, 0.2, swing_start(), [STEPS, 7]));
    assert!(account.drift() < 0.01 && account.growth() < 1.01, "{account:?}");
}

#[test]
fn of_the_pendulum_is_bounded_over_many_steps_by_the_trapezoidal_rule() {
    let account = Account::of(&energies(&SWING, Trapezoidal, 0.2, swing_start(), [STEPS, 7]));
    assert!(account.drift() < 0.01 && account.growth() < 1.01, "{account:?}");
}

/// The amplitude is of the rule's order, after many steps as at first.
#[test]
fn of_the_pendulum_errs_by_h_squared_over_many_steps() {
    let account = |h: f64| Account::of(&energies(&SWING, Midpoint, h, swing_start(), [STEPS, 7]));
    let [wide, narrow] = [account(0.1), account(0.05)];
    for part in 0..2 {
        let order = (wide.amplitudes[part] / narrow.amplitudes[part]).log2();
        assert!((order - 2.0).abs() < 0.15, "{order}: {wide:?} {narrow:?}");
    }
}

/// Control: a step that does not resolve the fastest motion loses the energy at once, with no friction and a
/// symplectic step. Störmer–Verlet is stable for hω < 2.
#[test]
fn of_a_spring_is_lost_where_h_does_not_resolve_it() {
    let start = State { q: vector![1.0, 0.0], p: vector![0.0, 0.0] };
    let energy = |h: f64| {
        let all = energies(&Spring { m: 1.0, k: 1.0 }, Trapezoidal, h, start, [200, 1]);
        all.iter().fold(0.0, |worst: f64, e| worst.max((e / 0.5 - 1.0).abs()))
    };
    assert!(energy(0.1) < 3e-3 && energy(2.1) > 1e50, "{:e} {:e}", energy(0.1), energy(2.1));
}

/// Two degrees of freedom, a mass matrix that depends on q: the rule is implicit.
#[test]
fn of_the_double_pendulum_is_bounded_over_many_steps() {
    let start = State::from_velocity(&DoublePendulum::FREE, [0.9, -0.4], [0.2, 0.3]).unwrap();
    let account = Account::of(&energies(&DoublePendulum::FREE, Midpoint, 0.1, start, [STEPS, 25]));
    assert!(account.drift() < 0.05 && account.growth() < 1.2, "{account:?}");
}

/// Positive control: a friction that takes one part in 10⁷ a unit of time over a million steps, or as much in
/// all over fewer, is seen as a drift.
#[test]
fn drifts_under_the_least_friction() {
    let system = Pendulum { m: 1.3, l: 1.0, g: 1.0, r: 1.3e-7 * 1e6 / STEPS as f64 };
    let account = Account::of(&energies(&system, Midpoint, 0.2, swing_start(), [STEPS, 7]));
    assert!(account.drift() > 0.1, "{account:?}");
}

/// Positive control: RK4 at the same step size is more accurate at first, but its energy error grows without
/// bound.
#[test]
fn drifts_by_runge_kutta() {
    struct Swing;
    impl ODE<f64, SMatrix<f64, 1, 2>> for Swing {
        fn diff(&self, _: f64, y: &SMatrix<f64, 1, 2>, rate: &mut SMatrix<f64, 1, 2>) {
            rate[0] = y[1];
            [rate[1]] = SWING.acceleration([y[0]], [y[1]]);
        }
    }
    let steps = 100_000;
    let start = SMatrix::<f64, 1, 2>::new(2.4, 0.1 / SWING.m);
    let solution = IVP::ode(&Swing, 0.0, 0.2 * f64::from(steps), start)
        .method(ExplicitRungeKutta::rk4(0.2).max_steps(usize::MAX))
        .solve()
        .unwrap();
    let energies: Vec<_> =
        solution.y.iter().map(|y| 0.5 * SWING.m * y[1] * y[1] - SWING.m * SWING.g * y[0].cos()).collect();
    let account = Account::of(&energies);
    assert!(account.drift() > 0.5 && account.growth() > 2.0, "{account:?}");
}

#[test]
fn at_a_node_it_is_that_of_the_velocity_which_p_stands_for() {
    let Bead { m, g, k, .. } = Bead::EXAMPLE;
    let (q, v) = (0.8_f64, 1.3_f64);
    let state = State::from_velocity(&Bead::EXAMPLE, [q], [v]).unwrap();
    let expected = 0.5 * m * (1.0 + q.cos().powi(2)) * v * v + m * g * q.sin() + 0.5 * k * q * q;
    assert!((state.energy(&Bead::EXAMPLE).unwrap() - expected).abs() < 1e-15 * 10.0);
}

#[test]
fn on_a_segment_it_is_that_of_the_points_and_the_velocity_which_the_rule_sees() {
    let Bead { m, g, k, .. } = Bead::EXAMPLE;
    let energy =
        |q: f64, v: f64| 0.5 * m * (1.0 + q.cos().powi(2)) * v * v + m * g * q.sin() + 0.5 * k * q * q;
    let (q0, q1, h) = (0.8, 1.1, 0.25);
    let v = (q1 - q0) / h;
    let midpoint = Bead::EXAMPLE.by(Midpoint, h).segment_energy(&vector![q0], &vector![q1]);
    assert!((midpoint - energy(0.5 * (q0 + q1), v)).abs() < 1e-14);
    let trapezoidal = Bead::EXAMPLE.by(Trapezoidal, h).segment_energy(&vector![q0], &vector![q1]);
    assert!((trapezoidal - 0.5 * (energy(q0, v) + energy(q1, v))).abs() < 1e-14);
    assert!((midpoint - trapezoidal).abs() > 1e-3, "the two rules see different points");
}

/// A spring of stiffness k: the midpoint rule conserves its energy exactly, at the nodes and on the segments.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn spring(q: [f64; 2], v: [f64; 2], m: f64, k: f64) -> f64 {
    0.5 * m * (v[0] * v[0] + v[1] * v[1]) - 0.5 * k * (q[0] * q[0] + q[1] * q[1])
}

/// A quadratic energy is a quadratic invariant, which the midpoint rule keeps: node energies are constant to
/// rounding over many steps, so the solver leaves no bias.
#[test]
fn of_a_linear_system_is_constant_to_rounding() {
    let system = Spring { m: 1.7, k: 0.9 };
    let start = State { q: SVector::from([1.0, -0.3]), p: SVector::from([0.2, 1.1]) };
    let steps = if cfg!(debug_assertions) { 60_000 } else { 1_000_000 };
    let account = energies(&system, Midpoint, 0.3, start, [steps, 1000]);
    let off = account.iter().map(|e| (e / account[0] - 1.0).abs()).fold(0.0, f64::max);
    // Of a million steps unbiased rounding walks √steps ε = 2e-13; a bias of ε a step would reach 2e-10.
    assert!(off < 2e-17 * steps as f64, "{off:e}");
}
