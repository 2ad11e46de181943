//! The controllers against closed forms, and what the scenes `cart_pole`, `crane`, `arm` and `drive` claim to
//! hold.

#[path = "../examples/arm.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod arm;
#[path = "../examples/cart_pole.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod cart_pole;
#[path = "../examples/crane.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod crane;
#[path = "../examples/drive.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod drive;

use crane::{CRANE, G, H, LIFT, Moment, ROPE, WAY};
use dalembert::nalgebra::{SMatrix, matrix, vector};
use dalembert::step::Flow;
use dalembert::{Composition, Discretise, Gauss, Midpoint, State, StepError, rayleigh_system};
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
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
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

/// The crane by the place of its trolley and the angle of the rope.
struct ByAngle;

#[rayleigh_system(rule = gauss)]
impl ByAngle {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        let rates = self.rates(q, v, t);
        0.5 * CRANE.trolley * v[0] * v[0]
            + 0.5 * CRANE.load * (rates[0] * rates[0] + rates[1] * rates[1])
            + CRANE.load * G * self.rope(t)[0] * q[1].cos()
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        let rates = self.rates(q, v, t);
        0.5 * CRANE.drag[0] * v[0] * v[0] + 0.5 * CRANE.drag[1] * (rates[0] * rates[0] + rates[1] * rates[1])
    }

    fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
        [u[0], 0.0]
    }

    /// How the load moves along and up.
    fn rates(&self, q: [f64; 2], v: [f64; 2], t: f64) -> [f64; 2] {
        let [length, rate] = self.rope(t);
        let (s, c) = (q[1].sin(), q[1].cos());
        [v[0] + rate * s + length * c * v[1], length * s * v[1] - rate * c]
    }

    /// Its length and the rate of that.
    fn rope(&self, t: f64) -> [f64; 2] {
        let s = (t / LIFT).clamp(0.0, 1.0);
        let (share, rate) = (s * s * s * (10.0 - s * (15.0 - 6.0 * s)), 30.0 * (s * (1.0 - s)).powi(2));
        [ROPE[0] + (ROPE[1] - ROPE[0]) * share, (ROPE[1] - ROPE[0]) * rate / LIFT]
    }
}

/// Trolley and swing at the end of the lift under the forces of a run, each period in `parts` steps.
fn under<M: Copy>(method: M, run: &[Moment], parts: usize) -> Result<[f64; 2], StepError>
where
    crane::DrivenCrane<'static>: Flow<M, 3>,
{
    let still = CRANE.driven([0.0], 0.0);
    let start = State::from_velocity(&still, [0.0, 0.0, -ROPE[0]], [0.0; 3])?;
    let mut motion = still.by(method, H / parts as f64).run_with_inputs(start);
    for at in &run[..(LIFT / H) as usize] {
        for _ in 0..parts {
            motion.advance(&CRANE.driven([at.drive], motion.time()))?;
        }
    }
    let q = motion.state().q;
    Ok([q[0], (q[1] - q[0]).atan2(-q[2])])
}

#[test]
fn the_crane_goes_as_its_angle_does() {
    let run = crane::carried(&crane::gains().unwrap(), true).unwrap();
    let still = ByAngle.driven([0.0], 0.0);
    let start = State::from_velocity(&still, [0.0; 2], [0.0; 2]).unwrap();
    let mut by_angle = still.by(Gauss::<6>, H).run_with_inputs(start);
    for at in &run[..(LIFT / H) as usize] {
        by_angle.advance(&ByAngle.driven([at.drive], by_angle.time())).unwrap();
    }
    let exact = by_angle.state().q;
    let error = |found: [f64; 2]| (found[0] - exact[0]).abs().max((found[1] - exact[1]).abs());
    let [coarse, fine] = [1, 2].map(|parts| error(under(Midpoint, &run, parts).unwrap()));
    assert!(((coarse / fine).log2() - 2.0).abs() < 0.05 && coarse < 1e-4, "{coarse:e} {fine:e}");
    let by_order_8 = error(under(Composition::kahan_li_8(Midpoint), &run, 1).unwrap());
    assert!(by_order_8 < 1e-13, "{by_order_8:e}");
}

/// Where the rope no longer changes, no eigenvalue depends on coordinates: powers of A have equal traces.
#[test]
fn the_crane_has_the_eigenvalues_of_its_angle_and_two_of_0() {
    let (view, still) = (CRANE.driven([0.0], LIFT), ByAngle.driven([0.0], LIFT));
    let hanging = State::from_velocity(&view, [0.0, 0.0, -ROPE[1]], [0.0; 3]).unwrap();
    let a: SMatrix<f64, 6, 6> =
        view.by(Composition::kahan_li_8(Midpoint), H).linearized_step(&hanging).unwrap().1.assembled();
    let by_midpoint: SMatrix<f64, 6, 6> =
        view.by(Midpoint, H).linearized_step(&hanging).unwrap().1.assembled();
    let hanging = State::from_velocity(&still, [0.0; 2], [0.0; 2]).unwrap();
    let by_angle: SMatrix<f64, 4, 4> =
        still.by(Gauss::<6>, H).linearized_step(&hanging).unwrap().1.assembled();
    for power in 1..=6 {
        let expected = by_angle.pow(power).trace();
        let found = a.pow(power).trace();
        assert!((found - expected).abs() < 1e-12, "{power}: {found} {expected}");
        // Positive control: by the midpoint rule they are those of a step of order 2.
        assert!((by_midpoint.pow(power).trace() - expected).abs() > 1e-6);
    }
}

#[test]
fn the_crane_brings_its_load_to_rest() {
    let mut gains = crane::gains().unwrap();
    gains.resize(3000, *gains.last().unwrap());
    let seeing = crane::carried(&gains, true).unwrap();
    let blind = crane::carried(&gains[..crane::PERIODS], false).unwrap();
    assert!(crane::largest_swing(&seeing, LIFT + 1.0) < 0.4_f64.to_radians());
    // Positive control: gains that do not see the load leave it swinging.
    assert!(crane::largest_swing(&blind, LIFT + 1.0) > 1.5_f64.to_radians());
    let end = seeing.last().unwrap();
    assert!((end.q - vector![WAY, WAY, -ROPE[1]]).amax() < 1e-11);
    assert!((end.tension - G * CRANE.load).abs() < 1e-8);
    // A rope does not push.
    assert!(seeing.iter().all(|at| at.tension > 9e3));
    // The hoist brings what the rope's force does along the rope.
    let work = |pair: &[Moment]| {
        let [from, to] = [pair[0], pair[1]].map(|at| (at.q[0] - at.q[1]).hypot(at.q[2]));
        0.5 * (pair[0].tension + pair[1].tension) * (from - to)
    };
    let hoist: f64 = seeing.windows(2).map(work).sum();
    assert!((hoist / end.account.remainder() - 1.0).abs() < 1e-3);
}

/// With the integral alone the load goes on from one side of the angle to the other; with a dead zone it
/// stands in it to the last bit.
#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn a_dead_zone_ends_the_hunting() {
    let [hunting, still] = [0.0, drive::DEAD_ZONE].map(|dead_zone| {
        let moments = drive::motion(drive::Controller::with(dead_zone)).unwrap();
        moments.into_iter().filter(|at| at.time > 5.0).collect::<Vec<_>>()
    });
    assert!(still.iter().all(|at| at.stands && (at.angles[1] - drive::WANTED).abs() < drive::DEAD_ZONE));
    let sides = hunting.iter().map(|at| at.angles[1] > drive::WANTED).collect::<Vec<_>>();
    let crossings = sides.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!((3..=5).contains(&crossings), "{crossings}");
    // Between the jumps it stands.
    assert!(hunting.iter().filter(|at| at.stands).count() > hunting.len() / 4);
}
