//! Steps through which no slip turns are solved with the friction known: they are those of the general way,
//! which a step from the state alone takes.

use dalembert::{Discretise, Proximal, State, rayleigh_system};
use dalembert_tests::draws::Draws;

/// A block on ground that is rougher on the way, another on it and on a belt; the mass of both depends on q.
struct Rough {
    mu: f64,
    rougher: f64,
    belt: f64,
}

#[rayleigh_system(rule = proximal)]
impl Rough {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (1.0 + 0.3 * q[0] * q[0]) * v[0] * v[0] + 0.5 * v[1] * v[1] + 0.2 * v[0] * v[1]
            - 0.5 * q[0] * q[0]
            + (q[1] - q[0]).cos()
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.mu * (1.0 + self.rougher * q[0] * q[0]) * v[0].abs()
            + 0.3 * (v[1] - v[0]).abs()
            + 0.1 * (v[1] - self.belt).abs()
            + 0.05 * v[1] * v[1]
    }
}

/// Whether the signs of all slips are those of others, of which none is 0.
fn keep_on(one: &[f64; 3], other: &[f64; 3]) -> bool {
    one.iter().zip(other).all(|(one, other)| one * other > 0.0)
}

impl Rough {
    fn slips(&self, v: &[f64]) -> [f64; 3] {
        [v[0], v[1] - v[0], v[1] - self.belt]
    }
}

/// The largest difference between steps from a guess and from the state alone over 60 steps from random
/// starts, of unturned and of turned slips; and how many there were of each.
fn apart(seed: u64) -> ([f64; 2], [usize; 2]) {
    let mut draws = Draws::new(seed);
    let belt = draws.between(-1.0, 1.0);
    let rough = Rough { mu: draws.between(0.0, 0.5), rougher: draws.between(0.0, 2.0), belt };
    let mut between = |size: f64| [draws.between(-size, size), draws.between(-size, size)];
    let mut state = State::from_velocity(&rough, between(1.0), between(1.5)).unwrap();
    let by = rough.by(Proximal, 0.02);
    let (mut apart, mut count) = ([0.0_f64; 2], [0; 2]);
    let mut last = rough.slips(state.velocity(&rough).unwrap().as_slice());
    for step in by.run(state).take(60) {
        let (found, alone) = (step.unwrap(), by.step(&state).unwrap());
        let (q, p) = (found.state.q - alone.state.q, found.state.p - alone.state.p);
        let now = rough.slips(alone.velocity.as_slice());
        let at_end = rough.slips(alone.state.velocity(&rough).unwrap().as_slice());
        let turned = usize::from(!(keep_on(&last, &now) && keep_on(&now, &at_end)));
        apart[turned] = apart[turned].max(q.amax()).max(p.amax());
        count[turned] += 1;
        (state, last) = (found.state, now);
    }
    (apart, count)
}

#[test]
fn a_step_from_a_guess_is_the_step() {
    let (mut apart, mut count) = ([0.0_f64; 2], [0; 2]);
    for seed in 0..if cfg!(debug_assertions) { 30 } else { 2000 } {
        let (of_run, steps) = self::apart(seed);
        for kind in [0, 1] {
            apart[kind] = apart[kind].max(of_run[kind]);
            count[kind] += steps[kind];
        }
    }
    // Where a slip turns, both are found in the general way, from two guesses. A sign taken wrongly would
    // move p by (h/2)·0.1 at the least.
    assert!(apart[0] < 4e-15 && apart[1] < 1e-13, "{apart:?}");
    assert!(count[0] > 500 && count[1] > 100, "{count:?}");
}
