//! Curves that are fields, in lanes: every member reads its own, at its own place, and its state is bit by
//! bit that of its own run.

use dalembert::nalgebra::vector;
use dalembert::run::LaneRuns;
use dalembert::system::{Curve, Interpolation, Table, TableSlice};
use dalembert::{Gauss, Midpoint, Splitting, State, Trapezoidal, rayleigh_system};
use rand::RngExt;
use rand::rngs::StdRng;

use crate::lanes::{agree, agree_in_two, bits, forward, members, start};

/// K increasing points at random, of which the last has the value of the first.
fn points<const K: usize>(random: &mut StdRng) -> [[f64; K]; 2] {
    let mut at = random.random_range(-2.0..-1.0);
    let x = std::array::from_fn(|_| {
        at += random.random_range(0.1..1.0);
        at
    });
    let mut y = std::array::from_fn(|_| random.random_range(0.2..1.5));
    if let [first, .., last] = &mut y[..] {
        *last = *first;
    }
    [x, y]
}

fn kind(random: &mut StdRng) -> Interpolation {
    Interpolation::ALL[random.random_range(0..4)]
}

/// A table of any kind, that holds or goes on by its slope.
fn table<const K: usize>(random: &mut StdRng) -> Table<K> {
    let [x, y] = points(random);
    let table = Table::through(kind(random), x, y).expect("increasing points");
    if random.random_bool(0.3) { table.straight_beyond() } else { table }
}

/// A table of as many points as come.
fn slice(random: &mut StdRng) -> TableSlice<'static> {
    let [x, mut y] = points::<9>(random).map(Vec::from);
    let count = random.random_range(3..=9);
    y[count - 1] = y[0];
    let (of, pieces) = (kind(random), vec![[0.0; 4]; count].leak());
    TableSlice::through(of, x[..count].to_vec().leak(), &y[..count], pieces).expect("increasing points")
}

/// A curve of one's own.
#[derive(Clone, Copy, Debug)]
struct Wave(f64);

impl Curve<f64> for Wave {
    fn derivatives(&self, x: f64) -> [f64; 4] {
        let (sine, cosine) = x.sin_cos();
        [sine, cosine, -sine, -cosine].map(|value| self.0 * value)
    }
}

#[derive(Clone, Debug)]
struct Wheel {
    cam: Table<4>,
}

/// Tables, slices, an array of tables, points and a curve of one's own in the force, beside a constant one;
/// one of two chosen by a field, and one read before the run.
#[derive(Clone, Debug)]
struct Rider {
    k: f64,
    drag: f64,
    wheels: [Wheel; 2],
    spring: TableSlice<'static>,
    wave: Wave,
    lines: [[f64; 2]; 3],
    is_soft: bool,
}

const HILL: Table<3> = match Table::monotone([-1.0, 0.3, 1.4], [0.2, 0.5, 0.9]) {
    Ok(table) => table,
    Err(_) => panic!("not increasing"),
};

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, midpoint, gauss])]
impl Rider {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let mut height = HILL.at(q[0]) * self.spring.at(q[1] - q[0]) + self.wave.at(q[0]);
        height += 0.3 * (self.wheels[0].cam.at(q[0]) + self.wheels[1].cam.at(q[1]));
        let table = if self.is_soft { &self.wheels[0].cam } else { &self.wheels[1].cam };
        height += table.at(self.k * q[1]) + self.lines.at(q[1]) * q[0];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * self.k * (q[0] * q[0] + q[1] * q[1]) - height
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.drag * self.spring.at(self.k) * v[0] * v[0]
    }
}

fn rider(random: &mut StdRng) -> Rider {
    Rider {
        k: random.random_range(1.0..3.0),
        drag: random.random_range(0.0..0.4),
        wheels: [0; 2].map(|_| Wheel { cam: table(random) }),
        spring: slice(random),
        wave: Wave(random.random_range(-0.5..0.5)),
        lines: [[-1.0, 0.3], [0.1, random.random_range(-0.5..0.5)], [1.0, 0.4]],
        is_soft: random.random_bool(0.5),
    }
}

const COUNT: usize = if cfg!(debug_assertions) { 40 } else { 400 };

#[test]
fn members_with_tables_of_their_own_are_their_own_runs() {
    let riders = members(COUNT, 1, rider);
    let ends = [
        agree_in_two(Midpoint, &riders, 0.05),
        agree_in_two(Trapezoidal, &riders, 0.05),
        agree_in_two(Gauss::<2>, &riders, 0.05),
        agree::<_, _, 2, 5>(Splitting::blanes_moan_6(), &riders, 0.1),
    ];
    assert!(ends.iter().all(|&ends| ends * 10 > COUNT * 9), "{ends:?} of {COUNT}");
}

/// Bits see a table that differs by a rounding of one y, and another member's.
#[test]
fn a_table_of_another_member_is_seen() {
    let riders = members(8, 2, rider);
    let seen = |systems: [&Rider; 8]| {
        let starts = std::array::from_fn(|lane| riders[lane].1);
        let mut runs = LaneRuns::new(Midpoint, systems, &starts, 0.05);
        forward(&mut runs, 20);
        std::array::from_fn::<_, 8, _>(|lane| runs.state(lane).map(|state| bits(&state)))
    };
    let own = seen(std::array::from_fn(|lane| &riders[lane].0));
    let mut exchanged = riders.clone();
    for lane in 0..8 {
        exchanged[lane].0.wheels = riders[(lane + 1) % 8].0.wheels.clone();
    }
    let others = seen(std::array::from_fn(|lane| &exchanged[lane].0));
    assert!(own.iter().zip(&others).all(|(own, other)| own.is_some() && own != other));
    let mut rounded = riders.clone();
    rounded[3].0.wave.0 = rounded[3].0.wave.0.next_up();
    let others = seen(std::array::from_fn(|lane| &rounded[lane].0));
    let differing: Vec<usize> = (0..8).filter(|&lane| own[lane] != others[lane]).collect();
    assert_eq!(differing, [3]);
}

/// Tables in the mass, of the velocity and of the time, in a system that takes an input: their values go from
/// one function of a Gauss rule to the next, and a view stands between a member and its fields.
#[derive(Clone, Debug)]
struct Crank {
    inertia: Table<5>,
    thrust: Table<4>,
    drag: Table<3>,
}

#[rayleigh_system(rule = [midpoint, gauss], lanes = [midpoint, gauss])]
impl Crank {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (2.0 + self.inertia.at(q[0])) * v[0] * v[0] + 0.5 * v[1] * v[1] - (q[0] - q[1]).powi(2)
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.1 * self.drag.at(q[1]) * v[1] * v[1]
    }

    fn force(&self, _q: [f64; 2], v: [f64; 2], u: [f64; 1], t: f64) -> [f64; 2] {
        [u[0] * self.thrust.at(t) + self.thrust.at(u[0]), -0.2 * self.drag.at(v[1]) * v[1]]
    }
}

fn crank(random: &mut StdRng) -> Crank {
    Crank { inertia: table(random), thrust: table(random), drag: table(random) }
}

#[test]
fn members_with_tables_of_the_time_and_in_the_mass_are_their_own_runs() {
    let cranks = members(COUNT, 3, |random| {
        (crank(random), [random.random_range(-1.0..1.0)], random.random_range(-2.0..1.0))
    });
    let views: Vec<_> = cranks.iter().map(|((crank, u, t), start)| (crank.driven(*u, *t), *start)).collect();
    let ends = [agree_in_two(Midpoint, &views, 0.05), agree_in_two(Gauss::<3>, &views, 0.1)];
    assert!(ends.iter().all(|&ends| ends * 10 > COUNT * 9), "{ends:?} of {COUNT}");
}

/// A table of single precision.
#[rayleigh_system(rule = [trapezoidal], lanes = explicit)]
fn slope(q: [f32; 1], v: [f32; 1], height: Table<4, f32>) -> f32 {
    0.5 * v[0] * v[0] - 0.5 * q[0] * q[0] - height.at(q[0])
}

#[test]
fn single_precision_reads_tables_of_its_own() {
    let slopes = members(16, 4, |random| Slope { height: table::<4>(random).single().expect("few digits") });
    let slopes: Vec<(Slope, State<f32, 1>)> = slopes
        .into_iter()
        .map(|(slope, State { q, p }): (_, State<f64, 1>)| {
            (slope, State { q: vector![q[0] as f32], p: vector![p[0] as f32] })
        })
        .collect();
    for chunk in slopes.chunks(4) {
        let systems: [&Slope; 4] = std::array::from_fn(|lane| &chunk[lane].0);
        let starts = std::array::from_fn(|lane| chunk[lane].1);
        let mut runs = LaneRuns::new(Trapezoidal, systems, &starts, 0.05);
        forward(&mut runs, 30);
        for (lane, (system, start)) in chunk.iter().enumerate() {
            let own =
                dalembert::Discretise::by(system, Trapezoidal, 0.05).run(*start).nth(29).unwrap().unwrap();
            assert_eq!(runs.state(lane), Some(own.state));
            assert_ne!(own.state, *start);
        }
    }
}

/// A member that takes the place of another brings its tables.
#[test]
fn a_lane_that_is_given_to_another_reads_the_tables_of_that() {
    let riders: Vec<(Rider, State<f64, 2>)> = members(6, 5, rider);
    let mut random = rand::SeedableRng::seed_from_u64(6);
    let starts = [0; 3].map(|_| start(&mut random));
    let [a, b, c, d, ..] = &riders[..] else { panic!("six") };
    let mut runs = LaneRuns::new(Gauss::<2>, [&a.0, &b.0, &c.0], &starts, 0.05);
    forward(&mut runs, 5);
    runs.refill([None, Some(&d.0), None], &starts);
    forward(&mut runs, 10);
    for (lane, system, steps) in [(0, &a.0, 15), (1, &d.0, 10), (2, &c.0, 15)] {
        let mut own = dalembert::Discretise::by(system, Gauss::<2>, 0.05).run(starts[lane]);
        let own = own.nth(steps - 1).unwrap().unwrap().state;
        assert_eq!(runs.state(lane).map(|state| bits(&state)), Some(bits(&own)));
    }
}
