//! Isotropic drag does not keep the angular momentum: its defect is −k q1·J q0. The paper (last example of
//! section 3.6) names the ring potential with this drag as an instance of a system that keeps it.

use dalembert::nalgebra::vector;
use dalembert::noether::Generator;
use dalembert::{Discrete, Discretise, Midpoint, State, Trapezoidal, rayleigh_system, samples};

/// Example 3.2.3 of Marsden & West.
#[derive(Clone, Copy)]
struct Ring {
    k: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

/// The same in polar coordinates (r, θ).
#[derive(Clone, Copy)]
struct PolarRing {
    k: f64,
}

#[rayleigh_system]
impl PolarRing {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0];
        0.5 * (v[0] * v[0] + s * v[1] * v[1]) - s * (s - 1.0).powi(2)
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + q[0] * q[0] * v[1] * v[1])
    }
}

fn defect_is_as_derived<R: Copy>(rule: R)
where
    Ring: Discrete<R, 2, Scalar = f64>,
{
    let (k, h) = (0.3, 0.2);
    let system = Ring { k };
    let noether = system.by(rule, h).noether();
    let rotation = Generator::rotation(0, 1);
    let segments = samples::segments([-1.5; 2], [1.5; 2], [0.3; 2], 100);
    for segment in &segments {
        let (q0, q1) = (segment.q0, segment.q1);
        let defect = noether.defect(&rotation, &q0, &q1);
        let expected = -k * q1.dot(&vector![-q0[1], q0[0]]);
        assert!((defect.force - expected).abs() < 1e-15, "{} {expected}", defect.force);
    }
    let report = noether.symmetry(&rotation, &segments).unwrap();
    assert!(
        report.is_symmetry_of_lagrangian() && report.force_does_work() && !report.is_conserved(),
        "{report}"
    );
    // The paper's claim would be a defect of zero.
    assert!(report.defect.value.abs() > 1e3 * report.defect.tolerance, "{report}");
}

#[test]
fn isotropic_drag_has_the_defect_minus_k_q1_j_q0() {
    defect_is_as_derived(Midpoint);
    defect_is_as_derived(Trapezoidal);
}

/// In the example's own coordinates and rule: ξ̂(R_d) = −k r̄² (θ1 − θ0), since R_d is no function of θ0 +
/// θ1.
#[test]
fn the_polar_instance_loses_angular_momentum_too() {
    let (k, h) = (0.3, 0.2);
    let system = PolarRing { k };
    let noether = system.by(Midpoint, h).noether();
    let rotation = Generator::translation("θ", [0.0, 1.0]);
    for segment in samples::segments([0.5, -3.0], [1.5, 3.0], [0.2, 0.4], 100) {
        let mean = 0.5 * (segment.q0[0] + segment.q1[0]);
        let expected = -k * mean * mean * (segment.q1[1] - segment.q0[1]);
        let defect = noether.defect(&rotation, &segment.q0, &segment.q1);
        assert!((defect.force - expected).abs() < 1e-15 && defect.lagrangian == 0.0);
    }
}

/// Along the run of section 3.5 the angular momentum decays as e^{−kt} up to O(h²), as that of the continuous
/// system does (dJ/dt = −kJ: isotropic drag, central potential). Positive control: without drag it stays.
#[test]
fn along_the_run_of_the_paper_it_decays() {
    let time = if cfg!(debug_assertions) { 500.0 } else { 2000.0 };
    let final_share = |k: f64, h: f64| {
        let system = Ring { k };
        let start = State::from_velocity(&system, [0.0, 1.15549918674982], [0.5, 0.0]).unwrap();
        let mut trajectory = system.by(Midpoint, h).run(start);
        let steps = (time / h).round() as usize;
        let account = system
            .by(Midpoint, h)
            .noether()
            .balance(&Generator::rotation(0, 1), &start, trajectory.by_ref().take(steps))
            .unwrap();
        assert!(account.is_balanced(), "{account}");
        account.end / account.start
    };
    let error = |h| (final_share(1e-3, h) * f64::exp(1e-3 * time) - 1.0).abs();
    let (coarse, fine) = (error(0.1), error(0.05));
    assert!(fine < 1e-3 && (3.5..4.5).contains(&(coarse / fine)), "{coarse} {fine}");
    assert!((final_share(0.0, 0.2) - 1.0).abs() < 1e-12);
}
