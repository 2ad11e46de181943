//! The controllers against closed forms, and what the scenes `cart_pole` and `arm` claim to hold.

#[path = "../examples/arm.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod arm;
#[path = "../examples/cart_pole.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod cart_pole;

use dalembert::nalgebra::{matrix, vector};
use dalembert_examples::control::{Estimate, Linearised, Regulator};

/// x₁ = x + u with unit weights: P = 1 + P/(1 + P) is the golden ratio, and K = P/(1 + P) = P − 1.
#[test]
fn the_regulator_of_an_integrator_is_the_golden_ratio() {
    let model = Linearised { next: vector![0.0], a: matrix![1.0], b: matrix![1.0] };
    let gain = Regulator::of(&model, &matrix![1.0], &matrix![1.0]).unwrap().gain;
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    assert!((gain[0] - (golden - 1.0)).abs() < 1e-11, "{gain}");
    // Positive control: what no input reaches cannot be stabilised.
    let model = Linearised { b: matrix![0.0], a: matrix![1.1], ..model };
    assert!(Regulator::of(&model, &matrix![1.0], &matrix![1.0]).is_err());
}

/// The dual of the same: the filter's covariance before a measurement settles at the golden ratio.
#[test]
fn the_filter_of_a_random_walk_settles_at_the_golden_ratio() {
    let model = Linearised { next: vector![0.0], a: matrix![1.0], b: matrix![1.0] };
    let mut estimate = Estimate { x: vector![0.0], covariance: matrix![7.0] };
    for _ in 0..60 {
        estimate = estimate.corrected(&vector![0.3], &matrix![1.0], &matrix![1.0]).unwrap();
        estimate = estimate.predicted(&model, &matrix![1.0]);
    }
    assert!((estimate.covariance[0] - (1.0 + 5.0_f64.sqrt()) / 2.0).abs() < 1e-14);
    let corrected = estimate.corrected(&vector![1.0], &matrix![1.0], &matrix![1.0]).unwrap();
    assert!((corrected.x[0] - (5.0_f64.sqrt() - 1.0) / 2.0).abs() < 1e-14, "{}", corrected.x);
}

#[test]
fn the_cart_swings_its_pole_up_and_holds_it() {
    use cart_pole::{PERIODS, Run, SWING};
    let (plan, _) = cart_pole::swing_up().unwrap();
    let gain = cart_pole::upright_gain().unwrap();
    let held = SWING..PERIODS;
    let run = Run::new(&plan, &gain, true).unwrap();
    assert!(run.largest_angle(held.clone()) < 0.15 && run.largest_offset(held.clone()) < 0.5);
    // Positive control: the same forces without feedback let it fall.
    let fallen = Run::new(&plan, &gain, false).unwrap();
    assert!(fallen.largest_angle(held) > 1.0);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn the_arm_keeps_to_its_reference() {
    use arm::{Run, SETTLED, rms};
    let run = Run::new().unwrap();
    assert!(rms(&run.misses[SETTLED..]) < 5e-4);
    // The model makes velocities of angles: an encoder alone has noise √2 · 0.5 mrad from one reading to the
    // next, in two joints.
    let by_noise = (2.0_f64 * 2.0).sqrt() * 5e-4 / arm::ENCODERS[1];
    assert!((rms(&run.difference_errors[SETTLED..]) / by_noise - 1.0).abs() < 0.05);
    assert!(20.0 * rms(&run.filter_errors[SETTLED..]) < by_noise);
}
