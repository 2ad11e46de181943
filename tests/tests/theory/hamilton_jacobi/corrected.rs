//! The corrected Hamilton–Jacobi theory holds on the closed-form complete solution of the damped oscillator,
//! and its check rejects what is no solution.

use dalembert::nalgebra::vector;
use dalembert::{Discretise, Midpoint, ScalarField, State};
use dalembert_tests::damped_oscillator::{CompleteSolution, DAMPED, H, Oscillator, UNDAMPED, Vector};

const STEPS: usize = 12;

fn samples() -> Vec<Vector> {
    [-1.7, -0.4, 0.0, 0.3, 2.1].map(|q| vector![q]).to_vec()
}

fn solution(system: &Oscillator) -> CompleteSolution {
    CompleteSolution::new(system, H, -0.2, 0.7)
}

#[test]
fn the_closed_form_solves_both_transforms() {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let closed = solution(&DAMPED);
    let maps: Vec<_> = (0..STEPS).map(|k| closed.map(k)).collect();
    let family = closed.family(STEPS);

    let report = theory.check_solution(&maps, &family, &samples()).unwrap();
    assert!(report.is_solution(), "{report}");
    assert!(report.work.unwrap().holds(), "{report}");
    assert!(report.closed_sections.unwrap().holds() && report.closed_work.unwrap().holds(), "{report}");
    // The W-equation is not the unforced one: the force does work on this family.
    assert!(report.no_work.unwrap().size > 1e-2, "{report}");

    let report = theory.check_generating_functions(&family, &samples()).unwrap();
    assert!(report.is_solution() && report.minus.is_none(), "{report}");
    assert!(report.hamiltonian.unwrap().unwrap().holds(), "{report}");
    assert!(report.to_string().contains("a solution"));
}

#[test]
fn a_wrong_parameter_a_wrong_map_and_the_undamped_family_are_rejected() {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let closed = solution(&DAMPED);

    // λ_{k+1} off by η: the plus transform is missed by η.
    let eta = 1e-9;
    let mut family = closed.family(1);
    family[1].lambda += eta;
    let report = theory.check_generating_functions(&family, &samples()).unwrap();
    assert!(!report.is_solution(), "{report}");
    assert!((report.plus.unwrap().size / eta - 1.0).abs() < 1e-5, "{report}");

    // F_0 off by η: the minus transform is missed by ∂p0/∂q1 η = (β + ρ) η.
    let mut map = closed.map(0);
    map.shift += eta;
    let report = theory.check_solution(&[map], &closed.family(1), &samples()).unwrap();
    assert!(!report.is_solution(), "{report}");
    let expected = (closed.beta + closed.rho) * eta;
    assert!((report.minus.unwrap().unwrap().size / expected - 1.0).abs() < 1e-5, "{report}");

    let undamped = solution(&UNDAMPED).family(STEPS);
    let report = theory.check_generating_functions(&undamped, &samples()).unwrap();
    assert!(!report.is_solution() && report.plus.unwrap().size > 1e-2, "{report}");
    assert!(report.to_string().contains("NOT a solution"));
}

#[test]
fn virtual_work_is_the_closed_form() {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let closed = solution(&DAMPED);
    for k in 0..STEPS {
        let (s0, s1) = (closed.function(k), closed.function(k + 1));
        let at = |q: f64| theory.virtual_work(&s0, &s1, &vector![q]).unwrap().value;
        for q in [-1.7, 0.3, 2.1] {
            let size = 1.0 + closed.s(k).abs() + closed.s(k + 1).abs();
            assert!((at(q) - closed.work(k, q)).abs() < 1e-14 * size * (1.0 + q * q), "k = {k}, q = {q}");
        }
    }
    // Positive control: half the work is not the work.
    let (s0, s1) = (closed.function(0), closed.function(1));
    let work = |q: f64| theory.virtual_work(&s0, &s1, &vector![q]).unwrap().value;
    assert!((work(2.1) - 0.5 * closed.work(0, 2.1)).abs() > 0.1 * closed.work(0, 2.1).abs());
}

/// n = 1: S_{k+1} needs DF_k ≠ 0. S_0 = A cos q gives momenta −A sin q, and F_0 folds at cos q = ½. Across
/// the folds three labels lead to one q1 with three momenta p1; between them F_0 is monotone, and p1 a
/// function of q1.
#[test]
fn for_one_coordinate_a_function_exists_up_to_the_fold_and_not_across() {
    let end = |amplitude: f64, q: f64| {
        let state = State { q: vector![q], p: vector![-amplitude * q.sin()] };
        let next = DAMPED.by(Midpoint, H).step(&state).unwrap().state;
        (next.q[0], next.p[0])
    };
    // F_0 = (step of q) − (step of p) A sin q, linear in both.
    let by_q = end(0.0, 1.0).0;
    let by_p = DAMPED.by(Midpoint, H).step(&State { q: vector![0.0], p: vector![1.0] }).unwrap().state.q[0];
    let amplitude = 2.0 * by_q / by_p;
    let fold = 0.5_f64.acos();
    // Across the folds: F_0 = 0 at 0 and at ±q, where sin q = q/2.
    let (mut low, mut high) = (fold, 3.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if end(amplitude, middle).0 < 0.0 { low = middle } else { high = middle }
    }
    let [left, centre, right] = [-low, 0.0, low].map(|q| end(amplitude, q));
    assert!(left.0.abs().max(centre.0.abs()).max(right.0.abs()) < 1e-14, "{left:?} {centre:?} {right:?}");
    assert!(left.1 - centre.1 > 0.1 && centre.1 - right.1 > 0.1, "{left:?} {centre:?} {right:?}");
    // Between them: q1 falls with q throughout, so that p1 is a function of it.
    let within: Vec<_> = (-50..=50).map(|k| end(amplitude, fold * f64::from(k) / 50.0).0).collect();
    assert!(within.windows(2).all(|pair| pair[1] < pair[0]), "{within:?}");
}

#[test]
fn without_force_it_is_the_equation_of_ohsawa_bloch_and_leok() {
    let theory = UNDAMPED.by(Midpoint, H).hamilton_jacobi();
    let report = theory.check_generating_functions(&solution(&UNDAMPED).family(STEPS), &samples()).unwrap();
    assert!(report.is_solution(), "{report}");
    let no_work = report.no_work.unwrap();
    assert!(no_work.holds() && no_work.size == 0.0, "{report}");
}

#[test]
fn a_carried_section_reproduces_the_closed_form_and_its_generating_functions() {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let closed = solution(&DAMPED);
    let nodes = 4.try_into().unwrap();
    let s0 = closed.function(0);
    let (reference, label) = (vector![-0.5], vector![1.3]);
    let [from, to] = [reference, label]
        .map(|x| theory.carried_generating_function(&s0, &reference, &x, STEPS, nodes).unwrap());
    // W_k quadratic: two nodes integrate its derivative exactly.
    assert!(to.quadrature_error < 1e-13);

    let mut accumulated = 0.0;
    for k in 0..=STEPS {
        let (q, p) = (to.characteristic.states[k].q, to.characteristic.states[k].p);
        let frame = to.characteristic.frames[k];
        let amplification = 1.0 + closed.s(k).abs() + closed.lambda(k).abs();
        assert!((p[0] - closed.s(k) * q[0] - closed.lambda(k)).abs() < 1e-13 * amplification, "k = {k}");
        assert!((frame.q[0] - closed.frame(k)).abs() < 1e-13, "k = {k}");
        assert!((frame.p[0] / frame.q[0] - closed.s(k)).abs() < 1e-12 * amplification.powi(2));

        // Differences of S_k between two points of Q know no constant.

        let s = closed.function(k);
        let difference = s.value(&q) - s.value(&from.characteristic.states[k].q);
        assert!((to.values[k] - from.values[k] - difference).abs() < 1e-12 * amplification, "k = {k}");
        accumulated += to.virtual_work.get(k).map_or(0.0, |work| work.abs());
    }
    assert!(accumulated > 0.1, "the force must have done work for this to say anything: {accumulated}");
}
