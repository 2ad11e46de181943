//! Checkers of a view follow the time: the k-th segment is that of t0 + k h.

use dalembert::exact::Exact;
use dalembert::hamilton_jacobi::Section;
use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::noether::Generator;
use dalembert::rayleigh::{Comparison, Potential, Resplit, structure};
use dalembert::samples::{Pair, segments};
use dalembert::{Discrete, Discretise, Midpoint, State, Trapezoidal, rayleigh_system};
use dalembert_tests::sections::Constant;

/// A force t.
struct Ramp;

#[rayleigh_system]
impl Ramp {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [t]
    }
}

/// Everything takes the time.
struct Swing;

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Swing {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        let inertia = 1.2 + 0.3 * t.sin();
        0.5 * (inertia * v[0] * v[0] + v[1] * v[1]) + q[0].cos() - 0.3 * q[1] * q[1] * (1.0 + 0.2 * t)
            + t * v[0] * q[1]
    }

    fn rayleigh(&self, v: [f64; 2], t: f64) -> f64 {
        0.1 * (1.0 + t * t) * (v[0] * v[0] + v[0] * v[1] + v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], v: [f64; 2], t: f64) -> [f64; 2] {
        [t.cos() + 0.1 * q[1], 0.2 * v[0] * t]
    }
}

/// Friction and a force with a curl that begin at t = ½.
struct Late;

#[rayleigh_system]
impl Late {
    fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], v: [f64; 2], t: f64) -> [f64; 2] {
        if t < 0.5 { [0.0, 0.0] } else { [-v[0] + q[1], -v[1] - q[0]] }
    }
}

#[test]
fn a_force_that_grows_with_time_moves_by_a_sixth() {
    // q″ = t + t0 from rest: q(1) = 1/6 + t0/2.
    for t0 in [0.0, 0.7, -2.0] {
        let view = Ramp.at_time(t0);
        let end = Exact::new(&view).flow(&State { q: vector![0.0], p: vector![0.0] }, 1.0).unwrap();
        assert!((end.q[0] - 1.0 / 6.0 - 0.5 * t0).abs() < 1e-15, "{end:?}");
        assert!((end.p[0] - 0.5 - t0).abs() < 1e-15, "{end:?}");
        let segment = Exact::new(&view).segment(vector![0.0], vector![1.0 / 6.0 + 0.5 * t0], 1.0).unwrap();
        assert!(segment.v0[0].abs() < 1e-14, "{segment}");
    }
}

#[test]
fn the_family_of_the_time_that_goes_on_is_the_solution() {
    // p_{k+1} = p_k + h (t_k + h/2): γ_k = γ_0 + k h t0 + (kh)²/2; with the time held it is γ_0 + k h (t0 +
    // h/2).
    let h = 0.5;
    let samples = [vector![0.3], vector![-0.8]];
    for t0 in [0.0, 0.7] {
        let view = Ramp.at_time(t0);
        let theory = view.by(Midpoint, h).hamilton_jacobi();
        let at = |k: i32| h * f64::from(k);
        let true_family: Vec<_> = (0..6).map(|k| Constant(0.2 + at(k) * t0 + 0.5 * at(k) * at(k))).collect();
        let held: Vec<_> = (0..6).map(|k| Constant(0.2 + at(k) * (t0 + 0.5 * h))).collect();
        assert!(theory.check_sections(&true_family, &samples).unwrap().is_solution());
        assert!(!theory.check_sections(&held, &samples).unwrap().is_solution());
    }
}

const H: f64 = 0.15;
const T0: f64 = 0.4;

fn start() -> State<f64, 2> {
    State { q: vector![0.4, -0.3], p: vector![0.5, 0.2] }
}

fn path<R>(rule: R, steps: usize) -> Vec<State<f64, 2>>
where
    for<'a> SwingAtTime<'a>: Discrete<R, 2, Scalar = f64>,
{
    let view = Swing.at_time(T0);
    let run = view.by(rule, H).run(start()).take(steps).map(|step| step.unwrap().state);
    std::iter::once(start()).chain(run).collect()
}

fn identities<R: Copy>(rule: R)
where
    for<'a> SwingAtTime<'a>: Discrete<R, 2, Scalar = f64>,
{
    let view = Swing.at_time(T0);
    let states = path(rule, 12);
    let q: Vec<_> = states.iter().map(|state| state.q).collect();
    for (k, q) in q.windows(3).enumerate() {
        let here = Swing.at_time(T0 + H * k as f64);
        let later = Swing.at_time(T0 + H * k as f64 + H);
        let before = here.by(rule, H).segment(&q[0], &q[1]).unwrap().momenta().unwrap();
        let after = later.by(rule, H).segment(&q[1], &q[2]).unwrap().momenta().unwrap();
        let residual = before.p1 - after.p0;
        assert!(residual.amax() < 1e-14, "{k}: {residual}");
        let step = here.by(rule, H).step_configurations(&q[0], &q[1]).unwrap();
        assert!((step.state.q - q[2]).amax() < 1e-13, "{k}");
    }
    let noether = view.by(rule, H).noether();
    let generator = Generator::rotation(0, 1) + Generator::translation("x", [1.0, 0.0]);
    let run = view.by(rule, H).run(start());
    let account = noether.balance(&generator, &start(), run.take(200)).unwrap();
    assert!(account.is_balanced() && account.worst_step.0 < 1e-13, "{account}");
    let judged = noether.symmetry(&generator, &Pair::along(&q)).unwrap();
    assert!(judged.is_consistent() && !judged.is_conserved(), "{judged}");

    let theory = view.by(rule, H).hamilton_jacobi();
    let along = theory.along_trajectory(&q).unwrap();
    assert!(along.trajectory.unwrap().holds() && along.right_minus.corrected.unwrap().holds(), "{along}");
    assert!(along.example_minus.corrected.unwrap().holds() && !along.net_force.unwrap().holds(), "{along}");
    let hamilton = theory.hamilton_equations(&q).unwrap();
    assert!(hamilton.right_momentum.corrected.unwrap().holds(), "{hamilton}");
    assert!(hamilton.left_momentum.corrected.unwrap().holds(), "{hamilton}");
    assert!(hamilton.left_configuration.corrected.unwrap().holds(), "{hamilton}");

    // A section that is carried is a trajectory of the view, and its sections are a solution.
    let section = Plane { slope: SMatrix::<f64, 2, 2>::new(0.3, 0.1, 0.1, -0.2), at: start() };
    let carried = theory.carry(&section, &start().q, 12).unwrap();
    for (carried, state) in carried.states.iter().zip(&states) {
        assert!((carried.q - state.q).amax() < 1e-12 && (carried.p - state.p).amax() < 1e-12);
    }
    let report = theory.characteristics_report(&[carried]).unwrap();
    assert!(report.balance.unwrap().holds(), "{report}");
    let action: f64 = q
        .windows(2)
        .enumerate()
        .map(|(k, q)| {
            let here = Swing.at_time(T0 + H * k as f64);
            here.by(rule, H).segment(&q[0], &q[1]).unwrap().discrete_lagrangian().unwrap()
        })
        .sum();
    assert!((theory.discrete_action(&q) - action).abs() < 1e-13);
}

/// γ(q) = p + slope (q − q0).
struct Plane {
    slope: SMatrix<f64, 2, 2>,
    at: State<f64, 2>,
}

impl Section<2> for Plane {
    type Scalar = f64;

    fn covector(&self, q: &SVector<f64, 2>) -> SVector<f64, 2> {
        self.at.p + self.slope * (q - self.at.q)
    }

    fn jacobian(&self, _q: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
        self.slope
    }
}

#[test]
fn identities_hold_along_trajectories_of_timed_systems() {
    identities(Midpoint);
    identities(Trapezoidal);
}

#[test]
fn what_begins_later_is_seen() {
    let h = 0.1;
    let samples = segments([-1.0; 2], [1.0; 2], [0.1; 2], 12);
    let view = Late.at_time(0.0);
    let along = Generator::translation("x", [1.0, 0.0]);
    // Five segments before t = ½ see nothing yet.
    for (count, is_free) in [(4, true), (12, false)] {
        let samples = &samples[..count];
        let judged = view.by(Midpoint, h).noether().symmetry(&along, samples).unwrap();
        assert_eq!(judged.is_conserved(), is_free, "{judged}");
        assert_eq!(structure(&view, Midpoint, h, samples).unwrap().is_rayleigh(), is_free);
        let base = Pair::new([0.1; 2], [0.0; 2]);
        assert_eq!(Potential::new(&view, Midpoint, h, base).check(samples).unwrap().exists(), is_free);
        assert_eq!(Resplit::new(&view, Midpoint, h, [0.1; 2]).check(samples).unwrap().exists(), is_free);
        let other = Late.at_time(-100.0);
        let compared = Comparison::new((&view, Midpoint), (&other, Midpoint), h, [0.1; 2]);
        assert_eq!(compared.check(samples).unwrap().is_gauge(), is_free);
    }
}
