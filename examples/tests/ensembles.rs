//! What the scenes `escape` and `settling` claim, against computations that share no code with them.

#[path = "../examples/escape.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod escape;
#[path = "../examples/settling.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod settling;

use dalembert::{Discretise, Midpoint, State};
use dalembert_examples::picture::colour;
use escape::{ENERGY, Fate, GONE, H, Plane, along, left_through};
use indicatif::ProgressBar;
use nalgebra::{SVector, Vector2};
use settling::{EXPECTED, G, L, M, RECORDS, STIFFNESS, WANTED};

fn fates(columns: usize, energy: f64) -> (Plane, Vec<Fate>) {
    let plane = Plane::new(columns, energy);
    let fates = escape::fates(&plane, &ProgressBar::hidden()).unwrap();
    assert!(fates.len() as u64 == plane.members() && fates.len() > 50, "{}", fates.len());
    (plane, fates)
}

/// q̈ = −∂V/∂q written by hand, one step of the classical Runge–Kutta method.
fn runge_kutta(state: &State<f64, 2>, h: f64) -> State<f64, 2> {
    let force = |q: &Vector2<f64>| Vector2::new(-q.x - 2.0 * q.x * q.y, -q.y - q.x * q.x + q.y * q.y);
    let State { q, p } = *state;
    let [a, b] = [p, force(&q)];
    let [c, d] = [p + 0.5 * h * b, force(&(q + 0.5 * h * a))];
    let [e, f] = [p + 0.5 * h * d, force(&(q + 0.5 * h * c))];
    let [i, j] = [p + h * f, force(&(q + h * e))];
    State { q: q + h / 6.0 * (a + 2.0 * (c + e) + i), p: p + h / 6.0 * (b + 2.0 * (d + f) + j) }
}

#[test]
fn starts_leave_as_another_method_says_and_keep_their_energy() {
    let (plane, fates) = fates(31, ENERGY);
    let mut compared = 0;
    for (number, fate) in (0..).zip(&fates) {
        assert!(fate.energy_error < 1e-9, "{fate:?}");
        // Later the errors of the other method have grown as the motion spreads them.
        if fate.time > 25.0 {
            continue;
        }
        let (mut state, mut time) = (plane.start(number), 0.0);
        while left_through(&state).is_none() && time < 26.0 {
            state = runge_kutta(&state, 0.01);
            time += 0.01;
        }
        assert_eq!(left_through(&state), fate.opening, "{number}");
        assert!((fate.time - H - 0.02..fate.time + 0.02).contains(&time), "{number}: {time} {fate:?}");
        compared += 1;
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn below_the_threshold_none_leaves_and_above_it_most_do() {
    let inside = |energy| {
        let (_, fates) = fates(24, energy);
        let inside = fates.iter().filter(|fate| fate.opening.is_none()).count();
        inside as f64 / fates.len() as f64
    };
    // Beyond the saddles, at s = 1, the energy 0.16 allows positions as well: their starts leave at once.
    let (plane, below) = fates(24, 0.16);
    for (number, fate) in (0..).zip(&below) {
        let is_beyond = along(&plane.start(number).q).iter().any(|&s| s > 1.0);
        assert_eq!(fate.opening.is_some(), is_beyond, "{number}: {fate:?}");
    }
    assert!(inside(0.16) > 0.9 && inside(ENERGY) < 0.1, "{} {}", inside(0.16), inside(ENERGY));
}

/// A rotation by 120° takes the opening above to the left, left to right, and right to above.
#[test]
fn a_start_turned_by_a_third_leaves_through_the_next_opening() {
    let (plane, fates) = fates(31, ENERGY);
    let (sine, cosine) = (0.75_f64.sqrt(), -0.5);
    let turned = |of: SVector<f64, 2>| Vector2::new(cosine * of.x - sine * of.y, sine * of.x + cosine * of.y);
    let mut numbers_of = [0; 3];
    for (number, fate) in (0..).zip(&fates) {
        let Some(opening) = fate.opening else { continue };
        // Rounding grows as the motion spreads it.
        if fate.time > 60.0 {
            continue;
        }
        let State { q, p } = plane.start(number);
        let start = State { q: turned(q), p: turned(p) };
        let method = dalembert::Splitting::blanes_moan_6();
        let mut run = escape::HenonHeiles {}.by(method, H).run(start);
        let state = run.nth((fate.time / H) as usize - 1).unwrap().unwrap().state;
        assert_eq!(left_through(&state), Some([2, 0, 1][opening]), "{number}");
        numbers_of[opening] += 1;
    }
    assert!(numbers_of.iter().all(|&number| number > 50), "{numbers_of:?}");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn the_three_shares_are_equal_but_for_sampling() {
    let (plane, fates) = fates(80, ENERGY);
    // In standard deviations of as many members drawn at random: a grid samples no worse.
    let uneven = |fates: &[Fate]| {
        let left = escape::left(fates).map(|left| left as f64);
        let all: f64 = left.iter().sum();
        left.iter().map(|left| (left - all / 3.0).abs() / (2.0 / 9.0 * all).sqrt()).fold(0.0, f64::max)
    };
    assert!(uneven(&fates) < 4.0, "{}", uneven(&fates));
    // Positive control: starts near one opening, which no rotation takes into themselves.
    let near = fates.iter().zip(0..).filter(|&(_, number)| plane.start(number).q.y > 0.8);
    let near: Vec<Fate> = near.map(|(fate, _)| *fate).collect();
    assert!(uneven(&near) > 4.0, "{}", uneven(&near));
}

/// From the line that counts as gone no member returns, whatever its direction; from within the saddle some
/// do.
#[test]
fn what_has_left_does_not_return() {
    let returns = |line: f64| {
        let mut returned = 0;
        for k in 0..400 {
            let (w, angle) = (0.02 * f64::from(k % 20) - 0.19, 0.15 * f64::from(k / 20) + 0.05);
            // Along the opening above: x = w, y = s.
            let kinetic = ENERGY - (0.5 * (w * w + line * line) + w * w * line - line.powi(3) / 3.0);
            if kinetic < 0.0 {
                continue;
            }
            let speed = (2.0 * kinetic).sqrt();
            let p = speed * Vector2::new(angle.cos(), angle.sin());
            assert!(p.y > 0.0);
            let mut state = State { q: Vector2::new(w, line), p };
            let mut steps = 0;
            while state.q.y < 3.0 && state.p.y > 0.0 && steps < 3000 {
                state = runge_kutta(&state, 0.01);
                steps += 1;
            }
            returned += usize::from(state.q.y < 3.0);
        }
        returned
    };
    assert_eq!(returns(GONE), 0);
    assert!(returns(0.9) > 20, "{}", returns(0.9));
}

/// How many arms the small study has.
const ARMS: u64 = 150;

fn small_study() -> settling::Study {
    settling::study(ARMS, &ProgressBar::hidden()).unwrap()
}

/// The `share` of sorted values that is below.
fn percentile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((share * values.len() as f64) as usize).min(values.len() - 1)]
}

/// The largest gap between neighbours around a percentile: what different definitions of it may differ by.
fn gap(values: &[f64], share: f64) -> f64 {
    let at = (share * values.len() as f64) as usize;
    values[at + 1] - values[at - 2]
}

#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn percentiles_are_those_of_all_arms_one_by_one() {
    let study = small_study();
    for record in [20, 60, 130] {
        let mut heights: Vec<f64> = (0..ARMS)
            .map(|number| {
                let (arm, start) = settling::member(number).unwrap();
                let steps = (settling::time(record) / 5e-3).round() as usize;
                let state = arm.by(Midpoint, 5e-3).run(start).nth(steps - 1).unwrap().unwrap().state;
                settling::tip(state.q.into()).y
            })
            .collect();
        for share in [0.05, 0.25, 0.5, 0.75, 0.95] {
            let (one_by_one, counted) =
                (percentile(&mut heights, share), study.heights[record].percentile(share));
            assert!(
                (counted - one_by_one).abs() <= 1e-3 + gap(&heights, share),
                "{record} {share}: {counted} {one_by_one}"
            );
        }
        // Positive control: the band is wider than what is allowed.
        assert!(percentile(&mut heights, 0.95) - percentile(&mut heights, 0.05) > 0.07);
    }
}

/// Where springs, holding torque and weight are in balance, whatever the friction: by fixed point.
fn height_at_rest(payload: f64) -> f64 {
    let weight = |q: [f64; 2], payload: f64| {
        let tip = M[1] / 2.0 + payload;
        let second = G * tip * L[1] * (q[0] + q[1]).cos();
        [G * (M[0] / 2.0 + M[1] + payload) * L[0] * q[0].cos() + second, second]
    };
    let (mut q, held) = (WANTED, weight(WANTED, EXPECTED));
    for _ in 0..200 {
        let load = weight(q, payload);
        q = [0, 1].map(|k| WANTED[k] + (held[k] - load[k]) / STIFFNESS[k]);
    }
    L[0] * q[0].sin() + L[1] * (q[0] + q[1]).sin()
}

#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn arms_end_where_the_spring_holds_their_payload() {
    let study = small_study();
    let mut rests: Vec<f64> =
        (0..ARMS).map(|number| height_at_rest(settling::member(number).unwrap().0.payload)).collect();
    for share in [0.05, 0.25, 0.5, 0.75, 0.95] {
        let (rest, end) = (percentile(&mut rests, share), study.heights[RECORDS].percentile(share));
        assert!((end - rest).abs() <= 1.5e-3 + gap(&rests, share), "{share}: {end} {rest}");
    }
    // With the payload expected the arm ends where it is wanted; positive control: the others do not.
    assert!((height_at_rest(EXPECTED) - settling::tip(WANTED).y).abs() < 1e-12);
    assert!(height_at_rest(1.0) < height_at_rest(0.5) - 0.04);
}

#[test]
fn colours_of_the_openings_are_as_far_apart_in_grey() {
    let grey = |colour: dalembert_examples::picture::RGBColor| {
        0.2126 * f64::from(colour.0) + 0.7152 * f64::from(colour.1) + 0.0722 * f64::from(colour.2)
    };
    let greys = [colour::REFERENCE, colour::VARIATIONAL, colour::FIFTH, colour::SEVENTH].map(grey);
    assert!(greys.windows(2).all(|pair| pair[1] - pair[0] > 40.0), "{greys:?}");
}
