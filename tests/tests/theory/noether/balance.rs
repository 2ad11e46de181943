//! J_N − J_0 = Σ ξ(L_d) + Σ f_d(ξ) along every trajectory, to rounding, whether J is conserved or not.

use dalembert::noether::{Balance, Generator};
use dalembert::{Discrete, Discretise, Midpoint, State, Trapezoidal, rayleigh_system};

/// The ring potential, tilted: no rotation is a symmetry.
#[derive(Clone, Copy)]
struct Tilted {
    k: f64,
    tilt: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Tilted {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2) - self.tilt * q[0]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

const STEPS: usize = if cfg!(debug_assertions) { 3_000 } else { 20_000 };

fn balance<R: Copy>(system: &Tilted, of: &Tilted, rule: R, steps: usize) -> Balance
where
    Tilted: Discrete<R, 2, Scalar = f64>,
{
    let start = State::from_velocity(system, [0.3, 1.05], [0.5, 0.1]).unwrap();
    let mut trajectory = system.by(rule, 0.1).run(start);
    of.by(rule, 0.1)
        .noether()
        .balance(&Generator::rotation(0, 1), &start, trajectory.by_ref().take(steps))
        .unwrap()
}

fn account_closes<R: Copy>(rule: R)
where
    Tilted: Discrete<R, 2, Scalar = f64>,
{
    let system = Tilted { k: 0.01, tilt: 0.2 };
    let account = balance(&system, &system, rule, STEPS);
    assert!(account.is_balanced(), "{account}");
    // The bound is sharp enough to mean something, and both causes took part.
    assert!(account.tolerance < 1e-8, "{account}");
    assert!(
        account.accumulated.lagrangian.abs() > 1e-2 && account.accumulated.force.abs() > 1e-2,
        "{account}"
    );
    assert!(account.worst_step.0 < 1e-13, "{account}");
}

#[test]
fn the_account_closes_to_rounding() {
    account_closes(Midpoint);
    account_closes(Trapezoidal);
}

/// The momentum of a symmetry is kept to rounding over a long run, that of the drag decays.
#[test]
fn without_tilt_and_drag_nothing_is_accumulated() {
    let free = Tilted { k: 0.0, tilt: 0.0 };
    let account = balance(&free, &free, Midpoint, STEPS);
    assert!((account.end - account.start).abs() < 1e-12, "{account}");
    let damped = Tilted { k: 0.01, tilt: 0.0 };
    let account = balance(&damped, &damped, Midpoint, 5_000);
    // e^{−kT} = e^{−5}.
    assert!(account.end.abs() < 1e-2 * account.start.abs(), "{account}");
    assert!(account.is_balanced(), "{account}");
}

/// Positive control: the account of another system, friction off by 1e-6 of itself, does not close.
#[test]
fn the_account_of_another_system_does_not_close() {
    let system = Tilted { k: 0.01, tilt: 0.2 };
    let other = Tilted { k: 0.01 * (1.0 + 1e-6), tilt: 0.2 };
    let account = balance(&system, &other, Midpoint, STEPS);
    assert!(!account.is_balanced(), "{account}");
    assert!(account.to_string().contains("OUTSIDE"), "{account}");
}

/// Two stretches add up to the whole.
#[test]
fn stretches_add() {
    let system = Tilted { k: 0.01, tilt: 0.2 };
    let whole = balance(&system, &system, Midpoint, 300);
    let start = State::from_velocity(&system, [0.3, 1.05], [0.5, 0.1]).unwrap();
    let mut trajectory = system.by(Midpoint, 0.1).run(start);
    let noether = system.by(Midpoint, 0.1).noether();
    let rotation = Generator::rotation(0, 1);
    let first = noether.balance(&rotation, &start, trajectory.by_ref().take(100)).unwrap();
    let middle = *trajectory.state();
    let second = noether.balance(&rotation, &middle, trajectory.by_ref().take(200)).unwrap();
    let sum = first + second;
    assert_eq!((sum.steps, sum.end), (whole.steps, whole.end));
    assert_eq!(sum.worst_step, whole.worst_step);
    assert!((sum.accumulated.total() - whole.accumulated.total()).abs() < 1e-14);
}
