//! The equation that is solved, as slices and behind pointers.

use super::vectors::{Room, subtract};
use crate::numbers::{Precision, Singular};

/// The equation p0(q, v, h) = p, for who knows neither how many coordinates it has nor in which form its
/// matrix is kept.
pub trait Evaluate<S> {
    /// p0(q, v, h). The present matrix is ∂p0/∂v there from then on; rows and columns of the coordinates
    /// `held` (those with an entry there that is not 0) are those of the unit matrix.
    fn kernel(&mut self, q: &[S], v: &[S], h: S, held: &[S], p0: &mut [S]);

    /// Keeps the present matrix as the one before.
    fn keep(&mut self);

    /// The solution of A x = `right` with the present matrix A.
    ///
    /// # Errors
    /// [`Singular`].
    fn solve(&self, right: &[S], x: &mut [S]) -> Result<(), Singular>;

    /// Σⱼ |Aᵢⱼ||vⱼ| for each i.
    fn magnitudes(&self, of: Matrix<'_, S>, v: &[S], sums: &mut [S]);

    /// |Aᵢᵢ| for each i.
    fn diagonal(&self, of: Matrix<'_, S>, entries: &mut [S]);

    /// Whether every entry of the row of the present matrix is a finite number.
    fn row_is_finite(&self, row: usize) -> bool;

    /// Both momenta at (q, v, h).
    fn momenta(&self, q: &[S], v: &[S], h: S, p0: &mut [S], p1: &mut [S]);

    /// The sizes of terms that cancel in p0.
    fn cancelling(&self, q: &[S], v: &[S], h: S, terms: &mut [S]);

    /// Adds what may hold a coordinate beside p, v and forces: beside it roundings are none.
    fn add_holding(&self, q: &[S], v: &[S], h: S, terms: &mut [S]) {
        let _ = (q, v, h, terms);
    }

    /// Writes what constraints at (q, v, h) leave of a correction, and whether there are any: a matrix beside
    /// the present one.
    fn along_constraints(&mut self, q: &[S], v: &[S], h: S, correction: &[S], along: &mut [S]) -> bool {
        let _ = (q, v, h, correction, along);
        false
    }

    /// Whether what p0 does not see holds at its root.
    fn is_held(&self, q: &[S], v: &[S], h: S) -> bool {
        let _ = (q, v, h);
        true
    }
}

/// A matrix of the equation.
#[derive(Clone, Copy)]
pub enum Matrix<'a, S> {
    /// ∂p0/∂v where it was evaluated last.
    Present,
    /// ∂p0/∂v as it was kept.
    Before,
    /// The mass matrix, the metric that tells which of two velocities is longer.
    Mass {
        /// The configuration.
        q: &'a [S],
        /// The velocity.
        v: &'a [S],
    },
}

/// The equation for v at the state (q, p).
pub struct Equations<'e, S> {
    pub(crate) evaluate: &'e mut dyn Evaluate<S>,
    pub(crate) q: &'e [S],
    pub(crate) p: &'e [S],
    /// v times this and a share leads from q to the configurations on the way.
    pub(crate) h: S,
    /// Velocities next to rest of the coordinates that are held at rest, 0 for the others: the equations of
    /// those are solved alone.
    pub(crate) held: &'e [S],
}

/// Where a solution is written to; `v` is where the search for it starts.
pub struct Root<'r, S> {
    pub(crate) v: &'r mut [S],
    pub(crate) p0: &'r mut [S],
    pub(crate) p1: &'r mut [S],
}

/// How a solution was found.
#[derive(Clone, Copy)]
pub struct Solved<S> {
    pub(crate) iterations: u32,
    pub(crate) damped: u32,
    pub(crate) residual: S,
    pub(crate) floor: S,
    pub(crate) last_correction: S,
}

/// Why there is no solution.
#[derive(Clone, Copy)]
pub enum Unsolved<S> {
    /// A derivative is no finite number.
    NonFinite { index: usize },
    /// The matrix is singular.
    Singular { iteration: u32, column: usize },
    /// No shorter step lowers the residual.
    NoRoot { iteration: u32, residual: S },
    /// Rounding leaves no digit.
    LostPrecision { residual: S, floor: S },
    /// Iterations have run out.
    NotConverged { iterations: u32, residual: S, floor: S },
}

/// The way to a solution.
#[derive(Clone, Copy)]
pub enum Way<'a, S> {
    /// By the damped method, after so many iterations.
    Damped { iterations: u32 },
    /// From rest or away from it, after an error.
    FromRest { error: Unsolved<S> },
    /// By the damped method after so many iterations; where that fails, from rest, and in parts of h from the
    /// velocity `start`.
    Every { iterations: u32, start: &'a [S] },
}

impl<S: Precision> Equations<'_, S> {
    /// The equation with another h, or with coordinates held.
    pub(super) fn with<'a>(&'a mut self, h: S, held: &'a [S]) -> Equations<'a, S> {
        Equations { evaluate: self.evaluate, q: self.q, p: self.p, h, held }
    }

    /// p0 − p, and the present matrix.
    #[inline(never)]
    pub(super) fn evaluate(&mut self, v: &[S], residual: &mut [S]) {
        self.evaluate.kernel(self.q, v, self.h, self.held, residual);
        subtract(residual, self.p);
        for (residual, held) in residual.iter_mut().zip(self.held) {
            if *held != S::zero() {
                *residual = S::zero();
            }
        }
    }

    /// p0 − p by the momenta, with no coordinate held.
    pub(super) fn residual(&self, v: &[S], residual: &mut [S], p1: &mut [S]) {
        self.evaluate.momenta(self.q, v, self.h, residual, p1);
        subtract(residual, self.p);
    }

    /// Both momenta at a configuration of its own.
    pub(super) fn momenta(&self, q: &[S], v: &[S], p0: &mut [S], p1: &mut [S], room: Room<'_, S>) {
        self.evaluate.momenta(q, v, self.h, p0, p1);
        if self.held.iter().any(|held| *held != S::zero()) {
            self.hold_momenta(v, p0, p1, room);
        }
    }

    /// The momenta of the coordinates that are held: p, and what it changes to.
    #[cold]
    #[inline(never)]
    fn hold_momenta(&self, v: &[S], p0: &mut [S], p1: &mut [S], mut room: Room<'_, S>) {
        let [moved, change] = room.vectors();
        self.change_at_rest(v, self.held, moved, change, room);
        let entries = p0.iter_mut().zip(p1).zip(self.p).zip(change.iter()).zip(self.held);
        for ((((p0, p1), p), change), held) in entries {
            if *held != S::zero() {
                (*p0, *p1) = (*p, *p + *change);
            }
        }
    }

    /// p0 of [`momenta`](Self::momenta).
    #[inline(never)]
    pub(super) fn p0(&self, q: &[S], v: &[S], p0: &mut [S], mut room: Room<'_, S>) {
        let p1 = room.vector();
        self.momenta(q, v, p0, p1, room);
    }

    /// p1 − p0 where some coordinates of `v` are next to rest, as the mean of both sides: what is odd in
    /// their velocities vanishes.
    #[cold]
    #[inline(never)]
    pub(super) fn change_at_rest(
        &self,
        v: &[S],
        near: &[S],
        moved: &mut [S],
        change: &mut [S],
        mut room: Room<'_, S>,
    ) {
        let half = S::nearest(0.5);
        let [p0, p1] = room.vectors();
        change.fill(S::zero());
        for sign in [S::one(), -S::one()] {
            for ((moved, v), near) in moved.iter_mut().zip(v).zip(near) {
                *moved = if *near == S::zero() { *v } else { *near * sign };
            }
            self.evaluate.momenta(self.q, moved, self.h, p0, p1);
            for ((change, p0), p1) in change.iter_mut().zip(p0.iter()).zip(p1.iter()) {
                *change += (*p1 - *p0) * half;
            }
        }
    }

    /// The first coordinate whose residual or row of the present matrix is not finite.
    #[cold]
    #[inline(never)]
    pub(super) fn first_non_finite(&self, residual: &[S]) -> Option<usize> {
        let mut entries = residual.iter().enumerate();
        entries.find(|(i, entry)| !entry.is_finite() || !self.evaluate.row_is_finite(*i)).map(|(i, _)| i)
    }
}

/// An equation for tests of what asks it for values alone: p0, and p0 as the kernel has it, by (q, v).
#[cfg(test)]
pub(super) struct Values<P, K> {
    pub(super) momentum: P,
    pub(super) kernel: K,
}

#[cfg(test)]
impl<P: Fn(&[f64], &[f64], &mut [f64]), K: Fn(&[f64], &[f64], &mut [f64])> Evaluate<f64> for Values<P, K> {
    fn momenta(&self, q: &[f64], v: &[f64], _: f64, p0: &mut [f64], _: &mut [f64]) {
        (self.momentum)(q, v, p0);
    }
    fn kernel(&mut self, q: &[f64], v: &[f64], _: f64, _: &[f64], p0: &mut [f64]) {
        (self.kernel)(q, v, p0);
    }
    fn keep(&mut self) {}
    fn solve(&self, _: &[f64], _: &mut [f64]) -> Result<(), Singular> {
        Err(Singular { column: 0 })
    }
    fn magnitudes(&self, _: Matrix<'_, f64>, _: &[f64], _: &mut [f64]) {}
    fn diagonal(&self, _: Matrix<'_, f64>, _: &mut [f64]) {}
    fn row_is_finite(&self, _: usize) -> bool {
        true
    }
    fn cancelling(&self, _: &[f64], _: &[f64], _: f64, _: &mut [f64]) {}
}
