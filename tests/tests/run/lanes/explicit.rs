//! Members by Störmer–Verlet and its compositions.

use dalembert::nalgebra::{SMatrix, vector};
use dalembert::{Composition, State, Trapezoidal};
use rand::RngExt;
use rand::rngs::StdRng;

use super::alone::{agree, agree_in_all, damping, members};
use super::systems::{Band, Chain, Coupled, Pendulums, Ring};

/// Störmer–Verlet and its compositions, by every form of the matrix.
#[test]
fn explicit_steps_are_bit_by_bit_their_own_runs() {
    let ring = |random: &mut StdRng| Ring { k: damping(random), height: random.random_range(0.5..2.0) };
    let mut all = members(13, 9, ring);
    all[3].1 = State { q: vector![0.0, -0.0], p: vector![-0.0, 0.0] };
    assert_eq!(agree_in_all(Trapezoidal, &all, 0.03), 13);
    assert_eq!(agree::<_, _, 2, 8>(Composition::kahan_li_8(Trapezoidal), &all, 0.1), 13);
    let pendulums = |random: &mut StdRng| Pendulums {
        m: [random.random_range(0.5..2.0), random.random_range(0.5..2.0)],
        g: random.random_range(0.0..9.81),
        spring: random.random_range(0.0..3.0),
        drift: random.random_range(-1.0..1.0),
        thrust: random.random_range(-0.1..0.1),
        r: damping(random),
    };
    let all = members(13, 10, pendulums);
    assert_eq!(agree::<_, _, 2, 3>(Trapezoidal, &all, 0.02), 13);
    assert_eq!(agree::<_, _, 2, 8>(Composition::kahan_li_6(Trapezoidal), &all, 0.05), 13);
    let coupled = |random: &mut StdRng| {
        let r = damping(random);
        let mut symmetric = |scale: f64| {
            let w = SMatrix::<f64, 6, 6>::from_fn(|_, _| random.random_range(-1.0..1.0));
            let full = (w * w.transpose() + SMatrix::identity()) * scale;
            std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (full[(i, j)] + full[(j, i)])))
        };
        let (mass, damping) = (symmetric(1.0), symmetric(r));
        Coupled { mass, damping, spring: random.random_range(0.5..2.0) }
    };
    let all = members(9, 11, coupled);
    assert_eq!(agree::<_, _, 6, 4>(Trapezoidal, &all, 0.05), 9);
    let chain = |random: &mut StdRng| Chain { k: random.random_range(0.5..2.0), r: damping(random) };
    let all = members(9, 12, chain);
    assert_eq!(agree::<_, _, 18, 4>(Trapezoidal, &all, 0.05), 9);
    let band = |random: &mut StdRng| Band { coupling: random.random_range(-0.4..0.4), r: damping(random) };
    let all = members(9, 13, band);
    assert_eq!(agree::<_, _, 5, 8>(Trapezoidal, &all, 0.05), 9);
    assert_eq!(agree::<_, _, 5, 2>(Composition::kahan_li_6(Trapezoidal), &all, 0.1), 9);
}

#[test]
fn explicit_members_that_fail_leave_the_others_as_they_are() {
    let good = State { q: vector![0.1, 1.1], p: vector![0.5, 0.0] };
    let ring = |k| Ring { k, height: 1.0 };
    let all = [
        (ring(0.1), good),
        (ring(0.1), State { q: vector![f64::NAN, 0.0], ..good }),
        (ring(0.0), State { q: vector![1e80, 0.0], ..good }),
        (ring(f64::NAN), good),
        (ring(0.0), State { p: vector![4e3, 0.0], ..good }),
        // The matrix 1/h + k/2 has no inverse.
        (ring(-2.0 / 0.0625), good),
        (ring(0.2), good),
    ];
    assert_eq!(agree_in_all(Trapezoidal, &all, 0.0625), 2);
    assert_eq!(agree::<_, _, 2, 8>(Composition::kahan_li_6(Trapezoidal), &all[..5], 0.0625), 1);
}
