//! The forced discrete Hamilton equations: the printed second ones miss by the force at the eliminated end,
//! the corrected ones hold; in Rayleigh form two signs are wrong besides (paper, sections 3.2 and 3.3).

use dalembert::hamilton_jacobi::HamiltonEquationsReport;
use dalembert::nalgebra::{SVector, vector};
use dalembert::step::{DiscreteRayleigh, Segment};
use dalembert::{Discrete, Discretise, Midpoint, Trapezoidal, rayleigh_system};
use dalembert_tests::damped_oscillator::{DAMPED, H, UNDAMPED};

/// Two degrees of freedom, nonlinear, with a Rayleigh function that depends on q.
struct Coupled {
    friction: f64,
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
}

/// The same L with a force that is not Rayleigh.
struct Curl;

#[rayleigh_system]
impl Curl {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (1.0 + 0.3 * q[1] * q[1]) * v[0] * v[0] + 0.8 * v[1] * v[1] - 0.5 * q[0] * q[0] - q[1].powi(4)
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [-0.3 * v[0] + 0.8 * q[1], -0.8 * q[0] - 0.1 * v[1]]
    }
}

const Q0: SVector<f64, 2> = vector![0.4, -0.3];
const Q1: SVector<f64, 2> = vector![0.52, -0.18];

fn misses<const N: usize>(report: &HamiltonEquationsReport<N>) -> [[f64; 2]; 4] {
    [report.right_configuration, report.right_momentum, report.left_configuration, report.left_momentum]
        .map(|pair| [pair.printed.unwrap().size, pair.corrected.unwrap().size])
}

fn corrected_hold<const N: usize>(report: &HamiltonEquationsReport<N>) -> bool {
    [report.right_configuration, report.right_momentum, report.left_configuration, report.left_momentum]
        .iter()
        .all(|pair| pair.corrected.unwrap().holds())
}

/// H_d⁺ and H_d⁻ by their values alone.
fn check_derivatives<R: Copy, L>(system: &L, rule: R)
where
    L: Discrete<R, 2, Scalar = f64>,
{
    let theory = system.by(rule, H).hamilton_jacobi();
    let momenta = system.by(rule, H).segment(&Q0, &Q1).unwrap().legendre_derivatives().unwrap().momenta;
    let action = system.by(rule, H).segment(&Q0, &Q1).unwrap().discrete_lagrangian().unwrap();
    let v = (Q1 - Q0) / H;
    let plus = |q0: &SVector<f64, 2>, p1: &SVector<f64, 2>| {
        theory.discrete_hamiltonian_plus(q0, p1, Some(&v)).unwrap()
    };
    let minus = |q1: &SVector<f64, 2>, p0: &SVector<f64, 2>| {
        theory.discrete_hamiltonian_minus(q1, p0, Some(&v)).unwrap()
    };
    let (at_plus, at_minus) = (plus(&Q0, &momenta.p1), minus(&Q1, &momenta.p0));
    assert!((at_plus.eliminated - Q1).amax() < 1e-14 && (at_minus.eliminated - Q0).amax() < 1e-14);
    assert!((at_plus.value - (momenta.p1.dot(&Q1) - action)).abs() < 1e-13);
    assert!((at_minus.value - (-momenta.p0.dot(&Q0) - action)).abs() < 1e-13);
    let width = 1e-5;
    for i in 0..2 {
        let mut e: SVector<f64, 2> = vector![0.0, 0.0];
        e[i] = width;
        let slope = |after: f64, before: f64| (after - before) / (2.0 * width);
        let p = momenta;
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-8, "{a} {b}");
        close(slope(plus(&(Q0 + e), &p.p1).value, plus(&(Q0 - e), &p.p1).value), at_plus.d1[i]);
        close(slope(plus(&Q0, &(p.p1 + e)).value, plus(&Q0, &(p.p1 - e)).value), at_plus.d2[i]);
        close(slope(minus(&(Q1 + e), &p.p0).value, minus(&(Q1 - e), &p.p0).value), at_minus.d1[i]);
        close(slope(minus(&Q1, &(p.p0 + e)).value, minus(&Q1, &(p.p0 - e)).value), at_minus.d2[i]);
    }
}

#[test]
fn the_derivatives_of_the_hamiltonians_are_those_of_their_values() {
    check_derivatives(&Coupled { friction: 0.7 }, Midpoint);
    check_derivatives(&Coupled { friction: 0.7 }, Trapezoidal);
    check_derivatives(&Curl, Midpoint);
}

/// The terms that the printed equations lack, from the matrices of the transforms: (∂q1/∂q0)ᵀ f⁺ and
/// (∂q0/∂q1)ᵀ f⁻.
fn missing_terms<R: Copy, L>(system: &L, rule: R) -> [SVector<f64, 2>; 2]
where
    L: Discrete<R, 2, Scalar = f64>,
{
    let segment = system.by(rule, H).segment(&Q0, &Q1).unwrap();
    let (k, f) = (segment.legendre_derivatives().unwrap(), segment.discrete_force().unwrap());
    let q1_by_q0 = -k.p1_by_q1.try_inverse().unwrap() * k.p1_by_q0;
    let q0_by_q1 = -k.p0_by_q0.try_inverse().unwrap() * k.p0_by_q1;
    [q1_by_q0.transpose() * f.plus, q0_by_q1.transpose() * f.minus]
}

fn check_general<R: Copy, L>(system: &L, rule: R)
where
    L: Discrete<R, 2, Scalar = f64>,
{
    let report = system.by(rule, H).hamilton_jacobi().hamilton_equations(&[Q0, Q1]).unwrap();
    assert!(corrected_hold(&report), "{report}");
    // The first equations are right as printed.
    assert!(report.right_configuration.printed.unwrap().holds(), "{report}");
    assert!(report.left_configuration.printed.unwrap().holds(), "{report}");
    let [_, [right, _], _, [left, _]] = misses(&report);
    let [right_term, left_term] = missing_terms(system, rule);
    // The report gives the component furthest above its tolerance.
    let is_one_of = |miss: f64, term: SVector<f64, 2>| term.iter().any(|t| (miss - t.abs()).abs() < 1e-13);
    assert!(right > 1e-3 && is_one_of(right, right_term), "{report}{right_term}");
    assert!(left > 1e-3 && is_one_of(left, left_term), "{report}{left_term}");
}

#[test]
fn the_printed_second_equations_miss_by_the_force_at_the_eliminated_end() {
    check_general(&Coupled { friction: 0.7 }, Midpoint);
    check_general(&Coupled { friction: 0.7 }, Trapezoidal);
    check_general(&Curl, Midpoint);
}

/// One degree of freedom: the misses in closed form. With K10 = −(m/h + kh/4) + r/2, K11 = m/h − kh/4 − r/2
/// and f⁺ = f⁻ = −(r/2)(q1 − q0) the right one is −(K10/K11) f⁺; the left one −(K01/K00) f⁻, r with the other
/// sign.
#[test]
fn the_oscillators_misses_are_the_closed_form() {
    let (m, k, r, h) = (DAMPED.m, DAMPED.k, DAMPED.r, H);
    let (q0, q1) = (0.3, 0.5);
    let report =
        DAMPED.by(Midpoint, h).hamilton_jacobi().hamilton_equations(&[vector![q0], vector![q1]]).unwrap();
    let f = -0.5 * r * (q1 - q0);
    let right = f * (m / h + k * h / 4.0 - r / 2.0) / (m / h - k * h / 4.0 - r / 2.0);
    let left = f * (m / h + k * h / 4.0 + r / 2.0) / (m / h - k * h / 4.0 + r / 2.0);
    let [_, [printed_right, _], _, [printed_left, _]] = misses(&report);
    assert!(
        (printed_right - right.abs()).abs() < 1e-14 && (printed_left - left.abs()).abs() < 1e-14,
        "{report}"
    );
    assert!(corrected_hold(&report), "{report}");
}

#[test]
fn without_force_printed_and_corrected_agree() {
    let report =
        UNDAMPED.by(Midpoint, H).hamilton_jacobi().hamilton_equations(&[vector![0.3], vector![0.5]]).unwrap();
    assert!(corrected_hold(&report), "{report}");
    for pair in [report.right_momentum, report.left_momentum] {
        assert!(pair.printed.unwrap().holds(), "{report}");
    }
}

fn check_rayleigh<R: Copy, L>(system: &L, rule: R)
where
    L: DiscreteRayleigh<R, 2, Scalar = f64>,
{
    let report = system.by(rule, H).hamilton_jacobi().hamilton_equations_rayleigh(&[Q0, Q1]).unwrap();
    assert!(corrected_hold(&report), "{report}");
    let r = system.discrete_rayleigh_derivatives(&Segment::between(&Q0, &Q1, H));
    let [[right_a, _], [right_b, _], [left_a, _], [left_b, _]] = misses(&report);
    // The wrong sign in the first equations misses by twice the term.
    let is_one_of =
        |miss: f64, terms: SVector<f64, 2>| terms.iter().any(|t| (miss - 2.0 * t.abs()).abs() < 1e-13);
    assert!(is_one_of(right_a, r.d2) && is_one_of(left_a, r.d1), "{report}");
    assert!(right_b > 1e-3 && left_b > 1e-3, "{report}");
    // Both forms are the same equations.
    let general = system.by(rule, H).hamilton_jacobi().hamilton_equations(&[Q0, Q1]).unwrap();
    assert!(corrected_hold(&general), "{general}");
}

#[test]
fn the_rayleigh_form_needs_all_four_signs() {
    check_rayleigh(&Coupled { friction: 0.7 }, Midpoint);
    check_rayleigh(&Coupled { friction: 0.7 }, Trapezoidal);
    // Positive control: without friction nothing misses, printed or not.
    let report = Coupled { friction: 0.0 }
        .by(Midpoint, H)
        .hamilton_jacobi()
        .hamilton_equations_rayleigh(&[Q0, Q1])
        .unwrap();
    for [printed, corrected] in misses(&report) {
        assert_eq!(printed, corrected, "{report}");
    }
    assert!(corrected_hold(&report), "{report}");
}

/// The oscillator's Rayleigh form, where also the second equations' misses have a closed form: printed less
/// corrected is 2 D1 R_d − (∂q1/∂q0) D2 R_d (right) and 2 D2 R_d − (∂q0/∂q1) D1 R_d (left).
#[test]
fn the_oscillators_rayleigh_misses_are_the_closed_form() {
    let (m, k, r, h) = (DAMPED.m, DAMPED.k, DAMPED.r, H);
    let (q0, q1) = (0.3, 0.5);
    let theory = DAMPED.by(Midpoint, h).hamilton_jacobi();
    let report = theory.hamilton_equations_rayleigh(&[vector![q0], vector![q1]]).unwrap();
    let (d1, d2) = (-0.5 * r * (q1 - q0), 0.5 * r * (q1 - q0));
    let q1_by_q0 = (m / h + k * h / 4.0 - r / 2.0) / (m / h - k * h / 4.0 - r / 2.0);
    let q0_by_q1 = (m / h + k * h / 4.0 + r / 2.0) / (m / h - k * h / 4.0 + r / 2.0);
    let expected = [2.0 * d2, 2.0 * d1 - q1_by_q0 * d2, 2.0 * d1, 2.0 * d2 - q0_by_q1 * d1];
    for ([printed, _], expected) in misses(&report).into_iter().zip(expected) {
        assert!((printed - f64::abs(expected)).abs() < 1e-14, "{printed} {expected}\n{report}");
    }
}
