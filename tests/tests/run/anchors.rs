//! Sines, cosines and reciprocals that start from those of the sweep before: how far off they may be, beside
//! 31 digits, and that each lane is what it is alone.

use std::f64::consts::FRAC_PI_2;

use dalembert::generated::{Angle, Lanes, Members, Reciprocal};
use dalembert::system::Blank;
use double_double::DoubleDouble;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Beyond this an angle is taken for a new one.
const FARTHEST: f64 = 0.1875;

/// An angle of any size, half of them next to a multiple of π/2.
fn angle(random: &mut StdRng) -> f64 {
    let size = 10_f64.powf(random.random_range(-9.0..4.0));
    let sign = if random.random() { 1.0 } else { -1.0 };
    match random.random() {
        true => sign * size,
        false => f64::from(random.random_range(-20..20)) * FRAC_PI_2 + sign * size.min(0.3),
    }
}

/// Errors of sine and cosine at x + δ from those at x, in units of ε (|sine| + |δ|) and of ε (|cosine| +
/// |δ|).
fn errors(x: f64, by: f64) -> [f64; 2] {
    let mut near = Angle::<Lanes<f64, 1>>::blank();
    let _ = near.sin_cos(Lanes([x]));
    let moved = x + by;
    let (sine, cosine) = near.sin_cos(Lanes([moved]));
    let (exact_sine, exact_cosine) = DoubleDouble::from(moved).sin_cos();
    [(sine.0[0], exact_sine), (cosine.0[0], exact_cosine)].map(|(value, exact)| {
        let unit = f64::EPSILON * (exact.high.abs() + (moved - x).abs());
        (DoubleDouble::from(value) - exact).abs().high / unit
    })
}

#[test]
fn sines_and_cosines_from_near_by_are_rounded_as_others_are() {
    let mut random = StdRng::seed_from_u64(31);
    let mut worst = 0.0_f64;
    for _ in 0..20_000 {
        let x = angle(&mut random);
        let by = FARTHEST * random.random_range(-1.0_f64..1.0).powi(random.random_range(1..40));
        let [sine, cosine] = errors(x, by);
        worst = worst.max(sine).max(cosine);
    }
    assert!((1.0..2.0).contains(&worst), "{worst}");
    // The control: sine and cosine of one double are seen to be off where the angle is off by its last place.
    let mut seen = 0;
    for _ in 0..1000 {
        let x = f64::from(random.random_range(3..40)) * FRAC_PI_2 + random.random_range(0.1..0.2);
        let exact = DoubleDouble::from(x).sin_cos();
        let beside = f64::from_bits(x.to_bits() + 1).sin_cos();
        for (value, exact) in [(beside.0, exact.0), (beside.1, exact.1)] {
            let error = (DoubleDouble::from(value) - exact).abs().high;
            seen += usize::from(error > 2.0 * f64::EPSILON * exact.high.abs());
        }
    }
    assert!(seen > 800, "{seen}");
}

/// Far or near, with neighbours of every kind, in one kind of numbers side by side and in the other.
#[test]
fn each_is_what_it_is_alone() {
    let bits = |x: f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
    let mut random = StdRng::seed_from_u64(32);
    let mut together = (Angle::<Members<f64, 8>>::blank(), Reciprocal::<Members<f64, 8>>::blank());
    let mut alone = [(Angle::<Lanes<f64, 1>>::blank(), Reciprocal::<Lanes<f64, 1>>::blank()); 8];
    let mut x = [0.3, -0.0, 1e9, f64::INFINITY, f64::NAN, 5.0, 0.1, -2.0];
    let mut of_far = [0; 2];
    for sweep in 0..2000 {
        let (sines, cosines) = together.0.sin_cos(Members(x));
        let reciprocals = together.1.of(Members(x));
        for lane in 0..8 {
            let (angle, reciprocal) = &mut alone[lane];
            let (sine, cosine) = angle.sin_cos(Lanes([x[lane]]));
            let own = [sine, cosine, reciprocal.of(Lanes([x[lane]]))].map(|own| bits(own.0[0]));
            assert_eq!([sines.0[lane], cosines.0[lane], reciprocals.0[lane]].map(bits), own, "{sweep}");
            // What is no number has no sine; what is far has that of numbers side by side.
            let (full_sine, full_cosine) = Lanes([x[lane]]).sin_cos();
            assert_eq!(x[lane].is_finite(), sines.0[lane].is_finite());
            let is_full = (sines.0[lane], cosines.0[lane]) == (full_sine.0[0], full_cosine.0[0]);
            assert!(is_full || x[lane].is_nan() || x[lane].is_infinite() || sweep > 0);
            of_far[usize::from(is_full)] += 1;
        }
        for x in &mut x {
            let size = if random.random_range(0..50) == 0 { 10.0 } else { 0.02 };
            *x += random.random_range(-size..size);
            if random.random_range(0..400) == 0 {
                *x = [f64::NAN, f64::INFINITY, 1e300, 0.0, 0.4][random.random_range(0..5)];
            }
        }
    }
    assert!(of_far.iter().all(|&count| count > 1000), "{of_far:?}");
}

#[test]
fn reciprocals_converge_as_sweeps_do() {
    let mut random = StdRng::seed_from_u64(33);
    for _ in 0..1000 {
        let x = 10_f64.powf(random.random_range(-100.0..100.0)) * if random.random() { 1.0 } else { -1.0 };
        let mut near = Reciprocal::<Lanes<f64, 1>>::blank();
        assert_eq!(near.of(Lanes([x])).0, [1.0 / x]);
        // By less than a sixteenth: off by the square.
        let share = random.random_range(-0.06..0.06);
        let moved = x * (1.0 + share);
        let once = near.of(Lanes([moved])).0[0] * moved - 1.0;
        assert!((once.abs() - share * share).abs() < 1e-15, "{once:e} {share}");
        for _ in 0..4 {
            let _ = near.of(Lanes([moved]));
        }
        assert!((near.of(Lanes([moved])).0[0] * moved - 1.0).abs() < 4e-16);
        // By more: the quotient.
        let far = x * random.random_range(-2.0..0.9);
        assert_eq!(near.of(Lanes([far])).0, [1.0 / far]);
    }
    let mut near = Reciprocal::<Lanes<f64, 2>>::blank();
    let _ = near.of(Lanes([0.5, 2.0]));
    assert_eq!(near.of(Lanes([0.0, 2.0])).0, [f64::INFINITY, 0.5]);
}
