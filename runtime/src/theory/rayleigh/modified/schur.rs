//! The complex Schur form of a real matrix, by Francis's QR iteration with one shift.
//!
//! Own code because nalgebra's double shift does not converge on complex matrices whose eigenvalues lie close
//! together, as those of a step do for small h.

use nalgebra::{Complex, DMatrix, Hessenberg};

pub(super) type Matrix = DMatrix<Complex<f64>>;

/// Iterations for one eigenvalue; three are usual.
const ITERATIONS: usize = 60;

/// Every so many iterations a shift that is no eigenvalue of anything breaks a circle.
const UNUSUAL: usize = 10;

/// Unitary Q and T with `matrix` = Q T Qᴴ, T upper triangular with the eigenvalues on its diagonal; nothing
/// where an entry is not finite or the iteration does not end. G. H. Golub and C. F. Van Loan, Matrix
/// Computations, 2013, § 7.5.
pub(super) fn schur(matrix: &DMatrix<f64>) -> Option<(Matrix, Matrix)> {
    let (q, t) = Hessenberg::new(matrix.clone()).unpack();
    let (mut q, mut t) = (q.map(Complex::from), t.map(Complex::from));
    let size = t.iter().map(|entry| entry.norm()).fold(0.0, f64::max);
    let mut end = t.nrows() - 1;
    let mut iterations = 0;
    while end > 0 {
        let start = (1..=end)
            .rev()
            .find(|&k| {
                let beside = t[(k - 1, k - 1)].norm() + t[(k, k)].norm();
                t[(k, k - 1)].norm() <= f64::EPSILON * if beside > 0.0 { beside } else { size }
            })
            .unwrap_or(0);
        if start > 0 {
            t[(start, start - 1)] = Complex::from(0.0);
        }
        if start == end {
            (end, iterations) = (end - 1, 0);
            continue;
        }
        iterations += 1;
        if iterations > ITERATIONS {
            return None;
        }
        let shift = if iterations % UNUSUAL == 0 {
            t[(end, end)] + t[(end, end - 1)].norm()
        } else {
            eigenvalue_near_the_last(&t, end)
        };
        iterate(&mut q, &mut t, start..end, shift);
    }
    Some((q, t))
}

/// The eigenvalue of the 2×2 matrix that ends at `end` which is nearer to its last entry.
fn eigenvalue_near_the_last(t: &Matrix, end: usize) -> Complex<f64> {
    let (a, b, c, d) = (t[(end - 1, end - 1)], t[(end - 1, end)], t[(end, end - 1)], t[(end, end)]);
    let half = (a - d) * 0.5;
    let root = (half * half + b * c).sqrt();
    let away = if (half + root).norm() > (half - root).norm() { half + root } else { half - root };
    // d + half ∓ root, as a quotient that does not cancel.
    if away == Complex::from(0.0) { d } else { d - b * c / away }
}

/// T − shift = GR, then T = RG + shift, with rotations G of neighbours within `range`.
fn iterate(q: &mut Matrix, t: &mut Matrix, range: core::ops::Range<usize>, shift: Complex<f64>) {
    let n = t.nrows();
    let zero = Complex::from(0.0);
    for k in 0..n {
        t[(k, k)] -= shift;
    }
    let mut rotations = Vec::with_capacity(range.len());
    for k in range.clone() {
        let (x, y) = (t[(k, k)], t[(k + 1, k)]);
        let length = x.norm().hypot(y.norm());
        let (c, s) = if length > 0.0 { (x / length, y / length) } else { (Complex::from(1.0), zero) };
        for j in k..n {
            let (x, y) = (t[(k, j)], t[(k + 1, j)]);
            t[(k, j)] = c.conj() * x + s.conj() * y;
            t[(k + 1, j)] = c * y - s * x;
        }
        t[(k + 1, k)] = zero;
        rotations.push((c, s));
    }
    for (k, (c, s)) in range.zip(rotations) {
        for (matrix, rows) in [(&mut *t, k + 2), (&mut *q, n)] {
            for i in 0..rows {
                let (x, y) = (matrix[(i, k)], matrix[(i, k + 1)]);
                matrix[(i, k)] = x * c + y * s;
                matrix[(i, k + 1)] = y * c.conj() - x * s.conj();
            }
        }
    }
    for k in 0..n {
        t[(k, k)] += shift;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Q T Qᴴ is the matrix, Q is unitary, T is triangular: random matrices, near I, with multiple
    /// eigenvalues.
    #[test]
    fn schur_forms_are_what_they_say() {
        let mut seed = 1_u64;
        let mut draw = || {
            // Knuth's linear congruence.
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for case in 0..300 {
            let n = 2 + case % 9;
            let identity = DMatrix::identity(n, n);
            let matrix = match case % 5 {
                0 => DMatrix::from_fn(n, n, |_, _| draw()),
                1 => &identity + DMatrix::from_fn(n, n, |_, _| 1e-3 * draw()),
                2 => &identity + DMatrix::from_fn(n, n, |_, _| 1e-9 * draw()),
                3 => DMatrix::from_fn(n, n, |i, j| if i + 1 == j { 1.0 } else { 0.0 }),
                _ => DMatrix::from_fn(n, n, |i, j| if (i + 1) % n == j { 1.0 } else { 0.0 }),
            };
            let (q, t) = schur(&matrix).unwrap();
            let complex = matrix.map(Complex::from);
            let off = |m: Matrix| m.iter().map(|entry| entry.norm()).fold(0.0, f64::max);
            assert!(off(&q * &t * q.adjoint() - complex) < 1e-14, "{case}");
            assert!(off(q.adjoint() * &q - identity.map(Complex::from)) < 1e-14, "{case}");
            assert!((0..n).all(|j| (j + 1..n).all(|i| t[(i, j)].norm() == 0.0)), "{case}");
        }
        let lost = DMatrix::from_element(3, 3, f64::NAN);
        assert!(schur(&lost).is_none());
    }
}
