//! The block of `stick_slip` beside its motion written out: Runge–Kutta while it slips, a line while it
//! sticks.

use crate::stick_slip::{BELT, FRICTION, H, MASS, STIFFNESS, hanging, on_the_belt, slips};

/// The time from slip to slip, with that friction of fast sliding.
fn period(sliding: f64) -> f64 {
    let dt = 1e-5;
    let rate = |[q, v]: [f64; 2]| {
        let w = (v - BELT) / FRICTION.width;
        // Behind the belt: friction drags the block along.
        let friction = sliding + (FRICTION.at_rest - sliding) * (-w * w).exp();
        [v, (friction - STIFFNESS * q) / MASS]
    };
    let along = |[q, v]: [f64; 2], [dq, dv]: [f64; 2], by: f64| [q + dq * by, v + dv * by];
    let loose = FRICTION.at_rest / STIFFNESS;
    let (mut y, mut time) = ([loose, BELT], 0.0);
    while time < 0.01 || y[1] < BELT {
        let k1 = rate(y);
        let k2 = rate(along(y, k1, 0.5 * dt));
        let k3 = rate(along(y, k2, 0.5 * dt));
        let k4 = rate(along(y, k3, dt));
        y = std::array::from_fn(|i| y[i] + dt / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        time += dt;
    }
    time + (loose - y[0]) / BELT
}

#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn the_block_sticks_and_slips_in_the_period_of_its_motion_written_out() {
    let exact = period(FRICTION.sliding);
    let found = |start, h| {
        let times = slips(&on_the_belt(start, h, 6.0).unwrap());
        times[times.len() - 1] - times[times.len() - 2]
    };
    for start in [[0.0, 0.0], [0.02, 0.5]] {
        let [coarse, fine] = [H, 0.1 * H].map(|h| (found(start, h) - exact).abs());
        // Both ends of a period are ends of steps.
        assert!(coarse < 2.0 * H && fine < 0.2 * H, "{coarse:e} {fine:e}");
    }
    // Positive control: a twentieth more friction of sliding.
    assert!((period(1.05 * FRICTION.sliding) - exact).abs() > 10.0 * H);
}

#[test]
fn a_load_below_the_friction_moves_what_is_rounded_alone() {
    let moved = hanging(1e-2, 1.0).unwrap().map(|places| places.last().unwrap().1);
    // ε artanh(load/friction) a second, but for what F falls within ε.
    assert!(
        moved[0] == 0.0 && (moved[1] / 1.2e-3 - 1.0).abs() < 0.02 && (moved[2] / 1.2e-4 - 1.0).abs() < 0.02
    );
}
