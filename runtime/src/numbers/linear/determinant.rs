//! The sign of a determinant.

use core::cmp::Ordering;

use nalgebra::SMatrix;

use crate::numbers::Scalar;

/// The determinant against 0, by elimination with row exchanges.
pub(crate) fn determinant_sign<S: Scalar, const N: usize>(mut a: SMatrix<S, N, N>) -> Ordering {
    let mut sign = Ordering::Greater;
    for k in 0..N {
        let mut pivot = k;
        for i in k + 1..N {
            if a[(i, k)].abs() > a[(pivot, k)].abs() {
                pivot = i;
            }
        }
        if pivot != k {
            a.swap_rows(k, pivot);
            sign = sign.reverse();
        }
        if a[(k, k)] < S::zero() {
            sign = sign.reverse();
        } else if a[(k, k)].partial_cmp(&S::zero()) != Some(Ordering::Greater) {
            return Ordering::Equal;
        }
        for i in k + 1..N {
            let factor = a[(i, k)] / a[(k, k)];
            for j in k..N {
                let upper = a[(k, j)];
                a[(i, j)] -= factor * upper;
            }
        }
    }
    sign
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::matrix;

    #[test]
    fn signs_of_determinants() {
        assert_eq!(determinant_sign(matrix![2.0, 1.0; 1.0, 2.0]), Ordering::Greater);
        assert_eq!(determinant_sign(matrix![1.0, 2.0; 2.0, 1.0]), Ordering::Less);
        assert_eq!(determinant_sign(matrix![0.0, 1.0; 1.0, 0.0]), Ordering::Less);
        assert_eq!(determinant_sign(matrix![0.0, 1.0, 0.0; 0.0, 0.0, 1.0; 1.0, 0.0, 0.0]), Ordering::Greater);
        // A singular matrix, and one with a NaN, have none.
        assert_eq!(determinant_sign(matrix![1.0, 2.0; 2.0, 4.0]), Ordering::Equal);
        assert_eq!(determinant_sign(matrix![f64::NAN]), Ordering::Equal);
    }
}
