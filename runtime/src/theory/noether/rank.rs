use core::fmt;

use nalgebra::DMatrix;

use crate::theory::verdict::{largest, tells, typical};

/// A rank decision with its evidence: the singular values, the threshold and the gap between those kept and
/// dropped.
///
/// The matrix is scaled first, rows by kind and columns by generator, so that an entry says which part of its
/// terms did not cancel: 1 if nothing cancels, ε if everything does. Units of coordinates and sizes of
/// generators drop out, and so does the size of samples that lie far out.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RankDecision {
    /// Singular values of the scaled matrix, decreasing.
    pub singular_values: Vec<f64>,
    /// Singular values up to here count as zero: the tolerance × √(columns), which bounds what rounding adds
    /// to them.
    pub threshold: f64,
    /// Number of singular values above the threshold.
    pub rank: usize,
}

/// A gap of fewer decades than this is no evidence.
const CLEAR_GAP: f64 = 1e3;

impl RankDecision {
    /// Smallest singular value kept over the largest dropped, infinite if the latter is 0.
    ///
    /// Where none is kept, 1 stands for it, the size of an entry without cancellation; where none is dropped,
    /// the threshold.
    #[must_use]
    pub fn gap(&self) -> f64 {
        self.smallest_kept() / self.singular_values.get(self.rank).copied().unwrap_or(self.threshold)
    }

    /// Whether the gap spans at least three decades; if not, look at the singular values before trusting the
    /// rank. A threshold that leaves no digit of 1, the size of what does not cancel at all, decides nothing.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        tells(self.threshold, 1.0) && self.gap() >= CLEAR_GAP
    }

    /// Angle by which rounding may have turned the null space: threshold over smallest singular value kept.
    pub(super) fn uncertainty(&self) -> f64 {
        self.threshold / self.smallest_kept()
    }

    fn smallest_kept(&self) -> f64 {
        if self.rank > 0 { self.singular_values[self.rank - 1] } else { 1.0 }
    }
}

impl fmt::Display for RankDecision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("singular values")?;
        for (index, value) in self.singular_values.iter().enumerate() {
            write!(f, "{} {value:.2e}", if index == self.rank { " |" } else { "" })?;
        }
        write!(f, "; zero below {:.1e}; gap {:.1e}", self.threshold, self.gap())?;
        if !self.is_clear() {
            f.write_str(" — NO CLEAR GAP")?;
        }
        Ok(())
    }
}

/// Linear conditions of one kind on the coefficients of a combination: one row a sample, one column a
/// generator.
pub(crate) struct Conditions {
    /// The values that have to vanish.
    pub(crate) values: DMatrix<f64>,
    /// Σ|terms| of each value.
    pub(crate) sizes: DMatrix<f64>,
}

impl Conditions {
    /// Rows far out in units of their own size, and all in units of the largest: a sample far out would drown
    /// the others, and squares of its entries overflow.
    fn equalised(&self) -> Self {
        let columns: Vec<f64> =
            self.sizes.column_iter().map(|column| typical(column.iter().copied())).collect();
        let far = |row: usize| {
            largest(self.sizes.row(row).iter().zip(&columns).map(|(size, column)| size / column)).max(1.0)
        };
        let far: Vec<f64> = (0..self.sizes.nrows()).map(far).collect();
        let unit = positive_or_one(largest(
            self.sizes
                .row_iter()
                .zip(&far)
                .flat_map(|(row, far)| row.iter().map(|size| size / far).collect::<Vec<_>>()),
        ));
        let scaled = |matrix: &DMatrix<f64>| {
            DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] / far[i] / unit)
        };
        Self { values: scaled(&self.values), sizes: scaled(&self.sizes) }
    }
}

/// Combinations that fulfil all conditions: the decision, and a basis in reduced row echelon form.
pub(crate) fn null_space(conditions: &[Conditions], tolerance: f64) -> (RankDecision, Vec<Vec<f64>>) {
    let conditions: Vec<Conditions> = conditions.iter().map(Conditions::equalised).collect();
    let columns = conditions.first().map_or(0, |block| block.values.ncols());
    let row_scales: Vec<f64> = conditions.iter().map(|block| positive_or_one(block.sizes.norm())).collect();
    let column_scales: Vec<f64> = (0..columns)
        .map(|i| {
            let squares = conditions
                .iter()
                .zip(&row_scales)
                .map(|(block, scale)| (block.sizes.column(i) / *scale).norm_squared());
            positive_or_one(squares.sum::<f64>().sqrt())
        })
        .collect();
    let rows: usize = conditions.iter().map(|block| block.values.nrows()).sum();
    let mut scaled = DMatrix::zeros(rows, columns);
    let mut first = 0;
    for (block, row_scale) in conditions.iter().zip(&row_scales) {
        for (j, column_scale) in column_scales.iter().enumerate() {
            let column = block.values.column(j) / (row_scale * column_scale);
            scaled.view_mut((first, j), (column.len(), 1)).copy_from(&column);
        }
        first += block.values.nrows();
    }

    // R of QR has the same singular values and null space, and is small.
    let svd = scaled.qr().r().svd(false, true);
    let singular_values: Vec<f64> = svd.singular_values.iter().copied().collect();
    let threshold = tolerance * (columns as f64).sqrt();
    let rank = singular_values.iter().filter(|value| **value > threshold).count();
    let decision = RankDecision { singular_values, threshold, rank };
    let mut basis: Vec<Vec<f64>> = svd
        .v_t
        .iter()
        .flat_map(|v_t| v_t.row_iter().skip(rank).map(|row| row.iter().copied().collect()))
        .collect();
    reduce(&mut basis, decision.uncertainty());
    for vector in &mut basis {
        let pivot = vector.iter().zip(&column_scales).find(|(entry, _)| **entry == 1.0);
        let unit = pivot.map_or(1.0, |(_, scale)| *scale);
        for (entry, scale) in vector.iter_mut().zip(&column_scales) {
            *entry *= unit / scale;
        }
    }
    (decision, basis)
}

/// Gauss–Jordan elimination with complete pivoting; entries within `uncertainty` of 0 become 0.
fn reduce(rows: &mut [Vec<f64>], uncertainty: f64) {
    let mut done = Vec::new();
    for k in 0..rows.len() {
        let candidates = (k..rows.len()).flat_map(|i| (0..rows[i].len()).map(move |j| (i, j)));
        let Some((i, j)) = candidates
            .filter(|(_, j)| !done.contains(j))
            .max_by(|a, b| rows[a.0][a.1].abs().total_cmp(&rows[b.0][b.1].abs()))
        else {
            return;
        };
        done.push(j);
        rows.swap(k, i);
        let pivot = rows[k][j];
        rows[k].iter_mut().for_each(|entry| *entry /= pivot);
        rows[k][j] = 1.0;
        let pivot_row = rows[k].clone();
        for (index, row) in rows.iter_mut().enumerate() {
            if index != k {
                let factor = row[j];
                row.iter_mut().zip(&pivot_row).for_each(|(entry, above)| *entry -= factor * above);
            }
        }
    }
    for entry in rows.iter_mut().flatten() {
        if entry.abs() <= uncertainty {
            *entry = 0.0;
        }
    }
}

fn positive_or_one(scale: f64) -> f64 {
    if scale > 0.0 { scale } else { 1.0 }
}
