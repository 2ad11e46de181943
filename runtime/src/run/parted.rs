//! Steps in parts, where they cannot be taken at once.

use crate::numbers::Scalar;
use crate::run::{Checkpoint, Course, DrivenTrajectory, Trajectory};
use crate::step::{Flow, Memory, Step, StepError};

/// A step taken at once or in parts; see [`Trajectory::next_in_parts`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parted<S, const N: usize> {
    /// The last part: its state is that at the end of the whole step.
    pub step: Step<S, N>,
    /// In how many parts, 1 for a whole step.
    pub parts: u32,
}

impl<L, M, const N: usize> Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// The next step, in 2, 4, … 2^`halvings` parts where it cannot be taken at once: at the end the time is
    /// that of a whole step.
    ///
    /// The value returned says how many parts were taken. The error, where all fail, is that of the whole
    /// step; the state is then the last good one, the trajectory has ended, and another step size lets it go
    /// on.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, State, Trajectory, rayleigh_system};
    ///
    /// /// Cubic drag, which accelerates for v < 0: no real step of length 1 from p = −1.3, one of length ½.
    /// #[rayleigh_system]
    /// fn cubic(q: [f64; 1], v: [f64; 1]) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] - 0.0 * q[0], v[0].powi(3) / 3.0)
    /// }
    /// let start = State { q: vector![0.0], p: vector![-0.6] };
    /// let mut trajectory = Cubic {}.by(Midpoint, 1.0).run(start);
    /// let parted = trajectory.next_in_parts(6)?;
    /// assert!(parted.parts > 1 && trajectory.time() == 1.0);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// The [`StepError`] of the whole step.
    pub fn next_in_parts(&mut self, halvings: u32) -> Result<Parted<L::Scalar, N>, StepError> {
        if self.run.course != Course::Open {
            self.prepare()?;
        }
        let parted = self.run.in_parts(self.system, self.time(), halvings);
        if parted.is_err() {
            self.end();
        }
        parted
    }
}

impl<V, M, const N: usize> DrivenTrajectory<V, M, N>
where
    V: Flow<M, N>,
{
    /// As [`advance`](Self::advance), in 2, 4, … 2^`halvings` parts with the same input where the whole one
    /// fails.
    ///
    /// # Errors
    /// The [`StepError`] of the whole step; the state is untouched.
    pub fn advance_in_parts<L>(
        &mut self,
        system: &L,
        halvings: u32,
    ) -> Result<Parted<V::Scalar, N>, StepError>
    where
        L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
        V::RunMemory: Memory<L, M, N>,
    {
        let course = self.course.after::<L, V::RunMemory, M, N>(system, &self.at)?;
        let parted = self.in_parts(system, 0.0, halvings)?;
        Memory::<L, M, N>::change_input(&mut self.memory.0);
        self.course = course;
        Ok(parted)
    }

    /// The next step of `system`, `elapsed` after the time of that, in up to 2^`halvings` parts.
    ///
    /// # Errors
    /// That of the whole step.
    fn in_parts<L>(
        &mut self,
        system: &L,
        elapsed: f64,
        halvings: u32,
    ) -> Result<Parted<V::Scalar, N>, StepError>
    where
        L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
        V::RunMemory: Memory<L, M, N>,
    {
        let Checkpoint { state, step_size, .. } = self.at;
        let error = match self.memory.0.advance_later(system, elapsed, &state, step_size) {
            Ok(step) => {
                self.at.follow(&step.state);
                return Ok(Parted { step, parts: 1 });
            }
            Err(error) => error,
        };
        let mut part = step_size;
        for halving in 1..=halvings.min(31) {
            part *= V::Scalar::constant(0.5);
            let mut memory = V::RunMemory::default();
            let (mut state, mut last) = (state, None);
            for taken in 0..1_u32 << halving {
                let elapsed = elapsed + f64::from(taken) * part.widen();
                match memory.advance_later(system, elapsed, &state, part) {
                    Ok(step) => {
                        state = step.state;
                        last = Some(step);
                    }
                    Err(_) => {
                        last = None;
                        break;
                    }
                }
            }
            if let Some(step) = last {
                self.at.follow(&state);
                return Ok(Parted { step, parts: 1 << halving });
            }
        }
        Err(error)
    }
}
