//! The rules fitted to linear damping, where it is stiff: stability, and the orders that are left.

use dalembert::nalgebra::{Matrix2, vector};
use dalembert::step::Linearizable;
use dalembert::{Discrete, Discretise, Fitted, FittedTrapezoidal, Midpoint, State, rayleigh_system};

/// ∂(q1, p1)/∂(q0, p0) of the oscillator at rest, m = 1, h = 1.
fn at_rest<R: Copy>(rule: R, z: f64, stiffness: f64) -> Matrix2<f64>
where
    Oscillator: Linearizable<R, 1, Scalar = f64>,
{
    let system = Oscillator { k: stiffness, r: 2.0 * z };
    let rest = vector![0.0];
    system.by(rule, 1.0).segment(&rest, &rest).unwrap().linearized().unwrap().by_state().unwrap().assembled()
}

/// The largest modulus of the eigenvalues of the step of m q̈ + r q̇ + k q = 0.
fn radius<R: Copy>(rule: R, z: f64, stiffness: f64) -> f64
where
    Oscillator: Linearizable<R, 1, Scalar = f64>,
{
    let a = at_rest(rule, z, stiffness);
    let (mean, det) = (0.5 * a.trace(), a.determinant());
    let square = mean * mean - det;
    if square < 0.0 { det.sqrt() } else { mean.abs() + square.sqrt() }
}

/// An oscillator of mass 1.
#[rayleigh_system(rule = [midpoint, fitted, fitted_trapezoidal])]
fn oscillator(q: [f64; 1], v: [f64; 1], k: f64, r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// Stable for every h: no eigenvalue of the oscillator's step is above 1, over 12 decades of damping and of
/// stiffness. With damping alone stiff, the eigenvalue of the fast motion goes to 0 (L-stable); midpoint's
/// goes to −1.
#[test]
fn the_implicit_one_is_stable_at_any_step() {
    let mut unstable = 0;
    for i in -24..=24 {
        for j in -24..=24 {
            let (z, stiffness) = (10.0_f64.powf(0.25 * f64::from(i)), 10.0_f64.powf(0.25 * f64::from(j)));
            let radius_of_fitted = radius(Fitted, z, stiffness);
            // A double eigenvalue feels the root of the rounding.
            assert!(radius_of_fitted <= 1.0 + 1e-7, "{z:e} {stiffness:e}: {radius_of_fitted}");
            unstable += u32::from(radius(FittedTrapezoidal, z, stiffness) > 1.0 + 1e-7);
        }
    }
    // The control: the explicit one is not.
    assert!(unstable > 200, "{unstable}");

    // The eigenvalue of the fast motion: the determinant over the one next to 1.
    let fast = |a: Matrix2<f64>| {
        a.determinant() / (0.5 * a.trace() + (0.25 * a.trace().powi(2) - a.determinant()).sqrt())
    };
    for z in [1e2, 1e4, 1e6] {
        assert!(fast(at_rest(Fitted, z, 0.7)).abs() < 1e-3 / z);
        let by_midpoint = at_rest(Midpoint, z, 0.7);
        assert!((by_midpoint.determinant() + 1.0).abs() < 3.0 / z, "{}", by_midpoint.determinant());
    }
}

/// A mass in a potential as stiff as its damping, r q̇ = −V′ in the limit: V = r(1 − cos q).
#[rayleigh_system(rule = [fitted, fitted_trapezoidal])]
fn creeping(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + r * q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// Errors of q and p at time 1 in the limit r → ∞, where tan(q/2) = tan(q0/2) e^{−t} and p = −sin q.
fn creep<R: Copy>(rule: R, h: f64) -> [f64; 2]
where
    Creeping: Discrete<R, 1, Scalar = f64>,
{
    let (system, q) = (Creeping { r: 1e9 }, 1.1_f64);
    let start = State { q: vector![q], p: vector![-q.sin()] };
    let end = system.by(rule, h).run(start).take((1.0 / h).round() as usize).last().unwrap().unwrap().state;
    let exact = 2.0 * ((0.5 * q).tan() * f64::exp(-1.0)).atan();
    [end.q[0] - exact, end.p[0] + exact.sin()]
}

/// In the stiff limit q keeps order 2 and p falls to order 1, lagging by half a step: p1 = −(m/r) V′(q̄). By
/// the explicit one both are of order 1.
#[test]
fn orders_in_the_stiff_limit() {
    let order = |rule: fn(f64) -> [f64; 2], of: usize| {
        let [a, b] = [1.0 / 64.0, 1.0 / 128.0].map(|h| rule(h)[of].abs());
        (a / b).log2()
    };
    let implicit = |h| creep(Fitted, h);
    let explicit = |h| creep(FittedTrapezoidal, h);
    assert!((order(implicit, 0) - 2.0).abs() < 0.1, "{}", order(implicit, 0));
    for order in [order(implicit, 1), order(explicit, 0), order(explicit, 1)] {
        assert!((order - 1.0).abs() < 0.1, "{order}");
    }

    let system = Creeping { r: 1e9 };
    let start = State { q: vector![1.1], p: vector![-0.3] };
    let end = system.by(Fitted, 0.1).step(&start).unwrap().state;
    let mean = 0.5 * (start.q[0] + end.q[0]);
    assert!((end.p[0] + mean.sin()).abs() < 1e-8, "{} {}", end.p[0], -mean.sin());
    assert!((end.p[0] + end.q[0].sin()).abs() > 1e-2);
}

/// q1 and p1 in the stiff limit r → ∞ of one mass with ℒ and φ = 1 + zℒ given: a family of rules of which 1
/// is backward Euler, 0 midpoint.
fn family(lag: f64, share_of_potential: f64, [q, p]: [f64; 2], h: f64, r: f64) -> [f64; 2] {
    let z = 0.5 * r * h;
    let phi = 1.0 + z * lag;
    let (mut v, force) = (0.0_f64, |q: f64| -r * q.sin());
    for _ in 0..50 {
        let mean = q + 0.5 * h * v;
        let weight = 0.5 * h * (1.0 + share_of_potential);
        let residual = (phi + z) * v - weight * force(mean) - p;
        v -= residual / ((phi + z) + weight * 0.5 * h * r * mean.cos());
    }
    let impulse = 0.5 * h * (1.0 - share_of_potential) * force(q + 0.5 * h * v);
    [q + h * v, (phi - z) * v + impulse]
}

/// The term −hℒV of R_d is essential: without it q is of order 1 in the stiff limit. With it the rule is
/// `Fitted`, to rounding.
#[test]
fn the_lag_of_the_potential_is_essential() {
    let (r, q) = (1e6, 1.1_f64);
    let exact = 2.0 * ((0.5 * q).tan() * f64::exp(-1.0)).atan();
    let error = |with: bool, h: f64| {
        let z: f64 = 0.5 * r * h;
        let lag = 1.0 / z.tanh() - 1.0 / z;
        let mut state = [q, -q.sin()];
        for _ in 0..(1.0 / h).round() as usize {
            state = family(lag, if with { lag } else { 0.0 }, state, h, r);
        }
        (state[0] - exact).abs()
    };
    let order = |with| (error(with, 1.0 / 32.0) / error(with, 1.0 / 64.0)).log2();
    assert!((order(true) - 2.0).abs() < 0.1, "{}", order(true));
    assert!((order(false) - 1.0).abs() < 0.1, "{}", order(false));

    for r in [0.5, 20.0] {
        let z: f64 = 0.5 * r * 0.3;
        let lag = 1.0 / z.tanh() - 1.0 / z;
        let start = State { q: vector![1.1], p: vector![-0.3] };
        let end = Creeping { r }.by(Fitted, 0.3).step(&start).unwrap().state;
        let expected = family(lag, lag, [1.1, -0.3], 0.3, r);
        assert!(
            (end.q[0] - expected[0]).abs() < 1e-14 && (end.p[0] - expected[1]).abs() < 1e-13,
            "{end:?} {expected:?}"
        );
    }
    // A free mass: ℒ = 0 is midpoint, (1 − z)/(1 + z), and ℒ = 1 backward Euler, 1/(1 + 2z).
    for (lag, ratio) in [(0.0, (1.0 - 3.0) / 4.0), (1.0, 1.0 / 7.0)] {
        let z = 3.0;
        let phi = 1.0 + z * lag;
        assert!(f64::abs((phi - z) / (phi + z) - ratio) < 1e-15);
    }
}
