//! The action in terms of H_d⁺ and the principle in phase space (paper, section 3.2, equation (3) and the
//! display after it). With p_{k+1} tied to (q_k, q_{k+1}) by 𝔽⁺ it is the principle on configurations. With
//! q_k and p_{k+1} free the force f_d⁺ has to work along the variation of what H_d⁺ eliminates, q_{k+1}(q_k,
//! p_{k+1}):
//!
//! ```text
//! δ Σ [p_{k+1}·q_{k+1} − H_d⁺(q_k, p_{k+1})] + Σ [f_d⁻·δq_k + f_d⁺·δ(q_{k+1}(q_k, p_{k+1}))] = 0
//! ```

use dalembert::nalgebra::SVector;
use dalembert::{Discrete, Discretise, Midpoint, State, Trapezoidal, rayleigh_system};
use dalembert_tests::draws::Draws;

use super::slope;

/// Two degrees of freedom, nonlinear, with friction that depends on q and a force without potential.
struct Coupled {
    friction: f64,
    curl: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Coupled {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (1.0 + 0.3 * q[1] * q[1]) * v[0] * v[0] + 0.8 * v[1] * v[1] + 0.2 * v[0] * v[1]
            - 0.5 * q[0] * q[0]
            - (q[0] - q[1]).powi(4)
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.friction * (1.0 + q[0] * q[0]) * (0.5 * v[0] * v[0] + 0.4 * v[0] * v[1] + v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        [-self.curl * q[1], self.curl * q[0]]
    }
}

const H: f64 = 0.25;
const STEPS: usize = 4;

type Vector = SVector<f64, 2>;

/// q_0, …, q_N and p_1, …, p_N.
#[derive(Clone)]
struct Path {
    q: Vec<Vector>,
    p: Vec<Vector>,
}

impl Path {
    fn of_run<R: Copy>(system: &Coupled, rule: R, start: State<f64, 2>) -> Self
    where
        Coupled: Discrete<R, 2, Scalar = f64>,
    {
        let mut path = Self { q: vec![start.q], p: Vec::new() };
        for step in system.by(rule, H).run(start).take(STEPS) {
            let state = step.unwrap().state;
            path.q.push(state.q);
            path.p.push(state.p);
        }
        path
    }

    /// A variation that keeps the end points.
    fn variation(draws: &mut Draws) -> Self {
        let mut vectors = |count: usize| {
            (0..count).map(|_| Vector::from_fn(|_, _| draws.between(-0.5, 0.5))).collect::<Vec<_>>()
        };
        let (mut q, p) = (vectors(STEPS + 1), vectors(STEPS));
        (q[0], q[STEPS]) = (Vector::zeros(), Vector::zeros());
        Self { q, p }
    }

    fn moved(&self, delta: &Self, s: f64) -> Self {
        let add = |x: &[Vector], d: &[Vector]| x.iter().zip(d).map(|(x, d)| x + d * s).collect();
        Self { q: add(&self.q, &delta.q), p: add(&self.p, &delta.p) }
    }

    /// p_{k+1} = D2 L_d + f_d⁺ at these configurations.
    fn tied<R: Copy>(mut self, system: &Coupled, rule: R) -> Self
    where
        Coupled: Discrete<R, 2, Scalar = f64>,
    {
        let by = system.by(rule, H);
        let plus = |ends: &[Vector]| by.segment(&ends[0], &ends[1]).unwrap().legendre_plus().unwrap().p;
        self.p = self.q.windows(2).map(plus).collect();
        self
    }
}

/// H_d⁺ at (q_k, p_{k+1}) and the q_{k+1} that it eliminates, near those of `near`.
fn hamiltonian<R: Copy>(system: &Coupled, rule: R, path: &Path, near: &Path, k: usize) -> (f64, Vector)
where
    Coupled: Discrete<R, 2, Scalar = f64>,
{
    let guess = (near.q[k + 1] - near.q[k]) / H;
    let theory = system.by(rule, H).hamilton_jacobi();
    let found = theory.discrete_hamiltonian_plus(&path.q[k], &path.p[k], Some(&guess)).unwrap();
    (found.value, found.eliminated)
}

/// Σ [p_{k+1}·q_{k+1} − H_d⁺(q_k, p_{k+1})].
fn action<R: Copy>(system: &Coupled, rule: R, path: &Path, near: &Path) -> f64
where
    Coupled: Discrete<R, 2, Scalar = f64>,
{
    (0..STEPS).map(|k| path.p[k].dot(&path.q[k + 1]) - hamiltonian(system, rule, path, near, k).0).sum()
}

fn check<R: Copy>(system: &Coupled, rule: R, draws: &mut Draws)
where
    Coupled: Discrete<R, 2, Scalar = f64>,
{
    let mut small = || Vector::from_fn(|_, _| draws.between(-0.4, 0.4));
    let path = Path::of_run(system, rule, State { q: small(), p: small() });
    let delta = Path::variation(draws);
    let by = system.by(rule, H);
    let forces: Vec<_> = path.q.windows(2).map(|ends| by.discrete_force_at(&ends[0], &ends[1])).collect();

    // In value: of any configurations, with their momenta.
    let other = path.moved(&delta, 0.1).tied(system, rule);
    let lagrangians = by.hamilton_jacobi().discrete_action(&other.q);
    assert!((action(system, rule, &other, &other) - lagrangians).abs() < 1e-13);
    // Control: the momentum of another segment.
    let mut wrong = other.clone();
    wrong.p[1][0] += 0.1;
    assert!((action(system, rule, &wrong, &other) - lagrangians).abs() > 1e-4);

    // Momenta tied to configurations: the display as printed.
    let printed_work: f64 =
        (0..STEPS).map(|k| forces[k][0].dot(&delta.q[k]) + forces[k][1].dot(&delta.q[k + 1])).sum();
    let tied = slope(0.02, |s| action(system, rule, &path.moved(&delta, s).tied(system, rule), &path));
    assert!((tied + printed_work).abs() < 1e-10, "{}", tied + printed_work);

    // Both free: f_d⁺ works along what is eliminated.
    let free = slope(0.02, |s| action(system, rule, &path.moved(&delta, s), &path));
    let along: Vec<f64> = (0..STEPS)
        .map(|k| {
            slope(0.02, |s| hamiltonian(system, rule, &path.moved(&delta, s), &path, k).1.dot(&forces[k][1]))
        })
        .collect();
    let work: f64 = (0..STEPS).map(|k| forces[k][0].dot(&delta.q[k]) + along[k]).sum();
    assert!((free + work).abs() < 1e-10, "{}", free + work);
    // Control: as printed it is not 0, but for the difference of the two works of f_d⁺.
    let printed = free + printed_work;
    let difference: f64 = (0..STEPS).map(|k| forces[k][1].dot(&delta.q[k + 1]) - along[k]).sum();
    assert!((printed - difference).abs() < 1e-10);
    let acts = system.friction != 0.0 || system.curl != 0.0;
    assert_eq!(printed.abs() > 1e-5, acts, "{printed}");
}

trait ForceAt {
    fn discrete_force_at(&self, q0: &Vector, q1: &Vector) -> [Vector; 2];
}

impl<R> ForceAt for dalembert::Discretised<'_, Coupled, R, 2>
where
    Coupled: Discrete<R, 2, Scalar = f64>,
{
    /// f_d⁻ and f_d⁺.
    fn discrete_force_at(&self, q0: &Vector, q1: &Vector) -> [Vector; 2] {
        let force = self.segment(q0, q1).unwrap().discrete_force().unwrap();
        [force.minus, force.plus]
    }
}

#[test]
fn the_principle_in_phase_space_holds_with_the_eliminated_variation() {
    let mut draws = Draws::new(33);
    for _ in 0..5 {
        let system = Coupled { friction: draws.between(0.2, 0.8), curl: draws.between(0.2, 0.8) };
        check(&system, Midpoint, &mut draws);
        check(&system, Trapezoidal, &mut draws);
    }
    // Without force all readings agree.
    check(&Coupled { friction: 0.0, curl: 0.0 }, Midpoint, &mut draws);
}
