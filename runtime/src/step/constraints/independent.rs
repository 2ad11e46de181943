//! The Schur complement S = G(q1) W⁻¹ G(q0)ᵀ in triangles, where it has lost half of its digits.
//!
//! S has the squares of what is left of one gradient beside the others: of a share of 10⁻⁸ nothing in double
//! precision. Here what is left are vectors, at first xₖ of G(q0)ᵀ, aₖ = W⁻¹xₖ and yₖ of G(q1):
//!
//! ```text
//! aₗ ← aₗ − aₖ (yₖ·aₗ)/dₖ        yₗ ← yₗ − yₖ (yₗ·aₖ)/dₖ        dₖ = yₖ·aₖ
//! ```
//!
//! and xₗ as aₗ, so that yₖ·aₗ = 0 for k ≠ l. The pivots dₖ, the largest first, are those of elimination, but
//! rounded beside the length of what is left and not beside the whole gradients. A constraint of whose xₗ
//! rounding alone is left is redundant.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Scalar, linear::dot};

/// Roundings of a gradient that others leave of one that depends on them: a state on the constraints may be
/// off by as many.
const DEPENDENT: f64 = 1024.0;

/// Roundings of the terms of a pivot of which no digit is left.
const LOST: f64 = 16.0;

/// A share of a pivot that is little: of the gradients a tenth or less is left.
const LITTLE: f64 = 0.01;

/// M constraints of which some may be redundant, ready to solve S κ = b with: κ = Σₖ hₖ (eₖ·b) over those
/// that are not, where yₖ = Σₗ eₖₗ Gₗ(q1), xₖ = dₖ Σₗ hₖₗ Gₗ(q0). Σₗ |Sₗₗ| κₗ² is least, and where b
/// contradicts itself Σₗ (S κ − b)ₗ²/|Sₗₗ|: a constraint that is left out would have all of the
/// contradiction, and be off by many roundings, or on another branch of the others.
#[derive(Clone, Copy, Debug)]
pub(in crate::step) struct Independent<S: Scalar, const M: usize> {
    /// eₖ by columns, 0 of a redundant constraint.
    of_rows: SMatrix<S, M, M>,
    /// hₖ by columns.
    of_directions: SMatrix<S, M, M>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Open,
    Taken,
    Redundant,
}

/// A constraint, as far as those taken before leave something of it.
#[derive(Clone, Copy)]
struct Left<S: Scalar, const N: usize, const M: usize> {
    kind: Kind,
    a: SVector<S, N>,
    y: SVector<S, N>,
    /// y·a, and |y·a| of the whole gradients.
    pivot: S,
    weight: S,
    /// y and x as sums of the gradients.
    of_rows: SVector<S, M>,
    of_directions: SVector<S, M>,
}

impl<S: Scalar, const N: usize, const M: usize> Left<S, N, M> {
    fn whole(k: usize, a: SVector<S, N>, y: SVector<S, N>) -> Self {
        let mut unit: SVector<S, M> = nalgebra::zero();
        if let Some(entry) = unit.as_mut_slice().get_mut(k) {
            *entry = S::one();
        }
        let pivot = dot(&y, &a);
        let weight = if pivot == S::zero() { S::one() } else { pivot.abs() };
        Self { kind: Kind::Open, a, y, pivot, weight, of_rows: unit, of_directions: unit }
    }

    /// The pivot beside that of the whole gradients.
    fn share(&self) -> S {
        self.pivot.abs() / self.weight
    }

    /// Whether more than rounding is left of G(q0), in the metric of W.
    fn is_independent(
        &self,
        directions: &SMatrix<S, N, M>,
        whole: &SVector<S, N>,
        a: &SVector<S, N>,
    ) -> bool {
        let x = directions * self.of_directions;
        let least = S::EPSILON * S::constant(DEPENDENT);
        dot(&x, &self.a).abs() > dot(whole, a).abs() * least * least
    }

    /// The pivot; nothing if rounding has taken every digit.
    fn regular(&self) -> Option<S> {
        let terms = dot(&self.y.abs(), &self.a.abs());
        (self.pivot.abs() > terms * (S::EPSILON * S::constant(LOST))).then_some(self.pivot)
    }

    /// Takes off the share of one that is taken, and once more where little is left: the first time rounds
    /// beside what was there.
    fn take_off(&mut self, taken: &Self) {
        for _ in 0..2 {
            let share = dot(&taken.y, &self.a) / taken.pivot;
            self.a -= taken.a * share;
            self.of_directions -= taken.of_directions * share;
            let share = dot(&self.y, &taken.a) / taken.pivot;
            self.y -= taken.y * share;
            self.of_rows -= taken.of_rows * share;
            let before = self.pivot.abs();
            self.pivot = dot(&self.y, &self.a);
            if self.pivot.abs() > before * S::constant(LITTLE) {
                break;
            }
        }
    }
}

impl<S: Scalar, const M: usize> Independent<S, M> {
    /// Of G(q1), G(q0)ᵀ and W⁻¹G(q0)ᵀ; nothing if S is singular beyond redundancy, or an entry is not finite.
    #[cold]
    #[inline(never)]
    pub(in crate::step) fn of<const N: usize>(
        rows: &SMatrix<S, M, N>,
        directions: &SMatrix<S, N, M>,
        answers: &SMatrix<S, N, M>,
    ) -> Option<Self> {
        let rows = rows.transpose();
        let mut all = [Left::<S, N, M>::whole(0, nalgebra::zero(), nalgebra::zero()); M];
        for (k, (left, (a, y))) in all.iter_mut().zip(answers.data.0.iter().zip(&rows.data.0)).enumerate() {
            *left = Left::whole(k, SVector::from(*a), SVector::from(*y));
        }
        if !all.iter().all(|left| left.pivot.is_finite()) {
            return None;
        }
        for _ in 0..M {
            let whole = directions.data.0.iter().zip(&answers.data.0);
            let mut next: Option<(S, usize)> = None;
            for (k, (left, (x, a))) in all.iter_mut().zip(whole).enumerate() {
                let share = left.share();
                if left.kind != Kind::Open {
                    continue;
                }
                if share < S::constant(LITTLE)
                    && !left.is_independent(directions, &SVector::from(*x), &SVector::from(*a))
                {
                    left.kind = Kind::Redundant;
                } else if next.is_none_or(|(largest, _)| share > largest) {
                    next = Some((share, k));
                }
            }
            let Some((_, k)) = next else { break };
            let taken = all.get_mut(k)?;
            taken.kind = Kind::Taken;
            taken.pivot = taken.regular()?;
            let taken = *taken;
            let open = all.iter_mut().filter(|left| left.kind == Kind::Open);
            open.for_each(|left| left.take_off(&taken));
        }
        Some(Self::of_least_norm(&all))
    }

    /// κ without what the redundant constraints add to it without a reaction, and b without what no reaction
    /// moves.
    fn of_least_norm<const N: usize>(all: &[Left<S, N, M>; M]) -> Self {
        let of_rows = apart_from_redundant(all, |left| &left.of_rows);
        let mut of_directions = apart_from_redundant(all, |left| &left.of_directions);
        for (left, column) in all.iter().zip(&mut of_directions.data.0) {
            if left.kind == Kind::Taken {
                [*column] = (SVector::from(*column) / left.pivot).data.0;
            }
        }
        Self { of_rows, of_directions }
    }

    /// The solution of S κ = `right`.
    pub(in crate::step) fn solve(&self, right: &SVector<S, M>) -> SVector<S, M> {
        let mut kappa: SVector<S, M> = nalgebra::zero();
        for (of_rows, of_directions) in self.of_rows.data.0.iter().zip(&self.of_directions.data.0) {
            kappa += SVector::from(*of_directions) * dot(&SVector::from(*of_rows), right);
        }
        kappa
    }
}

/// The combinations of those taken, each with what is at right angles to those of the redundant ones, in
/// which S is 0; lengths are those of √|Sₖₖ| times the entries.
fn apart_from_redundant<S: Scalar, const N: usize, const M: usize>(
    all: &[Left<S, N, M>; M],
    of: fn(&Left<S, N, M>) -> &SVector<S, M>,
) -> SMatrix<S, M, M> {
    let mut scales: SVector<S, M> = nalgebra::zero();
    scales.as_mut_slice().iter_mut().zip(all).for_each(|(scale, left)| *scale = left.weight.sqrt());
    // Those of the redundant ones, of length 1 and at right angles to one another.
    let mut without: SMatrix<S, M, M> = nalgebra::zero();
    let at_right_angles = |left: &Left<S, N, M>, without: &SMatrix<S, M, M>| {
        let mut to = of(left).component_mul(&scales);
        for (column, left) in without.data.0.iter().zip(all) {
            if left.kind == Kind::Redundant {
                let column = SVector::from(*column);
                to -= column * dot(&column, &to);
            }
        }
        to
    };
    for (k, left) in all.iter().enumerate().filter(|(_, left)| left.kind == Kind::Redundant) {
        let found = at_right_angles(left, &without);
        if let Some(column) = without.data.0.get_mut(k) {
            [*column] = (found / dot(&found, &found).sqrt()).data.0;
        }
    }
    let mut combinations: SMatrix<S, M, M> = nalgebra::zero();
    for (left, column) in all.iter().zip(&mut combinations.data.0) {
        if left.kind == Kind::Taken {
            [*column] = at_right_angles(left, &without).component_div(&scales).data.0;
        }
    }
    combinations
}
