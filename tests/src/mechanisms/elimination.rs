//! Linear equations in twice the precision.

use double_double::DoubleDouble;

/// Rows of a matrix.
pub(super) type Rows = Vec<Vec<DoubleDouble>>;

/// A matrix as the product of two triangles, its rows exchanged by scaled pivots.
pub(super) struct Factors {
    rows: Rows,
    order: Vec<usize>,
    /// The smallest pivot beside its row.
    pub(super) least: f64,
}

impl Factors {
    /// Of a square matrix; nothing where it is singular in this precision.
    pub(super) fn of(mut rows: Rows) -> Option<Self> {
        let n = rows.len();
        let largest = |row: &[DoubleDouble]| row.iter().fold(0.0_f64, |size, x| size.max(x.high.abs()));
        let mut scales: Vec<f64> = rows.iter().map(|row| largest(row)).collect();
        let mut order: Vec<usize> = (0..n).collect();
        let mut least = f64::INFINITY;
        for k in 0..n {
            let share = |i: usize| rows[i][k].high.abs() / scales[i];
            let pivot = (k..n).max_by(|i, j| share(*i).total_cmp(&share(*j)))?;
            // A NaN is none.
            let is_regular = share(pivot) > 1e-28;
            if !is_regular {
                return None;
            }
            least = least.min(share(pivot));
            rows.swap(k, pivot);
            scales.swap(k, pivot);
            order.swap(k, pivot);
            let (above, below) = rows.split_at_mut(k + 1);
            for row in below {
                let factor = row[k] / above[k][k];
                row[k] = factor;
                if factor.high != 0.0 {
                    for (entry, of_pivot) in row[k + 1..].iter_mut().zip(&above[k][k + 1..]) {
                        *entry = *entry - factor * *of_pivot;
                    }
                }
            }
        }
        Some(Self { rows, order, least })
    }

    /// x of A x = `right`.
    pub(super) fn solve(&self, right: &[DoubleDouble]) -> Vec<DoubleDouble> {
        let mut x: Vec<DoubleDouble> = self.order.iter().map(|i| right[*i]).collect();
        for i in 0..x.len() {
            x[i] = self.rows[i][..i].iter().zip(&x).fold(x[i], |sum, (entry, x)| sum - *entry * *x);
        }
        for i in (0..x.len()).rev() {
            let (row, known) = (&self.rows[i], &x[i + 1..]);
            let rest = row[i + 1..].iter().zip(known).fold(x[i], |sum, (entry, x)| sum - *entry * *x);
            x[i] = rest / row[i];
        }
        x
    }

    /// |A⁻¹| `errors`.
    pub(super) fn bound(&self, errors: &[f64]) -> Vec<f64> {
        let mut bound = vec![0.0; errors.len()];
        let mut unit = vec![DoubleDouble::ZERO; errors.len()];
        for (j, error) in errors.iter().enumerate() {
            unit[j] = DoubleDouble::new(*error);
            for (bound, entry) in bound.iter_mut().zip(self.solve(&unit)) {
                *bound += entry.high.abs();
            }
            unit[j] = DoubleDouble::ZERO;
        }
        bound
    }
}
