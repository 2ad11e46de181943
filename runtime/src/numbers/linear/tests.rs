//! Matrices of members beside those of each alone.

use nalgebra::{SMatrix, SVector};

use super::{Banded, MatricesOfMembers, NewtonMatrix};
use crate::numbers::{MemberVector, Members};

/// The matrices of the members, of those of one.
type OfMembers<M, const N: usize> = <M as NewtonMatrix<f64, N>>::OfMembers<W>;

const W: usize = 8;

/// Matrices of all sizes and shapes: diagonals that call for exchanges in some members, rows that lose
/// all digits, rows of zeros.
fn entry(member: usize, i: usize, j: usize) -> f64 {
    let any = ((13 * member + 5 * i + 3 * j * j + 7 * i * i * j) as f64 + 0.7).sin();
    match member {
        0 if i == j => any + 3.0,
        5 => ((i + 2 * j + i * j) as f64).sin() * if i == 0 { 1e-14 } else { 1.0 },
        6 if i == 0 => 0.0,
        7 if i == j => 1e-9 * any,
        _ => any,
    }
}

fn dense_agrees<const N: usize>() -> usize {
    let matrices: [SMatrix<f64, N, N>; W] =
        core::array::from_fn(|member| SMatrix::from_fn(|i, j| entry(member, i, j)));
    let entries = core::array::from_fn(|i| {
        core::array::from_fn(|j| Members(matrices.map(|matrix: SMatrix<f64, N, N>| matrix[(i, j)])))
    });
    let right: MemberVector<f64, N, W> =
        core::array::from_fn(|i| Members(core::array::from_fn(|member| entry(member, i, 17))));
    let (solutions, is_solved) = OfMembers::<SMatrix<f64, N, N>, N>::solution(&entries, &right);
    let magnitudes = OfMembers::<SMatrix<f64, N, N>, N>::magnitudes_of(&entries, &right);
    for (member, matrix) in matrices.iter().enumerate() {
        let right = SVector::from_fn(|i, _| right[i].0[member]);
        let alone = matrix.magnitudes(&right);
        assert!((0..N).all(|i| magnitudes[i].0[member].to_bits() == alone[i].to_bits()));
        if is_solved.0[member] {
            let alone = matrix.solve(&right).expect("it is solved in lanes");
            assert!((0..N).all(|i| solutions[i].0[member].to_bits() == alone[i].to_bits()), "{N} {member}");
        }
    }
    is_solved.0.iter().filter(|is_solved| **is_solved).count()
}

fn band_agrees<const N: usize, const B: usize>() -> usize {
    let at = |member: usize, i: usize, k: usize| {
        let is_within = i + k >= B / 2 && i + k - B / 2 < N;
        if is_within { entry(member, i, i + k) + if k == B / 2 { 2.0 } else { 0.0 } } else { 0.0 }
    };
    let matrices: [Banded<f64, N, B>; W] = core::array::from_fn(|member| Banded {
        rows: core::array::from_fn(|i| core::array::from_fn(|k| at(member, i, k))),
    });
    let entries = core::array::from_fn(|i| {
        core::array::from_fn(|k| Members(matrices.map(|matrix: Banded<f64, N, B>| matrix.rows[i][k])))
    });
    let right: MemberVector<f64, N, W> =
        core::array::from_fn(|i| Members(core::array::from_fn(|member| entry(member, i, 17))));
    let (solutions, is_solved) = OfMembers::<Banded<f64, N, B>, N>::solution(&entries, &right);
    for (member, matrix) in matrices.iter().enumerate() {
        let right = SVector::from_fn(|i, _| right[i].0[member]);
        if is_solved.0[member] {
            let alone = matrix.solve(&right).expect("it is solved in lanes");
            assert!((0..N).all(|i| solutions[i].0[member].to_bits() == alone[i].to_bits()), "{N} {member}");
        }
    }
    is_solved.0.iter().filter(|is_solved| **is_solved).count()
}

#[test]
fn each_member_gets_the_solution_that_its_matrix_gives_alone() {
    let solved = [dense_agrees::<1>(), dense_agrees::<2>(), dense_agrees::<3>(), dense_agrees::<7>()];
    assert!(solved.iter().all(|&solved| (4..8).contains(&solved)), "{solved:?}");
    let solved = [band_agrees::<5, 1>(), band_agrees::<6, 3>(), band_agrees::<18, 5>()];
    assert!(solved.iter().all(|&solved| (2..=8).contains(&solved)), "{solved:?}");
}
