//! Systems that take the time, in lanes of explicit methods and of Gauss rules: every member stands at a time
//! of its own, that of its view and the steps since it was put into its lane, and its state is bit by bit
//! that of its own run, whatever the number of lanes and whatever runs beside it.

use dalembert::nalgebra::vector;
use dalembert::run::LaneRuns;
use dalembert::step::FlowInLanes;
use dalembert::{Composition, Discretise, Gauss, Lagrangian, Splitting, State, Trapezoidal, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::lanes::{agree, agree_in_all, agree_in_two, bits, damping, forward, refilled, start};

/// An explicit system whose potential and force take the time, by the names that generated code has.
#[derive(Clone, Debug)]
struct Shaken {
    m: f64,
    k: f64,
    rate: f64,
    r: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss], lanes = [explicit, gauss])]
impl Shaken {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2], time: f64) -> f64 {
        let now = 1.0 + 0.3 * (self.rate * time).sin();
        0.5 * self.m * (v[0] * v[0] + v[1] * v[1]) + 0.2 * v[0] + self.k * now * q[0].cos()
            - 0.5 * (q[0] - q[1]).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + v[0] * v[1] + v[1] * v[1]) + 0.01 * v[1]
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2], push: [f64; 1], t: f64) -> [f64; 2] {
        let u = push[0] * t.cos();
        let elapsed = u * (-0.1 * t).exp() + push[0];
        [u, if t > 1.0 { elapsed } else { -elapsed * q[1] }]
    }
}

/// Mass, damping and force take the time: for Gauss rules alone. A wall makes kinks.
#[derive(Clone, Debug)]
struct Pumped {
    k: f64,
    r: f64,
}

#[rayleigh_system(rule = gauss, lanes = gauss)]
impl Pumped {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        let length = 1.0 + 0.2 * (1.3 * t).sin();
        let swing = 0.5 * length * length * v[0] * v[0] + 0.3 * q[1].sin() * t.cos() * v[0] * v[1];
        swing + (0.6 + 0.5 * length) * v[1] * v[1] + self.k * length * q[0].cos()
            - 0.5 * (q[0] - q[1]).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2], time: f64) -> f64 {
        0.5 * self.r * v[1] * v[1] * (1.0 + (-0.1 * time).exp())
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2], time: f64) -> [f64; 2] {
        [if q[0] > time.sin() { 0.3 * (time.sin() - q[0]) } else { 0.0 }, (self.k * 0.5).sin()]
    }
}

/// Only the force takes the time, and a full matrix of masses.
#[derive(Clone, Debug)]
struct Pushed {
    c: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss], lanes = [explicit, gauss])]
impl Pushed {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let kinetic = 0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1] + v[2] * v[2]) + self.c * v[0] * v[1];
        kinetic - 0.5 * (q[0] * q[0] + (q[1] - q[0]).powi(2)) - 0.25 * q[2].powi(4)
    }

    fn force(&self, _q: [f64; 3], _v: [f64; 3], t: f64) -> [f64; 3] {
        [self.c * t, 0.0, (2.0 * t).sin()]
    }
}

/// In single precision.
#[derive(Clone, Debug)]
struct Single {
    m: f32,
    k: f32,
    r: f32,
}

#[rayleigh_system(rule = [trapezoidal, gauss], lanes = [explicit, gauss])]
impl Single {
    fn lagrangian(&self, q: [f32; 1], v: [f32; 1], t: f32) -> f32 {
        0.5 * self.m * v[0] * v[0] - 0.5 * self.k * (1.5 + t.cos()) * q[0] * q[0] + (q[0] - t).cos()
    }

    fn rayleigh(&self, v: [f32; 1]) -> f32 {
        0.5 * self.r * v[0] * v[0]
    }
}

fn shaken(random: &mut StdRng) -> Shaken {
    let mut positive = |low: f64| random.random_range(low..2.0);
    Shaken { m: positive(0.5), k: positive(0.2), rate: 3.0 * positive(0.1), r: 0.5 * damping(random) }
}

/// Times of either sign, and both zeros.
fn time(random: &mut StdRng) -> f64 {
    match random.random_range(0..8) {
        0 => 0.0,
        1 => -0.0,
        2 => random.random_range(1e6..2e6),
        _ => random.random_range(-4.0..4.0),
    }
}

/// Members of systems, and where they start.
fn views<'s, S, L, const N: usize>(
    systems: &'s [S],
    seed: u64,
    view: impl Fn(&'s S, f64, &mut StdRng) -> L,
) -> Vec<(L, State<f64, N>)> {
    let mut random = StdRng::seed_from_u64(seed);
    let member = |system| {
        let t = time(&mut random);
        (view(system, t, &mut random), start(&mut random))
    };
    systems.iter().map(member).collect()
}

fn many<S>(count: usize, seed: u64, system: impl Fn(&mut StdRng) -> S) -> Vec<S> {
    let mut random = StdRng::seed_from_u64(seed);
    (0..count).map(|_| system(&mut random)).collect()
}

fn pushed_by_input<'s>(system: &'s Shaken, t: f64, random: &mut StdRng) -> DrivenShaken<'s> {
    system.driven([random.random_range(-1.0..1.0)], t)
}

#[test]
fn explicit_methods_see_the_time_of_each_member() {
    let systems = many(37, 1, shaken);
    let all = views::<_, _, 2>(&systems, 2, pushed_by_input);
    let ends = [
        agree_in_two(Splitting::blanes_moan_4(), &all, 0.05),
        agree_in_all(Splitting::blanes_moan_6(), &all, 0.09),
        agree_in_two(Splitting::blanes_casas_escorihuela_8(), &all, -0.08),
        agree_in_two(Splitting::blanes_moan_6().compensated(), &all, 0.09),
        agree_in_all(Trapezoidal, &all, 0.03),
        agree_in_two(Composition::kahan_li_6(Trapezoidal), &all, 0.06),
        agree::<_, _, 2, 8>(Composition::kahan_li_8(Trapezoidal), &all, 0.1),
    ];
    assert_eq!(ends, [37; 7]);
    let systems = many(19, 3, |random| Pushed { c: random.random_range(-0.4..0.4) });
    let all = views::<_, _, 3>(&systems, 4, |system, t, _| system.at_time(t));
    assert_eq!(agree_in_two(Splitting::blanes_moan_6(), &all, 0.07), 19);
    assert_eq!(agree::<_, _, 3, 8>(Splitting::blanes_casas_escorihuela_8(), &all, 0.07), 19);
    assert_eq!(agree_in_two(Trapezoidal, &all, 0.03), 19);
    assert_eq!(agree::<_, _, 3, 4>(Composition::kahan_li_6(Trapezoidal), &all, 0.07), 19);
}

#[test]
fn gauss_rules_see_the_time_of_each_stage() {
    let count = if cfg!(debug_assertions) { 12 } else { 24 };
    let systems = many(count, 5, |random| Pumped { k: random.random_range(0.2..2.0), r: damping(random) });
    let all = views::<_, _, 2>(&systems, 6, |system, t, _| system.at_time(t));
    let ends = [
        agree_in_two(Gauss::<2>, &all, 0.05),
        agree_in_all(Gauss::<4>, &all, -0.1),
        agree::<_, _, 2, 8>(Gauss::<1>, &all, 0.02),
        agree::<_, _, 2, 5>(Gauss::<3>, &all, 0.08),
        agree::<_, _, 2, 8>(Gauss::<5>, &all, 0.15),
        agree::<_, _, 2, 16>(Gauss::<6>, &all, 0.2),
        agree::<_, _, 2, 8>(Gauss::<7>, &all, 0.2),
        agree::<_, _, 2, 32>(Gauss::<8>, &all, 0.3),
    ];
    assert!(ends.iter().all(|&ends| 6 * ends > 5 * count), "{ends:?}");
    let systems = many(19, 7, shaken);
    let all = views::<_, _, 2>(&systems, 8, pushed_by_input);
    assert_eq!(agree_in_two(Gauss::<6>, &all, 0.2), 19);
    // The control: it is lanes that agree, not members that step alone.
    let systems: [&DrivenShaken<'_>; 8] = std::array::from_fn(|lane| &all[lane].0);
    let starts = std::array::from_fn(|lane| all[lane].1);
    let mut runs = LaneRuns::new(Gauss::<6>, systems, &starts, 0.05);
    forward(&mut runs, 100);
    assert!(runs.steps_alone() < 160, "{}", runs.steps_alone());
}

#[test]
fn single_precision_too() {
    fn agrees<M: Copy, const W: usize>(method: M, h: f32)
    where
        for<'s> SingleAtTime<'s>: FlowInLanes<M, 1, Scalar = f32>,
    {
        let mut random = StdRng::seed_from_u64(9);
        let mut any = |low: f32, high: f32| random.random_range(low..high);
        let all: [Single; W] =
            std::array::from_fn(|_| Single { m: any(0.5, 2.0), k: any(0.1, 3.0), r: any(0.0, 0.3) });
        let times: [f32; W] = std::array::from_fn(|_| any(-5.0, 50.0));
        let views: [SingleAtTime<'_>; W] = std::array::from_fn(|lane| all[lane].at_time(times[lane]));
        let starts =
            std::array::from_fn(|_| State { q: vector![any(-1.0, 1.0)], p: vector![any(-1.0, 1.0)] });
        let mut runs = LaneRuns::new(method, views.each_ref(), &starts, h);
        forward(&mut runs, 200);
        for (lane, system) in views.iter().enumerate() {
            let alone = system.by(method, h).run(starts[lane]).nth(199).unwrap().unwrap().state;
            let bits = |state: State<f32, 1>| [state.q[0].to_bits(), state.p[0].to_bits()];
            assert_eq!(runs.state(lane).map(bits), Some(bits(alone)), "lane {lane}");
        }
    }
    agrees::<_, 8>(Splitting::blanes_moan_6(), 0.1);
    agrees::<_, 5>(Splitting::blanes_casas_escorihuela_8(), 0.1);
    agrees::<_, 16>(Trapezoidal, 0.03);
    agrees::<_, 8>(Composition::kahan_li_6(Trapezoidal), 0.1);
    agrees::<_, 8>(Gauss::<3>, 0.1);
    agrees::<_, 32>(Gauss::<6>, 0.2);
}

/// Lanes are given to others on the way: each then stands at another number of steps. Some fail.
#[test]
fn members_put_in_later_start_at_their_own_times() {
    let systems = many(150, 10, shaken);
    let mut all = views::<_, _, 2>(&systems, 11, pushed_by_input);
    for (of, (view, state)) in all.iter_mut().enumerate() {
        match of % 17 {
            3 => state.q[0] = f64::NAN,
            5 => state.p[0] = 1e300,
            8 => *view = systems[of].driven([0.1], f64::NAN),
            11 => *view = systems[of].driven([f64::INFINITY], 0.0),
            13 => *view = systems[of].driven([0.1], f64::INFINITY),
            _ => {}
        }
    }
    let ends = [
        refilled::<_, _, 2, 1>(Splitting::blanes_moan_6(), &all, 0.09, 1),
        refilled::<_, _, 2, 8>(Splitting::blanes_moan_6(), &all, 0.09, 2),
        refilled::<_, _, 2, 32>(Splitting::blanes_moan_4(), &all, 0.03, 3),
        refilled::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8(), &all, 0.09, 4),
        refilled::<_, _, 2, 8>(Trapezoidal, &all, 0.03, 5),
        refilled::<_, _, 2, 3>(Composition::kahan_li_6(Trapezoidal), &all, 0.06, 6),
        refilled::<_, _, 2, 8>(Gauss::<3>, &all, 0.1, 7),
        refilled::<_, _, 2, 16>(Gauss::<6>, &all, 0.2, 8),
    ];
    assert!(ends.iter().all(|ends| (100..140).contains(ends)), "{ends:?}");
}

/// Stiff members leave the usual path, are stepped alone at their own times, and come back.
#[test]
fn stiff_members_take_their_steps_alone() {
    let pumped = |random: &mut StdRng| {
        let is_stiff = random.random_range(0..3) == 0;
        Pumped { k: if is_stiff { 1e6 } else { 1.0 }, r: if is_stiff { 1e4 } else { damping(random) } }
    };
    let systems = many(24, 12, pumped);
    let all = views::<_, _, 2>(&systems, 13, |system, t, _| system.at_time(t));
    let ends = [agree::<_, _, 2, 4>(Gauss::<3>, &all, 0.1), agree::<_, _, 2, 8>(Gauss::<6>, &all, 0.3)];
    assert!(ends.iter().all(|&ends| ends > 14), "{ends:?}");
    let systems: [&PumpedAtTime<'_>; 24] = std::array::from_fn(|lane| &all[lane].0);
    let starts = std::array::from_fn(|lane| all[lane].1);
    let mut runs = LaneRuns::new(Gauss::<3>, systems, &starts, 0.1);
    let steps = if cfg!(debug_assertions) { 25 } else { 100 };
    forward(&mut runs, steps);
    assert!((2 * steps..18 * steps).contains(&runs.steps_alone()), "{}", runs.steps_alone());
}

#[test]
fn solved_for_an_error() {
    let systems = many(8, 14, |random| Pumped { k: random.random_range(0.2..2.0), r: damping(random) });
    let all = views::<_, _, 2>(&systems, 15, |system, t, _| system.at_time(t));
    let systems: [&PumpedAtTime<'_>; 8] = std::array::from_fn(|lane| &all[lane].0);
    let starts = std::array::from_fn(|lane| all[lane].1);
    let mut runs = LaneRuns::new(Gauss::<6>, systems, &starts, 0.2).solved_for(1e-6, 6.0);
    forward(&mut runs, 40);
    let mut differ = false;
    for (lane, (system, start)) in all.iter().enumerate() {
        let run = || system.by(Gauss::<6>, 0.2).run(*start);
        let alone = run().solved_for(1e-6, 6.0).nth(39).unwrap().unwrap().state;
        assert_eq!(runs.state(lane).map(|state| bits(&state)), Some(bits(&alone)), "lane {lane}");
        differ |= bits(&alone) != bits(&run().nth(39).unwrap().unwrap().state);
    }
    assert!(differ, "what is left shows");
}

/// The control: a time that is another by one rounding, or by a step, is seen by the bits, in that lane
/// alone.
#[test]
fn bits_see_another_time() {
    fn sees<'s, M, L, const N: usize>(method: M, right: [L; 4], wrong: [L; 2], starts: [State<f64, N>; 4])
    where
        L: FlowInLanes<M, N, Scalar = f64> + Lagrangian<N> + 's,
        M: Copy,
    {
        for wrong in &wrong {
            let mut systems = right.each_ref();
            systems[2] = wrong;
            let mut runs = LaneRuns::new(method, systems, &starts, 0.05);
            forward(&mut runs, 60);
            for (lane, system) in right.iter().enumerate() {
                let alone = system.by(method, 0.05).run(starts[lane]).nth(59).unwrap().unwrap().state;
                let agrees = runs.state(lane).map(|state| bits(&state)) == Some(bits(&alone));
                assert_eq!(agrees, lane != 2, "lane {lane}");
            }
        }
    }
    let mut random = StdRng::seed_from_u64(16);
    let starts: [State<f64, 2>; 4] = std::array::from_fn(|_| start(&mut random));
    let times = [0.3, -1.2, 2.1, 40.0];
    let shaken = shaken(&mut random);
    let right = || times.map(|t| shaken.driven([0.4], t));
    let wrong = || [2.1_f64.next_up(), 2.1 + 0.05].map(|t| shaken.driven([0.4], t));
    sees(Splitting::blanes_moan_6(), right(), wrong(), starts);
    sees(Splitting::blanes_casas_escorihuela_8(), right(), wrong(), starts);
    sees(Trapezoidal, right(), wrong(), starts);
    sees(Composition::kahan_li_6(Trapezoidal), right(), wrong(), starts);
    let pumped = Pumped { k: 1.1, r: 0.05 };
    let right = times.map(|t| pumped.at_time(t));
    sees(Gauss::<4>, right, [2.1_f64.next_up(), 2.1 + 0.05].map(|t| pumped.at_time(t)), starts);
}
