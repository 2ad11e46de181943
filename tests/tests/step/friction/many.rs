//! Several elements of friction, drawn at random: v̄ against the least of the objective over all ways to
//! stick and to slide. `cargo study friction` takes more of them.
//!
//! ```text
//! v̄ = argmin ½vᵀMv − p·v + (h/2) Σ Fₖ |Bₖ v|
//! ```

use dalembert::nalgebra::Vector4;
use dalembert_tests::draws::Draws;
use dalembert_tests::sliders::Problem;

#[test]
fn steps_are_the_least_of_all_sets() {
    let mut draws = Draws::new(5);
    let (mut stuck, mut worst) = (0, 0.0_f64);
    for _ in 0..if cfg!(debug_assertions) { 40 } else { 400 } {
        let problem = Problem::drawn(&mut draws);
        let v = problem.velocity(false).unwrap();
        stuck += usize::from((0..5).any(|k| (problem.b.row(k) * v)[0].abs() < 1e-14));
        let least = problem.least();
        let over = |v: &Vector4<f64>| (problem.objective(v) - least) / (1.0 + least.abs());
        worst = worst.max(over(&v));
        // Positive control.
        assert!(over(&(v + Vector4::new(1e-5, 0.0, 0.0, 0.0))) > 1e-12);
    }
    assert!(worst < 1e-14 && stuck > 10, "{worst:e}, {stuck} stick");
}

/// A length beside |·|: of its force |s| ≤ 1, along its slip where that is not 0.
#[test]
fn a_length_is_held_by_a_ball() {
    let mut draws = Draws::new(6);
    let mut stuck = 0;
    for _ in 0..if cfg!(debug_assertions) { 40 } else { 400 } {
        let mut problem = Problem::drawn(&mut draws);
        // Beside each other at most as many as coordinates, so that their forces are known.
        problem.f[4] = 0.0;
        problem.f[0] *= 3.0;
        let v = problem.velocity(true).unwrap();
        let slips = problem.b * v;
        let left = problem.p - problem.m * v;
        // (h/2) Σ F Bᵀs = p − Mv for s by least squares.
        let mut rows = problem.b.fixed_rows::<4>(0).transpose() * problem.half;
        for (k, f) in [problem.f[0], problem.f[0], problem.f[2], problem.f[3]].into_iter().enumerate() {
            rows.column_mut(k).scale_mut(f);
        }
        let s = rows.lu().solve(&left).unwrap();
        let length = slips[0].hypot(slips[1]);
        assert!(s[0].hypot(s[1]) < 1.0 + 1e-9 && s[2].abs() < 1.0 + 1e-9 && s[3].abs() < 1.0 + 1e-9);
        if length > 1e-12 {
            assert!((s[0] - slips[0] / length).abs() < 1e-7 && (s[1] - slips[1] / length).abs() < 1e-7);
        } else {
            stuck += 1;
        }
    }
    assert!(stuck > 5);
}
