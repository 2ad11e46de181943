//! The stationary Hamilton–Jacobi equation: S* of the damped pendulum by the trapezoidal rule.

use std::f64::consts::{PI, TAU};

use dalembert::hamilton_jacobi::{Jet, StationaryError, StationarySolution};
use dalembert::nalgebra::vector;
use dalembert::rayleigh::ProportionalSplit;
use dalembert::{Discretise, FittedTrapezoidal, Trapezoidal, rayleigh_system, samples};

/// V = −cos q + tilt q, R = a v².
#[rayleigh_system(rule = [trapezoidal, fitted_trapezoidal])]
fn pendulum(q: [f64; 1], v: [f64; 1], a: f64, tilt: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos() - tilt * q[0], a * v[0] * v[0])
}

/// The pendulum in single precision.
#[rayleigh_system(rule = trapezoidal)]
fn single(q: [f32; 1], v: [f32; 1], a: f32) -> (f32, f32) {
    (0.5 * v[0] * v[0] + q[0].cos(), a * v[0] * v[0])
}

const A: f64 = 0.25;
const H: f64 = 0.2;
const DAMPED: Pendulum = Pendulum { a: A, tilt: 0.0 };

/// c on paper.
fn factor(a: f64) -> f64 {
    (1.0 - a * H) / (1.0 + a * H)
}

fn split(system: &Pendulum, h: f64) -> ProportionalSplit<'_, Pendulum, Trapezoidal, 1> {
    let by = system.by(Trapezoidal, h);
    let proportion = by.proportion(&samples::segments([-3.0], [3.0], [0.3], 20)).unwrap();
    by.proportional_split(&proportion, [0.0]).unwrap()
}

fn solution(system: &Pendulum, points: usize) -> StationarySolution {
    split(system, H).stationary_equation(TAU, points).unwrap().solve().unwrap()
}

/// An S_0.
type Start = fn(f64) -> Jet;

/// S_0 = 0.
fn zero(_q: f64) -> Jet {
    Jet::default()
}

/// S_0 without the pendulum's symmetry, least upright: 0.3 there.
fn skew(q: f64) -> Jet {
    let ((s, c), factor) = (q.sin_cos(), 0.4 + 0.3 * q.sin());
    Jet { value: 0.3 + (1.0 + c) * factor, slope: -s * factor + 0.3 * (1.0 + c) * c }
}

/// S_0 that is least elsewhere.
fn rough(q: f64) -> Jet {
    Jet { value: q.sin() + 0.3 * (2.0 * q).cos(), slope: q.cos() - 0.6 * (2.0 * q).sin() }
}

/// A step on paper: p = v̄ + ah v̄ + (h/2) sin q at its start, v̄ − ah v̄ − (h/2) sin q at its end.
fn step(a: f64, [q, p]: [f64; 2]) -> [f64; 2] {
    let v = (p - 0.5 * H * q.sin()) / (1.0 + a * H);
    let q = q + H * v;
    [q, (1.0 - a * H) * v - 0.5 * H * q.sin()]
}

/// Slope p/q of the eigenvector of the step's derivative upright, with the larger or the smaller eigenvalue.
fn direction(a: f64, is_unstable: bool) -> f64 {
    let e = 1e-6;
    let column = |by: [f64; 2]| {
        let [plus, minus] = [1.0, -1.0].map(|sign| step(a, [PI + sign * by[0], sign * by[1]]));
        [0, 1].map(|i| (plus[i] - minus[i]) / (2.0 * e))
    };
    let ([a, c], [b, d]) = (column([e, 0.0]), column([0.0, e]));
    let root = (0.25 * (a - d) * (a - d) + b * c).sqrt();
    (0.5 * (d - a) + if is_unstable { root } else { -root }) / b
}

/// p at q > π of the unstable manifold of the upright position: the step of a tiny displacement along the
/// eigenvector that ends there, by bisection.
fn unstable(a: f64, q: f64) -> f64 {
    let slope = direction(a, true);
    let run = |by: f64, steps: usize| (0..steps).fold([PI + by, by * slope], |state, _| step(a, state));
    let steps = (1..).find(|&steps| run(1e-6, steps)[0] > q).unwrap();
    let [mut low, mut high] = [0.0, 1e-6];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *if run(middle, steps)[0] > q { &mut high } else { &mut low } = middle;
    }
    run(low, steps)[1]
}

#[test]
fn the_ratio_of_contraction_is_c() {
    let split = split(&DAMPED, H);
    let equation = split.stationary_equation(TAU, 64).unwrap();
    let ratios = |start: Start| {
        let s: Vec<_> = equation.iterates(start).take(43).collect();
        let change = move |k: usize| s[k + 1].distance(&s[k]);
        move |k: usize| change(k + 1) / change(k)
    };
    for (name, start) in [("0", zero as Start), ("skew", skew)] {
        let ratio = ratios(start);
        for k in [20, 40] {
            assert!((ratio(k) - factor(A)).abs() < 1e-10, "{name}, k = {k}: {}", ratio(k));
            // Positive control: the factor of the exact motion is seen to be another.
            assert!((ratio(k) - (-2.0 * A * H).exp()).abs() > 1e-5);
        }
    }
    // Of a start that is least elsewhere it is less for a while. The grid's points miss some of a sup.
    let ratio = ratios(rough);
    assert!((0..40).all(|k| ratio(k) < factor(A) + 5e-3) && ratio(20) < factor(A) - 0.03);
    for a in [0.02, 1.0] {
        let found = solution(&Pendulum { a, ..DAMPED }, 64);
        assert!((found.ratio - factor(a)).abs() < 1e-10, "{a}: {}", found.ratio);
    }
}

#[test]
fn s_k_goes_to_one_s_as_c_to_the_k_from_any_start() {
    let split = split(&DAMPED, H);
    let equation = split.stationary_equation(TAU, 64).unwrap();
    let [first, second] =
        [equation.solve().unwrap(), equation.solve_from(rough).unwrap()].map(|found| found.function);
    assert!(first.distance(&second) < 2e-12, "{:e}", first.distance(&second));
    for (start, constant) in [(zero as Start, 2.1), (skew, 2.1 + 0.3)] {
        let s: Vec<_> = equation.iterates(start).take(61).collect();
        for k in [30, 60] {
            // Upright S* = G(π, π)/(1 − c) = −2.1, and nowhere is S_k further from it.
            let of_power = |c: f64| s[k].distance(&first) / c.powi(k as i32);
            assert!((of_power(factor(A)) - constant).abs() < 1e-7, "k = {k}: {}", of_power(factor(A)));
            assert!((of_power((-2.0 * A * H).exp()) - constant).abs() > 1e-3);
        }
        // Positive control: before the limit the two are apart.
        assert!(s[20].distance(&first) > 0.1);
    }
}

#[test]
fn the_graph_of_the_differential_is_backward_invariant() {
    let found = solution(&DAMPED, 128);
    let system = DAMPED;
    let by = system.by(Trapezoidal, H);
    let forward = |q: f64| {
        let state =
            by.step(&dalembert::State { q: vector![q], p: vector![found.gradient(q)] }).unwrap().state;
        [state.q[0], state.p[0]]
    };
    for (i, (node, q0)) in found.function.nodes().iter().zip(&found.minimisers).enumerate() {
        let [q1, p1] = forward(*q0);
        let expected = i as f64 * found.function.spacing();
        assert!((q1 - expected).abs() < 1e-6 && (p1 - node.slope).abs() < 1e-6, "{q1} {expected}, {p1}");
    }
    // Positive control: forward it is not. Over the bottom, where the kink is, the motion leaves the graph.
    let [q1, p1] = forward(-0.1);
    assert!(q1 > 0.1 && (p1 - found.gradient(q1)).abs() > 1.0);
    assert_eq!(found.kinks.len(), 1);
    assert!(found.kinks[0].sin().abs() < 1e-3, "{:?}", found.kinks);
}

/// Largest |dS* − p| on the unstable manifold, at points between those of the grid.
fn off_the_manifold(found: &StationarySolution, a: f64) -> f64 {
    let points = (1..100).map(|i| PI + (PI - 0.01) * f64::from(i) / 100.0);
    points.map(|q| (found.gradient(q) - unstable(a, q)).abs()).fold(0.0, f64::max)
}

#[test]
fn the_differential_is_the_unstable_manifold_of_the_upright_position() {
    let [coarse, fine] = [64, 128].map(|points| solution(&DAMPED, points));
    let errors = [&coarse, &fine].map(|found| off_the_manifold(found, A));
    let order = (errors[0] / errors[1]).log2();
    assert!(errors[1] < 1e-6 && (order - 3.0).abs() < 0.4, "{errors:?}, order {order}");
    // Positive controls: another friction's manifold, and the stable one.
    assert!(off_the_manifold(&fine, A * 1.01) > 1e-3);
    let near = 1e-3;
    let slope = fine.gradient(PI + near) / near;
    assert!((slope - direction(A, true)).abs() < 1e-3, "{slope}");
    assert!((slope - direction(A, false)).abs() > 1.0);
}

/// S* is the integral of that manifold's p, by Simpson's rule, and G(π, π)/(1 − c) upright.
#[test]
fn its_values_are_those_of_the_manifold() {
    let upright = |found: &StationarySolution| found.value(PI);
    let errors = [64, 128].map(|points| {
        let found = solution(&DAMPED, points);
        // (1 − κ)L_d(π, π) − κhV(π), with α and β from 0; V(π) = −V(0) = 1.
        let (kappa, v) = (A * H, 1.0);
        let g = -(1.0 - kappa) * H * v - kappa * H * v;
        assert!((upright(&found) - g / (1.0 - factor(A))).abs() < 1e-11);
        let middle = 1.5 * PI;
        let (panels, width) = (200, 0.5 * PI / 200.0);
        let p = |i: u32| if i == 0 { 0.0 } else { unstable(A, PI + 0.5 * width * f64::from(i)) };
        let simpson = |i: u32| width / 6.0 * (p(2 * i) + 4.0 * p(2 * i + 1) + p(2 * i + 2));
        let expected: f64 = (0..panels).map(simpson).sum();
        (found.value(middle) - upright(&found) - expected).abs()
    });
    let order = (errors[0] / errors[1]).log2();
    assert!(errors[1] < 1e-7 && (order - 4.0).abs() < 0.7, "{errors:?}, order {order}");
}

#[test]
fn another_rule_and_single_precision() {
    let by = DAMPED.by(FittedTrapezoidal, H);
    let proportion = by.proportion(&samples::segments([-3.0], [3.0], [0.3], 20)).unwrap();
    let split = by.proportional_split(&proportion, [0.0]).unwrap();
    let fitted = split.stationary_equation(TAU, 64).unwrap().solve().unwrap();
    assert!((fitted.ratio - (-2.0 * A * H).exp()).abs() < 1e-10, "{}", fitted.ratio);
    // It is another step: the trapezoidal rule's manifold is not its own.
    assert!(off_the_manifold(&fitted, A) > 1e-4);

    let system = Single { a: A as f32 };
    let by = system.by(Trapezoidal, H as f32);
    let proportion = by.proportion(&samples::segments([-3.0], [3.0], [0.3], 20)).unwrap();
    let split = by.proportional_split(&proportion, [0.0]).unwrap();
    let single = split.stationary_equation(TAU, 64).unwrap().solve().unwrap();
    let distance = single.function.distance(&solution(&DAMPED, 64).function);
    assert!(distance < 3e-4 && (single.ratio - factor(A)).abs() < 1e-3, "{distance:e} {}", single.ratio);
}

#[test]
fn hypotheses_that_fail_have_names() {
    let of = |a: f64, tilt: f64, h: f64, period: f64, points: usize| {
        split(&Pendulum { a, tilt }, h).stationary_equation(period, points).map(drop)
    };
    assert_eq!(of(A, 0.0, H, TAU, 16), Ok(()));
    assert_eq!(of(0.0, 0.0, H, TAU, 64), Err(StationaryError::NoFriction));
    assert!(matches!(of(-A, 0.0, H, TAU, 64), Err(StationaryError::Growing { factor }) if factor > 1.0));
    assert!(matches!(of(A, 0.0, -H, TAU, 64), Err(StationaryError::Growing { .. })));
    assert!(matches!(of(6.0, 0.0, H, TAU, 64), Err(StationaryError::Overdamped { factor }) if factor < 0.0));
    assert!(matches!(of(A, 0.1, H, TAU, 64), Err(StationaryError::NotPeriodic { .. })));
    assert!(matches!(of(A, 0.0, H, 6.0, 64), Err(StationaryError::NotPeriodic { .. })));
    assert_eq!(of(A, 0.0, H, 2.0 * TAU, 64), Ok(()));
    assert_eq!(of(A, 0.0, H, 0.0, 64), Err(StationaryError::Period { period: 0.0 }));
    assert_eq!(of(A, 0.0, H, TAU, 15), Err(StationaryError::TooFewPoints { needed: 16, found: 15 }));
    // A friction so small that S* may vary by more than G does within eight periods.
    assert_eq!(of(1e-6, 0.0, H, TAU, 16), Err(StationaryError::Unbounded { periods: 8 }));
}
