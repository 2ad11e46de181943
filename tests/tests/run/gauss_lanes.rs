//! Gauss rules in lanes: every member's state is bit by bit that of its own run, whatever the number of
//! stages and of lanes, whatever runs beside it: stiff members, members on their way to infinity, members
//! that fail.

use std::fmt::Debug;

use dalembert::nalgebra::vector;
use dalembert::run::LaneRuns;
use dalembert::step::FlowInLanes;
use dalembert::{Discretise, Gauss, State, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::lanes::{Chain, agree, bits, damping, forward, members};

/// Two pendulums, one at the end of the other, with friction in their joints.
#[derive(Clone, Debug)]
struct DoublePendulum {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
    c: [f64; 2],
    /// By which the frame is tilted: its sine is a number before the run.
    tilt: f64,
}

#[rayleigh_system(rule = gauss, lanes = gauss)]
impl DoublePendulum {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let total = self.m[0] + self.m[1];
        let [first, second] = self.l;
        let turning =
            0.5 * total * first * first * v[0] * v[0] + 0.5 * self.m[1] * second * second * v[1] * v[1];
        let coupling = self.m[1] * first * second * (q[0] - q[1]).cos() * v[0] * v[1];
        let (x, y) = (self.tilt.sin(), self.tilt.cos());
        let fall = total * first * (y * q[0].cos() + x * q[0].sin())
            + self.m[1] * second * (y * q[1].cos() + x * q[1].sin());
        turning + coupling + self.g * fall
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c[0] * v[0] * v[0] + 0.5 * self.c[1] * (v[1] - v[0]) * (v[1] - v[0])
    }
}

fn pendulums(random: &mut StdRng) -> DoublePendulum {
    let mut positive = |low: f64| random.random_range(low..2.0);
    let (m, l, g) = ([positive(0.5), positive(0.5)], [positive(0.5), positive(0.5)], 5.0 * positive(0.1));
    let tilt = positive(-2.0);
    DoublePendulum { m, l, g, c: [damping(random), 0.1 * damping(random)], tilt }
}

/// The same, its sums rounded with the products in them.
#[derive(Clone, Debug)]
struct FusedPendulum {
    m: [f64; 2],
    l: [f64; 2],
    c: [f64; 2],
}

#[rayleigh_system(rule = gauss, lanes = gauss, multiply_add = fused)]
impl FusedPendulum {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let total = self.m[0] + self.m[1];
        let [first, second] = self.l;
        let turning =
            0.5 * total * first * first * v[0] * v[0] + 0.5 * self.m[1] * second * second * v[1] * v[1];
        let coupling = self.m[1] * first * second * (q[0] - q[1]).cos() * v[0] * v[1];
        turning + coupling + 9.81 * (total * first * q[0].cos() + self.m[1] * second * q[1].cos())
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c[0] * v[0] * v[0] + 0.5 * self.c[1] * (v[1] - v[0]) * (v[1] - v[0])
    }
}

/// Fields, branches and questions; friction that depends on q, a force; a mass that is no polynomial.
#[derive(Clone, Debug)]
struct Bead {
    k: f64,
    has_wall: bool,
    wind: Option<f64>,
    roughness: f64,
}

#[rayleigh_system(rule = gauss, lanes = gauss)]
impl Bead {
    const WALL: f64 = 0.7;

    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let push = if self.has_wall && q[0] > Self::WALL { self.k * (q[0] - Self::WALL) } else { 0.0 };
        let inertia =
            1.0 + (0.3 * q[0]).sin().powi(2) + 0.2 * (-q[0] * q[0]).exp() + 0.1 * q[0].hypot(self.k);
        0.5 * inertia * v[0] * v[0] + q[0].cos() - push * push - 0.1 * (1.5 + q[0].sin()).ln()
    }

    fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.roughness * (1.0 + q[0].tanh()) * v[0] * v[0]
    }

    fn force(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        let wind = self.wind.unwrap_or(0.0) - v[0];
        [if q[0] < 0.0 { 0.1 * wind * wind.abs() } else { 0.2 * (self.k * 0.5).sin() }]
    }
}

fn beads(random: &mut StdRng) -> Bead {
    let wind = if random.random() { Some(random.random_range(-1.0..1.0)) } else { None };
    Bead { k: random.random_range(0.5..3.0), has_wall: random.random(), wind, roughness: damping(random) }
}

/// A constant mass and no field at all: starts near the bottom stay, others leave for infinity.
#[derive(Clone, Debug)]
struct HenonHeiles;

#[rayleigh_system(rule = [midpoint, gauss], lanes = gauss)]
impl HenonHeiles {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let potential = 0.5 * (q[0] * q[0] + q[1] * q[1]) + q[0] * q[0] * q[1] - q[1].powi(3) / 3.0;
        0.5 * (v[0] * v[0] + v[1] * v[1]) - potential
    }
}

/// A spring between walls, soft in some members and stiff in others.
#[derive(Clone, Debug)]
pub(crate) struct Spring {
    pub(crate) k: f64,
    pub(crate) r: f64,
}

#[rayleigh_system(rule = [midpoint, gauss], lanes = [gauss, midpoint])]
impl Spring {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * self.k * q[0] * q[0] - 0.25 * q[0].powi(4)
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }
}

/// In single precision.
#[rayleigh_system(rule = gauss, lanes = gauss)]
fn single(q: [f32; 1], v: [f32; 1], m: f32, k: f32, r: f32) -> (f32, f32) {
    (
        0.5 * (m + q[0].sin() * q[0].sin()) * v[0] * v[0] - 0.5 * k * q[0] * q[0] + q[0].cos(),
        0.5 * r * v[0] * v[0],
    )
}

/// Steps that members of a run in eight lanes take alone, in one step of a hundred.
fn share_alone<L, const N: usize, const S: usize>(members: &[(L, State<f64, N>)], h: f64) -> f64
where
    L: FlowInLanes<Gauss<S>, N, Scalar = f64> + dalembert::system::ForcedLagrangianInLanes<N>,
{
    let systems: [&L; 8] = std::array::from_fn(|lane| &members[lane].0);
    let starts: [State<f64, N>; 8] = std::array::from_fn(|lane| members[lane].1);
    let mut runs = LaneRuns::new(Gauss::<S>, systems, &starts, h);
    forward(&mut runs, 100);
    runs.steps_alone() as f64 / 800.0
}

#[test]
fn pendulums_are_bit_by_bit_their_own_runs() {
    let all = members(16, 1, pendulums);
    let ends = [
        agree::<_, _, 2, 8>(Gauss::<1>, &all, 0.02),
        agree::<_, _, 2, 3>(Gauss::<2>, &all, 0.05),
        agree::<_, _, 2, 8>(Gauss::<3>, &all, -0.1),
        agree::<_, _, 2, 1>(Gauss::<4>, &all, 0.1),
        agree::<_, _, 2, 16>(Gauss::<4>, &all, 0.1),
        agree::<_, _, 2, 5>(Gauss::<5>, &all, 0.15),
        agree::<_, _, 2, 8>(Gauss::<6>, &all, 0.2),
        agree::<_, _, 2, 8>(Gauss::<7>, &all, 0.2),
        agree::<_, _, 2, 32>(Gauss::<8>, &all, 0.3),
    ];
    assert!(ends.iter().all(|&ends| ends > 14), "{ends:?}");
    // The control: they do step together, so that it is lanes that agree.
    let alone = [share_alone::<_, 2, 4>(&all, 0.1), share_alone::<_, 2, 8>(&all, 0.3)];
    assert!(alone.iter().all(|&share| share < 0.2), "{alone:?}");
}

/// The members of these pendulums without a tilt, on Earth.
fn fused((of, start): &(DoublePendulum, State<f64, 2>)) -> (FusedPendulum, State<f64, 2>) {
    (FusedPendulum { m: of.m, l: of.l, c: of.c }, *start)
}

#[test]
fn sums_fused_in_lanes_are_fused_alone_too() {
    let all = members(16, 10, pendulums);
    let fused: Vec<_> = all.iter().map(fused).collect();
    let ends = [
        agree::<_, _, 2, 3>(Gauss::<2>, &fused, 0.05),
        agree::<_, _, 2, 16>(Gauss::<4>, &fused, 0.1),
        agree::<_, _, 2, 8>(Gauss::<7>, &fused, 0.2),
        agree::<_, _, 2, 8>(Gauss::<8>, &fused, 0.3),
    ];
    assert!(ends.iter().all(|&ends| ends > 14), "{ends:?}");
    // The control: sums rounded apart lead elsewhere, by a rounding.
    let (mut differ, mut largest) = (0, 0.0_f64);
    for ((plain, start), (fused, _)) in all.iter().zip(&fused) {
        let plain = DoublePendulum { g: 9.81, tilt: 0.0, ..plain.clone() };
        let end = plain.by(Gauss::<4>, 0.05).run(*start).nth(9).unwrap().unwrap().state;
        let fused_end = fused.by(Gauss::<4>, 0.05).run(*start).nth(9).unwrap().unwrap().state;
        differ += usize::from(end != fused_end);
        largest = largest.max((end.q - fused_end.q).amax());
    }
    assert!(differ > 12 && largest < 1e-13, "{differ} differ by {largest:e}");
}

#[test]
fn branches_functions_and_forces() {
    let all = members(33, 2, beads);
    assert_eq!(agree::<_, _, 1, 16>(Gauss::<3>, &all, 0.1), 33);
    assert_eq!(agree::<_, _, 1, 8>(Gauss::<8>, &all, 0.2), 33);
    // Kinks keep some from contracting to rounding.
    assert!(share_alone::<_, 1, 3>(&all, 0.1) < 0.3);
}

#[test]
fn members_that_leave_for_infinity_leave_the_others_as_they_are() {
    let mut all = members(19, 3, |_| HenonHeiles);
    for (_, state) in &mut all[..10] {
        (state.q, state.p) = (state.q * 0.2, state.p * 0.2);
    }
    let ends = agree::<_, _, 2, 8>(Gauss::<4>, &all, 0.4);
    assert!((10..19).contains(&ends), "{ends}");
    assert!(share_alone::<_, 2, 4>(&all[..8], 0.4) < 0.1);
}

#[test]
fn chains_that_begin_to_move() {
    let mut all =
        members::<_, 18>(5, 4, |random| Chain { k: random.random_range(0.5..2.0), r: damping(random) });
    for (_, state) in &mut all[..3] {
        state.q.fill(0.0);
        state.p.rows_mut(1, 17).fill(0.0);
    }
    // Some of both kinds, side by side.
    let few = &all[if cfg!(debug_assertions) { 2..4 } else { 0..5 }];
    assert_eq!(agree::<_, _, 18, 2>(Gauss::<4>, few, 0.2), few.len());
    let few = &all[if cfg!(debug_assertions) { 2..5 } else { 0..5 }];
    assert_eq!(agree::<_, _, 18, 3>(Gauss::<2>, few, 0.1), few.len());
}

#[test]
fn stiff_members_take_their_steps_alone() {
    let spring = |random: &mut StdRng| {
        let is_stiff = random.random_range(0..3) == 0;
        Spring { k: if is_stiff { 1e6 } else { 1.0 }, r: if is_stiff { 1e4 } else { damping(random) } }
    };
    let all = members(24, 5, spring);
    assert_eq!(agree::<_, _, 1, 4>(Gauss::<3>, &all, 0.2), 24);
    assert_eq!(agree::<_, _, 1, 8>(Gauss::<8>, &all, 0.5), 24);
    let stiff = all[..8].iter().filter(|(spring, _)| spring.k > 1.0).count();
    let share = share_alone::<_, 1, 3>(&all, 0.2);
    assert!(stiff > 0 && share > 0.9 * stiff as f64 / 8.0 && share < 0.95, "{share}, {stiff} stiff");
}

#[test]
fn what_is_no_number_fails_alone() {
    let mut all = members(8, 6, pendulums);
    all[1].1.p = vector![f64::NAN, 0.0];
    all[3].0.g = f64::INFINITY;
    all[4].0.m = [0.0, 0.0];
    all[6].0.l[0] = f64::NAN;
    assert_eq!(agree::<_, _, 2, 8>(Gauss::<6>, &all, 0.1), 4);
    assert_eq!(agree::<_, _, 2, 3>(Gauss::<2>, &all, 0.1), 4);
    assert_eq!(agree::<_, _, 2, 8>(Gauss::<2>, &all, f64::NAN), 0);
}

#[test]
fn single_precision_too() {
    let mut random = StdRng::seed_from_u64(7);
    let mut any = |low: f32, high: f32| random.random_range(low..high);
    let all: [Single; 16] =
        std::array::from_fn(|_| Single { m: any(0.5, 2.0), k: any(0.1, 3.0), r: any(0.0, 0.3) });
    let starts = std::array::from_fn(|_| State { q: vector![any(-1.0, 1.0)], p: vector![any(-1.0, 1.0)] });
    let mut runs = LaneRuns::new(Gauss::<3>, all.each_ref(), &starts, 0.1);
    forward(&mut runs, 200);
    for (lane, system) in all.iter().enumerate() {
        let alone = system.by(Gauss::<3>, 0.1).run(starts[lane]).nth(199).unwrap().unwrap().state;
        let bits = |state: State<f32, 1>| [state.q[0].to_bits(), state.p[0].to_bits()];
        assert_eq!(runs.state(lane).map(bits), Some(bits(alone)));
    }
    assert!(runs.steps_alone() < 16 * 40, "{}", runs.steps_alone());
}

/// What members are together says nothing of one alone, but for its bits: draws of everything.
#[test]
fn whatever_runs_beside_them() {
    let mut random = StdRng::seed_from_u64(8);
    let (of, times) = if cfg!(debug_assertions) { (12, 6) } else { (40, 20) };
    let all = members(of, 9, pendulums);
    let ends: Vec<Option<Vec<u64>>> = all
        .iter()
        .map(|(system, start)| {
            let end = system.by(Gauss::<6>, 0.25).run(*start).nth(29)?;
            end.ok().map(|step| bits(&step.state))
        })
        .collect();
    for _ in 0..times {
        let drawn: [usize; 8] = std::array::from_fn(|_| random.random_range(0..of));
        let mut runs = LaneRuns::new(Gauss::<6>, drawn.map(|i| &all[i].0), &drawn.map(|i| all[i].1), 0.25);
        forward(&mut runs, 30);
        for (lane, &i) in drawn.iter().enumerate() {
            assert_eq!(runs.state(lane).map(|state| bits(&state)), ends[i]);
        }
    }
}

/// The input of each member is its own, and held; lanes are given to others on the way.
#[test]
fn inputs_and_lanes_given_to_others() {
    #[derive(Clone, Debug)]
    struct Crane {
        m: f64,
    }

    #[rayleigh_system(rule = gauss, lanes = gauss)]
    impl Crane {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let swing = self.m * q[1].cos() * v[0] * v[1] + 0.5 * self.m * v[1] * v[1];
            0.5 * (1.0 + self.m) * v[0] * v[0] + swing + self.m * q[1].cos()
        }

        fn force(&self, _q: [f64; 2], v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
            [u[0].sin() - 0.1 * v[0], -0.01 * v[1] * (self.m * u[0]).exp()]
        }
    }

    let mut random = StdRng::seed_from_u64(10);
    let cranes: [Crane; 6] = std::array::from_fn(|_| Crane { m: random.random_range(0.1..1.0) });
    let driven = cranes.each_ref().map(|crane| crane.driven([random.random_range(-2.0..2.0)]));
    let starts: [State<f64, 2>; 6] = std::array::from_fn(|_| crate::lanes::start(&mut random));
    let alone = |member: usize, steps: usize| {
        let mut run = driven[member].by(Gauss::<4>, 0.1).run(starts[member]);
        bits(&run.nth(steps - 1).unwrap().unwrap().state)
    };
    let mut runs = LaneRuns::new(
        Gauss::<4>,
        [&driven[0], &driven[1], &driven[2], &driven[3]],
        &[starts[0], starts[1], starts[2], starts[3]],
        0.1,
    );
    forward(&mut runs, 17);
    let end = |runs: &LaneRuns<'_, _, _, 2, 4>, lane: usize| runs.state(lane).map(|state| bits(&state));
    assert_eq!(end(&runs, 2), Some(alone(2, 17)));
    runs.refill(
        [None, Some(&driven[4]), None, Some(&driven[5])],
        &[starts[0], starts[4], starts[0], starts[5]],
    );
    forward(&mut runs, 1);
    forward(&mut runs, 12);
    for (lane, (member, steps)) in [(0, 30), (4, 13), (2, 30), (5, 13)].into_iter().enumerate() {
        assert_eq!(end(&runs, lane), Some(alone(member, steps)), "lane {lane}");
    }
}

/// To a tolerance, and beyond the time that it was asked for; with members that are stiff, or put in
/// later.
#[test]
fn solved_for_an_error() {
    fn agrees<L, const N: usize, const S: usize>(all: &[(L, State<f64, N>)], h: f64, error: f64) -> f64
    where
        L: FlowInLanes<Gauss<S>, N, Scalar = f64> + dalembert::system::ForcedLagrangianInLanes<N>,
    {
        let time = 20.0 * h;
        let systems: [&L; 8] = std::array::from_fn(|lane| &all[lane].0);
        let starts: [State<f64, N>; 8] = std::array::from_fn(|lane| all[lane].1);
        let mut runs = LaneRuns::new(Gauss::<S>, systems, &starts, h).solved_for(error, time);
        let end = |member: usize, steps: usize| {
            let mut run = all[member].0.by(Gauss::<S>, h).run(all[member].1).solved_for(error, time);
            run.nth(steps - 1)?.ok().map(|step| bits(&step.state))
        };
        for (more, steps) in [(9, 9), (11, 20), (5, 25)] {
            forward(&mut runs, more);
            for lane in 0..8 {
                assert_eq!(runs.state(lane).map(|state| bits(&state)), end(lane, steps), "lane {lane}");
            }
        }
        let mut others = [None; 8];
        (others[2], others[5]) = (Some(&all[8].0), Some(&all[9].0));
        let starts = std::array::from_fn(|lane| all[if lane == 2 { 8 } else { 9 }].1);
        runs.refill(others, &starts);
        forward(&mut runs, 22);
        for (lane, member, steps) in [(0, 0, 47), (2, 8, 22), (5, 9, 22), (7, 7, 47)] {
            assert_eq!(runs.state(lane).map(|state| bits(&state)), end(member, steps), "lane {lane}");
        }
        runs.steps_alone() as f64 / (8.0 * 47.0)
    }
    let pendulums = members(10, 11, pendulums);
    assert!(agrees::<_, 2, 4>(&pendulums, 0.1, 1e-4) < 0.2);
    assert!(agrees::<_, 2, 6>(&pendulums, 0.2, 1e-8) < 0.2);
    agrees::<_, 2, 8>(&pendulums, 0.3, 1e-13);
    let fused: Vec<_> = pendulums.iter().map(fused).collect();
    assert!(agrees::<_, 2, 6>(&fused, 0.2, 1e-8) < 0.2);
    let spring = |random: &mut StdRng| {
        let is_stiff = random.random_range(0..3) == 0;
        Spring { k: if is_stiff { 1e6 } else { 1.0 }, r: damping(random) }
    };
    agrees::<_, 1, 3>(&members(10, 12, spring), 0.2, 1e-5);
    // The control: what is left shows.
    let (system, start) = &pendulums[0];
    let end =
        |error: f64| system.by(Gauss::<6>, 0.2).run(*start).solved_for(error, 4.0).nth(19).unwrap().unwrap();
    assert_ne!(bits(&end(1e-5).state), bits(&end(1e-9).state));
}
