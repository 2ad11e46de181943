//! The complete solution of the damped oscillator: λ_0 as a function of (q, p, k) is a constant of motion,
//! ∂S/∂λ_0 is not; the k-step pair (L, R) in closed form gives k steps at once.

use dalembert::nalgebra::vector;
use dalembert::{Discretise, Midpoint, State};
use dalembert_tests::damped_oscillator::{CompleteSolution, DAMPED, H, Oscillator, UNDAMPED};

fn states(system: &Oscillator, [q, p]: [f64; 2], steps: usize) -> Vec<(f64, f64)> {
    let mut state = State { q: vector![q], p: vector![p] };
    let mut states = vec![(state.q[0], state.p[0])];
    for _ in 0..steps {
        state = system.by(Midpoint, H).step(&state).unwrap().state;
        states.push((state.q[0], state.p[0]));
    }
    states
}

/// λ_0(q, p, k): p = s_k q + λ_k solved for λ_0.
fn lambda_0(closed: &CompleteSolution, k: usize, (q, p): (f64, f64)) -> f64 {
    (p - closed.s(k) * q) * closed.angle(k).cos() / (closed.delta.powf(k as f64 / 2.0) * closed.phase.cos())
}

/// ∂S_k/∂λ_0 at q, up to a function of k and λ_0 alone.
fn by_lambda_0(closed: &CompleteSolution, k: usize, q: f64) -> f64 {
    closed.delta.powf(k as f64 / 2.0) * closed.phase.cos() / closed.angle(k).cos() * q
}

#[test]
fn lambda_0_is_a_constant_of_motion() {
    for system in [DAMPED, UNDAMPED] {
        let closed = CompleteSolution::new(&system, H, -0.2, 1.0);
        let states = states(&system, [0.4, 0.9], 60);
        let initial = lambda_0(&closed, 0, states[0]);
        for (k, state) in states.iter().enumerate() {
            let drift = lambda_0(&closed, k, *state) - initial;
            // Divided by the shrinking δ^{k/2}, the rounding of q and p grows by its inverse.
            assert!(
                drift.abs() < 1e-14 * (k + 1) as f64 / closed.delta.powf(k as f64 / 2.0),
                "k = {k}: {drift}"
            );
        }
        // Positive control: the same with k one off is no constant.
        assert!((lambda_0(&closed, 1, states[0]) - initial).abs() > 1e-2);
    }
}

/// The additive constant of S_k may depend on λ_0, so that two trajectories with the same λ_0 are compared:
/// if ∂S/∂λ_0 were a constant of motion, so would be its difference. It is δ^k times what it was.
#[test]
fn the_derivative_by_the_parameter_is_constant_only_where_no_force_acts() {
    for system in [DAMPED, UNDAMPED] {
        let closed = CompleteSolution::new(&system, H, -0.2, 0.7);
        let difference = |k: usize, [a, b]: [f64; 2]| by_lambda_0(&closed, k, a) - by_lambda_0(&closed, k, b);
        let [a, b] = [0.4, -1.1].map(|q| states(&system, [q, closed.s(0) * q + closed.lambda(0)], 30));
        let initial = difference(0, [a[0].0, b[0].0]);
        for k in 0..=30 {
            let ratio = difference(k, [a[k].0, b[k].0]) / initial;
            let near_caustic = 1.0 / closed.angle(k).cos().abs();
            assert!((ratio - closed.delta.powi(k as i32)).abs() < 1e-14 * (k + 1) as f64 * near_caustic);
        }
    }
    // Where force acts it falls to a twentieth within thirty steps; without, δ = 1.
    let delta = |system| CompleteSolution::new(system, H, 0.0, 0.0).delta;
    assert!(delta(&DAMPED).powi(30) < 0.05);
    assert_eq!(delta(&UNDAMPED), 1.0);
}

/// k steps at once: L = ½ω cot(kθ)(q0² + q_k²) − ω cosh(kκ)/sin(kθ) q0 q_k,
/// R = (r/4)(q0² + q_k²) − ω sinh(kκ)/sin(kθ) q0 q_k, e^{−2κ} = δ; the momenta are p0 = −D1(L + R), p_k =
/// D2(L − R).
#[test]
fn the_closed_k_step_pair_has_the_momenta_of_k_steps() {
    let closed = CompleteSolution::new(&DAMPED, H, 0.0, 0.0);
    let states = states(&DAMPED, [0.4, 0.9], 24);
    let (q0, p0) = states[0];
    let kappa = -0.5 * closed.delta.ln();
    let pair = |k: usize, sign: f64| {
        let n = k as f64;
        let (sin, cot) = ((n * closed.theta).sin(), 1.0 / (n * closed.theta).tan());
        let (qk, pk) = states[k];
        let cosh = closed.omega * (n * kappa).cosh() / sin;
        let sinh = sign * closed.omega * (n * kappa).sinh() / sin;
        let d1 = closed.omega * cot * q0 - cosh * qk + DAMPED.r / 2.0 * q0 - sinh * qk;
        let d2 = closed.omega * cot * qk - cosh * q0 - DAMPED.r / 2.0 * qk + sinh * q0;
        ((-d1 - p0).abs().max((d2 - pk).abs()), 1.0 + cot.abs() + cosh.abs() + sinh.abs())
    };
    for k in 1..=24 {
        let (miss, size) = pair(k, 1.0);
        assert!(miss < 1e-14 * k as f64 * size, "k = {k}: {miss}");
        // Positive control: the other sign of sinh misses.
        assert!(pair(k, -1.0).0 > 1e-2, "k = {k}: {}", pair(k, -1.0).0);
    }
}
