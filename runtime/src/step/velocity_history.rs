//! The latest velocities of a run, and the guess that they make.

use nalgebra::SVector;

use crate::numbers::{Scalar, dot};
use crate::step::{Flow, Memory, State, Step, StepError, or_without_guess};

/// The latest four mean velocities: the next, extrapolated to order 3, is the guess for Newton's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityHistory<S, const N: usize> {
    /// Newest first.
    velocities: [SVector<S, N>; 4],
    known: usize,
    /// The step size that they belong to.
    h: S,
    /// Whether the input changes from step to step: velocities are then less smooth than the motion.
    has_inputs: bool,
}

impl<S: Scalar, const N: usize> Default for VelocityHistory<S, N> {
    fn default() -> Self {
        Self { velocities: [nalgebra::zero(); 4], known: 0, h: S::zero(), has_inputs: false }
    }
}

impl<S: Scalar, const N: usize> VelocityHistory<S, N> {
    /// The newest `known` of these, of steps of one size.
    pub(crate) fn of(velocities: [SVector<S, N>; 4], known: usize, h: S) -> Self {
        Self { velocities, known, h, has_inputs: false }
    }

    /// The latest velocities, and how many of them are known.
    pub(crate) fn velocities(&self) -> (&[SVector<S, N>; 4], usize) {
        (&self.velocities, self.known)
    }

    #[inline]
    pub(crate) fn push(&mut self, velocity: SVector<S, N>, h: S) {
        let [a, b, c, _] = self.velocities;
        if h == self.h {
            self.velocities = [velocity, a, b, c];
            self.known = (self.known + 1).min(4);
            return;
        }
        // Velocities a step apart are known for one step size alone: on the line through the two, one step
        // back.
        let is_ahead = self.known > 0 && h * self.h > S::zero();
        let before = if is_ahead { velocity + (a - velocity) * (h / half_of(h + self.h)) } else { velocity };
        self.velocities = [velocity, before, b, c];
        self.known = if is_ahead { 2 } else { 1 };
        self.h = h;
    }

    /// The polynomial through the known velocities, one step on.
    #[inline]
    pub(crate) fn extrapolation(&self, h: S) -> Option<SVector<S, N>> {
        let [a, b, c, d] = &self.velocities;
        let (two, three, four, six) =
            (S::constant(2.0), S::constant(3.0), S::constant(4.0), S::constant(6.0));
        if h != self.h {
            // The polynomial needs equal steps; the line serves for one that is not much longer.
            let is_near = h * self.h > S::zero() && h.widen().abs() <= 2.0 * self.h.widen().abs();
            return match self.known {
                0 => None,
                2.. if is_near && !self.has_inputs => Some(a + (a - b) * (half_of(h + self.h) / self.h)),
                _ => Some(*a),
            };
        }
        let known = self.known;
        match if self.has_inputs { self.telling(known) } else { known } {
            0 => None,
            1 => Some(*a),
            2 => Some(a * two - b),
            3 => Some((a - b) * three + c),
            _ => Some((a + c) * four - b * six - d),
        }
    }

    /// Of the `known` velocities those by whose polynomial, a step back, the newest would have been told
    /// best: inputs that jump are carried on by none, and enlarged by a cubic 10 times.
    fn telling(&self, known: usize) -> usize {
        let [a, b, c, d] = &self.velocities;
        let mut best = (known.min(1), a - b);
        let mut consider = |count: usize, error: SVector<S, N>| {
            if count < known && dot(&error, &error) < dot(&best.1, &best.1) {
                best = (count, error);
            }
        };
        consider(2, a - b * S::constant(2.0) + c);
        consider(3, a - (b - c) * S::constant(3.0) - d);
        best.0
    }
}

fn half_of<S: Scalar>(value: S) -> S {
    value * S::constant(0.5)
}

impl<L, R, const N: usize> Memory<L, R, N> for VelocityHistory<L::Scalar, N>
where
    L: Flow<R, N> + ?Sized,
{
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let guess = self.extrapolation(h);
        let found = system.step(state, h, guess.as_ref());
        let step = or_without_guess(guess.is_some(), found, || system.step(state, h, None));
        if let Ok(step) = &step {
            self.push(step.velocity, h);
        }
        step
    }

    fn suggest(&mut self, velocity: &SVector<L::Scalar, N>, h: L::Scalar) {
        self.push(*velocity, h);
    }

    /// Keeps the velocities, which are but a guess, of any input.
    fn change_input(&mut self) {
        self.has_inputs = true;
    }

    /// Keeps the history: it holds velocities and no state.
    fn change_state(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean velocities of q = t²/2 are those of the middles of steps, on a line; of q = t³/3 they are not.
    #[test]
    fn a_line_is_carried_on_over_changes_of_the_step_size() {
        let mut history = VelocityHistory::<f64, 1>::default();
        let (mut time, mut off) = (0.0, 0.0_f64);
        for (index, h) in [0.25, 0.25, 0.5, 0.5, 0.5, 0.125, 0.125, 0.25, 0.1875].into_iter().enumerate() {
            let mean = time + 0.5 * h;
            if index > 1 {
                let guess = history.extrapolation(h).unwrap();
                assert!((guess[0] - mean).abs() < 1e-14, "{index}: {} for {mean}", guess[0]);
                off = off.max((history.velocities[0][0] - mean).abs());
            }
            history.push([mean].into(), h);
            time += h;
        }
        // Positive control: the newest velocity alone is no line.
        assert!(off > 0.1);
        // Backwards, or far ahead, it is the guess.
        assert_eq!(history.extrapolation(-0.1875), Some(history.velocities[0]));
        assert_eq!(history.extrapolation(3.0), Some(history.velocities[0]));
    }
}
