//! Sliders drawn at random, by steps and from event to event: `cargo study friction` takes more of them, for
//! docs/evidence/dry-friction.md.

use dalembert::{Discretise, Proximal, State};
use dalembert_tests::sliders::{Drawn, Motion};

/// The largest error of a place at rest by steps of h.
fn off(drawn: &Drawn, motion: &Motion<'_>, h: f64) -> f64 {
    let start = State::from_velocity(&drawn.sliders, drawn.q, drawn.v).unwrap();
    let steps = drawn.sliders.by(Proximal, h).run(start).take((TIME / h).round() as usize);
    (steps.last().unwrap().unwrap().state.q - motion.q).amax()
}

/// The time of a motion: without optimisation the second program takes a second for ten units.
const TIME: f64 = if cfg!(debug_assertions) { 8.0 } else { 30.0 };

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn sliders_come_to_rest_where_their_events_say() {
    for has_belts in [false, true] {
        let (mut coarse, mut fine, mut other) = (Vec::new(), Vec::new(), Vec::new());
        for seed in 20_000..if cfg!(debug_assertions) { 20_003 } else { 20_010 } {
            let drawn = Drawn::of(seed, has_belts);
            let mut motion = Motion::new(&drawn.sliders, drawn.q, drawn.v);
            motion.advance(TIME);
            coarse.push(off(&drawn, &motion, 0.04));
            fine.push(off(&drawn, &motion, 0.01));
            // Positive control: a hundredth more friction.
            let mut more = drawn.sliders;
            more.f.iter_mut().for_each(|f| *f *= 1.01);
            let mut motion = Motion::new(&more, drawn.q, drawn.v);
            motion.advance(TIME);
            other.push(off(&drawn, &motion, 0.01));
        }
        let largest = fine.iter().fold(0.0, |most: f64, &off| most.max(off));
        let [coarse, fine, other] = [coarse, fine, other].map(median);
        assert!(largest < 5e-3 && fine < 6e-4, "belts {has_belts}: {fine:e}, at most {largest:e}");
        assert!(
            coarse > 2.5 * fine && other > 3.0 * fine,
            "belts {has_belts}: {coarse:e} {fine:e} {other:e}"
        );
    }
}
