//! Friction that holds, by `rule = proximal`: kinks of R implicit at both ends of a step.

mod derivatives;
mod hysteresis;
mod inclusion;
mod many;
mod sliders;
mod unturned;
mod verdicts;
mod without_mass;
mod written;

use dalembert::nalgebra::{Vector2, vector};
use dalembert::step::Step;
use dalembert::{Discretise, Midpoint, Proximal, State, rayleigh_system};

/// A block on a spring, on a belt or the ground.
#[derive(Clone, Copy)]
struct Block {
    m: f64,
    k: f64,
    mu: f64,
    belt: f64,
    /// Viscous drag.
    c: f64,
    load: f64,
}

const BLOCK: Block = Block { m: 1.0, k: 1.0, mu: 0.2, belt: 0.0, c: 0.0, load: 0.0 };

#[rayleigh_system(rule = proximal)]
impl Block {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0] - 0.5 * self.k * q[0] * q[0] + self.load * q[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        self.mu * (v[0] - self.belt).abs() + 0.5 * self.c * v[0] * v[0]
    }
}

/// The block by dual numbers, which do not see the kink.
struct Unseen(Block);

#[rayleigh_system(derivatives = num_dual)]
impl Unseen {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.0.m * v[0] * v[0] - 0.5 * self.0.k * q[0] * q[0] + self.0.load * q[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        self.0.mu * (v[0] - self.0.belt).abs() + 0.5 * self.0.c * v[0] * v[0]
    }
}

fn at(q: f64, p: f64) -> State<f64, 1> {
    State { q: vector![q], p: vector![p] }
}

/// (q1, p1, v̄) in closed form: v̄ = soft(p − (h/2)kq, (h/2)μ)/(m + h²k/4), and p1 likewise.
#[test]
fn steps_are_those_in_closed_form() {
    let block = Block { m: 1.3, k: 2.0, mu: 0.4, ..BLOCK };
    let cases = [
        (0.1, [0.31, 0.5], [0.344406130268199, 0.39455938697318, 0.344061302681992]),
        (0.1, [0.31, 0.02], [0.31, -0.011, 0.0]),
        (0.1, [0.11, 0.004], [0.11, 0.0, 0.0]),
        (0.1, [0.5, 0.1], [0.502298850574713, -0.000229885057471263, 0.0229885057471264]),
        (0.05, [0.31, 0.5], [0.328232468780019, 0.448088376560999, 0.364649375600384]),
        (0.05, [0.31, 0.02], [0.31, -0.0055, 0.0]),
        (0.05, [0.5, 0.1], [0.502497598463016, 0.0298751200768492, 0.0499519692603266]),
    ];
    for (h, [q, p], [q1, p1, v]) in cases {
        let step = block.by(Proximal, h).step(&at(q, p)).unwrap();
        let off = [step.state.q[0] - q1, step.state.p[0] - p1, step.velocity[0] - v];
        assert!(off.iter().all(|off| off.abs() < 1e-15), "h = {h} from ({q}, {p}): {off:?}");
    }
}

/// Arcs about ∓μ, until the block stops within them; from (1, 0) it stops on the edge, at 2π.
#[test]
fn a_block_comes_to_rest_where_it_does_in_closed_form() {
    let starts =
        [([0.9, -0.3], 0.161577310586, 5.878293520894), ([0.5, 0.7], -0.010050506339, 7.068583470577)];
    let mut off = [0.0_f64; 3];
    for ([q, v], at_rest, from) in starts {
        for (k, off) in off.iter_mut().enumerate() {
            let h = 0.1 / f64::from(1 << (2 * k));
            let start = State::from_velocity(&BLOCK, [q], [v]).unwrap();
            let mut steps = BLOCK.by(Proximal, h).run(start).map(Result::unwrap);
            let is_at_rest = |step: &Step<f64, 1>| step.velocity[0] == 0.0 && step.state.p[0] == 0.0;
            let rest = steps.by_ref().position(|step| is_at_rest(&step)).unwrap();
            let time = (rest + 1) as f64 * h;
            assert!((from..from + 2.0 * h).contains(&time), "h = {h}: {time} for {from}");
            let stopped = steps.next().unwrap().state;
            // Bit by bit.
            assert!(steps.take(1000).all(|step| step.state == stopped));
            *off = off.max((stopped.q[0] - at_rest).abs());
        }
    }
    // Order 2: a quarter of h, a sixteenth of the error, but for where in a step it stops.
    assert!(off[0] < 1e-3 && off[2] < off[0] / 100.0, "{off:?}");
    // Positive control: by the midpoint rule, which is not told of the kink, p alternates for ever.
    let start = State::from_velocity(&BLOCK, [0.9], [-0.3]).unwrap();
    let steps = Unseen(BLOCK).by(Midpoint, 0.1).run(start).take(200).map_while(Result::ok);
    assert!(!steps.into_iter().any(|step| step.state.p[0] == 0.0));
}

#[test]
fn a_block_holds_as_long_as_its_load_is_within_the_friction() {
    let mut draws = dalembert_tests::draws::Draws::new(11);
    let mut held = [0, 0];
    for _ in 0..400 {
        let (mu, h) = (draws.scale(1e-6, 1e6), draws.scale(1e-4, 0.3));
        let sign = draws.sign();
        for (k, share) in [1.0 - 1e-12, 1.0 + 1e-12].into_iter().enumerate() {
            let block = Block { mu, load: sign * mu * share, ..BLOCK };
            let step = block.by(Proximal, h).step(&at(0.0, 0.0)).unwrap();
            held[k] += usize::from(step.state == at(0.0, 0.0));
        }
    }
    assert_eq!(held, [400, 0]);
}

#[test]
fn nothing_creeps() {
    let block = Block { load: 0.999 * BLOCK.mu, ..BLOCK };
    let mut run = block.by(Proximal, 0.01).run(at(0.0, 0.0));
    let last = run.nth(20_000).unwrap().unwrap().state;
    assert_eq!(last, at(0.0, 0.0));
    // Positive control.
    let block = Block { load: 1.001 * BLOCK.mu, ..BLOCK };
    assert!(block.by(Proximal, 0.01).run(at(0.0, 0.0)).nth(10).unwrap().unwrap().state.q[0] > 0.0);
}

/// With constant friction q̈ + cq̇ + q = μ until v = 0, solved in closed form.
#[test]
fn sliding_with_viscous_drag_is_of_order_two() {
    let block = Block { mu: 0.1, c: 0.3, ..BLOCK };
    let (time, start) = (1.5, State::from_velocity(&block, [1.0], [-0.2]).unwrap());
    let (rate, frequency) = (-0.15, (1.0_f64 - 0.15 * 0.15).sqrt());
    let (a, b) = (0.9, (-0.2 - rate * 0.9) / frequency);
    let (sine, cosine) = (frequency * time).sin_cos();
    let q = 0.1 + (rate * time).exp() * (a * cosine + b * sine);
    let errors = [15, 60].map(|steps| {
        let mut run = block.by(Proximal, time / f64::from(steps)).run(start);
        (run.nth(steps as usize - 1).unwrap().unwrap().state.q[0] - q).abs()
    });
    let order = (errors[0] / errors[1]).log2() / 2.0;
    assert!((order - 2.0).abs() < 0.02, "{order}");
}

#[test]
fn sliding_is_the_midpoint_rule() {
    let block = Block { c: 0.3, ..BLOCK };
    let mut state = State::from_velocity(&block, [0.2], [1.0]).unwrap();
    for _ in 0..5 {
        let steps = [block.by(Proximal, 0.05).step(&state), Unseen(block).by(Midpoint, 0.05).step(&state)];
        let [a, b] = steps.map(|step| step.unwrap().state);
        assert!((a.q - b.q).amax() < 1e-15 && (a.p - b.p).amax() < 1e-15);
        state = a;
    }
}

#[test]
fn a_block_on_a_belt_has_its_velocity_to_the_last_bit() {
    let block = Block { belt: 0.1, ..BLOCK };
    let step = block.by(Proximal, 0.1).step(&at(0.03, 0.1)).unwrap();
    assert!(step.velocity[0] == 0.1 && step.state.p[0] == 0.1);
}

/// One friction written in several ways, with a factor of q.
#[derive(Clone, Copy)]
struct Ways(usize);

#[rayleigh_system(rule = proximal)]
impl Ways {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1]) - 0.5 * (q[0] * q[0] + q[1] * q[1] - q[0] * q[1])
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let factor = 0.3 * (1.0 + 0.5 * q[1].sin());
        let u = v[0] - 0.5 * v[1];
        factor
            * match self.0 {
                0 => u.abs(),
                1 => u.max(-u),
                2 => 2.0 * u.max(0.0) - u,
                3 => u - 2.0 * u.min(0.0),
                4 => (u * u).sqrt(),
                _ => u.hypot(0.0),
            }
    }
}

#[test]
fn one_friction_written_in_several_ways_is_one_motion() {
    let start = State::from_velocity(&Ways(0), [0.7, -0.4], [0.1, 0.2]).unwrap();
    let end = |way: usize| Ways(way).by(Proximal, 0.05).run(start).nth(200).unwrap().unwrap().state;
    let first = end(0);
    for way in 1..6 {
        let other = end(way);
        assert!((other.q - first.q).amax() < 1e-13 && (other.p - first.p).amax() < 1e-13, "{way}");
    }
}

/// A puck on a table that is rougher to one side, held by a spring.
struct Puck {
    mu: f64,
    k: f64,
}

#[rayleigh_system(rule = proximal)]
impl Puck {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * self.k * (q[0] * q[0] + q[1] * q[1])
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.mu * (1.0 + 0.5 * q[0].sin()) * v[0].hypot(v[1])
    }
}

/// The length of a velocity has no gradient at rest: nothing asks for one there.
#[test]
fn a_length_is_held_from_rest_and_to_rest() {
    let puck = Puck { mu: 0.3, k: 1.0 };
    let still = State::from_velocity(&puck, [0.1, -0.1], [0.0; 2]).unwrap();
    let mut run = puck.by(Proximal, 0.05).run(still);
    assert!((0..100).all(|_| run.next().unwrap().unwrap().state == still));

    let start = State::from_velocity(&puck, [0.6, 0.2], [0.3, -0.5]).unwrap();
    let by = puck.by(Proximal, 0.01);
    let (mut before, mut at_rest) = (start, 0);
    for step in by.run(start).take(1000) {
        let step = step.unwrap();
        let entry = by.ledger(&before, &step.state).unwrap();
        assert!(entry.dissipated >= 0.0 && entry.dissipated.is_finite(), "{entry:?}");
        at_rest += usize::from(step.state == before && step.velocity == Vector2::zeros());
        before = step.state;
    }
    assert!(at_rest > 300, "{at_rest}");
}

/// By steps of h, h/2 and h/4 along one direction, from which the friction depends on q.
#[test]
fn sliding_over_ground_that_is_rougher_on_the_way_is_of_order_two() {
    let puck = Puck { mu: 0.3, k: 0.2 };
    let start = State::from_velocity(&puck, [-0.5, 0.0], [1.5, 0.0]).unwrap();
    let ends = [20, 40, 80].map(|steps: u32| {
        let mut run = puck.by(Proximal, 1.0 / f64::from(steps)).run(start);
        run.nth(steps as usize - 1).unwrap().unwrap().state
    });
    let order_of = |of: fn(&State<f64, 2>) -> f64| {
        let [a, b, c] = ends.map(|end| of(&end));
        ((a - b) / (b - c)).log2()
    };
    for order in [order_of(|state| state.q[0]), order_of(|state| state.p[0])] {
        assert!((order - 2.0).abs() < 0.05, "{order}");
    }
}

/// Friction that falls with the velocity, from 0.3 to 0.1, and one that is no kink.
#[derive(Clone, Copy)]
struct Stribeck {
    /// The velocity over which it falls.
    over: f64,
}

#[rayleigh_system(rule = proximal)]
impl Stribeck {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * q[0] * q[0]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.1 * v[0].abs() - 0.2 * self.over * (-v[0].abs() / self.over).exp() + v[1].abs().powi(3)
    }
}

#[test]
fn friction_may_fall_with_the_velocity_as_long_as_the_step_can_follow() {
    let found = <Stribeck as dalembert::Lagrangian<2>>::STRUCTURE;
    assert_eq!(found.kinks, 1);
    // Held by 0.3, slides with less.
    let by = Stribeck { over: 0.1 }.by(Proximal, 0.1);
    let still = State { q: vector![0.29, 0.0], p: Vector2::zeros() };
    assert_eq!(by.step(&still).unwrap().state, still);
    let slides = State { q: vector![0.31, 0.0], p: Vector2::zeros() };
    assert!(by.step(&slides).unwrap().state.q[0] < 0.31);
    // h max|F′| = h 0.2/over ≥ 2.
    let by = Stribeck { over: 0.005 }.by(Proximal, 0.1);
    let error = by.step(&slides).unwrap_err();
    let dalembert::StepError::NotConvex { component: 0, h, enough } = error else { panic!("{error}") };
    assert!(h == 0.1 && enough < 0.05 && enough > 0.01, "{enough}");
    assert!(by.with_step(enough).step(&slides).is_ok());
}
