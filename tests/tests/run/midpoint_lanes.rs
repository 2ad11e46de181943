//! The midpoint rule in lanes: every member's state is bit by bit that of its own run, whatever the number of
//! coordinates and of lanes and the form of the matrix, whatever runs beside it: stiff members, members on
//! their way to infinity, members that fail.

use dalembert::nalgebra::vector;
use dalembert::run::LaneRuns;

use dalembert::step::{DiscreteInLanes, FlowInLanes};
use dalembert::{Discretise, Midpoint, State, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::gauss_lanes::Spring;
use crate::lanes::{Chain, agree, bits, damping, forward, members};

/// Two pendulums, one at the end of the other, with friction in their joints.
#[derive(Clone, Debug)]
struct DoublePendulum {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
    c: [f64; 2],
}

#[rayleigh_system(lanes = midpoint)]
impl DoublePendulum {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let total = self.m[0] + self.m[1];
        let [first, second] = self.l;
        let turning =
            0.5 * total * first * first * v[0] * v[0] + 0.5 * self.m[1] * second * second * v[1] * v[1];
        let coupling = self.m[1] * first * second * (q[0] - q[1]).cos() * v[0] * v[1];
        turning + coupling + self.g * (total * first * q[0].cos() + self.m[1] * second * q[1].cos())
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c[0] * v[0] * v[0] + 0.5 * self.c[1] * (v[1] - v[0]) * (v[1] - v[0])
    }
}

fn pendulums(random: &mut StdRng) -> DoublePendulum {
    let mut positive = |low: f64| random.random_range(low..2.0);
    let (m, l, g) = ([positive(0.5), positive(0.5)], [positive(0.5), positive(0.5)], 5.0 * positive(0.1));
    DoublePendulum { m, l, g, c: [damping(random), 0.1 * damping(random)] }
}

/// Fields, branches and questions; friction that depends on q, a force; a mass that is no polynomial.
#[derive(Clone, Debug)]
struct Bead {
    k: f64,
    has_wall: bool,
    wind: Option<f64>,
    roughness: f64,
}

#[rayleigh_system(rule = [trapezoidal, midpoint], lanes = midpoint)]
impl Bead {
    const WALL: f64 = 0.7;

    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let push = if self.has_wall && q[0] > Self::WALL { self.k * (q[0] - Self::WALL) } else { 0.0 };
        let inertia = 1.0 + (0.3 * q[0]).sin().powi(2) + 0.2 * (-q[0] * q[0]).exp();
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

/// Three pendulums, one at the end of the other: a dense matrix, kept while it serves. Where they swing
/// wildly it soon does not, and Newton's method takes over.
#[derive(Clone, Debug)]
struct ThreePendulums {
    g: f64,
    r: f64,
}

#[rayleigh_system(lanes = midpoint)]
impl ThreePendulums {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let mut l = 0.0;
        for i in 0..3 {
            for j in 0..3 {
                let below = (3 - i.max(j)) as f64;
                l += 0.5 * below * (q[i] - q[j]).cos() * v[i] * v[j];
            }
            l += (3 - i) as f64 * self.g * q[i].cos();
        }
        l
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + (v[1] - v[0]).powi(2) + (v[2] - v[1]).powi(2))
    }
}

/// Steps that are one solve: three masses coupled by springs, friction and a gyroscopic term.
#[derive(Clone, Debug)]
struct Rotor {
    k: f64,
    spin: f64,
    r: f64,
}

#[rayleigh_system(lanes = midpoint)]
impl Rotor {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let springs = q[0] * q[0] + (q[1] - q[0]).powi(2) + (q[2] - q[1]).powi(2) + 0.3 * q[0] * q[2];
        0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1] + v[2] * v[2]) + self.spin * q[0] * v[1]
            - 0.5 * self.k * springs
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + (v[2] - v[1]).powi(2))
    }
}

/// In single precision, two coordinates that a diagonal matrix holds.
#[rayleigh_system(lanes = midpoint)]
fn single(q: [f32; 2], v: [f32; 2], m: f32, k: f32, r: f32) -> (f32, f32) {
    let springs = 0.5 * k * (q[0] * q[0] + q[1].powi(4));
    (
        0.5 * (m + q[0].sin() * q[0].sin()) * v[0] * v[0] + v[1] * v[1] - springs + q[1].cos(),
        0.5 * r * v[0] * v[0],
    )
}

/// Steps that members of a run in eight lanes take alone, in one step of a hundred.
fn share_alone<L, const N: usize>(members: &[(L, State<f64, N>)], h: f64) -> f64
where
    L: FlowInLanes<Midpoint, N, Scalar = f64> + DiscreteInLanes<Midpoint, N>,
{
    let systems: [&L; 8] = std::array::from_fn(|lane| &members[lane].0);
    let starts: [State<f64, N>; 8] = std::array::from_fn(|lane| members[lane].1);
    let mut runs = LaneRuns::new(Midpoint, systems, &starts, h);
    forward(&mut runs, 100);
    runs.steps_alone() as f64 / 800.0
}

#[test]
fn pendulums_are_bit_by_bit_their_own_runs() {
    let all = members(16, 1, pendulums);
    let ends = [
        agree::<_, _, 2, 1>(Midpoint, &all, 0.02),
        agree::<_, _, 2, 3>(Midpoint, &all, -0.05),
        agree::<_, _, 2, 8>(Midpoint, &all, 0.1),
        agree::<_, _, 2, 32>(Midpoint, &all, 0.3),
    ];
    assert!(ends.iter().all(|&ends| ends > 14), "{ends:?}");
    // The control: they do step together, so that it is lanes that agree.
    let alone = [share_alone::<_, 2>(&all, 0.02), share_alone::<_, 2>(&all, 0.1)];
    assert!(alone.iter().all(|&share| (0.01..0.05).contains(&share)), "{alone:?}");
}

#[test]
fn branches_functions_and_forces() {
    let all = members(33, 2, beads);
    assert_eq!(agree::<_, _, 1, 16>(Midpoint, &all, 0.1), 33);
    assert_eq!(agree::<_, _, 1, 8>(Midpoint, &all, 0.4), 33);
    let alone = share_alone::<_, 1>(&all, 0.1);
    assert!(alone < 0.1, "{alone}");
}

fn beads(random: &mut StdRng) -> Bead {
    let wind = if random.random() { Some(random.random_range(-1.0..1.0)) } else { None };
    Bead { k: random.random_range(0.5..3.0), has_wall: random.random(), wind, roughness: damping(random) }
}

#[test]
fn matrices_that_are_kept_and_given_up() {
    let three = |random: &mut StdRng| ThreePendulums { g: random.random_range(0.0..9.0), r: damping(random) };
    let mut all = members(12, 3, three);
    for (_, state) in &mut all[..6] {
        state.p *= 8.0;
    }
    let told =
        [0.01, 0.05, 0.2].map(|h| (agree::<_, _, 3, 8>(Midpoint, &all, h), share_alone::<_, 3>(&all, h)));
    let [small, medium, large] = told;
    // A step of a tumbling chain may be refused, in lanes as alone.
    let least = if cfg!(debug_assertions) { [12, 11, 10] } else { [12, 10, 8] };
    assert!([small.0, medium.0, large.0].iter().zip(least).all(|(&ends, least)| ends >= least), "{told:?}");
    assert!(small.1 < 0.1 && medium.1 < 0.15 && large.1 < 0.2, "{told:?}");
    assert_eq!(agree::<_, _, 3, 3>(Midpoint, &all[6..], -0.02), 6);
}

#[test]
fn steps_that_are_one_solve() {
    let rotor = |random: &mut StdRng| Rotor {
        k: random.random_range(0.1..9.0),
        spin: random.random_range(-1.0..1.0),
        r: damping(random),
    };
    let all = members(20, 4, rotor);
    assert_eq!(agree::<_, _, 3, 8>(Midpoint, &all, 0.1), 20);
    assert_eq!(agree::<_, _, 3, 3>(Midpoint, &all, 0.7), 20);
    let alone = share_alone::<_, 3>(&all, 0.1);
    assert!(alone < 0.05, "{alone}");
}

#[test]
fn chains_that_begin_to_move() {
    let mut all =
        members::<_, 18>(8, 5, |random| Chain { k: random.random_range(0.5..2.0), r: damping(random) });
    for (_, state) in &mut all[..3] {
        state.q.fill(0.0);
        state.p.rows_mut(1, 17).fill(0.0);
    }
    assert_eq!(agree::<_, _, 18, 2>(Midpoint, &all, 0.2), 8);
    assert_eq!(agree::<_, _, 18, 3>(Midpoint, &all, 0.02), 8);
    let alone = [share_alone::<_, 18>(&all, 0.02), share_alone::<_, 18>(&all, 0.2)];
    assert!(alone[0] < 0.2 && alone[1] < 0.2, "{alone:?}");
}

#[test]
fn stiff_members_beside_soft_ones() {
    let spring = |random: &mut StdRng| {
        let is_stiff = random.random_range(0..3) == 0;
        Spring { k: if is_stiff { 1e6 } else { 1.0 }, r: if is_stiff { 1e4 } else { damping(random) } }
    };
    let all = members(24, 6, spring);
    assert_eq!(agree::<_, _, 1, 4>(Midpoint, &all, 0.2), 24);
    assert_eq!(agree::<_, _, 1, 8>(Midpoint, &all, 3.0), 24);
}

#[test]
fn what_is_no_number_fails_alone() {
    let mut all = members(8, 7, pendulums);
    all[1].1.p = vector![f64::NAN, 0.0];
    all[3].0.g = f64::INFINITY;
    all[4].0.m = [0.0, 0.0];
    all[6].0.l[0] = f64::NAN;
    assert_eq!(agree::<_, _, 2, 8>(Midpoint, &all, 0.1), 4);
    assert_eq!(agree::<_, _, 2, 3>(Midpoint, &all, 0.1), 4);
    assert_eq!(agree::<_, _, 2, 8>(Midpoint, &all, f64::NAN), 0);
    assert_eq!(agree::<_, _, 2, 8>(Midpoint, &all, 0.0), 0);
}

/// Numbers so large that sums overflow in one order and not in another.
#[test]
fn what_overflows_is_left_to_each_member() {
    let mut all = members(4, 8, |random| Chain { k: random.random_range(0.5..2.0), r: damping(random) });
    for (i, (_, state)) in all.iter_mut().enumerate() {
        let large = 10_f64.powi(45 * i as i32);
        (state.q, state.p) = (state.q * large, state.p * large);
    }
    let ends = agree::<_, _, 18, 4>(Midpoint, &all, 0.1);
    assert!((1..4).contains(&ends), "{ends}");
}

#[test]
fn single_precision_too() {
    let mut random = StdRng::seed_from_u64(9);
    let mut any = |low: f32, high: f32| random.random_range(low..high);
    let all: [Single; 16] =
        std::array::from_fn(|_| Single { m: any(0.5, 2.0), k: any(0.1, 3.0), r: any(0.0, 0.3) });
    let starts = std::array::from_fn(|_| State {
        q: vector![any(-1.0, 1.0), any(-1.0, 1.0)],
        p: vector![any(-1.0, 1.0), any(-1.0, 1.0)],
    });
    let mut runs = LaneRuns::new(Midpoint, all.each_ref(), &starts, 0.1);
    forward(&mut runs, 200);
    for (lane, system) in all.iter().enumerate() {
        let alone = system.by(Midpoint, 0.1).run(starts[lane]).nth(199).unwrap().unwrap().state;
        let bits = |state: State<f32, 2>| [state.q, state.p].map(|of| [of[0].to_bits(), of[1].to_bits()]);
        assert_eq!(runs.state(lane).map(bits), Some(bits(alone)));
    }
    assert!(runs.steps_alone() < 16 * 10, "{}", runs.steps_alone());
}

/// What members are together says nothing of one alone, but for its bits: draws of everything.
#[test]
fn whatever_runs_beside_them() {
    let mut random = StdRng::seed_from_u64(10);
    let (of, times) = if cfg!(debug_assertions) { (12, 6) } else { (40, 20) };
    let all = members(of, 11, pendulums);
    let ends: Vec<Option<Vec<u64>>> = all
        .iter()
        .map(|(system, start)| {
            let end = system.by(Midpoint, 0.25).run(*start).nth(29)?;
            end.ok().map(|step| bits(&step.state))
        })
        .collect();
    for _ in 0..times {
        let drawn: [usize; 8] = std::array::from_fn(|_| random.random_range(0..of));
        let mut runs = LaneRuns::new(Midpoint, drawn.map(|i| &all[i].0), &drawn.map(|i| all[i].1), 0.25);
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

    #[rayleigh_system(lanes = midpoint)]
    impl Crane {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let swing = self.m * q[1].cos() * v[0] * v[1] + 0.5 * self.m * v[1] * v[1];
            0.5 * (1.0 + self.m) * v[0] * v[0] + swing + self.m * q[1].cos()
        }

        fn force(&self, _q: [f64; 2], v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
            [u[0].sin() - 0.1 * v[0], -0.01 * v[1] * (self.m * u[0]).exp()]
        }
    }

    let mut random = StdRng::seed_from_u64(12);
    let cranes: [Crane; 6] = std::array::from_fn(|_| Crane { m: random.random_range(0.1..1.0) });
    let driven = cranes.each_ref().map(|crane| crane.driven([random.random_range(-2.0..2.0)]));
    let starts: [State<f64, 2>; 6] = std::array::from_fn(|_| crate::lanes::start(&mut random));
    let alone = |member: usize, steps: usize| {
        let mut run = driven[member].by(Midpoint, 0.1).run(starts[member]);
        bits(&run.nth(steps - 1).unwrap().unwrap().state)
    };
    let mut runs = LaneRuns::new(
        Midpoint,
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

/// The time of each member is its own: that of its view, and the steps since it was put into its lane. Inputs
/// and locals of the body may go by the names that generated code has.
#[test]
fn every_member_has_a_time_of_its_own() {
    #[derive(Clone, Debug)]
    struct Pumped {
        k: f64,
    }

    #[rayleigh_system(lanes = midpoint)]
    impl Pumped {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
            let now = 1.0 + 0.2 * (1.3 * t).sin();
            0.5 * (v[0] * v[0] + now * v[1] * v[1]) + self.k * now * q[0].cos() - 0.5 * (q[0] - q[1]).powi(2)
        }

        fn rayleigh(&self, v: [f64; 2], time: f64) -> f64 {
            0.05 * v[1] * v[1] * (1.0 + (-0.1 * time).exp())
        }

        fn force(&self, q: [f64; 2], _v: [f64; 2], push: [f64; 1], time: f64) -> [f64; 2] {
            let u = push[0] * time.cos();
            let t = u * q[1] + push[0];
            [u, if time > 1.0 { t } else { -t }]
        }
    }

    /// A chain whose matrix is kept, and depends on the time.
    #[derive(Clone, Debug)]
    struct Growing;

    #[rayleigh_system(lanes = midpoint)]
    impl Growing {
        fn lagrangian(&self, q: [f64; 4], v: [f64; 4], t: f64) -> f64 {
            let (mut l, mut before) = (0.0, 0.0);
            for i in 0..4 {
                let d = q[i] - before;
                l += 0.5 * v[i] * v[i] - (1.0 + 4.0 * t * t) * (0.5 * d * d + 0.25 * d.powi(4));
                before = q[i];
            }
            l
        }
    }

    let mut random = StdRng::seed_from_u64(13);
    let pumped: [Pumped; 6] = std::array::from_fn(|_| Pumped { k: random.random_range(0.5..2.0) });
    let views = pumped
        .each_ref()
        .map(|system| system.driven([random.random_range(-1.0..1.0)], random.random_range(-3.0..3.0)));
    let starts: [State<f64, 2>; 6] = std::array::from_fn(|_| crate::lanes::start(&mut random));
    let alone = |member: usize, steps: usize| {
        let mut run = views[member].by(Midpoint, 0.07).run(starts[member]);
        bits(&run.nth(steps - 1).unwrap().unwrap().state)
    };
    let systems = [&views[0], &views[1], &views[2], &views[3]];
    let mut runs = LaneRuns::new(Midpoint, systems, &[starts[0], starts[1], starts[2], starts[3]], 0.07);
    forward(&mut runs, 17);
    runs.refill(
        [None, Some(&views[4]), None, Some(&views[5])],
        &[starts[0], starts[4], starts[0], starts[5]],
    );
    forward(&mut runs, 1);
    forward(&mut runs, 24);
    for (lane, (member, steps)) in [(0, 42), (4, 25), (2, 42), (5, 25)].into_iter().enumerate() {
        assert_eq!(runs.state(lane).map(|state| bits(&state)), Some(alone(member, steps)), "lane {lane}");
    }
    // Positive control: at another time it is another motion.
    let later = pumped[0].driven([0.3], 1.0).by(Midpoint, 0.07).step(&starts[0]).unwrap();
    assert_ne!(pumped[0].driven([0.3], 2.0).by(Midpoint, 0.07).step(&starts[0]).unwrap(), later);

    let growing = [0.0, 0.5, -0.5, 1.0].map(|t| Growing.at_time(t));
    let starts: [State<f64, 4>; 4] = std::array::from_fn(|_| crate::lanes::start(&mut random));
    let mut runs = LaneRuns::new(Midpoint, growing.each_ref(), &starts, 0.02);
    forward(&mut runs, 100);
    for (lane, system) in growing.iter().enumerate() {
        let alone = system.by(Midpoint, 0.02).run(starts[lane]).nth(99).unwrap().unwrap().state;
        assert_eq!(runs.state(lane).map(|state| bits(&state)), Some(bits(&alone)), "lane {lane}");
    }
    assert!(runs.steps_alone() < 100, "{}", runs.steps_alone());
}
