//! When a step is solved: the one definition, for every rule, memory and solver.
//!
//! **Definition.** A step is solved where each component of the residual of its equation is at most
//! [`AT_FLOOR`] times its round-off floor, and this floor
//!
//! 1. belongs to the solution that is returned, not to an iterate on the way or to an earlier step: where in
//!    a coordinate the last correction was not small beside v̄ ([`SMALL`](super::SMALL)), or the matrix is
//!    one kept, the matrix is evaluated again at the solution, unless the residual is small beside p
//!    ([`is_small_beside`]), which is a term of the equation whatever the matrix is;
//! 2. is finite;
//! 3. where the residual had stopped falling, or Newton steps had to be shortened: is at most
//!    a thousandth of the terms that the equation is made of ([`is_sensible`](super::is_sensible)). Otherwise
//!    rounding would explain any residual.
//!
//! Then the solution satisfies exactly the equation with q, v̄ and p changed by some units of their last
//! places. Each component has a floor of its own,
//!
//! ```text
//! floorᵢ = 4ε (|pᵢ| + Σⱼ |Jᵢⱼ||vⱼ|)                          one-stage rules, J = ∂p0/∂v̄
//! floorᵢ = 4ε (|pᵢ| + |h| max |Gᵢ| + max Σⱼ |Mᵢⱼ||Vⱼ|)        Gauss rules, the largest of all stages
//! ```
//!
//! so that neither the unit of a coordinate nor its neighbours' size matters. These estimates know nothing of
//! what q contributes: near an equilibrium away from q = 0 large forces cancel, and v and p go to 0 while the
//! rounding of those forces stays. Where the residual stops falling above the estimate, its rounding is
//! therefore measured: by what the last places of q and v change (`add_rounding`), and, where that does not
//! explain it, by how it scatters (`add_scatter`). The latter sees each configuration on the way rounded on
//! its own: far from q = 0, say after 10³ turns of an angle, q0 and q1 are known to ε|q|, and where what
//! their errors do cancels if both are moved together, as under the trapezoidal rule, moving q shows nothing
//! of it.
//!
//! Where forces cancel at q = 0, as (q − 1) + (q + 1) do, no place of q shows their rounding. The sizes of
//! such terms of the equation of motion ([`cancelling_terms`](crate::system::ActingForce::cancelling_terms))
//! are written out, or carried by dual numbers with the derivatives; each rule weighs them as its equation
//! does, and they count before anything is measured: ε times them is floor, and they are terms of the
//! equation.
//!
//! By hand, and beyond that, the equation itself says how it rounds: with `std`, by its noise
//! (`numbers/nonlinear/noise.rs`), to which the third condition does not apply, since at rest the noise is
//! all that there is; and by what the momenta and the kernel of a step differ by (`twice.rs`).
//!
//! `tests/examples/verdicts` holds every rule against this definition in twice the precision.

use nalgebra::SVector;

use crate::numbers::{
    NewtonMatrix, Scalar,
    nonlinear::{AT_FLOOR, held, held_one_by_one},
};

/// The floor that the terms of p0 give, 4ε (|pᵢ| + Σⱼ |Jᵢⱼ||vⱼ|).
#[inline]
pub(crate) fn estimated_floor<S: Scalar, const N: usize>(
    p: &SVector<S, N>,
    matrix: &impl NewtonMatrix<S, N>,
    v: &SVector<S, N>,
) -> SVector<S, N> {
    // Scaled before they are added up, so that only what overflows itself does.
    let unit = S::EPSILON * S::constant(4.0);
    let mut floor = matrix.magnitudes(&(v * unit));
    for i in 0..N {
        // Below the normal numbers ε no longer bounds the rounding.
        floor[i] += p[i].abs() * unit + S::SMALLEST_NORMAL;
    }
    floor
}

/// Whether the residual is within [`AT_FLOOR`] floors in every coordinate whatever the matrix is there: the
/// terms of p0 add up to p at a root, so that each floor is at least 8ε |pᵢ|.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn is_small_beside<S: Scalar, const N: usize>(
    residual: &SVector<S, N>,
    p: &SVector<S, N>,
) -> bool {
    let unit = S::EPSILON * S::constant(8.0 * AT_FLOOR);
    let mut is_small = true;
    for i in 0..N {
        is_small &= residual[i].abs() <= p[i].abs() * unit;
    }
    is_small
}

/// The residual that is largest in units of its floor, this floor, and whether it is a root's: at most
/// [`AT_FLOOR`] of them.
#[inline]
pub(crate) fn held_against<S: Scalar, const N: usize>(
    residual: &SVector<S, N>,
    floor: &SVector<S, N>,
) -> (S, S, bool) {
    const LANES: usize = 4;
    // One of the residuals from the start: products with one that is tiny, or with a floor that overflows,
    // decide nothing.
    let first = (residual[0].abs(), floor[0], true);
    if N < 2 * LANES {
        return held_one_by_one(residual.as_slice(), floor.as_slice(), first);
    }
    // Lane by lane, so that few comparisons wait for one another.
    let mut worst = [first; LANES];
    let (residuals, other_residuals) = residual.as_slice().as_chunks::<LANES>();
    let (floors, other_floors) = floor.as_slice().as_chunks::<LANES>();
    for (residuals, floors) in residuals.iter().zip(floors) {
        for lane in 0..LANES {
            worst[lane] = held(residuals[lane], floors[lane], worst[lane]);
        }
    }
    let [a, b, c, d] = worst;
    let rest = held_one_by_one(other_residuals, other_floors, a);
    let larger = |a: (S, S, bool), b: (S, S, bool)| {
        let (size, floor) = if b.0 * a.1 > a.0 * b.1 { (b.0, b.1) } else { (a.0, a.1) };
        (size, floor, a.2 & b.2)
    };
    larger(larger(rest, b), larger(c, d))
}

/// The residual and floor of [`held_against`] at a root, in a third of its operations, where the `size`,
/// [`weighted`](super::weighted) by `weights` = 1/`floor`, is known; `None` where it is no root, or where the
/// rounding of the weights would decide. No floor may overflow.
#[inline]
pub(crate) fn held_by_weights<S: Scalar, const N: usize>(
    residual: &SVector<S, N>,
    floor: &SVector<S, N>,
    weights: &SVector<S, N>,
    size: S,
) -> Option<(S, S)> {
    // Weight and product are rounded once each.
    let is_below = size <= S::constant(AT_FLOOR) * (S::one() - S::EPSILON * S::constant(2.0));
    if !is_below {
        return None;
    }
    let worst = (0..N).find(|&i| residual[i].abs() * weights[i] == size)?;
    Some((residual[worst].abs(), floor[worst]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{matrix, vector};

    #[test]
    fn floors_neither_vanish_nor_overflow() {
        let floor = |p: f64| estimated_floor(&vector![p], &matrix![1.0], &vector![p])[0];
        assert_eq!(floor(1.0), 8.0 * f64::EPSILON + f64::MIN_POSITIVE);
        assert!(floor(1e308) < 1e294 && floor(1e-320) == f64::MIN_POSITIVE);
    }

    /// A residual that needs no matrix is below four floors by every matrix whose terms add up to p.
    #[test]
    fn what_is_small_beside_p_is_a_root_by_every_matrix() {
        let p = vector![1.0, -1e-9];
        for part in [0.0, 0.5, 1.0, 1.0 + 1e-9, 2.0] {
            let residual = p * (part * 32.0 * f64::EPSILON);
            assert_eq!(is_small_beside(&residual, &p), part <= 1.0, "{part}");
            let floor = estimated_floor(&p, &matrix![1.0, 0.0; 0.0, 1.0], &p);
            assert!(!is_small_beside(&residual, &p) || held_against(&residual, &floor).2);
        }
        // In each coordinate, and only of numbers.
        assert!(!is_small_beside(&vector![0.0, 1e-20], &p));
        assert!(!is_small_beside(&vector![0.0, f64::NAN], &p));
        assert!(is_small_beside(&vector![0.0, 0.0], &vector![1.0, 0.0]));
    }

    #[test]
    fn a_residual_that_overflows_is_no_root() {
        let overflowed = vector![0.0, f64::INFINITY];
        assert!(!held_against(&overflowed, &vector![1.0, f64::INFINITY]).2);
        // Beside a finite floor that is larger, a large residual is that of a root.
        assert!(held_against(&vector![0.0, 1e300], &vector![1.0, 1e300]).2);
    }

    #[test]
    fn a_floor_that_overflows_explains_no_residual() {
        for residual in [0.0, 1.0, 1e300] {
            assert!(!held_against(&vector![0.0, residual], &vector![1.0, f64::INFINITY]).2);
            assert!(!held_against(&vector![0.0, residual], &vector![1.0, f64::NAN]).2);
        }
        let nine = SVector::<f64, 9>::from_fn(|i, _| if i == 6 { f64::INFINITY } else { 1.0 });
        assert!(!held_against(&SVector::<f64, 9>::repeat(1e-3), &nine).2);
    }

    /// By its weight as by its floor: what one calls a root, the other does, but for the last places of a
    /// residual of four floors.
    #[test]
    fn weights_say_of_a_residual_what_floors_do() {
        let by_weights = |residual: [f64; 5], floor: [f64; 5]| {
            let (residual, floor) = (SVector::from(residual), SVector::from(floor));
            let weights = floor.map(|floor: f64| 1.0 / floor);
            let (worst, of, is_root) = held_against(&residual, &floor);
            let size = crate::step::newton::weighted(&residual, &weights);
            let found = held_by_weights(&residual, &floor, &weights, size);
            assert!(found.is_none() || is_root);
            assert!(found.is_none_or(|found| found == (worst, of)));
            (found.is_some(), is_root)
        };
        let floor = [0.1, 0.7, 3.0, 1e-9, 1e200];
        for i in 0..5 {
            for (floors, expected) in [(3.999, true), (4.0 - 1e-14, true), (4.0 + 1e-14, false), (1e3, false)]
            {
                let mut residual = floor.map(|floor| -floor);
                residual[i] = floors * floor[i];
                assert_eq!(by_weights(residual, floor), (expected, expected), "{i}, {floors}");
            }
            let mut residual = [0.0; 5];
            residual[i] = f64::NAN;
            assert_eq!(by_weights(residual, floor), (false, false));
        }
    }

    #[test]
    fn the_residual_told_is_one_of_them() {
        // Products underflow, or are no numbers.
        assert_eq!(
            held_against(&vector![-1e-309], &vector![f64::MIN_POSITIVE]),
            (1e-309, f64::MIN_POSITIVE, true)
        );
        assert_eq!(held_against(&vector![1e284], &vector![f64::INFINITY]), (1e284, f64::INFINITY, false));
        let nine = SVector::<f64, 9>::from_fn(|i, _| if i == 6 { 3.0 } else { 1e-320 });
        assert_eq!(held_against(&nine, &SVector::repeat(1.0)), (3.0, 1.0, true));
    }
}
