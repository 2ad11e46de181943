//! Members by splittings: systems of every form, branches, inputs, failures.

use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::run::LaneRuns;
use dalembert::{Composition, Discretise, Splitting, State, Trapezoidal};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::alone::{agree, agree_in_all, agree_in_two, alone, bits, damping, forward, members, refilled};
use super::systems::{
    Branchy, Chain, Coupled, Everything, Floor, HenonHeiles, Pendulums, Pushed, Ring, Single,
};

#[test]
fn rings_are_bit_by_bit_their_own_runs() {
    let ring = |random: &mut StdRng| Ring { k: damping(random), height: random.random_range(0.5..2.0) };
    let mut all = members(37, 1, ring);
    // At rest on the axes, zeros of either sign.
    all[3].1 = State { q: vector![0.0, -0.0], p: vector![-0.0, 0.0] };
    all[4].1 = State { q: vector![-0.0, 1.0], p: vector![-0.0, -0.0] };
    assert_eq!(agree_in_all(Splitting::blanes_moan_6(), &all, 0.09), 37);
    assert_eq!(agree_in_two(Splitting::blanes_casas_escorihuela_8(), &all, 0.09), 37);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8().compensated(), &all, 0.09), 37);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_6().compensated(), &all, 0.09), 37);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_4(), &all, 0.02), 37);
    assert_eq!(agree::<_, _, 2, 16>(Splitting::blanes_moan_4(), &all, -0.05), 37);
    // Undamped ones alone take a way of their own.
    let undamped: Vec<_> = all.into_iter().filter(|(ring, _)| ring.k == 0.0).collect();
    assert!(undamped.len() > 5);
    assert_eq!(agree::<_, _, 2, 4>(Splitting::blanes_moan_6(), &undamped, 0.1), undamped.len());
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8(), &undamped, 0.1), undamped.len());
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_4().compensated(), &undamped, 0.1), undamped.len());
}

#[test]
fn members_without_fields_and_in_other_functions() {
    let mut all = members(19, 2, |_| HenonHeiles);
    // Half of them stay near the bottom; of the others some escape, and overflow.
    for (_, state) in &mut all[..10] {
        (state.q, state.p) = (state.q * 0.2, state.p * 0.2);
    }
    let ends = agree_in_two(Splitting::blanes_moan_6(), &all, 0.4);
    assert!((10..19).contains(&ends), "{ends}");
    let pendulums = |random: &mut StdRng| Pendulums {
        m: [random.random_range(0.5..2.0), random.random_range(0.5..2.0)],
        g: random.random_range(0.0..9.81),
        spring: random.random_range(0.0..3.0),
        drift: if random.random() { 0.0 } else { random.random_range(-1.0..1.0) },
        thrust: if random.random() { 0.0 } else { random.random_range(-0.1..0.1) },
        r: damping(random),
    };
    let all = members(35, 3, pendulums);
    assert_eq!(agree_in_two(Splitting::blanes_moan_6(), &all, 0.1), 35);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_4(), &all, 0.03), 35);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8(), &all, 0.1), 35);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_6().compensated(), &all, 0.1), 35);
}

#[test]
fn every_function_is_that_of_numbers() {
    let of = |random: &mut StdRng| Everything {
        k: if random.random_range(0..5) == 0 { 1.0 } else { random.random_range(0.5..1.5) },
        is_on: random.random(),
    };
    let mut all = members(27, 14, of);
    all[0].1.q = vector![0.0, -0.0];
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_6(), &all, 0.3), 27);
    assert_eq!(agree::<_, _, 2, 3>(Trapezoidal, &all, 0.05), 27);
}

#[test]
fn chains_longer_than_what_is_unrolled() {
    let chain = |random: &mut StdRng| Chain { k: random.random_range(0.5..2.0), r: damping(random) };
    let all = members(11, 8, chain);
    assert_eq!(agree::<_, _, 18, 8>(Splitting::blanes_moan_6(), &all, 0.2), 11);
    assert_eq!(agree::<_, _, 18, 3>(Splitting::blanes_moan_4(), &all, 0.1), 11);
}

#[test]
fn full_matrices_beside_diagonal_ones() {
    let coupled = |random: &mut StdRng| {
        let (is_diagonal, r) = (random.random_range(0..4) == 0, damping(random));
        let mut symmetric = |scale: f64| {
            let w = SMatrix::<f64, 6, 6>::from_fn(|_, _| random.random_range(-1.0..1.0));
            let full = (w * w.transpose() + SMatrix::identity()) * scale;
            let full = (full + full.transpose()) * 0.5;
            let kept = if is_diagonal { SMatrix::from_diagonal(&full.diagonal()) } else { full };
            std::array::from_fn(|i| std::array::from_fn(|j| kept[(i, j)]))
        };
        let (mass, damping) = (symmetric(1.0), symmetric(r));
        Coupled { mass, damping, spring: random.random_range(0.5..2.0) }
    };
    let mut all = members(11, 4, coupled);
    all[2].1 = State { q: SVector::zeros(), p: -SVector::<f64, 6>::zeros() };
    let is_diagonal = |of: &Coupled| of.mass[0][1] == 0.0;
    let diagonal = all.iter().filter(|(of, _)| is_diagonal(of)).count();
    assert!((2..9).contains(&diagonal), "{diagonal} of 11 are diagonal");
    assert_eq!(agree::<_, _, 6, 1>(Splitting::blanes_moan_6(), &all, 0.1), 11);
    assert_eq!(agree::<_, _, 6, 3>(Splitting::blanes_moan_4(), &all, 0.1), 11);
    assert_eq!(agree::<_, _, 6, 4>(Splitting::blanes_moan_6(), &all, 0.2), 11);
    assert_eq!(agree::<_, _, 6, 3>(Splitting::blanes_casas_escorihuela_8(), &all, 0.2), 11);
    assert_eq!(agree::<_, _, 6, 4>(Splitting::blanes_moan_6().compensated(), &all, 0.2), 11);
    assert_eq!(agree::<_, _, 6, 3>(Splitting::blanes_casas_escorihuela_8().compensated(), &all, 0.2), 11);
}

#[test]
fn every_member_takes_its_own_branches() {
    let branchy = |random: &mut StdRng| Branchy {
        floor: if random.random() { Floor::Flat } else { Floor::Ramp(random.random_range(-1.0..1.0)) },
        has_wall: random.random(),
        teeth: random.random_range(0..4),
        wind: random.random::<bool>().then(|| random.random_range(-0.3..0.3)),
    };
    let mut all = members(41, 5, branchy);
    for (of, (_, state)) in all.iter_mut().enumerate() {
        state.q *= 2.0;
        if of % 7 == 0 {
            state.q[0] = -0.0;
        }
    }
    assert_eq!(agree_in_two(Splitting::blanes_moan_6(), &all, 0.15), 41);
    assert_eq!(agree::<_, _, 1, 8>(Splitting::blanes_moan_4(), &all, 0.05), 41);
}

#[test]
fn members_are_driven_each_by_its_own_input() {
    let pushed = |random: &mut StdRng| Pushed {
        m: random.random_range(0.5..2.0),
        r: damping(random),
        is_blunt: random.random(),
    };
    let systems = members(41, 24, pushed);
    let mut random = StdRng::seed_from_u64(25);
    let mut input = || std::array::from_fn::<f64, 2, _>(|_| random.random_range(-1.0..1.0));
    let mut driven: Vec<_> = systems.iter().map(|(system, start)| (system.driven(input()), *start)).collect();
    // An input that is no number is that member's fault alone.
    driven[7].0 = systems[7].0.driven([f64::NAN, 0.0]);
    assert_eq!(agree_in_two(Splitting::blanes_moan_6(), &driven, 0.2), 40);
    assert_eq!(agree_in_two(Trapezoidal, &driven, 0.05), 40);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8(), &driven, 0.2), 40);
    assert_eq!(agree::<_, _, 2, 8>(Composition::kahan_li_6(Trapezoidal), &driven, 0.1), 40);
    assert_eq!(refilled::<_, _, 2, 8>(Trapezoidal, &driven, 0.05, 10), 40);
    assert_eq!(refilled::<_, _, 2, 4>(Splitting::blanes_moan_4(), &driven, 0.05, 11), 40);
    // The input is seen.
    let still = alone(Trapezoidal, &systems[0].0.driven([0.0, 0.0]), driven[0].1, 0.05, 20).unwrap();
    let moved = alone(Trapezoidal, &driven[0].0, driven[0].1, 0.05, 20).unwrap();
    assert!((still.q - moved.q).amax() > 1e-3);
}

#[test]
fn single_precision_agrees_too() {
    let mut random = StdRng::seed_from_u64(6);
    let systems: [Single; 8] = std::array::from_fn(|_| Single {
        m: random.random_range(0.5..2.0),
        k: random.random_range(0.0..2.0),
        r: damping(&mut random) as f32,
    });
    let starts: [State<f32, 1>; 8] = std::array::from_fn(|_| State {
        q: vector![random.random_range(-2.0..2.0)],
        p: vector![random.random_range(-2.0..2.0)],
    });
    let mut runs = LaneRuns::new(Splitting::blanes_moan_4(), systems.each_ref(), &starts, 0.1);
    forward(&mut runs, 50);
    for lane in 0..8 {
        let alone = systems[lane].by(Splitting::blanes_moan_4(), 0.1).run(starts[lane]).nth(49);
        let (alone, in_lanes) = (alone.unwrap().unwrap().state, runs.state(lane).unwrap());
        assert_eq!(
            (alone.q[0].to_bits(), alone.p[0].to_bits()),
            (in_lanes.q[0].to_bits(), in_lanes.p[0].to_bits())
        );
    }
}

#[test]
fn members_that_fail_leave_the_others_as_they_are() {
    let good = State { q: vector![0.1, 1.1], p: vector![0.5, 0.0] };
    let ring = |k| Ring { k, height: 1.0 };
    let far = State { q: vector![1e80, 0.0], ..good };
    let none = State { q: vector![f64::NAN, 0.0], ..good };
    let endless = State { p: vector![0.0, f64::INFINITY], ..good };
    let late = State { p: vector![4e3, 0.0], ..good };
    // Damping that overflows over a drift backwards, and none at all.
    let all = [
        (ring(0.1), good),
        (ring(0.1), none),
        (ring(0.0), far),
        (ring(f64::NAN), good),
        (ring(0.0), good),
        (ring(1e9), good),
        (ring(0.2), endless),
        (ring(0.2), good),
        (ring(0.0), late),
    ];
    assert_eq!(agree_in_all(Splitting::blanes_moan_6(), &all, 0.09), 3);
    let systems: [&Ring; 9] = std::array::from_fn(|lane| &all[lane].0);
    let starts = std::array::from_fn(|lane| all[lane].1);
    let mut runs = LaneRuns::new(Splitting::blanes_moan_6(), systems, &starts, 0.09);
    forward(&mut runs, 10);
    let has_state: [bool; 9] = std::array::from_fn(|lane| runs.state(lane).is_some());
    assert_eq!(has_state, [true, false, false, false, true, false, false, true, false]);
    // No step at all, by a step size that is none.
    for h in [0.0, f64::NAN, f64::INFINITY] {
        let runs = LaneRuns::new(Splitting::blanes_moan_6(), systems, &starts, h);
        assert!((0..9).all(|lane| runs.state(lane).is_none()), "h = {h}");
    }
}

#[test]
fn masses_that_are_none_have_no_state() {
    let mut all = members(6, 7, |random| Pendulums {
        m: [1.0, random.random_range(0.5..2.0)],
        g: 9.81,
        spring: 1.0,
        drift: 0.0,
        thrust: 0.0,
        r: 0.1,
    });
    all[1].0.m[1] = -1.0;
    all[4].0.m[0] = 0.0;
    assert_eq!(agree_in_two(Splitting::blanes_moan_6(), &all, 0.05), 4);
}

/// The control: another order of the same operations, or another sine, is seen by the bits.
#[test]
fn bits_see_another_rounding() {
    let ring = Ring { k: 0.1, height: 1.3 };
    let start = State { q: vector![0.1, 1.1], p: vector![0.5, 0.0] };
    let mut runs = LaneRuns::new(Splitting::blanes_moan_6(), [&ring; 2], &[start; 2], 0.09);
    forward(&mut runs, 21);
    let other = Ring { height: f64::from_bits(1.3_f64.to_bits() + 1), ..ring.clone() };
    let other = alone(Splitting::blanes_moan_6(), &other, start, 0.09, 21).unwrap();
    assert_ne!(bits(&runs.state(0).unwrap()), bits(&other));
    assert!((runs.state(0).unwrap().q - other.q).amax() < 1e-12);
}
