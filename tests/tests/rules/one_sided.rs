//! The rule with all of R at both ends of a step: its two lines, its derivatives, its order, what friction
//! takes, and what it refuses.

use dalembert::nalgebra::{SMatrix, Vector2, vector};
use dalembert::{Discretise, Midpoint, OneSided, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;

/// A bead on a rod that turns, with a mass that depends on q, friction that depends on q, v and the time, and
/// a force that takes an input, v and the time.
#[derive(Clone, Copy)]
struct Rod {
    m: f64,
    c: f64,
    k: f64,
}

#[rayleigh_system(rule = one_sided, parameters = [m, c, k])]
impl Rod {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        0.5 * self.m * (v[0] * v[0] + (1.0 + q[0] * q[0]) * v[1] * v[1])
            - 0.5 * self.k * q[0] * q[0]
            - (1.0 + 0.3 * t) * q[1].sin()
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        let slip = v[0] - 0.5 * v[1];
        self.c * (1.0 + q[0] * q[0] + t) * (0.5 * slip * slip + 0.25 * v[1] * v[1] * v[1] * v[1])
    }
    fn force(&self, q: [f64; 2], v: [f64; 2], u: [f64; 1], t: f64) -> [f64; 2] {
        [u[0] * q[1].cos() + 0.2 * v[1], -u[0] * (1.0 + t)]
    }
}

const ROD: Rod = Rod { m: 1.3, c: 0.7, k: 2.0 };
const INPUT: f64 = 0.4;
const TIME: f64 = 0.6;

/// ∂L/∂v, ∂L/∂q, ∂R/∂v and f, by hand.
impl Rod {
    fn momentum(&self, q: Vector2<f64>, v: Vector2<f64>) -> Vector2<f64> {
        vector![self.m * v[0], self.m * (1.0 + q[0] * q[0]) * v[1]]
    }
    fn slope(&self, q: Vector2<f64>, v: Vector2<f64>, t: f64) -> Vector2<f64> {
        vector![self.m * q[0] * v[1] * v[1] - self.k * q[0], -(1.0 + 0.3 * t) * q[1].cos()]
    }
    fn drag(&self, q: Vector2<f64>, v: Vector2<f64>, t: f64) -> Vector2<f64> {
        let (c, slip) = (self.c * (1.0 + q[0] * q[0] + t), v[0] - 0.5 * v[1]);
        vector![c * slip, c * (-0.5 * slip + v[1].powi(3))]
    }
    fn push(q: Vector2<f64>, v: Vector2<f64>, t: f64) -> Vector2<f64> {
        vector![INPUT * q[1].cos() + 0.2 * v[1], -INPUT * (1.0 + t)]
    }
}

fn states(draws: &mut Draws) -> Vec<State<f64, 2>> {
    let mut any = || vector![draws.between(-1.0, 1.0), draws.between(-1.0, 1.0)];
    (0..10).map(|_| State { q: any(), p: any() }).collect()
}

#[test]
fn a_step_satisfies_both_lines() {
    let mut draws = Draws::new(81);
    let mut furthest = 0.0_f64;
    for state in states(&mut draws) {
        for h in [0.01, 0.2] {
            let step = ROD.driven([INPUT], TIME).by(OneSided, h).step(&state).unwrap();
            let (v, q1) = (step.velocity, step.state.q);
            let (middle, t) = (state.q + v * (0.5 * h), TIME + 0.5 * h);
            let half = (ROD.slope(middle, v, t) + Rod::push(middle, v, t)) * (0.5 * h);
            let p0 = ROD.momentum(middle, v) - half + ROD.drag(middle, v, t) * (0.5 * h);
            assert!((p0 - state.p).amax() < 1e-14, "{p0} {state:?}");
            let v1 = vector![step.state.p[0], step.state.p[1] / (1.0 + q1[0] * q1[0])] / ROD.m;
            let w = step.state.p + ROD.drag(middle, v1, t) * (0.5 * h);
            assert!((w - ROD.momentum(middle, v) - half).amax() < 1e-14, "{w} {state:?}");
            let at_end = ROD.drag(q1, v1, TIME + h) * (0.5 * h);
            furthest = furthest.max((step.state.p + at_end - w).amax());
        }
    }
    // The control: it is q̄, as in the first line.
    assert!(furthest > 1e-3, "{furthest}");
}

/// A, B and θ against central differences of steps.
#[test]
fn steps_are_differentiated_through_their_ends() {
    let (mut draws, h, e) = (Draws::new(82), 0.2, 1e-5);
    for state in states(&mut draws).into_iter().take(4) {
        let at = |rod: Rod, u: f64, state: &State<f64, 2>| {
            let end = rod.driven([u], TIME).by(OneSided, h).step(state).unwrap().state;
            vector![end.q[0], end.q[1], end.p[0], end.p[1]]
        };
        let driven = ROD.driven([INPUT], TIME);
        let by = driven.by(OneSided, h);
        let taken = by.linearized(&state).unwrap();
        let a: SMatrix<f64, 4, 4> = taken.by_state().unwrap().assembled();
        for j in 0..4 {
            let moved = |by: f64| {
                let mut state = state;
                if j < 2 {
                    state.q[j] += by
                } else {
                    state.p[j - 2] += by
                }
                at(ROD, INPUT, &state)
            };
            let column = (moved(e) - moved(-e)) / (2.0 * e);
            assert!((a.column(j) - column).amax() < 1e-8, "{j}: {} {column}", a.column(j));
        }
        let (_, of_step) = by.linearized_step(&state).unwrap();
        assert!((of_step.assembled::<4>() - a).amax() < 1e-14);
        let b = taken.by_input().unwrap().assembled::<4>();
        let column = (at(ROD, INPUT + e, &state) - at(ROD, INPUT - e, &state)) / (2.0 * e);
        assert!((b - column).amax() < 1e-8 && column.amax() > 1e-2, "{b} {column}");
        let theta: SMatrix<f64, 4, 3> = taken.by_parameters::<3>().unwrap().assembled();
        for j in 0..3 {
            let moved = |by: f64| {
                let Rod { m, c, k } = ROD;
                let by = |of: usize| if of == j { by } else { 0.0 };
                at(Rod { m: m + by(0), c: c + by(1), k: k + by(2) }, INPUT, &state)
            };
            let column = (moved(e) - moved(-e)) / (2.0 * e);
            assert!(
                (theta.column(j) - column).amax() < 1e-8 && column.amax() > 1e-4,
                "{j}: {theta} {column}"
            );
        }
    }
}

/// A mass on a spring with drag v + v³: order 1, from a reference by the midpoint rule at steps a hundred
/// times as short.
#[rayleigh_system(rule = [midpoint, one_sided])]
fn spring(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0] + 0.25 * r * v[0].powi(4))
}

#[test]
fn it_is_of_order_one() {
    let (system, start, time) = (Spring { r: 0.5 }, State { q: vector![1.0], p: vector![0.3] }, 2.0);
    let exact = system.by(Midpoint, time / 16_000.0).run(start).nth(15_999).unwrap().unwrap().state;
    let errors = [40_usize, 80, 160].map(|steps| {
        let end = system.by(OneSided, time / steps as f64).run(start).nth(steps - 1).unwrap().unwrap().state;
        (end.q - exact.q).amax().max((end.p - exact.p).amax())
    });
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 1.0).abs() < 0.06, "{order} {errors:?}");
    }
}

/// p falls by more than any h asks, and never changes its sign, under every convex R.
#[test]
fn no_convex_friction_makes_it_ring() {
    #[rayleigh_system(rule = one_sided)]
    fn sliding(q: [f64; 1], v: [f64; 1], r: f64, dry: f64, e: f64) -> (f64, f64) {
        (
            0.5 * v[0] * v[0] + 0.0 * q[0],
            0.5 * r * v[0] * v[0] + r * v[0].powi(4) + dry * (v[0] * v[0] + e * e).sqrt(),
        )
    }
    let mut draws = Draws::new(83);
    for _ in 0..200 {
        let (r, dry) = (draws.scale(1e-3, 1e9), draws.scale(1e-3, 1e6));
        let system = Sliding { r, dry, e: draws.scale(1e-8, 1.0) };
        let mut state = State { q: vector![0.0], p: vector![draws.between(0.1, 2.0)] };
        for _ in 0..5 {
            let next = system.by(OneSided, 0.1).step(&state).unwrap().state;
            assert!(
                (0.0..=state.p[0]).contains(&next.p[0]) && next.q[0] >= state.q[0],
                "{system:?} {state:?}"
            );
            state = next;
        }
        assert!(r < 1e3 || state.p[0] < 1e-6, "{system:?} {state:?}");
    }
}

/// What friction takes is never below 0 for a convex R(v), at any h, also where v1 turns back against v̄; and
/// it is the loss of energy to the order of the rule.
#[test]
fn friction_takes_energy_at_every_step() {
    let mut draws = Draws::new(84);
    let mut turned = 0;
    for _ in 0..200 {
        let system = Spring { r: draws.scale(1e-2, 1e4) };
        let state = State { q: vector![draws.between(-2.0, 2.0)], p: vector![draws.between(-2.0, 2.0)] };
        let by = system.by(OneSided, draws.between(0.05, 1.0));
        let step = by.step(&state).unwrap();
        turned += u32::from(step.velocity[0] * step.state.p[0] < 0.0);
        let ledger = by.ledger(&state, &step.state).unwrap();
        assert!(ledger.dissipated >= 0.0, "{system:?} {state:?} {ledger:?}");
    }
    assert!(turned > 5, "{turned}");
}

/// L with a bounded ∂L/∂v: the middle of a push still has a velocity, its end has none.
#[test]
fn an_end_without_a_velocity_is_named() {
    #[rayleigh_system(rule = one_sided)]
    fn bounded(q: [f64; 1], v: [f64; 1], f: f64) -> (f64, f64) {
        ((1.0 + v[0] * v[0]).sqrt() + f * q[0], 0.01 * (1.0 + v[0] * v[0]).sqrt())
    }
    let state = State { q: vector![0.2], p: vector![0.5] };
    let step = |f: f64| Bounded { f }.by(OneSided, 0.1).step(&state);
    assert!(matches!(step(8.0), Err(StepError::NoVelocity { .. })), "{:?}", step(8.0));
    assert!(step(4.0).is_ok());
    // Nor has the run gone on.
    let mut run = Bounded { f: 8.0 }.by(OneSided, 0.1).run(state);
    assert!(run.next().unwrap().is_err() && *run.state() == state);
}

#[test]
fn dual_numbers_step_as_the_derivatives_written_out() {
    #[rayleigh_system(rule = one_sided, derivatives = num_dual)]
    fn by_duals(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
        (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0] + 0.25 * r * v[0].powi(4))
    }
    let state = State { q: vector![1.0], p: vector![0.3] };
    let a = Spring { r: 3.0 }.by(OneSided, 0.3).step(&state).unwrap().state;
    let b = ByDuals { r: 3.0 }.by(OneSided, 0.3).step(&state).unwrap().state;
    assert!((a.q - b.q).amax() < 1e-15 && (a.p - b.p).amax() < 1e-15, "{a:?} {b:?}");
}
