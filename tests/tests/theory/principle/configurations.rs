//! The discrete Lagrange–d'Alembert principle (paper, section 3.1) by finite variations: of L_d and f_d
//! values alone are used on the left of
//!
//! ```text
//! δ Σ L_d(q_k, q_{k+1}) + Σ [f_d⁻·δq_k + f_d⁺·δq_{k+1}]
//!     = Σ DEL(q_{k−1}, q_k, q_{k+1})·δq_k + p_N·δq_N − p_0·δq_0
//! ```

use dalembert::nalgebra::SVector;
use dalembert::{
    Discrete, Discretise, Fitted, FittedTrapezoidal, Gauss, Midpoint, OneSided, State, Trapezoidal,
    rayleigh_system,
};
use dalembert_tests::draws::Draws;

use super::slope;

/// Mass, gyroscopic term, friction and force depend on q; the force has no potential.
#[derive(Clone, Copy, Debug)]
struct Curved {
    m: [f64; 3],
    b: f64,
    k: [f64; 3],
    r: [f64; 2],
    f: [f64; 2],
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Curved {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [x, y] = q;
        0.5 * self.m[0] * (1.0 + 0.3 * y * y) * v[0] * v[0]
            + 0.5 * self.m[1] * v[1] * v[1]
            + self.m[2] * x.cos() * v[0] * v[1]
            + self.b * x * y * v[1]
            - self.k[0] * x.cos()
            - 0.5 * self.k[1] * y * y
            - self.k[2] * x * x * y
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let between = v[0] - q[0] * v[1];
        0.5 * self.r[0] * (1.0 + q[1] * q[1]) * between * between + 0.25 * self.r[1] * v[1].powi(4)
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [self.f[0] * q[1] + self.f[1] * v[1], -self.f[0] * q[0]]
    }
}

impl Curved {
    fn random(draws: &mut Draws) -> Self {
        let mut of = |low, high| draws.between(low, high);
        Self {
            m: [of(0.5, 2.0), of(0.5, 2.0), of(-0.3, 0.3)],
            b: of(-0.5, 0.5),
            k: [of(-1.0, 1.0), of(0.0, 2.0), of(-0.5, 0.5)],
            r: [of(0.1, 0.8), of(0.1, 0.8)],
            f: [of(0.3, 0.8), of(-0.5, 0.5)],
        }
    }
}

/// Constant mass and damping, which do not commute with the springs.
#[derive(Clone, Copy, Debug)]
struct Damped {
    m: [f64; 2],
    c: [f64; 3],
    k: [f64; 3],
}

#[rayleigh_system(rule = [fitted, fitted_trapezoidal, one_sided])]
impl Damped {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [a, b, quartic] = self.k;
        0.5 * (self.m[0] * v[0] * v[0] + self.m[1] * v[1] * v[1])
            - 0.5 * (a * q[0] * q[0] + b * q[1] * q[1])
            - quartic * (q[0] - q[1]).powi(4)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * (self.c[0] * v[0] * v[0] + self.c[1] * v[1] * v[1]) + self.c[2] * v[0] * v[1]
    }
}

impl Damped {
    fn random(draws: &mut Draws) -> Self {
        let mut of = |low, high| draws.between(low, high);
        Self {
            m: [of(0.5, 2.0), of(0.5, 2.0)],
            c: [of(0.5, 2.0), of(0.5, 2.0), of(0.1, 0.4)],
            k: [of(0.5, 2.0), of(0.5, 2.0), of(0.0, 0.5)],
        }
    }
}

type Points = [SVector<f64, 2>; 5];

const H: f64 = 0.3;

fn random_points(draws: &mut Draws, step: f64) -> Points {
    let mut at = SVector::from_fn(|_, _| draws.between(-0.8, 0.8));
    std::array::from_fn(|_| {
        at += SVector::from_fn(|_, _| draws.between(-step, step));
        at
    })
}

fn moved(q: &Points, delta: &Points, s: f64) -> Points {
    std::array::from_fn(|k| q[k] + delta[k] * s)
}

/// The left side of the principle and the work of the force alone, from values of L_d and f_d; (f⁻, f⁺) may
/// be changed before they do work.
fn principle<R: Copy, L>(
    system: &L,
    rule: R,
    q: &Points,
    delta: &Points,
    changed: impl Fn([SVector<f64, 2>; 2]) -> [SVector<f64, 2>; 2],
) -> f64
where
    L: Discrete<R, 2, Scalar = f64> + std::fmt::Debug,
{
    let by = system.by(rule, H);
    let action = |s: f64| {
        let q = moved(q, delta, s);
        q.windows(2).map(|ends| by.segment(&ends[0], &ends[1]).unwrap().discrete_lagrangian().unwrap()).sum()
    };
    let work: f64 = (0..4)
        .map(|k| {
            let force = by.segment(&q[k], &q[k + 1]).unwrap().discrete_force().unwrap();
            let [minus, plus] = changed([force.minus, force.plus]);
            minus.dot(&delta[k]) + plus.dot(&delta[k + 1])
        })
        .sum();
    slope(0.005, action) + work
}

/// Σ DEL·δq_k + p_N·δq_N − p_0·δq_0, by the derivatives that the rules work with.
fn residuals<R: Copy, L>(system: &L, rule: R, q: &Points, delta: &Points) -> f64
where
    L: Discrete<R, 2, Scalar = f64> + std::fmt::Debug,
{
    let by = system.by(rule, H);
    let momenta: Vec<_> = q
        .windows(2)
        .map(|ends| {
            let segment = by.segment(&ends[0], &ends[1]).unwrap();
            (segment.legendre_minus().unwrap().p, segment.legendre_plus().unwrap().p)
        })
        .collect();
    let inner: f64 = (1..4).map(|k| (momenta[k - 1].1 - momenta[k].0).dot(&delta[k])).sum();
    inner + momenta[3].1.dot(&delta[4]) - momenta[0].0.dot(&delta[0])
}

fn holds<R: Copy, L>(system: &L, rule: R, draws: &mut Draws)
where
    L: Discrete<R, 2, Scalar = f64> + std::fmt::Debug,
{
    // Any points, solution or not, and any variations, of the ends too.
    let (q, delta) = (random_points(draws, 0.4), random_points(draws, 0.5));
    let left = principle(system, rule, &q, &delta, |f| f);
    let right = residuals(system, rule, &q, &delta);
    assert!((left - right).abs() < 1e-11, "{left} {right}");
    assert!(right.abs() > 1e-3, "{right}");

    // Along a solution nothing is left of variations that keep the ends.
    let p = by_two(draws, 0.8);
    let start = State { q: q[0], p };
    let mut run = system.by(rule, H).run(start);
    let solution: Points =
        std::array::from_fn(|k| if k == 0 { start.q } else { run.next().unwrap().unwrap().state.q });
    let mut inner = delta;
    (inner[0], inner[4]) = (SVector::zeros(), SVector::zeros());
    let left = principle(system, rule, &solution, &inner, |f| f);
    assert!(left.abs() < 1e-11, "{left} of {system:?}");
    // Controls: without the force, and with another point, something is.
    assert!(principle(system, rule, &solution, &inner, |_| [SVector::zeros(); 2]).abs() > 1e-4);
    let mut bent = solution;
    bent[2][0] += 1e-3;
    assert!(principle(system, rule, &bent, &inner, |f| f).abs() > 1e-6);
}

fn by_two(draws: &mut Draws, size: f64) -> SVector<f64, 2> {
    SVector::from_fn(|_, _| draws.between(-size, size))
}

#[test]
fn finite_variations_of_the_action_give_the_discrete_equations() {
    let mut draws = Draws::new(31);
    for _ in 0..if cfg!(debug_assertions) { 2 } else { 6 } {
        let curved = Curved::random(&mut draws);
        holds(&curved, Midpoint, &mut draws);
        holds(&curved, Trapezoidal, &mut draws);
        holds(&curved, Gauss::<2>, &mut draws);
        holds(&curved, Gauss::<3>, &mut draws);
        let damped = Damped::random(&mut draws);
        holds(&damped, Fitted, &mut draws);
        holds(&damped, FittedTrapezoidal, &mut draws);
        holds(&damped, OneSided, &mut draws);
    }
}

/// The forces belong to their ends: f_d⁻ to δq_k, f_d⁺ to δq_{k+1}. Control of the same check: exchanged,
/// they do other work, by every rule whose two differ.
#[test]
fn exchanged_forces_are_seen() {
    let mut draws = Draws::new(32);
    let (curved, damped) = (Curved::random(&mut draws), Damped::random(&mut draws));
    let (q, delta) = (random_points(&mut draws, 0.4), random_points(&mut draws, 0.5));
    let exchanged = |[minus, plus]: [SVector<f64, 2>; 2]| [plus, minus];
    for (left, right) in [
        (principle(&curved, Trapezoidal, &q, &delta, exchanged), residuals(&curved, Trapezoidal, &q, &delta)),
        (principle(&curved, Gauss::<2>, &q, &delta, exchanged), residuals(&curved, Gauss::<2>, &q, &delta)),
        (principle(&damped, Fitted, &q, &delta, exchanged), residuals(&damped, Fitted, &q, &delta)),
    ] {
        assert!((left - right).abs() > 1e-4, "{left} {right}");
    }
}
