//! A, B and derivatives by parameters where coordinates have no mass, against differences.

use dalembert::nalgebra::{SVector, Vector3, vector};
use dalembert::step::StateBy;
use dalembert::{Discretise, Proximal, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;

/// A mass, behind a spring a node that a dashpot and dry friction hold, behind another one that dry friction
/// alone holds; friction and a dashpot between the mass and the first node, and an input that pulls at all.
#[derive(Clone, Copy, Debug)]
struct Nodes {
    k: [f64; 2],
    c: [f64; 2],
    limit: [f64; 3],
    pull: [f64; 3],
}

#[rayleigh_system(
    rule = proximal,
    parameters = [k[0], k[1], c[0], c[1], limit[0], limit[1], limit[2], pull[1], pull[2]]
)]
impl Nodes {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * v[0] * v[0]
            - 0.5 * self.k[0] * (q[0] - q[1]).powi(2)
            - 0.5 * self.k[1] * (q[0] - q[2]).powi(2)
            - 0.3 * q[0] * q[0]
            - 0.2 * q[1] * q[1]
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        let slip = v[0] - v[1];
        0.5 * self.c[0] * v[1] * v[1]
            + 0.5 * self.c[1] * slip * slip
            + self.limit[0] * v[1].abs()
            + self.limit[1] * slip.abs()
            + self.limit[2] * v[2].abs()
    }

    fn force(&self, _q: [f64; 3], _v: [f64; 3], u: [f64; 1]) -> [f64; 3] {
        [self.pull[0] * u[0], self.pull[1] * u[0], self.pull[2] * u[0]]
    }
}

type Field = fn(&mut Nodes) -> &mut f64;

/// The parameters, as listed.
const FIELDS: [Field; 9] = [
    |nodes| &mut nodes.k[0],
    |nodes| &mut nodes.k[1],
    |nodes| &mut nodes.c[0],
    |nodes| &mut nodes.c[1],
    |nodes| &mut nodes.limit[0],
    |nodes| &mut nodes.limit[1],
    |nodes| &mut nodes.limit[2],
    |nodes| &mut nodes.pull[1],
    |nodes| &mut nodes.pull[2],
];

const H: f64 = 0.1;

impl Nodes {
    fn drawn(draws: &mut Draws) -> Self {
        let mut maybe = |most: f64| if draws.below(3) == 0 { 0.0 } else { draws.between(0.1, 1.0) * most };
        let (c, limit) = ([0.3 + maybe(0.7), maybe(1.0)], [maybe(1.0), maybe(1.0), 0.1 + maybe(0.7)]);
        let [k, pull] = [(0.5, 3.0), (-1.0, 1.0)]
            .map(|(least, most)| std::array::from_fn::<f64, 3, _>(|_| draws.between(least, most)));
        Self { k: [k[0], k[1]], c, limit, pull }
    }

    fn stepped(self, start: &State<f64, 3>, u: f64) -> Result<State<f64, 3>, StepError> {
        Ok(self.driven([u]).by(Proximal, H).step(start)?.state)
    }
}

/// The slope of the end by what `step` moves; nothing where differences straddle a limit of friction.
fn slope(step: impl Fn(f64) -> Result<State<f64, 3>, StepError>) -> Option<[Vector3<f64>; 2]> {
    const BY: f64 = 1e-6;
    let between = |from: f64, to: f64| -> [Vector3<f64>; 2] {
        let [from_end, to_end] = [step(from), step(to)].map(Result::unwrap);
        [(to_end.q - from_end.q) / (to - from), (to_end.p - from_end.p) / (to - from)]
    };
    let slopes = [between(-BY, BY), between(0.0, BY), between(-BY / 8.0, 0.0)];
    let differs = |a: &[Vector3<f64>; 2]| off(a, &slopes[0]) > 1e-5;
    (!slopes.iter().any(differs)).then_some(slopes[0])
}

fn off(a: &[Vector3<f64>; 2], b: &[Vector3<f64>; 2]) -> f64 {
    (a[0] - b[0]).amax().max((a[1] - b[1]).amax())
}

#[test]
fn steps_are_differentiated_where_coordinates_have_no_mass() {
    let mut draws = Draws::new(21);
    let (mut compared, mut coupled, mut refused) = (0, 0, 0);
    let count = if cfg!(debug_assertions) { 30 } else { 2000 };
    for number in 0..count {
        let nodes = Nodes::drawn(&mut draws);
        let mut start = State {
            q: Vector3::from_fn(|_, _| draws.between(-1.0, 1.0)),
            p: vector![draws.between(-1.0, 1.0), 0.0, 0.0],
        };
        let mut u = draws.between(-1.0, 1.0);
        for _ in 0..1 + draws.below(20) {
            start = nodes.stepped(&start, u).unwrap();
            u += draws.between(-0.1, 0.1);
        }
        let driven = nodes.driven([u]);
        let taken = match driven.by(Proximal, H).linearized(&start) {
            Ok(taken) => taken,
            Err(error) => {
                assert!(matches!(error, StepError::AtLimitOfFriction { .. }), "{number}: {error}");
                refused += 1;
                continue;
            }
        };
        let mut check = |found: Option<[Vector3<f64>; 2]>, expected: [SVector<f64, 3>; 2]| {
            if let Some(found) = found {
                compared += 1;
                assert!(
                    off(&found, &expected) < 1e-7,
                    "{number}: {found:?}, {expected:?} {nodes:?} {start:?}"
                );
            }
        };
        let a = taken.by_state().unwrap();
        for index in 0..4 {
            let (q, p) = if index < 3 { (a.q_by_q, a.p_by_q) } else { (a.q_by_p, a.p_by_p) };
            let by = |by: f64| {
                let mut moved = start;
                *(if index < 3 { &mut moved.q[index] } else { &mut moved.p[0] }) += by;
                nodes.stepped(&moved, u)
            };
            check(slope(by), [q.column(index % 3).into(), p.column(index % 3).into()]);
        }
        let b: StateBy<f64, 3, 1> = taken.by_input().unwrap();
        let found = slope(|by| nodes.stepped(&start, u + by));
        check(found, [b.q.column(0).into(), b.p.column(0).into()]);
        // Where the first node pulls at the mass at the end, the input there reaches p1 by the balance alone.
        coupled += usize::from(nodes.c[1] > 0.0 || nodes.limit[1] > 0.0);
        let by: StateBy<f64, 3, 9> = taken.by_parameters().unwrap();
        for (index, field) in FIELDS.into_iter().enumerate() {
            let end = |by: f64| {
                let mut other = nodes;
                *field(&mut other) += by;
                other.stepped(&start, u)
            };
            // Friction that pushes is none.
            let mut of = nodes;
            if *field(&mut of) != 0.0 {
                check(slope(end), [by.q.column(index).into(), by.p.column(index).into()]);
            }
        }
    }
    println!("{compared} compared, {refused} refused");
    assert!(compared > 10 * count && coupled > count / 2 && refused < count / 10, "{compared} {refused}");
}
