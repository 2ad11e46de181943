//! The mass matrix at the start of a run: negative masses are a mistake in what was filled in.

use dalembert::StepError;
use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::system::{Lagrangian, Scalar};

/// Roundings below which a pivot is 0.
const ROUNDINGS: f64 = 64.0;

/// Fails where ∂²L/∂v² has a negative direction: some velocity whose kinetic energy is below 0. Coordinates
/// without mass are left to the step, and so is what constraints hold.
///
/// # Errors
/// [`StepError::MassNotPositiveDefinite`], with the first coordinate whose pivot is negative.
#[cold]
#[inline(never)]
pub(crate) fn require_no_negative<L: Lagrangian<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), StepError> {
    if L::IS_CONSTRAINED {
        return Ok(());
    }
    match negative_pivot(&system.lagrangian_derivatives(q, v).d22) {
        Some(column) => Err(StepError::MassNotPositiveDefinite { column }),
        None => Ok(()),
    }
}

/// The first negative pivot of a symmetric matrix; one that is 0 beside other entries counts.
fn negative_pivot<S: Scalar, const N: usize>(mass: &SMatrix<S, N, N>) -> Option<usize> {
    let rounding = S::EPSILON * S::constant(ROUNDINGS);
    let diagonal = mass.diagonal();
    let mut rows = mass.transpose().data.0;
    let mut first = 0;
    while let Some((row, below)) = rows.get_mut(first..).and_then(<[_]>::split_first_mut) {
        let own = diagonal.get(first).map_or(S::zero(), |own| own.abs());
        let pivot = row.get(first).copied().unwrap_or(S::zero());
        let beside = || row.iter().zip(diagonal.iter()).skip(first + 1);
        if pivot < -rounding * own {
            return Some(first);
        }
        if pivot <= rounding * own {
            // No pivot is left: with entries beside it there would be a negative direction.
            if beside().any(|(entry, other)| *entry * *entry > rounding * own * other.abs()) {
                return Some(first);
            }
        } else {
            for other in below {
                let factor = other.get(first).copied().unwrap_or(S::zero()) / pivot;
                other.iter_mut().zip(row.iter()).for_each(|(entry, of_row)| *entry -= factor * *of_row);
            }
        }
        first += 1;
    }
    None
}

#[cfg(test)]
mod tests {
    use dalembert::nalgebra::{Matrix3, SMatrix, vector};

    use super::negative_pivot;

    /// Numbers in ±1.
    fn drawn(bits: &mut u64) -> f64 {
        *bits = bits.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        2.0 * (*bits >> 11) as f64 / (1_u64 << 53) as f64 - 1.0
    }

    /// aᵀDa has as many negative directions as D (Sylvester), at any scale of the coordinates.
    #[test]
    fn matrices_with_a_negative_direction_are_found_and_no_others() {
        let mut bits = 1;
        let mut found = [0; 2];
        for case in 0..20_000 {
            let a = SMatrix::<f64, 4, 4>::from_fn(|_, _| drawn(&mut bits));
            if a.determinant().abs() < 1e-2 {
                continue;
            }
            let masses = SMatrix::from_diagonal(&vector![1.0, 0.3 + drawn(&mut bits).abs(), 2.0, 0.7]);
            let scale =
                SMatrix::from_diagonal(&SMatrix::<f64, 4, 1>::from_fn(|_, _| 1e6_f64.powf(drawn(&mut bits))));
            let mut signed = masses;
            if case % 2 == 1 {
                signed[(case / 2 % 4, case / 2 % 4)] *= -1.0;
            }
            let matrix = scale * a.transpose() * signed * a * scale;
            let matrix = (matrix + matrix.transpose()) * 0.5;
            assert_eq!(negative_pivot(&matrix).is_some(), case % 2 == 1, "{case} {matrix}");
            found[case % 2] += 1;
        }
        assert!(found.iter().all(|found| *found > 8000), "{found:?}");
    }

    #[test]
    fn coordinates_without_mass_are_none_but_indefinite_ones_are() {
        assert_eq!(negative_pivot(&Matrix3::from_diagonal(&vector![1.0, 0.0, 2.0])), None);
        assert_eq!(negative_pivot(&Matrix3::<f64>::zeros()), None);
        assert_eq!(negative_pivot(&Matrix3::from_diagonal(&vector![1.0, -1e-9, 2.0])), Some(1));
        let product = Matrix3::new(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        assert_eq!(negative_pivot(&product), Some(0)); // L = v₀v₁
        let rank_one = Matrix3::from_fn(|i, j| ((i + 1) * (j + 1)) as f64 / 3.0);
        assert_eq!(negative_pivot(&rank_one), None);
    }
}
