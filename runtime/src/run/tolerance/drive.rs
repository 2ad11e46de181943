//! How fast the derivative J of the motion changes with time where the system does: a parametric drive.

use super::variation::Variation;
use crate::numbers::Scalar;
use crate::step::PhaseMatrix;

/// When a system that takes the time is looked at before its run, as shares of that: at the start a drive may
/// do nothing yet. No common fraction of a period.
pub(super) const DRIVES: [f64; 5] = [0.013, 0.17, 0.41, 0.67, 0.89];

/// The share of its largest changes so far that still counts after a look.
const REMEMBERED: f64 = 0.9;

/// J as it changes along a run.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Drive<S: Scalar, const N: usize> {
    /// J where the run starts.
    start: PhaseMatrix<S, N>,
    /// The largest ∂q̇/∂p, ∂ṗ/∂q, and of the others.
    largest: [S; 3],
    /// The largest share of these by which J has differed from that at the start.
    range: f64,
    /// The largest share by which it has changed in a unit of time.
    pace: f64,
}

impl<S: Scalar, const N: usize> Drive<S, N> {
    pub(super) fn from(start: &Variation<S, N>) -> Self {
        let mut drive = Self { start: start.matrix, largest: [S::zero(); 3], range: 0.0, pace: 0.0 };
        drive.reach(start);
        drive
    }

    /// Takes in J at two states, the time `t` apart.
    pub(super) fn follow(&mut self, [from, to]: [&Variation<S, N>; 2], t: f64) {
        self.reach(to);
        self.pace = self.pace.max(self.change(&from.matrix, &to.matrix) / t);
    }

    fn reach(&mut self, at: &Variation<S, N>) {
        // An entry of the diagonal blocks is a rate as the motion's own.
        let sizes = [at.matrix.q_by_p.norm(), at.matrix.p_by_q.norm(), at.fastest];
        for (largest, size) in self.largest.iter_mut().zip(sizes) {
            *largest = largest.max(size);
        }
        self.range = self.range.max(self.change(&self.start, &at.matrix));
    }

    /// The rate at which J turns, once it has been seen to turn: of J₀ + A cos ωt from ω to 2ω.
    pub(super) fn rate(&self) -> f64 {
        if self.range > 0.0 { 2.0 * self.pace / self.range } else { 0.0 }
    }

    /// Lets earlier changes count less from here on.
    pub(super) fn forget(&mut self) {
        self.pace *= REMEMBERED;
    }

    /// The share of J by which `b` differs from `a`.
    fn change(&self, a: &PhaseMatrix<S, N>, b: &PhaseMatrix<S, N>) -> f64 {
        let of = [
            (a.q_by_p - b.q_by_p).norm(),
            (a.p_by_q - b.p_by_q).norm(),
            (a.q_by_q - b.q_by_q).norm().max((a.p_by_p - b.p_by_p).norm()),
        ];
        let shares = of
            .into_iter()
            .zip(self.largest)
            .map(|(of, largest)| if of > S::zero() { (of / largest).widen() } else { 0.0 });
        shares.fold(0.0, f64::max)
    }
}
