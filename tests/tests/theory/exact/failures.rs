//! What has no exact discrete objects is refused by name.

use dalembert::exact::{Exact, ExactError};
use dalembert::nalgebra::vector;
use dalembert::step::Quantity;
use dalembert::{State, rayleigh_system};

#[rayleigh_system]
fn massless(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * (q[0] * q[0] + q[1] * q[1])
}

#[rayleigh_system]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// Cubic drag, which accelerates backwards motion to infinite speed in finite time.
#[rayleigh_system]
fn cubic_drag(_q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0], r * v[0].powi(3) / 3.0)
}

/// A drag with a corner at v = 0.
#[rayleigh_system]
fn corner(_q: [f64; 1], v: [f64; 1]) -> (f64, f64) {
    (0.5 * v[0] * v[0], 0.5 * v[0] * v[0].abs())
}

/// Two equal springs: all coordinates conjugate at once.
#[rayleigh_system]
fn springs(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * (q[0] * q[0] + 4.0 * q[1] * q[1])
}

/// V = q⁴/4: the wider the swing, the shorter its period.
#[rayleigh_system]
fn quartic(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - 0.25 * q[0].powi(4)
}

const PENDULUM: Pendulum = Pendulum { r: 0.1 };

#[test]
fn step_size_zero_or_not_finite() {
    for h in [0.0, f64::INFINITY, f64::NAN] {
        let error = Exact::new(&PENDULUM).segment(vector![0.1], vector![0.2], h).unwrap_err();
        assert!(matches!(error, ExactError::StepSize { .. }), "{error}");
    }
}

#[test]
fn points_that_are_not_finite() {
    let error = Exact::new(&PENDULUM).segment(vector![0.1], vector![f64::NAN], 0.1).unwrap_err();
    assert_eq!(error, ExactError::NonFinite { quantity: Quantity::Configuration, index: 0 });
}

#[test]
fn a_degenerate_lagrangian() {
    let error = Exact::unforced(&Massless).segment(vector![0.1, 0.2], vector![0.2, 0.3], 0.1).unwrap_err();
    assert_eq!(error, ExactError::DegenerateLagrangian { time: 0.0, column: 1 });
}

#[test]
fn conjugate_points_of_one_coordinate_among_two() {
    // Frequencies 1 and 2: at h = π/2 the second coordinate alone is half a period on.
    let exact = Exact::unforced(&Springs);
    let half_pi = std::f64::consts::FRAC_PI_2;
    let error = exact.segment(vector![0.1, 0.2], vector![0.2, 0.3], half_pi).unwrap_err();
    assert!(matches!(error, ExactError::ConjugatePoints { growth, .. } if growth > 1e7), "{error}");
    // Positive control: away from it there is a motion.
    let segment = exact.segment(vector![0.1, 0.2], vector![0.2, 0.3], 1.4).unwrap();
    assert!(segment.report.error() < 1e-13, "{}", segment.report);
}

/// Time from q0 out to the turning point A and back to q1 in V = q⁴/4: with q = A sin φ,
/// (√2/A)(∫ from arcsin q0/A + ∫ from arcsin q1/A) to π/2 of dφ/√(1 + sin²φ).
fn time_by_way_of(turning: f64, q0: f64, q1: f64) -> f64 {
    let leg = |q: f64| {
        let (from, cells) = ((q / turning).asin(), 400);
        let width = (std::f64::consts::FRAC_PI_2 - from) / f64::from(2 * cells);
        let at = |i: i32| 1.0 / (1.0 + (from + f64::from(i) * width).sin().powi(2)).sqrt();
        let sum: f64 = (0..cells).map(|i| at(2 * i) + 4.0 * at(2 * i + 1) + at(2 * i + 2)).sum();
        sum * width / 3.0
    };
    std::f64::consts::SQRT_2 / turning * (leg(q0) + leg(q1))
}

#[test]
fn the_step_size_where_a_motion_ceases_is_found() {
    // The longest time from 0.6 to 1.1 with one turn: beyond it the motion near the straight line ceases to
    // exist.
    let longest_of = |turnings: &mut dyn Iterator<Item = f64>| {
        let times = turnings.map(|turning| (time_by_way_of(turning, 0.6, 1.1), turning));
        times.fold((0.0, 0.0), |longest, other| if other.0 > longest.0 { other } else { longest })
    };
    let (_, near) = longest_of(&mut (1..40).map(|i| 1.1 + 1e-2 * f64::from(i)));
    assert!((1.12..1.48).contains(&near), "{near}, at an end");
    let (longest, _) = longest_of(&mut (-25..=25).map(|i| near + 4e-4 * f64::from(i)));
    let exact = Exact::unforced(&Quartic);
    let error = exact.segment(vector![0.6], vector![1.1], 2.0).unwrap_err();
    let ExactError::ConjugatePoints { h, growth } = error else { panic!("{error}") };
    assert!((h / longest - 1.0).abs() < 1e-5 && growth > 100.0, "{error}, longest {longest}");
    // Positive control: just before it the motion exists, and is found by following it from small h.
    let segment = exact.segment(vector![0.6], vector![1.1], 0.999 * longest).unwrap();
    assert!(segment.report.error() < 1e-12 && segment.report.growth > 5.0, "{}", segment.report);
}

#[test]
fn points_too_far_apart_for_the_swing() {
    // Frequency near 1 in small swings: past half a period every motion from 0.3 to 0.9 has turned back or
    // gone round.
    let exact = Exact::new(&PENDULUM);
    let followed = exact.segment(vector![0.3], vector![0.9], 2.5).unwrap();
    assert!(followed.report.error() < 1e-12, "{}", followed.report);
    // The end's velocity has changed sign: it is not the straight line's motion any more, but the one grown
    // out of it.
    assert!(followed.v0[0] > 0.0 && followed.v1[0] < 0.0, "{followed}");
}

#[test]
fn a_motion_that_escapes() {
    let system = CubicDrag { r: 1.0 };
    // v = v0/(1 + r v0 t), infinite at t = 1 for v0 = −1.
    let error = Exact::new(&system).flow(&State { q: vector![0.0], p: vector![-1.0] }, 2.0).unwrap_err();
    assert!(matches!(error, ExactError::MotionNotFinite { .. } | ExactError::Unresolved { .. }), "{error}");
    // Positive control: before that it moves by ln(1 − ½).
    let state = Exact::new(&system).flow(&State { q: vector![0.0], p: vector![-1.0] }, 0.5).unwrap();
    assert!((state.q[0] - 0.5_f64.ln()).abs() < 1e-14, "{state:?}");
}

#[test]
fn a_force_with_a_corner_has_no_second_derivatives() {
    // A motion that stands still: R″ jumps there.
    let exact = Exact::new(&Corner);
    let segment = exact.segment(vector![0.2], vector![0.2], 0.5).unwrap();
    let error = exact.second_derivatives(&segment).unwrap_err();
    assert_eq!(error, ExactError::NotDifferentiable { index: 0 });
    // Positive control: a motion that goes one way has them.
    let segment = exact.segment(vector![0.2], vector![0.9], 0.5).unwrap();
    assert!(exact.second_derivatives(&segment).unwrap().force_error < 1e-10);
}

#[test]
fn errors_say_what_to_do() {
    for error in [
        ExactError::StepSize { h: 0.0 },
        ExactError::ConjugatePoints { h: 1.0, growth: 1e9 },
        ExactError::NoMotion { reached: 0.5, residual: 0.1 },
        ExactError::Unresolved { steps: 16384, difference: 1e-3 },
        ExactError::MotionNotFinite { time: 0.3 },
    ] {
        let text = error.to_string();
        assert!(text.contains("give") || text.contains("try"), "{text}");
    }
}
