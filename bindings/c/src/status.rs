//! How a call ended, as a number that C can read.

use core::fmt;

use dalembert::StepError;
use dalembert::step::Quantity;
use dalembert::system::{Function, TableError};
use dalembert_face::{PointsError, WrongPoints};

macro_rules! statuses {
    ($($(#[doc = $doc:literal])* $name:ident = $number:literal, $c:literal, $text:literal;)*) => {
        /// How a call ended: 0 where it did what it says, else why it did nothing.
        ///
        /// In C `enum dalembert_status`; the numbers do not change from one version to the next.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(C)]
        #[must_use]
        pub enum Status {
            $($(#[doc = $doc])* $name = $number,)*
        }

        impl Status {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// Its name in C.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$name => $c,)*
                }
            }

            /// Whether a system without constraints cannot return it.
            pub(crate) const fn is_of_constraints(self) -> bool {
                self as i32 >= Self::OffConstraint as i32 && self as i32 <= Self::NoDerivativeOfConstraint as i32
            }

            /// Whether a system without tables cannot return it.
            pub(crate) const fn is_of_tables(self) -> bool {
                self as i32 >= Self::PointsNotIncreasing as i32 && self as i32 <= Self::NoInterpolation as i32
            }

            /// The text for C: the cause and the remedy, in ASCII, ended by a zero byte.
            pub(crate) const fn text_for_c(self) -> &'static str {
                match self {
                    $(Self::$name => concat!($text, "\0"),)*
                }
            }
        }
    };
}

statuses! {
    /// The call did what it says.
    Ok = 0, "DALEMBERT_OK", "done";
    /// An address is NULL that must not be.
    NullPointer = 1, "DALEMBERT_NULL_POINTER", "an address is NULL: pass the object that the header declares";
    /// An address is no multiple of its type's alignment.
    Misaligned = 2, "DALEMBERT_MISALIGNED", "an address is misaligned: declare the object by its type, do not cast bytes to it";
    /// The memory is smaller than the system needs, or the header is of another build of the library.
    WrongMemory = 3, "DALEMBERT_WRONG_MEMORY", "memory or parameters are not laid out as the library's: compile with the header that this library wrote";
    /// The memory has not been initialised for this system, or has been overwritten.
    NotInitialised = 4, "DALEMBERT_NOT_INITIALISED", "the memory holds no run of this system: call init first, and keep the memory as it is";
    /// The step size is zero or not finite.
    StepSize = 5, "DALEMBERT_STEP_SIZE", "the step size is zero or not finite: give a finite step size that is not 0";
    /// The clock does not tell the step from none.
    Time = 6, "DALEMBERT_TIME", "a step does not change the time: the run is too long for its step size, or the time is not finite; initialise a new run";
    /// A configuration, a velocity or a momentum given is NaN or infinite.
    NotFinite = 7, "DALEMBERT_NOT_FINITE", "a configuration, velocity or momentum given is NaN or infinite: look at the state given";
    /// The input, or the time given, is NaN or infinite.
    InputNotFinite = 8, "DALEMBERT_INPUT_NOT_FINITE", "the input or the time given is NaN or infinite: look at the controller";
    /// A parameter is NaN.
    ParameterNan = 9, "DALEMBERT_PARAMETER_NAN", "a parameter is NaN: fill in every field of the parameters";
    /// L, R or f, or a derivative of theirs, is NaN or infinite.
    DerivativesNotFinite = 10, "DALEMBERT_DERIVATIVES_NOT_FINITE", "a derivative of L, R or f is NaN or infinite: look at parameters, input and state; sqrt(s) has no derivative at s = 0, sqrt(s + eps^2) has";
    /// The mass matrix is singular.
    DegenerateLagrangian = 11, "DALEMBERT_DEGENERATE_LAGRANGIAN", "the mass matrix is singular: look at the masses among the parameters; where it is singular at this configuration alone, as at a pole of the coordinates, start away from it";
    /// The mass matrix is not positive definite.
    MassNotPositiveDefinite = 12, "DALEMBERT_MASS_NOT_POSITIVE_DEFINITE", "the mass matrix is not positive definite: look at the masses among the parameters";
    /// No velocity in reach has the momentum given.
    NoVelocity = 13, "DALEMBERT_NO_VELOCITY", "no velocity in reach has this momentum: look at the state given";
    /// The Newton matrix is singular.
    SingularNewtonMatrix = 14, "DALEMBERT_SINGULAR_NEWTON_MATRIX", "the equations of the step are singular: try a smaller step";
    /// The step has no real solution in reach.
    NoRealSolution = 15, "DALEMBERT_NO_REAL_SOLUTION", "the equations of the step have no solution in reach: try a smaller step";
    /// Digits cancel in L, R or f.
    LostPrecision = 16, "DALEMBERT_LOST_PRECISION", "digits cancel in L, R or f: shift or rescale the coordinates";
    /// The iteration limit was reached.
    NotConverged = 17, "DALEMBERT_NOT_CONVERGED", "the equations of the step were not solved within the iteration limit: try a smaller step";
    /// Derivatives generated are of another function than the one written.
    GeneratedDiffers = 18, "DALEMBERT_GENERATED_DIFFERS", "the derivatives generated are not those of L, R and f as written: report this as a mistake of the generator";
    /// An error that this version has no number for.
    Other = 19, "DALEMBERT_OTHER", "the step was not taken";
    /// L has no derivative where the step evaluated it.
    NoDerivativeOfLagrangian = 20, "DALEMBERT_NO_DERIVATIVE_OF_L", "L has no derivative there, as sqrt(s), a power below 1 or a logarithm at s = 0: write sqrt(s + eps^2) in L; or a parameter or the input is too large";
    /// R has no derivative where the step evaluated it.
    NoDerivativeOfRayleigh = 21, "DALEMBERT_NO_DERIVATIVE_OF_R", "R has no derivative there, as sqrt(s), a power below 1 or a logarithm at s = 0: write sqrt(s + eps^2) in R; or a parameter or the input is too large";
    /// f has no derivative where the step evaluated it.
    NoDerivativeOfForce = 22, "DALEMBERT_NO_DERIVATIVE_OF_F", "f has no derivative there, as sqrt(s), a power below 1 or a logarithm at s = 0: write sqrt(s + eps^2) in f; or a parameter or the input is too large";
    /// A step from a finite state leads to one that is NaN or infinite.
    Overflow = 23, "DALEMBERT_OVERFLOW", "the step leads from a finite state to one that is NaN or infinite: look at parameters and input; if they are finite, try a smaller step";
    /// The mass matrix is singular at this configuration and regular beside it.
    SingularCoordinates = 24, "DALEMBERT_SINGULAR_COORDINATES", "the coordinates are singular at this configuration, as at a pole of spherical ones or in gimbal lock: start away from it, or take other coordinates";
    /// The configuration is off a constraint.
    OffConstraint = 25, "DALEMBERT_OFF_CONSTRAINT", "the configuration is off a constraint: violation says off which and by how much, nearest gives the nearest state on all constraints";
    /// The velocity leads off a constraint.
    LeavesConstraint = 26, "DALEMBERT_LEAVES_CONSTRAINT", "the velocity leads off a constraint: violation says off which and how fast, nearest gives the nearest state on all constraints";
    /// The constraints contradict one another, or do not tell where to go.
    DependentConstraints = 27, "DALEMBERT_DEPENDENT_CONSTRAINTS", "the constraints contradict one another there, or no state in reach is on all of them: a singular configuration; start away from it";
    /// There is no step to be asked.
    NoStep = 28, "DALEMBERT_NO_STEP", "no step was taken since the run began or its parameters were set: take one, and ask for its reactions then";
    /// A constraint has no value or no derivative where it was evaluated.
    NoDerivativeOfConstraint = 29, "DALEMBERT_NO_DERIVATIVE_OF_CONSTRAINT", "a constraint or its derivative is NaN or infinite there, as that of sqrt(s) at s = 0: look at parameters and configuration, violation says at which constraint";
    /// A friction force would push.
    NegativeFriction = 30, "DALEMBERT_NEGATIVE_FRICTION", "the factor of a kink of R is negative, so that friction would push: look at the parameters";
    /// Friction falls with the velocity too fast for the step.
    NotConvex = 31, "DALEMBERT_NOT_CONVEX", "friction falls with the velocity faster than a step of this size can follow: try a smaller step";
    /// A friction force that holds is at its limit.
    AtLimitOfFriction = 32, "DALEMBERT_AT_LIMIT_OF_FRICTION", "friction holds at its limit, so that the step has no derivative there: ask at another state";
    /// The x of a table do not increase.
    PointsNotIncreasing = 33, "DALEMBERT_POINTS_NOT_INCREASING", "an x of a table is not above the one before: sort the points by x, and keep one of each x; wrong_point says which";
    /// A number of a table is NaN or infinite.
    PointsNotFinite = 34, "DALEMBERT_POINTS_NOT_FINITE", "an x or y of a table is NaN or infinite, or an x infinitely far from the first: leave the point out; wrong_point says which";
    /// A periodic table does not end as it begins.
    PointsNotPeriodic = 35, "DALEMBERT_POINTS_NOT_PERIODIC", "the last y of a periodic table is not the first: end with the first point of the next turn; wrong_point says in which table";
    /// The points of a table are too close for their values.
    PointsTooSteep = 36, "DALEMBERT_POINTS_TOO_STEEP", "points of a table are too close for their values, so that a coefficient between them is beyond the largest number: leave one out; wrong_point says which";
    /// A table has no interpolation, or too few points for it.
    NoInterpolation = 37, "DALEMBERT_NO_INTERPOLATION", "the interpolation of a table is none of DALEMBERT_LINEAR, _SPLINE, _MONOTONE and _PERIODIC, or the table has too few points for it: periodic takes 3; wrong_point says which table";
}

impl From<WrongPoints> for Status {
    #[cold]
    fn from(wrong: WrongPoints) -> Self {
        let PointsError::Points(error) = wrong.error else { return Self::NoInterpolation };
        match error {
            TableError::NotIncreasing { .. } => Self::PointsNotIncreasing,
            TableError::KnotNotFinite { .. } | TableError::ValueNotFinite { .. } => Self::PointsNotFinite,
            TableError::NotPeriodic { .. } => Self::PointsNotPeriodic,
            TableError::TooSteep { .. } | TableError::SinglePrecision { .. } => Self::PointsTooSteep,
            TableError::TooShort { .. } => Self::NoInterpolation,
            _ => Self::Other,
        }
    }
}

impl From<StepError> for Status {
    fn from(error: StepError) -> Self {
        Self::from(&error)
    }
}

impl From<&StepError> for Status {
    /// Apart, and of an error where it lies: beside it a step that succeeds is copied as a whole.
    #[cold]
    #[inline(never)]
    fn from(error: &StepError) -> Self {
        match error {
            StepError::StepSize { .. } => Self::StepSize,
            StepError::Time { .. } => Self::Time,
            StepError::NonFinite { quantity, .. } => match quantity {
                Quantity::Derivatives => Self::DerivativesNotFinite,
                Quantity::InputEntry | Quantity::Time => Self::InputNotFinite,
                Quantity::Field { .. } => Self::ParameterNan,
                _ => Self::NotFinite,
            },
            StepError::Overflow { .. } => Self::Overflow,
            StepError::SingularCoordinates { .. } => Self::SingularCoordinates,
            StepError::NoDerivative { function, .. } => match function {
                Function::Lagrangian => Self::NoDerivativeOfLagrangian,
                Function::Rayleigh => Self::NoDerivativeOfRayleigh,
                Function::Force { .. } => Self::NoDerivativeOfForce,
                Function::Constraint { .. } => Self::NoDerivativeOfConstraint,
                _ => Self::DerivativesNotFinite,
            },
            StepError::DegenerateLagrangian { .. } => Self::DegenerateLagrangian,
            StepError::MassNotPositiveDefinite { .. } => Self::MassNotPositiveDefinite,
            StepError::OffConstraint { .. } => Self::OffConstraint,
            StepError::LeavesConstraint { .. } => Self::LeavesConstraint,
            StepError::DependentConstraints { .. } => Self::DependentConstraints,
            StepError::NegativeFriction { .. } => Self::NegativeFriction,
            StepError::NotConvex { .. } => Self::NotConvex,
            StepError::AtLimitOfFriction { .. } => Self::AtLimitOfFriction,
            StepError::NoVelocity { .. } => Self::NoVelocity,
            StepError::SingularNewtonMatrix { .. } => Self::SingularNewtonMatrix,
            StepError::NoRealSolution { .. } => Self::NoRealSolution,
            StepError::LostPrecision { .. } => Self::LostPrecision,
            StepError::NotConverged { .. } => Self::NotConverged,
            StepError::GeneratedDiffers { .. } => Self::GeneratedDiffers,
            _ => Self::Other,
        }
    }
}

impl From<Result<(), Status>> for Status {
    fn from(ended: Result<(), Status>) -> Self {
        ended.err().unwrap_or(Self::Ok)
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text_for_c().trim_end_matches('\0'))
    }
}

/// The text of the number `status`, for C: `dalembert_text`.
#[must_use]
pub fn text(status: i32) -> *const core::ffi::c_char {
    let known = Status::ALL.iter().find(|known| **known as i32 == status);
    known.map_or("no status of this library\0", |known| known.text_for_c()).as_ptr().cast()
}

#[cfg(test)]
mod tests {
    use dalembert::{Discretise, Lagrangian, Midpoint, State, rayleigh_system};

    use super::*;
    use crate::CViolation;

    /// A root of v² in R or f, or of q² in L.
    #[rayleigh_system(rule = midpoint)]
    impl Rough {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            0.5 * v[0] * v[0] - self.shares[0] * (q[0] * q[0] + self.soft[0]).sqrt()
        }

        fn rayleigh(&self, v: [f64; 1]) -> f64 {
            self.shares[1] * (v[0] * v[0] + self.soft[1]).sqrt()
        }

        fn force(&self, _q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
            [-self.shares[2] * (v[0] * v[0] + self.soft[2]).sqrt()]
        }
    }

    struct Rough {
        shares: [f64; 3],
        soft: [f64; 3],
    }

    #[test]
    fn a_derivative_that_is_none_has_the_status_of_its_function() {
        let rest = State { q: [0.0].into(), p: [0.0].into() };
        let statuses =
            [Status::NoDerivativeOfLagrangian, Status::NoDerivativeOfRayleigh, Status::NoDerivativeOfForce];
        for (i, status) in statuses.into_iter().enumerate() {
            let mut system = Rough { shares: [1.0; 3], soft: [1.0; 3] };
            assert!(system.by(Midpoint, 0.1).linearized(&rest).is_ok());
            system.soft[i] = 0.0;
            let error = system.by(Midpoint, 0.1).linearized(&rest).err().unwrap();
            assert_eq!(Status::from(error), status);
            assert!(status.text_for_c().contains("sqrt(s + eps^2)"), "{status}");
        }
    }

    /// A point at a distance from the origin, which has no gradient there.
    struct Tethered {
        length: f64,
    }

    #[rayleigh_system]
    impl Tethered {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            0.5 * (v[0] * v[0] + v[1] * v[1]) - q[1]
        }

        fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
            [(q[0] * q[0] + q[1] * q[1]).sqrt() - self.length]
        }
    }

    #[test]
    fn a_constraint_without_a_gradient_has_a_status_and_is_named() {
        for (length, status) in [(0.0, Status::NoDerivativeOfConstraint), (0.1, Status::OffConstraint)] {
            let error =
                State::from_velocity(&Tethered { length }, [length * 0.5, 0.0], [0.0; 2]).unwrap_err();
            assert_eq!(Status::from(error), status);
            let found = CViolation::from(
                Tethered { length }.violation(&[0.5 * length, 0.0].into(), &[0.0; 2].into()),
            );
            assert!(found.status == status as i32 && found.constraint == 0 && status.is_of_constraints());
            assert_eq!(found.amount.is_nan(), length == 0.0);
        }
    }
}
