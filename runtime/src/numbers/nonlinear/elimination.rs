//! Elimination of a dense matrix of any size with row exchanges, P A = L U, in place.
//!
//! Pivots are chosen relative to their rows as they were. The rows stand one after the other in one slice.

use core::cmp::Ordering;

use crate::numbers::{Precision, Singular};

/// Factors the matrix; afterwards `order[i]` is the row of the matrix that stands in place i. `scale` is room
/// for as many numbers as there are rows.
///
/// # Errors
/// [`Singular`], with the column of which rounding has left no pivot.
pub(super) fn factor<S: Precision>(
    rows: &mut [S],
    order: &mut [usize],
    scale: &mut [S],
) -> Result<(), Singular> {
    let length = order.len();
    let lost = S::SPACING * S::nearest(8.0 * length as f64);
    for (place, row) in order.iter_mut().enumerate() {
        *row = place;
    }
    for (row, scale) in rows.chunks_exact(length.max(1)).zip(&mut *scale) {
        let largest = row.iter().fold(S::zero(), |largest, entry| largest.max(entry.abs()));
        *scale = if largest > S::zero() { S::one() / largest } else { S::zero() };
    }
    for column in 0..length {
        let (mut pivot, mut best) = (column, S::zero());
        for (place, (row, scale)) in rows.chunks_exact(length).zip(&*scale).enumerate().skip(column) {
            let candidate = row.get(column).map_or(best, |entry| entry.abs() * *scale);
            if candidate > best {
                (pivot, best) = (place, candidate);
            }
        }
        // Rounding has left nothing of the pivot; a NaN fails the comparison.
        if best.partial_cmp(&lost) != Some(Ordering::Greater) {
            return Err(Singular { column });
        }
        if pivot != column {
            exchange(order, column, pivot);
            exchange(scale, column, pivot);
        }
        let Some((above, below)) = rows.split_at_mut_checked((column + 1) * length) else { continue };
        let Some(upper) = above.chunks_exact_mut(length).next_back() else { continue };
        if let Some(row) = below.chunks_exact_mut(length).nth(pivot.wrapping_sub(column + 1)) {
            upper.swap_with_slice(row);
        }
        let Some([pivot, right @ ..]) = upper.get(column..) else { continue };
        let reciprocal = S::one() / *pivot;
        for row in below.chunks_exact_mut(length) {
            let Some([first, rest @ ..]) = row.get_mut(column..) else { continue };
            let factor = *first * reciprocal;
            *first = factor;
            if factor != S::zero() {
                for (entry, upper) in rest.iter_mut().zip(right) {
                    *entry -= factor * *upper;
                }
            }
        }
    }
    Ok(())
}

/// Exchanges two entries.
fn exchange<T>(of: &mut [T], place: usize, other: usize) {
    if let Ok([a, b]) = of.get_disjoint_mut([place, other]) {
        core::mem::swap(a, b);
    }
}

/// Solves L U x = `x` in place, for a right side in the order of the rows.
pub(super) fn substitute<S: Precision>(rows: &[S], x: &mut [S]) {
    let length = x.len();
    for (place, row) in rows.chunks_exact(length.max(1)).enumerate() {
        let Some((known, [x, ..])) = x.split_at_mut_checked(place) else { continue };
        for (lower, known) in row.iter().zip(&*known) {
            *x -= *lower * *known;
        }
    }
    for (place, row) in rows.chunks_exact(length.max(1)).enumerate().rev() {
        let Some([x, known @ ..]) = x.get_mut(place..) else { continue };
        let Some([pivot, right @ ..]) = row.get(place..) else { continue };
        for (upper, known) in right.iter().zip(&*known) {
            *x -= *upper * *known;
        }
        *x /= *pivot;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix4, Vector4};

    use super::*;

    /// A matrix whose rows have to be exchanged, and one of rank 3.
    #[test]
    fn solves_or_names_the_column() {
        let matrix = Matrix4::new(
            0.0, 2.0, 1.0, -1.0, //
            3.0, 0.0, -2.0, 1.0, //
            1e-20, 1e-20, 4.0e-20, 0.0, //
            -1.0, 5.0, 0.5, 1e3,
        );
        let right = Vector4::new(1.0, -2.0, 3e-20, 0.25);
        let mut rows = matrix.transpose().data.0;
        let (mut order, mut scale) = ([0; 4], [0.0; 4]);
        factor(rows.as_flattened_mut(), &mut order, &mut scale).unwrap();
        let mut x = order.map(|row| right[row]);
        substitute(rows.as_flattened(), &mut x);
        let expected = matrix.full_piv_lu().solve(&right).unwrap();
        assert!((Vector4::from(x) - expected).amax() < 1e-14 * expected.amax(), "{x:?} {expected}");

        // The control: the third column is the sum of the first two.
        let mut lost = matrix;
        lost.set_column(2, &(matrix.column(0) + matrix.column(1)));
        let mut rows = lost.transpose().data.0;
        let found = factor(rows.as_flattened_mut(), &mut order, &mut scale);
        assert_eq!(found.unwrap_err().column, 2);
        rows[1][1] = f64::NAN;
        assert!(factor(rows.as_flattened_mut(), &mut order, &mut scale).is_err());
    }
}
