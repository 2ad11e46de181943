//! Long runs: rounding errors walk at random, they do not drift.

use dalembert::nalgebra::vector;
use dalembert::system::Scalar;
use dalembert::{Discrete, Discretise, Gauss, Midpoint, State, Trapezoidal, rayleigh_system};
use dalembert_tests::systems::FreePendulum;

#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn single(q: [f32; 1], v: [f32; 1], m: f32, k: f32) -> f32 {
    0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0]
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn double(q: [f64; 1], v: [f64; 1], m: f64, k: f64) -> f64 {
    0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0]
}

/// Starts on the circle of one energy.
const STARTS: u32 = 24;

/// Mean and root mean square, over the starts, of the relative error of the quadratic form that the rule
/// keeps exactly, in units of ε, after each of `counts` steps: p²/2m + ½kq²(1 − `share` h²k/4m).
fn errors<S, L, R: Copy>(
    system: &L,
    rule: R,
    h: S,
    [m, k]: [f64; 2],
    share: f64,
    counts: &[u64],
) -> Vec<[f64; 2]>
where
    S: Scalar,
    L: Discrete<R, 1, Scalar = S>,
{
    let form = 1.0 - share * h.widen() * h.widen() * k / (4.0 * m);
    let energy = |s: &State<S, 1>| {
        let (q, p) = (s.q[0].widen(), s.p[0].widen());
        p * p / (2.0 * m) + 0.5 * k * q * q * form
    };
    let mut sums = vec![[0.0; 2]; counts.len()];
    for start in 0..STARTS {
        let angle = 0.1 + 0.37 * f64::from(start);
        let [q, p] = [angle.cos(), angle.sin()].map(S::constant);
        let start = State { q: [q].into(), p: [p].into() };
        let first = energy(&start);
        let mut trajectory = system.by(rule, h).run(start);
        let mut taken = 0;
        for (count, sum) in counts.iter().zip(&mut sums) {
            while taken < *count {
                trajectory.next().unwrap().unwrap();
                taken += 1;
            }
            let error = (energy(trajectory.state()) / first - 1.0) / S::EPSILON.widen();
            sum[0] += error / f64::from(STARTS);
            sum[1] += error * error / f64::from(STARTS);
        }
    }
    sums.into_iter().map(|[mean, square]| [mean, square.sqrt()]).collect()
}

/// Brouwer's law: 256 times the steps, 16 times the error. A drift would make it 256.
#[test]
fn energy_errors_grow_with_the_root_of_the_number_of_steps() {
    // Without optimisation 9 times the steps, 3 times the error.
    let counts = if cfg!(debug_assertions) { [160, 1_440] } else { [1_000, 256_000] };
    let root = (counts[1] as f64 / counts[0] as f64).sqrt();
    let (m, k) = (1.3, 0.7);
    let of_f32 = Single { m: m as f32, k: k as f32 };
    let exact = [f64::from(of_f32.m), f64::from(of_f32.k)];
    for (name, rows) in [
        ("midpoint", errors(&Double { m, k }, Midpoint, 0.1, [m, k], 0.0, &counts)),
        ("trapezoidal", errors(&Double { m, k }, Trapezoidal, 0.1, [m, k], 1.0, &counts)),
        ("midpoint, f32", errors(&of_f32, Midpoint, 0.1_f32, exact, 0.0, &counts)),
        ("trapezoidal, f32", errors(&of_f32, Trapezoidal, 0.1_f32, exact, 1.0, &counts)),
    ] {
        let [[_, few], [mean, many]] = rows[..] else { unreachable!() };
        assert!((0.25 * root..4.0 * root).contains(&(many / few)), "{name}: {few} then {many} ε");
        // The mean of the walks is theirs over the root of their number; four times that is not chance.
        assert!(mean.abs() < 4.0 * many / f64::from(STARTS).sqrt(), "{name}: {mean} of {many}");
        // A step contributes about one rounding.
        assert!(many < 2.0 * (counts[1] as f64).sqrt(), "{name}: {many}");
    }
}

/// What is kept from step to step rounds the same way at each: the share of it that enters a step must be
/// small. With the last velocity for guess the mean of these walks was −1260 ε.
#[test]
fn a_kept_matrix_hardly_drifts() {
    let (m, k) = (1.3, 0.7);
    let steps = if cfg!(debug_assertions) { 8_000 } else { 2_000_000 };
    let rows = errors(&Double { m, k }, Midpoint, 0.1, [m, k], 0.0, &[steps]);
    // A drift grows as their number does, the walk of what is left with its root.
    let bound = 850.0 * (steps as f64 / 2e6).sqrt();
    assert!(rows[0][0].abs() < bound, "{rows:?}");
}

/// The control: a rounding that always falls the same way, of a step taken by hand towards zero, drifts.
#[test]
fn a_biased_rounding_would_show() {
    let (m, k, h) = (1.3, 0.7, 0.1);
    let (mut q, mut p) = (1.0_f64, 0.0_f64);
    let energy = |q: f64, p: f64| p * p / (2.0 * m) + 0.5 * k * q * q;
    let first = energy(q, p);
    let mut at = Vec::new();
    for step in 1..=256_000 {
        let v = (p - 0.5 * h * k * q) / (m + 0.25 * h * h * k);
        let force = -k * (q + 0.5 * h * v);
        // Chopped: the last place is lost, never gained.
        q = f64::from_bits((q + h * v).to_bits() & !1);
        p = f64::from_bits((p + h * force).to_bits() & !1);
        if step == 1_000 || step == 256_000 {
            at.push((energy(q, p) / first - 1.0).abs() / f64::EPSILON);
        }
    }
    assert!(at[1] / at[0] > 100.0, "{at:?}");
}

/// Angles far past 2π: the motion is that of the angle modulo 2π, to the last place of the angle.
#[test]
fn angles_past_many_turns() {
    let system = FreePendulum { m: 1.3, g: 0.9 };
    for turns in [1e3, 1e6] {
        let far = std::f64::consts::TAU * turns;
        let start = |q: f64| State { q: [q].into(), p: [3.9].into() };
        let near = system.by(Midpoint, 0.05).run(start(0.0));
        let moved = system.by(Midpoint, 0.05).run(start(far));
        for (a, b) in near.zip(moved).take(10_000) {
            let (a, b) = (a.unwrap().state, b.unwrap().state);
            // 10 000 roundings of the angle at random, which a rotation stretches linearly in time.
            assert!((b.q[0] - far - a.q[0]).abs() < 1e4 * far * f64::EPSILON, "{turns:e}");
            assert!((b.p[0] - a.p[0]).abs() < 1e4 * far * f64::EPSILON);
        }
    }
}

/// The ring of Marsden and West, without friction.
#[rayleigh_system(rule = gauss)]
fn ring(q: [f64; 2], v: [f64; 2]) -> f64 {
    let s = q[0] * q[0] + q[1] * q[1];
    0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
}

/// Root mean square over orbits of the energy error after `steps` steps.
fn energy_error(steps: usize, is_compensated: bool) -> f64 {
    let (h, orbits) = (0.02, 16);
    let square: f64 = (0..orbits)
        .map(|orbit| {
            let shift = 0.01 * f64::from(orbit);
            let start = State { q: vector![0.0, 1.15 - shift], p: vector![0.5 + 0.7 * shift, 0.3 * shift] };
            let mut state = start;
            if is_compensated {
                state = Ring {}.by(Gauss::<5>, h).run(start).take(steps).last().unwrap().unwrap().state;
            } else {
                for _ in 0..steps {
                    state = Ring {}.by(Gauss::<5>, h).step(&state).unwrap().state;
                }
            }
            let energy = |state: &State<f64, 2>| state.energy(&Ring {}).unwrap();
            (energy(&state) - energy(&start)).powi(2)
        })
        .sum();
    (square / f64::from(orbits)).sqrt()
}

#[test]
fn a_trajectory_loses_less_to_rounding_than_single_steps() {
    let steps = if cfg!(debug_assertions) { 200 } else { 20_000 };
    let (with, without) = (energy_error(steps, true), energy_error(steps, false));
    // A step adds ε|q| without compensation, and εh|v| with it.
    assert!(with < without / 4.0, "{with:e} {without:e}");
    assert!(with < 5e-15, "{with:e}");
}
