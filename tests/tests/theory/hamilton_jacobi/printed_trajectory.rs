//! γ⁻ = DS∘π1 − f⁻ as printed misses the momentum by the net force, the example's γ⁻ = D1 G_d by twice that;
//! both hold with the net force added, and without force (paper, section 4 and Example 4).

use dalembert::nalgebra::{SVector, vector};
use dalembert::{Discrete, Discretise, Midpoint, State, Trapezoidal, rayleigh_system};
use dalembert_tests::damped_oscillator::{DAMPED, H, UNDAMPED, trajectory};

#[test]
fn the_oscillators_gamma_minus_misses_by_half_r_times_the_displacement_over_two_steps() {
    let q = trajectory(&DAMPED, H, 0.0, 1.0, 20);
    let report = DAMPED.by(Midpoint, H).hamilton_jacobi().along_trajectory(&q).unwrap();
    assert!(report.trajectory.unwrap().holds(), "{report}");
    assert!(report.right_plus.unwrap().holds() && report.left_minus.unwrap().holds(), "{report}");
    for (pair, multiple) in [(report.right_minus, 1.0), (report.left_plus, 1.0), (report.example_minus, 2.0)]
    {
        let printed = pair.printed.unwrap();
        assert!(!printed.holds(), "{report}");
        let k = printed.step;
        let expected = multiple * DAMPED.r / 2.0 * (q[k + 1][0] - q[k - 1][0]);
        assert!(
            (printed.size - expected.abs()).abs() < 1e-14,
            "k = {k}: {} {expected}\n{report}",
            printed.size
        );
        assert!(printed.size > 0.05, "{report}");
        assert!(pair.corrected.unwrap().holds(), "{report}");
    }
}

#[test]
fn without_force_all_hold() {
    let q = trajectory(&UNDAMPED, H, 0.0, 1.0, 20);
    let report = UNDAMPED.by(Midpoint, H).hamilton_jacobi().along_trajectory(&q).unwrap();
    for pair in [report.right_minus, report.left_plus, report.example_minus] {
        assert!(pair.printed.unwrap().holds() && pair.corrected.unwrap().holds(), "{report}");
    }
    // Positive control: configurations that are no trajectory fail even without force.
    let mut bent = q;
    bent[7][0] += 1e-6;
    let report = UNDAMPED.by(Midpoint, H).hamilton_jacobi().along_trajectory(&bent).unwrap();
    assert!(
        !report.trajectory.unwrap().holds() && !report.right_minus.corrected.unwrap().holds(),
        "{report}"
    );
}

/// Pendulum-like, two degrees of freedom, friction that depends on q: the miss is the net force whatever the
/// system.
struct Drive {
    friction: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Drive {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * v[0] * v[0]
            + 0.8 * v[1] * v[1]
            + 0.3 * v[0] * v[1] * (q[0] - q[1]).cos()
            + 2.0 * q[0].cos()
            + q[1].cos()
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.friction * (1.0 + q[0] * q[0]) * (v[0] * v[0] + v[0] * v[1] + v[1] * v[1])
    }
}

fn check_drive<R: Copy>(rule: R)
where
    Drive: Discrete<R, 2, Scalar = f64>,
{
    let system = Drive { friction: 0.4 };
    let mut state = State { q: vector![0.9, -0.4], p: vector![0.2, 0.6] };
    let mut q: Vec<SVector<f64, 2>> = vec![state.q];
    for _ in 0..25 {
        state = system.by(rule, 0.1).step(&state).unwrap().state;
        q.push(state.q);
    }
    let report = system.by(rule, 0.1).hamilton_jacobi().along_trajectory(&q).unwrap();
    assert!(report.trajectory.unwrap().holds(), "{report}");
    assert!(report.net_force.unwrap().size > 1e-2, "{report}");
    for pair in [report.right_minus, report.left_plus, report.example_minus] {
        assert!(!pair.printed.unwrap().holds() && pair.corrected.unwrap().holds(), "{report}");
    }
}

#[test]
fn it_is_so_for_a_nonlinear_system_of_two_degrees_of_freedom_by_both_rules() {
    check_drive(Midpoint);
    check_drive(Trapezoidal);
}
