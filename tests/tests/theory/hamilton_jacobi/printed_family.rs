//! The paper's theory as printed, on functions S_k: by what each statement misses under force, in closed
//! form, and that all hold without (paper, section 4).

use dalembert::hamilton_jacobi::PrintedReport;
use dalembert::nalgebra::vector;
use dalembert::{Discretise, Midpoint, ScalarField};
use dalembert_tests::damped_oscillator::{
    CompleteSolution, DAMPED, H, Oscillator, Quadratic, UNDAMPED, Vector, trajectory,
};

const STEPS: usize = 5;

fn solution(system: &Oscillator) -> CompleteSolution {
    CompleteSolution::new(system, H, -0.4, 0.7)
}

/// The trajectory that lies on the family's sections.
fn on_sections(system: &Oscillator) -> Vec<Vector> {
    let s0 = solution(system).function(0);
    trajectory(system, H, 0.8, s0.gradient(&vector![0.8])[0], STEPS)
}

fn report(system: &Oscillator) -> PrintedReport<1> {
    let family = solution(system).family(STEPS);
    system.by(Midpoint, H).hamilton_jacobi().as_printed(&family, &on_sections(system)).unwrap()
}

#[test]
fn without_force_all_that_is_printed_holds() {
    let report = report(&UNDAMPED);
    for outcome in [
        report.trajectory,
        report.net_force,
        report.gamma_minus,
        report.gamma_plus,
        report.flow_gamma_minus,
        report.flow_gamma_plus,
        report.gamma_related_minus,
        report.gamma_related_plus,
        report.right_equation,
        report.left_equation,
        report.action_increment,
        report.lemma_plus,
        report.lemma_minus,
        report.lemma_plus_forced,
        report.lemma_plus_unforced,
        report.lemma_minus_forced,
        report.backward_flow,
    ] {
        assert!(outcome.unwrap().holds(), "{report}");
    }
}

/// The corrected solution γ_k = dS_k put into the printed formulas: γ⁻ = p_k − f⁻ and γ⁺ = p_{k+1} + f⁺, and
/// the flows miss by what these errors make of them.
#[test]
fn under_force_each_statement_misses_by_the_predicted_amount() {
    let (q, report) = (on_sections(&DAMPED), report(&DAMPED));
    assert!(report.trajectory.unwrap().holds(), "{report}");
    let closed = solution(&DAMPED);
    let f = |k: usize| -closed.rho * (q[k + 1][0] - q[k][0]);
    let (up, down) = (closed.beta + closed.rho, closed.beta - closed.rho);
    let check = |outcome: dalembert::hamilton_jacobi::Outcome<1>, expected: &dyn Fn(usize) -> f64| {
        let residual = outcome.unwrap();
        let expected = expected(residual.step).abs();
        assert!(
            expected > 1e-3 && (residual.size - expected).abs() < 1e-13,
            "{residual} {expected}\n{report}"
        );
    };
    check(report.net_force, &|j| f(j - 1) + f(j));
    check(report.gamma_minus, &|j| f(j));
    check(report.gamma_plus, &|j| f(j));
    // ∂q1/∂p0 = 1/(β + ρ) and ∂q0/∂p1 = −1/(β − ρ).
    check(report.flow_gamma_minus, &|j| f(j - 1) / up);
    check(report.flow_gamma_plus, &|j| f(j - 1) / up);
    check(report.backward_flow, &|j| f(j) / down);
    for outcome in [
        report.gamma_related_minus,
        report.gamma_related_plus,
        report.right_equation,
        report.left_equation,
        report.lemma_plus,
        report.lemma_minus,
        report.lemma_plus_forced,
        report.lemma_plus_unforced,
        report.lemma_minus_forced,
    ] {
        let residual = outcome.unwrap();
        assert!(!residual.holds() && residual.size > 1e-3, "{residual}\n{report}");
    }
}

/// Functions that satisfy the right equation for all q, under force: those of the undamped oscillator. Their
/// points solve the unforced Euler–Lagrange equations.
#[test]
fn the_right_equation_for_all_q_is_solved_by_the_unforced_family() {
    let samples = [-1.1, 0.2, 0.9].map(|q| vector![q]);
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let report = theory.right_equation_everywhere(&solution(&UNDAMPED).family(STEPS), &samples).unwrap();
    assert!(report.right_equation.unwrap().holds() && report.derivative.unwrap().holds(), "{report}");
    assert!(report.unforced.unwrap().holds(), "{report}");
    assert!(!report.forced.unwrap().holds() && report.forced.unwrap().size > 1e-2, "{report}");

    // Positive control: the family that solves the forced problem fails the right equation.
    let report = theory.right_equation_everywhere(&solution(&DAMPED).family(STEPS), &samples).unwrap();
    assert!(report.right_equation.unwrap().size > 1e-3, "{report}");
}

/// The lemma's 𝓕⁺ from a family that satisfies the right equation for all q. Its points, in closed form:
/// x = q̂ − ρ (q̂ − q)/(α − ρ) + ρ (x − q)/(s − ρ) with (α − ρ) q̂ = (s − ρ) x + λ + β q, s and λ those of
/// S_{k+1}.
#[test]
fn the_lemmas_flow_solves_neither_the_forced_nor_the_unforced_equations() {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let closed = solution(&DAMPED);
    let family = solution(&UNDAMPED).family(STEPS);
    let mut c = vec![vector![0.8]];
    for k in 0..STEPS {
        let guess = k.checked_sub(1).map(|before| (c[k] - c[before]) / H);
        c.push(theory.lemma_flow_plus(&family[k + 1], &c[k], guess.as_ref()).unwrap());

        let (alpha, beta, rho) = (closed.alpha, closed.beta, closed.rho);
        let (q, Quadratic { s, lambda, .. }) = (c[k][0], family[k + 1]);
        // q̂ = hat_x x + hat_0.
        let (hat_x, hat_0) = ((s - rho) / (alpha - rho), (lambda + beta * q) / (alpha - rho));
        let shrink = 1.0 - rho / (alpha - rho);
        let by_x = 1.0 - shrink * hat_x - rho / (s - rho);
        let expected = (shrink * hat_0 + rho * q / (alpha - rho) - rho * q / (s - rho)) / by_x;
        assert!(
            (c[k + 1][0] - expected).abs() < 1e-13 * (1.0 + expected.abs()),
            "{} {expected}",
            c[k + 1][0]
        );
    }
    for q in c.windows(3) {
        let forced = DAMPED.by(Midpoint, H).del_residual(&q[0], &q[1], &q[2])[0];
        let unforced = UNDAMPED.by(Midpoint, H).del_residual(&q[0], &q[1], &q[2])[0];
        assert!(forced.abs() > 1e-3 && unforced.abs() > 1e-3, "{forced} {unforced}");
    }

    // Positive control: without force 𝓕⁺ and 𝓕⁻ are the flow.
    let theory = UNDAMPED.by(Midpoint, H).hamilton_jacobi();
    let q = on_sections(&UNDAMPED);
    for k in 1..STEPS {
        let guess = (q[k] - q[k - 1]) / H;
        let plus = theory.lemma_flow_plus(&family[k + 1], &q[k], Some(&guess)).unwrap();
        let minus = theory.lemma_flow_minus(&family[k], &q[k], Some(&guess)).unwrap();
        assert!((plus - q[k + 1]).amax() < 1e-13, "{plus}");
        assert!((minus - q[k + 1]).amax() < 1e-13, "{minus}");
    }
}

/// The lemma's 𝓕⁻ under force, in closed form: q = −ρ (x − q)/(s − ρ) + q̂ − ρ (x − q̂)/(α + ρ) with
/// (α + ρ) q̂ = β x − (s − ρ) q − λ, s and λ those of S_k. It is no flow of the system either.
#[test]
fn the_lemmas_other_flow_is_its_closed_form_and_no_solution() {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let CompleteSolution { alpha, beta, rho, .. } = solution(&DAMPED);
    for (k, family) in [solution(&UNDAMPED), solution(&DAMPED)].iter().flat_map(|f| [(1, f), (4, f)]) {
        let function = family.function(k);
        let Quadratic { s, lambda, .. } = function;
        let q = 0.8;
        let x = theory.lemma_flow_minus(&function, &vector![q], None).unwrap()[0];
        // q̂ = hat_x x + hat_0.
        let (hat_x, hat_0) = (beta / (alpha + rho), -((s - rho) * q + lambda) / (alpha + rho));
        let stretch = 1.0 + rho / (alpha + rho);
        let by_x = stretch * hat_x - rho / (s - rho) - rho / (alpha + rho);
        let expected = (q - rho * q / (s - rho) - stretch * hat_0) / by_x;
        assert!((x - expected).abs() < 1e-12 * (1.0 + expected.abs()), "k = {k}: {x} {expected}");
        // The step from (q, dS_k(q)) leads elsewhere.
        let p = function.gradient(&vector![q]);
        let state = dalembert::State { q: vector![q], p };
        let step = DAMPED.by(Midpoint, H).step(&state).unwrap().state.q[0];
        assert!((x - step).abs() > 1e-3, "k = {k}: {x} {step}");
    }
}

/// With q_j not eliminated from H_d⁻ the left equation holds whatever γ⁻ is.
#[test]
fn the_left_equation_without_elimination_is_empty() {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let q = on_sections(&DAMPED);
    let mut action = 0.0;
    let mut family = Vec::new();
    for k in 0..=STEPS {
        // Gradients that have nothing to do with the system; values that are the discrete action at q_k.
        let arbitrary = Quadratic { s: 0.3 * k as f64 - 2.0, lambda: 1.0 - 0.9 * k as f64, constant: 0.0 };
        family.push(Quadratic { constant: action - arbitrary.value(&q[k]), ..arbitrary });
        action = theory.discrete_action(&q[..(k + 2).min(STEPS + 1)]);
    }
    let report = theory.as_printed(&family, &q).unwrap();
    assert!(report.action_increment.unwrap().holds(), "{report}");
    assert!(report.gamma_minus.unwrap().size > 0.1, "{report}");
    // Positive control: as an equation of functions of (q_{j+1}, p_j) it sees the wrong γ⁻.
    assert!(report.left_equation.unwrap().size > 1e-2, "{report}");
}

/// γ = DG_d for functions S_k: by differences of G_d, which is quadratic.
#[test]
fn gamma_is_the_differential_of_the_generating_function() {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let [s0, s1] = [0, 1].map(|k| solution(&DAMPED).function(k));
    let g = |a: f64, b: f64| theory.generating_function(&s0, &s1, &vector![a], &vector![b]);
    let (a, b) = (0.8, 0.9);
    let gamma = theory.gamma(&s0, &s1, &vector![a], &vector![b]);
    assert!((g(a + 0.5, b) - g(a - 0.5, b) - gamma.p0[0]).abs() < 1e-13);
    assert!((g(a, b + 0.5) - g(a, b - 0.5) - gamma.p1[0]).abs() < 1e-13);
    // Positive control: without R_d it is not.
    let without = |a: f64| s0.value(&vector![a]) + s1.value(&vector![b]);
    assert!((without(a + 0.5) - without(a - 0.5) - gamma.p0[0]).abs() > 1e-2);
}
