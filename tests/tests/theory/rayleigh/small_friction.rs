//! Small friction: (L_d, ε R_d) for ε → 0.
//!
//! At ε = 0 the step is symplectic, and keeps a modified energy Ẽ but for what is exponentially small in 1/h.
//! Friction is a kick of ε f_d⁻ at the start of a step and of ε f_d⁺ at its end. A kick δp changes Ẽ by
//! q̇ δp, q̇ along the motion of Ẽ through the q_k, so that Ẽ goes at the mean rate of
//!
//! ```text
//! ε f_d⁻(q_k, q_{k+1})·q̇_k + ε f_d⁺(q_k, q_{k+1})·q̇_{k+1}     over the steps without friction,
//! ```
//!
//! a discrete Melnikov function, up to O(ε²): without a term h^p/ε. Where it changes sign there is a limit
//! cycle for small ε, h^p off that of the motion however small ε. A method that is not symplectic at ε = 0
//! has its own drift beside ε, and no limit.

use std::convert::Infallible;

use dalembert::nalgebra::vector;
use dalembert::{Discretise, Midpoint};
use dalembert_tests::limit_cycle::{LimitCycle, bisected, weighted_mean};

/// Half of the points that q̇ is a difference of, to order 32.
const HALF: usize = 16;

/// q̇ h at each of the points but the first and last few: by differences.
fn velocities(q: &[f64]) -> Vec<f64> {
    let n = HALF as f64;
    let mut weight = n / (n + 1.0);
    let mut weights = Vec::new();
    for j in 1..=HALF {
        weights.push(weight);
        let j = j as f64;
        weight *= -j * (n - j) / ((j + 1.0) * (n + j + 1.0));
    }
    let difference = |k: usize| {
        let terms = weights.iter().enumerate();
        terms.map(|(j, weight)| weight * (q[k + j + 1] - q[k - j - 1])).sum()
    };
    (HALF..q.len() - HALF).map(difference).collect()
}

/// The discrete Melnikov function by the midpoint rule from (`amplitude`, 0), and the mean energy.
fn melnikov(amplitude: f64, h: f64) -> [f64; 2] {
    let free = LimitCycle { epsilon: 0.0 };
    let mut states = vec![[amplitude, 0.0]];
    for k in 0..(60.0 / h) as usize {
        states.push(free.step(Midpoint, h, states[k]).unwrap());
    }
    let q: Vec<_> = states.iter().map(|state| state[0]).collect();
    let velocities = velocities(&q);
    let excited = LimitCycle { epsilon: 1.0 };
    let by = excited.by(Midpoint, h);
    let power = velocities.windows(2).zip(q[HALF..].windows(2)).map(|(v, q)| {
        let f = by.discrete_force(&vector![q[0]], &vector![q[1]]);
        f.minus[0] * v[0] + f.plus[0] * v[1]
    });
    let energies: Vec<_> = states.iter().map(|state| LimitCycle::energy_of(*state)).collect();
    [weighted_mean(&power.collect::<Vec<_>>()), weighted_mean(&energies)]
}

/// The mean energy of the rule's cycle as ε → 0.
fn limit(h: f64) -> f64 {
    let amplitude = bisected(|amplitude| melnikov(amplitude, h)[0], [1.5, 3.0]);
    melnikov(amplitude, h)[1]
}

fn of_midpoint(epsilon: f64, h: f64) -> f64 {
    let excited = LimitCycle { epsilon };
    excited.mean_energy(h, |state| excited.step(Midpoint, h, state)).unwrap()
}

fn of_runge_kutta(epsilon: f64, h: f64) -> f64 {
    let excited = LimitCycle { epsilon };
    excited.mean_energy(h, |state| Ok::<_, Infallible>(excited.runge_kutta(h, state))).unwrap()
}

#[test]
fn the_cycle_has_a_limit_where_the_discrete_melnikov_function_changes_sign() {
    let exact = LimitCycle::energy_without_friction();
    let [coarse, fine] = [0.2, 0.1].map(limit);
    for epsilon in [0.1, 0.01] {
        for (h, limit) in [(0.2, coarse), (0.1, fine)] {
            let found = of_midpoint(epsilon, h);
            assert!((found - limit).abs() < 5e-4, "ε = {epsilon}, h = {h}: {found} {limit}");
            // Positive control: it is not the limit of the motion.
            assert!((found - exact).abs() > 0.1);
        }
    }
    // Which is h² off that of the motion, and no more.
    let order = ((coarse - exact) / (fine - exact)).log2();
    assert!((order - 2.0).abs() < 0.2, "{order}");
}

/// Without a symplectic step at ε = 0 there is no limit: by Runge–Kutta 4 the cycle shrinks with ε/h⁵.
#[test]
fn the_cycle_of_runge_kutta_goes_with_the_friction() {
    let exact = LimitCycle::energy_without_friction();
    let off = [0.1, 0.01, 0.001].map(|epsilon| exact - of_runge_kutta(epsilon, 0.2));
    // At ε = 0.1 its order shows: it is nearer than the midpoint rule. At 0.001 half of the energy is gone.
    assert!(off[0] < 0.1 && of_midpoint(0.1, 0.2) - exact > 0.7, "{off:?}");
    assert!(off[1] > 0.6 && off[2] > 2.5, "{off:?}");
    // Its own drift does it: without friction it takes energy, and the midpoint rule takes none.
    let free = LimitCycle { epsilon: 0.0 };
    let lost = |step: &dyn Fn([f64; 2]) -> [f64; 2]| {
        let energies =
            |from: [f64; 2]| std::iter::successors(Some(from), |state| Some(step(*state))).take(500);
        let mean = |from| energies(from).map(LimitCycle::energy_of).collect::<Vec<_>>();
        let late = energies([2.0, 0.0]).last().unwrap();
        weighted_mean(&mean([2.0, 0.0])) - weighted_mean(&mean(late))
    };
    assert!(lost(&|state| free.runge_kutta(0.2, state)) > 0.1);
    assert!(lost(&|state| free.step(Midpoint, 0.2, state).unwrap()).abs() < 1e-3);
}
