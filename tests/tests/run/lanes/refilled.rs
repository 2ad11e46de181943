//! Lanes that are given to others.

use dalembert::nalgebra::{SVector, vector};
use dalembert::{Composition, Splitting, State, Trapezoidal};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::alone::{damping, members, refilled};
use super::systems::{Coupled, Ring};

#[test]
fn members_in_lanes_that_others_have_left_are_their_own_runs() {
    // Damped and undamped members, and some that fail: at their start, in their first step and later.
    let ring = |random: &mut StdRng| Ring { k: damping(random), height: random.random_range(0.5..2.0) };
    let mut all = members(150, 21, ring);
    for (of, (ring, state)) in all.iter_mut().enumerate() {
        match of % 17 {
            3 => state.q[0] = f64::NAN,
            5 => *state = State { q: vector![0.0, -0.0], p: vector![-0.0, 0.0] },
            8 => ring.k = f64::NAN,
            11 => state.q[0] = 1e80,
            13 => state.p[0] = 4e3,
            _ => {}
        }
    }
    let ends = [
        refilled::<_, _, 2, 1>(Splitting::blanes_moan_6(), &all, 0.09, 1),
        refilled::<_, _, 2, 8>(Splitting::blanes_moan_6(), &all, 0.09, 2),
        refilled::<_, _, 2, 32>(Splitting::blanes_moan_4(), &all, 0.03, 3),
        refilled::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8(), &all, 0.09, 4),
        refilled::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8().compensated(), &all, 0.09, 5),
        refilled::<_, _, 2, 8>(Trapezoidal, &all, 0.03, 5),
        refilled::<_, _, 2, 3>(Composition::kahan_li_6(Trapezoidal), &all, 0.06, 6),
    ];
    assert!(ends.iter().all(|ends| (110..150).contains(ends)), "{ends:?}");

    // The drifts take a wider form on the way: without damping, diagonal, full.
    let mut random = StdRng::seed_from_u64(22);
    let mut all = members(40, 23, |_| Coupled { mass: [[0.0; 6]; 6], damping: [[0.0; 6]; 6], spring: 1.0 });
    for (of, (coupled, _)) in all.iter_mut().enumerate() {
        for i in 0..6 {
            coupled.mass[i][i] = random.random_range(1.0..2.0);
            coupled.damping[i][i] = if of < 12 || of % 3 == 0 { 0.0 } else { random.random_range(0.0..0.5) };
        }
        if of > 24 && of % 2 == 0 {
            (coupled.mass[0][3], coupled.mass[3][0]) = (0.2, 0.2);
        }
    }
    all[9].1 = State { q: SVector::zeros(), p: -SVector::<f64, 6>::zeros() };
    assert_eq!(refilled::<_, _, 6, 4>(Splitting::blanes_moan_6(), &all, 0.1, 7), 40);
    assert_eq!(refilled::<_, _, 6, 3>(Splitting::blanes_casas_escorihuela_8(), &all, 0.1, 8), 40);
    assert_eq!(refilled::<_, _, 6, 4>(Trapezoidal, &all, 0.05, 9), 40);
}
