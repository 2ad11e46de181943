//! A, B and derivatives by parameters of steps with friction, sticking and sliding, against differences.

use dalembert::nalgebra::Vector2;
use dalembert::step::StateBy;
use dalembert::{Discretise, Proximal, State, rayleigh_system};
use dalembert_tests::draws::Draws;

/// A mass matrix, slips, limits and drag that depend on q, a belt, and a motor.
#[derive(Clone, Copy)]
struct Arm {
    m: f64,
    k: f64,
    belt: f64,
    limit: f64,
    lever: f64,
    drag: f64,
}

const ARM: Arm = Arm { m: 0.6, k: 1.0, belt: 0.0, limit: 0.6, lever: 0.2, drag: 0.05 };

#[rayleigh_system(rule = proximal, parameters = [m, k, belt, limit, lever, drag])]
impl Arm {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.m * (1.0 + 0.3 * q[1].cos()) * v[0] * v[0] + 0.4 * v[0] * v[1] * q[0].sin() + 0.5 * v[1] * v[1]
            - 0.5 * self.k * (q[0] * q[0] + 2.0 * q[1] * q[1] - q[0] * q[1])
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let slip = v[0] * (1.0 + self.lever * q[0]) - v[1] - self.belt;
        self.limit * (1.0 + 0.5 * q[1].sin()) * slip.abs()
            + 0.5 * v[1].abs()
            + self.drag * (1.0 + q[0] * q[0]) * (v[0] * v[0] + v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
        [u[0], 0.5 * u[0] * q[1] * (1.0 + self.lever)]
    }
}

type Field = fn(&mut Arm) -> &mut f64;

/// The parameters, as listed.
const FIELDS: [Field; 6] = [
    |arm| &mut arm.m,
    |arm| &mut arm.k,
    |arm| &mut arm.belt,
    |arm| &mut arm.limit,
    |arm| &mut arm.lever,
    |arm| &mut arm.drag,
];

/// A puck on a table.
#[derive(Clone, Copy)]
struct Puck {
    limit: f64,
    stretch: f64,
}

const PUCK: Puck = Puck { limit: 0.3, stretch: 1.0 };

#[rayleigh_system(rule = proximal, parameters = [limit, stretch])]
impl Puck {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + 1.5 * v[1] * v[1]) - 0.5 * (q[0] * q[0] + 3.0 * q[1] * q[1])
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.limit * (1.0 + q[0] * q[0]) * v[0].hypot(self.stretch * v[1])
    }
}

const H: f64 = 0.1;
const DIFFERENCE: f64 = 1e-6;

/// How far the end that follows `step` is from `expected`, by central differences.
fn off(step: impl Fn(f64) -> State<f64, 2>, expected: [Vector2<f64>; 2]) -> f64 {
    let (ahead, behind) = (step(DIFFERENCE), step(-DIFFERENCE));
    let q = (ahead.q - behind.q) / (2.0 * DIFFERENCE) - expected[0];
    let p = (ahead.p - behind.p) / (2.0 * DIFFERENCE) - expected[1];
    q.amax().max(p.amax())
}

fn moved(state: State<f64, 2>, index: usize, by: f64) -> State<f64, 2> {
    let mut moved = state;
    if index < 2 {
        moved.q[index] += by
    } else {
        moved.p[index - 2] += by
    }
    moved
}

#[test]
fn a_step_is_differentiated_on_the_sets_that_hold() {
    let mut draws = Draws::new(3);
    let mut kinds = [0; 4];
    for trial in 0..if cfg!(debug_assertions) { 60 } else { 400 } {
        let (k, belt) = (1.0 + draws.between(-1.0, 1.0), if trial % 2 == 0 { 0.0 } else { 0.1 });
        let arm = Arm { k, belt, ..ARM };
        let u = [draws.between(-0.5, 0.5)];
        let size = if trial % 4 < 2 { 0.05 } else { 1.0 };
        let start = State {
            q: Vector2::from_fn(|_, _| draws.between(-0.4, 0.4)),
            p: Vector2::from_fn(|_, _| size * draws.between(-1.0, 1.0)),
        };
        let step =
            |start: State<f64, 2>, u: [f64; 1]| arm.driven(u).by(Proximal, H).step(&start).unwrap().state;
        let driven = arm.driven(u);
        let taken = driven.by(Proximal, H).linearized(&start).unwrap();
        let a = taken.by_state().unwrap().assembled::<4>();
        let v = taken.step().velocity;
        let slip = v[0] * (1.0 + arm.lever * (start.q[0] + 0.5 * H * v[0])) - v[1] - arm.belt;
        kinds[usize::from(v[1] == 0.0) + 2 * usize::from(slip.abs() < 1e-14)] += 1;
        for index in 0..4 {
            let column = a.column(index);
            let expected = [column.fixed_rows::<2>(0).into_owned(), column.fixed_rows::<2>(2).into_owned()];
            let off = off(|by| step(moved(start, index, by), u), expected);
            assert!(off < 1e-8, "{trial}, {index}: {off:e}");
        }
        let b: StateBy<f64, 2, 1> = taken.by_input().unwrap();
        let off = off(|by| step(start, [u[0] + by]), [b.q.column(0).into(), b.p.column(0).into()]);
        assert!(off < 1e-8, "{trial}: {off:e} by the input");
        let by: StateBy<f64, 2, 6> = taken.by_parameters().unwrap();
        for (index, field) in FIELDS.into_iter().enumerate() {
            let end = |by: f64| {
                let mut other = arm;
                *field(&mut other) += by;
                other.driven(u).by(Proximal, H).step(&start).unwrap().state
            };
            let off = self::off(end, [by.q.column(index).into(), by.p.column(index).into()]);
            assert!(off < 1e-8, "{trial}: {off:e} by parameter {index}");
        }
    }
    // Each of the sets occurs.
    assert!(kinds.iter().all(|&count| count > 0), "{kinds:?}");
}

#[test]
fn a_length_that_turns_is_differentiated() {
    let mut draws = Draws::new(4);
    for trial in 0..60 {
        let start = State {
            q: Vector2::from_fn(|_, _| draws.between(-0.4, 0.4)),
            p: Vector2::from_fn(|_, _| draws.between(-0.5, 0.5)),
        };
        let by = PUCK.by(Proximal, H);
        let taken = by.linearized(&start).unwrap();
        let a = taken.by_state().unwrap().assembled::<4>();
        for index in 0..4 {
            let column = a.column(index);
            let expected = [column.fixed_rows::<2>(0).into_owned(), column.fixed_rows::<2>(2).into_owned()];
            let off = off(|by_how_much| by.step(&moved(start, index, by_how_much)).unwrap().state, expected);
            assert!(off < 1e-7, "{trial}, {index}: {off:e}");
        }
        let by: StateBy<f64, 2, 2> = taken.by_parameters().unwrap();
        for (index, puck) in [|by| Puck { limit: 0.3 + by, ..PUCK }, |by| Puck { stretch: 1.0 + by, ..PUCK }]
            .into_iter()
            .enumerate()
        {
            let end = |by: f64| puck(by).by(Proximal, H).step(&start).unwrap().state;
            let off = off(end, [by.q.column(index).into(), by.p.column(index).into()]);
            assert!(off < 1e-7, "{trial}: {off:e} by parameter {index}");
        }
    }
    // Positive control: without its kink the puck has another A.
    let start = State { q: Vector2::new(0.3, 0.1), p: Vector2::new(0.2, -0.3) };
    let a = PUCK.by(Proximal, H).linearized(&start).unwrap().by_state().unwrap();
    assert!((a.p_by_p.determinant() - 1.0).abs() > 1e-3);
}
