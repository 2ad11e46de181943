//! The principal logarithm of a real matrix.

use core::num::NonZeroUsize;

use nalgebra::{Complex, DMatrix, DVector};

use super::schur::{Matrix, schur};
use crate::theory::legendre::GaussLegendre;
use crate::theory::rayleigh::modified::ModifiedLinearSystemError;

/// Square roots are taken until ‖T − I‖ is below this, where the quadrature of `NODES` nodes is exact to
/// rounding: its error is that of the Padé approximant of ln(1 + x), ((√(1+x) − 1)/(√(1+x) + 1))^(2·12) =
/// 4e-19 at x = −½.
const NEAR: f64 = 0.5;
const NODES: NonZeroUsize = NonZeroUsize::new(12).unwrap();

/// More square roots than any matrix of finite numbers needs to come near I.
const MOST_ROOTS: i32 = 64;

/// An eigenvalue this near to 0 or to the negative real axis, in units of the matrix, is on it: rounding.
const ON_THE_AXIS: f64 = 1024.0 * f64::EPSILON;

/// The eigenvalues of `matrix`.
pub(super) fn eigenvalues(matrix: &DMatrix<f64>) -> Result<DVector<Complex<f64>>, ModifiedLinearSystemError> {
    Ok(schur(matrix).ok_or(ModifiedLinearSystemError::NotConverged)?.1.diagonal())
}

/// ln `matrix`, with the imaginary parts of its eigenvalues between −π and π: by inverse scaling and squaring
/// of the Schur form (N. J. Higham, Functions of Matrices, 2008, algorithm 11.9), ln(1 + X) = ∫₀¹ X (I +
/// xX)⁻¹ dx by a Gauss–Legendre quadrature.
pub(super) fn logarithm(matrix: &DMatrix<f64>) -> Result<DMatrix<f64>, ModifiedLinearSystemError> {
    let n = matrix.nrows();
    let (q, mut t) = schur(matrix).ok_or(ModifiedLinearSystemError::NotConverged)?;
    let size = matrix.lp_norm(1);
    for &eigenvalue in t.diagonal().iter() {
        if eigenvalue.norm() <= ON_THE_AXIS * size {
            return Err(ModifiedLinearSystemError::ZeroEigenvalue);
        }
        if eigenvalue.re < 0.0 && eigenvalue.im.abs() <= ON_THE_AXIS * size {
            return Err(ModifiedLinearSystemError::NegativeEigenvalue { eigenvalue: eigenvalue.re });
        }
    }
    // What of the diagonal the roots round need not be rounded.
    let of_eigenvalues = t.diagonal().map(Complex::ln);
    let identity = Matrix::identity(n, n);
    let mut doublings = 0;
    while column_norm(&(&t - &identity)) > NEAR {
        if doublings == MOST_ROOTS {
            return Err(ModifiedLinearSystemError::NotConverged);
        }
        t = square_root(&t);
        doublings += 1;
    }
    let x = &t - &identity;
    let mut sum = DMatrix::zeros(n, n);
    for (node, weight) in GaussLegendre::new(NODES).nodes {
        let shifted = &identity + &x * Complex::from(node);
        let term = shifted.solve_upper_triangular(&x).ok_or(ModifiedLinearSystemError::NotConverged)?;
        sum += term * Complex::from(weight);
    }
    let mut logarithm = sum * Complex::from(2.0_f64.powi(doublings));
    logarithm.set_diagonal(&of_eigenvalues);
    Ok((&q * logarithm * q.adjoint()).map(|entry| entry.re))
}

/// The upper triangular root of an upper triangular matrix with eigenvalues in the right half-plane (Å.
/// Björck and S. Hammarling, 1983).
fn square_root(t: &Matrix) -> Matrix {
    let n = t.nrows();
    let mut root = DMatrix::zeros(n, n);
    for j in 0..n {
        root[(j, j)] = t[(j, j)].sqrt();
        for i in (0..j).rev() {
            let known: Complex<f64> = (i + 1..j).map(|k| root[(i, k)] * root[(k, j)]).sum();
            root[(i, j)] = (t[(i, j)] - known) / (root[(i, i)] + root[(j, j)]);
        }
    }
    root
}

/// The largest sum of magnitudes of a column.
fn column_norm(matrix: &Matrix) -> f64 {
    matrix.column_iter().map(|column| column.iter().map(|entry| entry.norm()).sum()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    const APART: [f64; 16] =
        [0.7, 2.5, -0.3, 0.1, -0.4, 0.2, 1.5, 0.8, 0.05, -0.9, 0.6, 3.0, 0.3, -0.2, -1.1, 0.9];
    const LOGARITHM_OF_APART: [f64; 16] = [
        0.019_178_634_725_321_72,
        3.087_259_332_508_860_4,
        -1.681_745_689_759_781,
        1.898_039_606_061_862,
        -0.331_971_585_240_315_6,
        -0.126_672_618_937_231_06,
        1.157_952_291_640_348_3,
        -0.634_003_301_759_387,
        -0.226_345_458_082_936_15,
        -0.038_480_762_053_522_62,
        0.490_457_273_700_455_2,
        2.186_128_119_474_733_5,
        0.124_461_900_029_336_04,
        -0.565_825_611_426_746_2,
        -0.422_771_363_371_102_5,
        0.469_428_716_535_377_5,
    ];

    #[test]
    fn logarithms_of_matrices() {
        let identity = DMatrix::identity(4, 4);
        assert_eq!(logarithm(&identity).unwrap(), &identity * 0.0);
        // A Jordan block: ln = [[0, 1, −½, ⅓], …], the series by hand.
        let jordan = DMatrix::from_fn(4, 4, |i, j| if i == j || i + 1 == j { 1.0 } else { 0.0 });
        let expected =
            DMatrix::from_fn(4, 4, |i, j| if j > i { [1.0, -0.5, 1.0 / 3.0][j - i - 1] } else { 0.0 });
        assert!((logarithm(&jordan).unwrap() - expected).amax() < 1e-15);
        // Eigenvalues apart, not normal: mpmath with 40 digits.
        let apart = DMatrix::from_row_slice(4, 4, &APART);
        let expected = DMatrix::from_row_slice(4, 4, &LOGARITHM_OF_APART);
        assert!((logarithm(&apart).unwrap() - expected).amax() < 1e-14);
        // A turn by 3, and a spiral: closed forms.
        for (radius, angle) in [(1.0_f64, 3.0_f64), (0.2, -3.1), (5.0, 1e-9)] {
            let (s, c) = angle.sin_cos();
            let spiral = DMatrix::from_row_slice(2, 2, &[c, -s, s, c]) * radius;
            let l = radius.ln();
            let expected = DMatrix::from_row_slice(2, 2, &[l, -angle, angle, l]);
            assert!((logarithm(&spiral).unwrap() - expected).amax() < 4e-15, "{angle}");
        }
        // Negative real axis, zero.
        let diagonal = |x: f64| DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, x]));
        assert_eq!(
            logarithm(&diagonal(-0.5)),
            Err(ModifiedLinearSystemError::NegativeEigenvalue { eigenvalue: -0.5 })
        );
        assert_eq!(logarithm(&diagonal(0.0)), Err(ModifiedLinearSystemError::ZeroEigenvalue));
    }
}
