//! Whether v·∂R/∂v ≥ 0 on the sampled region, with the point where it is not.

use dalembert::rayleigh::{dissipation, dissipation_over};
use dalembert::samples::{SampleError, TangentPoint, tangent_points};
use dalembert::{Discretise, Midpoint, State, rayleigh_system};

#[rayleigh_system]
fn cubic(_q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0], r * v[0].powi(3) / 3.0)
}

#[rayleigh_system]
fn absolute_cubic(_q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0], r * v[0].abs().powi(3) / 3.0)
}

/// R = r v³/3 pushes backwards whatever the motion: power r v³, least at the fastest backward motion.
#[test]
fn cubic_drag_is_caught() {
    let points = tangent_points([-1.0], [1.0], [2.0], 200);
    let system = Cubic { m: 1.0, r: 0.7 };
    let report = dissipation(&system, &points).unwrap();
    let slowest = points.iter().map(|point| point.v[0]).fold(f64::INFINITY, f64::min);
    assert!(!report.is_dissipative());
    assert_eq!(report.at.v[0], slowest);
    assert!((report.least_power - 0.7 * slowest.powi(3)).abs() < 1e-14);
    assert_eq!(report.driven, points.iter().filter(|point| point.v[0] < 0.0).count());
    assert!(report.to_string().contains("NOT dissipative"), "{report}");
    // What it warns of happens: a mass that moves backwards is accelerated.
    let start = State::from_velocity(&system, [0.0], [-0.5]).unwrap();
    let end = system.by(Midpoint, 0.1).run(start).take(10).last().unwrap().unwrap();
    assert!(end.state.p[0] < 1.2 * start.p[0], "{end:?}");
    // Positive control: R = r|v|³/3 brakes both ways.
    let report = dissipation(&AbsoluteCubic { m: 1.0, r: 0.7 }, &points).unwrap();
    assert!(report.is_dissipative() && report.gradient_at_rest == 0.0, "{report}");
}

/// R = ½ vᵀCv + g(q).
#[derive(Clone, Copy)]
struct Quadratic {
    coupling: f64,
    g: f64,
}

#[rayleigh_system]
impl Quadratic {
    fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1])
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) + self.coupling * v[0] * v[1] + self.g * q[0] * q[0]
    }
}

#[test]
fn a_quadratic_function_is_dissipative_iff_its_matrix_is_semidefinite() {
    let points = tangent_points([-1.0; 2], [1.0; 2], [2.0; 2], 500);
    for (coupling, expected) in [(0.5, true), (1.0, true), (-1.0, true), (1.3, false), (-1.3, false)] {
        let report = dissipation(&Quadratic { coupling, g: 0.0 }, &points).unwrap();
        assert_eq!(report.is_dissipative(), expected, "{coupling}: {report}");
        let v = report.at.v;
        assert!(expected || v[0] * v[1] * coupling < 0.0, "{report}");
    }
}

/// A part g(q) does nothing in continuous time but shifts the discrete forces: it is named.
#[test]
fn a_part_without_velocity_is_named() {
    let points = tangent_points([-1.0; 2], [1.0; 2], [2.0; 2], 500);
    let report = dissipation(&Quadratic { coupling: 0.0, g: 0.5 }, &points).unwrap();
    let expected = points.iter().map(|point| point.q[0].abs()).fold(0.0, f64::max);
    assert!(report.is_dissipative() && report.gradient_at_rest == expected, "{report}");
    assert!(report.to_string().contains("subtract R(q, 0)"));
}

#[test]
fn points_that_decide_nothing_are_refused() {
    let system = Cubic { m: 1.0, r: 0.7 };
    assert_eq!(dissipation(&system, &[]).unwrap_err(), SampleError::TooFew { given: 0, needed: 1 });
    let point = TangentPoint { q: [0.0].into(), v: [f64::NAN].into() };
    assert_eq!(dissipation(&system, &[point]).unwrap_err(), SampleError::NonFinite { index: 0 });
}

/// R = ½ c (b + cos ωt) v².
struct Reversing {
    b: f64,
    omega: f64,
}

#[rayleigh_system]
impl Reversing {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }
    fn rayleigh(&self, _q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * (self.b + (self.omega * t).cos()) * v[0] * v[0]
    }
}

/// At each of its own times alone a view would brake: friction that reverses is seen over a duration.
#[test]
fn a_view_is_asked_over_a_duration() {
    let points = tangent_points([-1.0], [1.0], [2.0], 50);
    let reverses = Reversing { b: 0.0, omega: 3.0 };
    for start in [0.0, 2.1, 40.0] {
        let view = reverses.at_time(start);
        assert_eq!(dissipation(&view, &points).unwrap_err(), SampleError::OneTime);
        let report = dissipation_over(&view, &points, 2.1).unwrap();
        let power = (3.0 * (start + report.after)).cos() * report.at.v[0].powi(2);
        assert!(!report.is_dissipative() && (report.least_power - power).abs() < 1e-12, "{report}");
        assert!(report.to_string().contains("later"), "{report}");
        // Both ends are among the times, and a period that divides the duration does not hide.
        for periods in [1.0, 2.0, 4.0, 8.0, 16.0] {
            let duration = periods * core::f64::consts::TAU / 3.0;
            assert!(!dissipation_over(&view, &points, duration).unwrap().is_dissipative(), "{periods}");
        }
        // Positive control: what does not reverse brakes all the time.
        let brakes = Reversing { b: 1.5, omega: 3.0 };
        assert!(dissipation_over(&brakes.at_time(start), &points, 40.0).unwrap().is_dissipative());
    }
    let early = dissipation_over(&reverses.at_time(0.0), &points, 0.5).unwrap();
    assert!(early.is_dissipative(), "{early}");
    let never = dissipation_over(&reverses.at_time(0.0), &points, f64::NAN).unwrap_err();
    assert_eq!(never, SampleError::NonFinite { index: 0 });
}
