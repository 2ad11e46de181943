//! Questions to a run at its present time.

/// Methods of a run on a system of type `L`, and the time of the run at which that has its own: the system is
/// asked as it is at the time of the run.
macro_rules! at_present {
    ($run:ident => $system:expr, $since:expr) => {
        /// `ask` of the system as it is at the present time, where L, R or f take the time: of the view at
        /// that time, and of the system itself where they take none.
        ///
        /// For whatever is asked of the present state, by a rule too, such as the derivatives of the step
        /// that comes next: [`Trajectory`](crate::Trajectory) has an example.
        pub fn at_present<T>(&self, ask: impl FnOnce(&L) -> T) -> T {
            let $run = self;
            let elapsed: L::Scalar = $crate::numbers::Scalar::constant($run.time() - $since);
            $system.later(elapsed, ask)
        }

        /// The velocity of the present state, at its time.
        ///
        /// # Errors
        /// Those of [`State::velocity`](crate::State::velocity).
        pub fn velocity(&self) -> Result<nalgebra::SVector<L::Scalar, N>, $crate::step::StepError> {
            self.at_present(|system| self.state().velocity(system))
        }

        /// The energy of the present state, at its time.
        ///
        /// # Errors
        /// Those of [`State::velocity`](crate::State::velocity).
        pub fn energy(&self) -> Result<L::Scalar, $crate::step::StepError> {
            self.at_present(|system| self.state().energy(system))
        }
    };
}

pub(in crate::run) use at_present;
