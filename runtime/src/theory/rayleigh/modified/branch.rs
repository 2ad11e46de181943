//! Which logarithm of a step matrix: the one that the step size leads to from 0.

use nalgebra::{Complex, DVector};

use crate::theory::rayleigh::modified::ModifiedLinearSystemError;

/// Where the rates are read off: far below any angle of interest, far above the rounding of A.
const FIRST: f64 = 1.0 / (1 << 20) as f64;

/// Angle between the steps at which eigenvalues are looked at.
const ANGLE: f64 = 0.25;

/// Step sizes looked at, at least and at most.
const FEWEST: f64 = 16.0;
const MOST: f64 = 4096.0;

/// Fails where an eigenvalue of the step with size sh has met the negative real axis on the way from s = 0 to
/// s = 1: the logarithm that began at hX has then an imaginary part beyond ±π, and the principal one is
/// another branch. `eigenvalues` are those of the step of size sh.
///
/// The logarithms of eigenvalues are followed by linear extrapolation, through the axis.
pub(super) fn require_principal(
    eigenvalues: impl Fn(f64) -> Result<DVector<Complex<f64>>, ModifiedLinearSystemError>,
) -> Result<(), ModifiedLinearSystemError> {
    use core::f64::consts::{PI, TAU};
    let mut change = eigenvalues(FIRST)?.map(|value| value.ln() / FIRST);
    let fastest = change.iter().fold(0.0_f64, |most, rate| most.max(rate.im.abs()));
    let count = (fastest / ANGLE).ceil().max(FEWEST);
    if count.is_nan() || count > MOST {
        return Err(ModifiedLinearSystemError::AnotherBranch { angle: fastest });
    }
    change /= Complex::from(count);
    let mut followed = change.map(|_| Complex::new(0.0, 0.0));
    for k in 1..=count as u32 {
        let found = eigenvalues(f64::from(k) / count)?.map(Complex::ln);
        let expected = &followed + &change;
        let mut pairs: Vec<_> = (0..found.len())
            .flat_map(|i| (0..found.len()).map(move |j| (i, j)))
            .map(|(i, j)| {
                let turns = ((expected[i].im - found[j].im) / TAU).round();
                let candidate = found[j] + Complex::new(0.0, TAU * turns);
                ((candidate - expected[i]).norm(), i, j, candidate)
            })
            .collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut next = followed.clone();
        let (mut is_placed, mut is_taken) = (vec![false; found.len()], vec![false; found.len()]);
        for (_, i, j, candidate) in pairs {
            if !is_placed[i] && !is_taken[j] {
                (is_placed[i], is_taken[j], next[i]) = (true, true, candidate);
            }
        }
        change = &next - &followed;
        followed = next;
    }
    match followed.iter().map(|value| value.im.abs()).fold(0.0, f64::max) {
        angle if angle > PI => Err(ModifiedLinearSystemError::AnotherBranch { angle }),
        _ => Ok(()),
    }
}
