//! The errors of a step.

use core::fmt;

use nalgebra::SMatrix;

use crate::numbers::Scalar;
use crate::system::{Compared, Function, GeneratedDiffers, NoDerivative, Place, Quantity, Violation};

/// Why a step was not taken. The state that it started from is untouched; each message says whether a smaller
/// step size can help.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
// A tag of one byte lies where a step has the first byte of its state: `Result<Step, StepError>` is then
// copied as that byte and the rest, which has no alignment, and on a microcontroller byte by byte.
#[repr(u32)]
pub enum StepError {
    /// The step size is zero or not finite.
    StepSize {
        /// The step size given.
        h: f64,
    },
    /// The clock of a run does not tell a step from none: its time is so large that the step does not change
    /// it, or is not finite.
    Time {
        /// The time of the run.
        time: f64,
        /// The step size.
        h: f64,
    },
    /// A run whose steps follow a time scale has no next step size: σ is not positive there, or grows by more
    /// in a step than a step size can follow.
    TimeScale {
        /// σ at the state.
        scale: f64,
        /// The step size before.
        h: f64,
    },
    /// A value is NaN or infinite: of the state, guess, input or time given, of a field of the system, or a
    /// derivative at a state that is finite.
    NonFinite {
        /// Which value.
        quantity: Quantity,
        /// Its coordinate, or the entry of the input; 0 of a time and a field.
        index: usize,
    },
    /// A step from a finite state leads to one that is NaN or infinite.
    Overflow {
        /// Which value of the new state.
        quantity: Quantity,
        /// Its coordinate.
        index: usize,
    },
    /// A derivative of L, R, f or a constraint, or a constraint itself, is NaN or infinite at a point where
    /// the step evaluated it ([`Lagrangian::without_derivative`](crate::Lagrangian::without_derivative),
    /// [`Lagrangian::violation`](crate::Lagrangian::violation)). Without the standard library the error of L,
    /// R and f is [`NonFinite`](Self::NonFinite) in its place.
    NoDerivative {
        /// Which function.
        function: Function,
        /// The coordinate i of the derivative by qᵢ or vᵢ; of no meaning where a value alone is none.
        coordinate: usize,
        /// The operation that has no derivative there, where it is known.
        place: Option<Place>,
    },
    /// ∂²L/∂v² is singular: momenta do not determine velocities, nor does friction where L does not hold
    /// one, or the rule takes no coordinate without mass.
    DegenerateLagrangian {
        /// The coordinate whose pivot vanishes.
        column: usize,
    },
    /// ∂²L/∂v² is singular at this configuration and regular beside it, as at a pole of spherical
    /// coordinates. Without the standard library nothing looks beside it, and the error is
    /// [`DegenerateLagrangian`](Self::DegenerateLagrangian).
    SingularCoordinates {
        /// The coordinate whose pivot vanishes.
        column: usize,
    },
    /// ∂²L/∂v² is regular but not positive definite, as the rules fitted to damping and the splittings need
    /// it.
    MassNotPositiveDefinite {
        /// The first coordinate with a pivot that is not positive.
        column: usize,
    },
    /// The configuration is off a constraint gₖ(q) = 0.
    OffConstraint {
        /// The constraint k, from 0.
        constraint: usize,
        /// gₖ(q).
        value: f64,
    },
    /// The velocity leads off a constraint.
    LeavesConstraint {
        /// The constraint k, from 0.
        constraint: usize,
        /// ∂gₖ/∂q·v + ∂gₖ/∂t, or ψₖ(q, v) of a constraint of velocity.
        rate: f64,
    },
    /// The gradient of a constraint depends on those of the others and the constraints are not redundant: the
    /// configuration is singular, as a four-bar linkage is where all bars lie on a line. Or, of
    /// [`State::nearest`](crate::State::nearest), no configuration in reach is on all constraints.
    DependentConstraints {
        /// The constraint k, from 0, as far as it is known.
        constraint: usize,
    },
    /// A step that is asked about, as for its [`reactions`](crate::Discretised::reactions), does not lead
    /// from the state given by the step size of the question: it was taken with another one, or from another
    /// state.
    OtherStep {
        /// The step size of the question.
        h: f64,
        /// (q1 − q0)/v̄ of the coordinate that is farthest off: the step size of the step, if it was taken
        /// from the state given.
        taken: f64,
    },
    /// A kink of R with a negative factor, which pushes where it should hold.
    NegativeFriction {
        /// The component of the kinks of R, from 0 in the order of R.
        component: usize,
        /// Its factor.
        limit: f64,
    },
    /// The objective of a step with friction is not convex: friction falls with the velocity faster than a
    /// step of this length can follow, h max|F′| ≥ 2m; or the step is one back in time, along which friction
    /// pushes. Velocities along a line are looked at, from rest to that of the step and, for another least,
    /// to that without friction, fourteen in all: a fall narrower than these are apart is not seen.
    NotConvex {
        /// The component of the kinks of R, from 0 in the order of R.
        component: usize,
        /// The step size.
        h: f64,
        /// A step size that would do at the velocity at which it was met.
        enough: f64,
    },
    /// A friction force that holds is at its limit: the least change makes it slide, and the step has no
    /// derivative.
    AtLimitOfFriction {
        /// The component of the kinks of R, from 0 in the order of R.
        component: usize,
    },
    /// No velocity in reach has this momentum: ∂L/∂v(q, v) = p, which no step size enters.
    NoVelocity {
        /// Largest residual p − ∂L/∂v.
        residual: f64,
    },
    /// The Newton matrix −h D2 D1 L_d⁺ is singular at an iterate.
    SingularNewtonMatrix {
        /// The iteration, from 0.
        iteration: u32,
        /// The coordinate whose pivot vanishes.
        column: usize,
    },
    /// No shorter Newton step lowers the residual: the equation has no real solution near the guess.
    NoRealSolution {
        /// The iteration, from 0.
        iteration: u32,
        /// Largest residual of the momentum equation.
        residual: f64,
    },
    /// The residual cannot be brought to its round-off floor: digits cancel inside L, R or f.
    LostPrecision {
        /// Largest residual of the momentum equation.
        residual: f64,
        /// The round-off floor expected.
        floor: f64,
    },
    /// The iteration limit was reached while the residual was still falling.
    NotConverged {
        /// Iterations taken.
        iterations: u32,
        /// Largest residual of the momentum equation.
        residual: f64,
        /// The round-off floor aimed at.
        floor: f64,
    },
    /// The derivatives generated belong to another function than the one written: it has another value, or
    /// another slope ([`verification`](crate::system::verification)).
    GeneratedDiffers {
        /// Which function.
        function: Function,
        /// Which quantity of it.
        compared: Compared,
        /// The quantity as generated.
        generated: f64,
        /// The quantity of the function as written: a derivative by differences.
        written: f64,
    },
}

impl StepError {
    /// Fails with the first coordinate of `vector`, or of a column of several, that is not finite.
    #[inline]
    pub(crate) fn require_finite<S: Scalar, const N: usize, const K: usize>(
        vector: &SMatrix<S, N, K>,
        quantity: Quantity,
    ) -> Result<(), Self> {
        // 0·x is 0 for every finite x and NaN for the others: one pass without a branch.
        let mut poison = S::zero();
        for entry in vector.iter() {
            poison += *entry * S::zero();
        }
        if poison == S::zero() { Ok(()) } else { Err(Self::non_finite(vector, quantity)) }
    }

    /// The error of a state that is reached, made of that of one that is given.
    #[cold]
    pub(crate) fn of_reached(self) -> Self {
        match self {
            Self::NonFinite { quantity, index } => Self::Overflow { quantity, index },
            other => other,
        }
    }

    #[cold]
    fn non_finite<S: Scalar, const N: usize, const K: usize>(
        vector: &SMatrix<S, N, K>,
        quantity: Quantity,
    ) -> Self {
        let index = vector.iter().position(|entry| !entry.is_finite()).unwrap_or(0);
        Self::NonFinite { quantity, index: index % N }
    }
}

impl From<GeneratedDiffers> for StepError {
    fn from(GeneratedDiffers { function, compared, generated, written }: GeneratedDiffers) -> Self {
        Self::GeneratedDiffers { function, compared, generated, written }
    }
}

impl From<Violation> for StepError {
    fn from(violation: Violation) -> Self {
        match violation {
            Violation::NoDerivative { constraint: index, coordinate } => {
                Self::NoDerivative { function: Function::Constraint { index }, coordinate, place: None }
            }
            Violation::Off { constraint, value } => Self::OffConstraint { constraint, value },
            Violation::Leaving { constraint, rate } => Self::LeavesConstraint { constraint, rate },
        }
    }
}

impl From<NoDerivative> for StepError {
    fn from(NoDerivative { function, coordinate, place }: NoDerivative) -> Self {
        Self::NoDerivative { function, coordinate, place }
    }
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StepSize { h } => write!(f, "step size {h} is zero or not finite; give a finite h ≠ 0"),
            Self::Time { time, h } => write!(
                f,
                "a step of {h} does not change the time {time} of the run; start a new run from its state, whose time begins at 0, \
                 with the system as it is at that time"
            ),
            Self::TimeScale { scale, h } if *scale > 0.0 && scale.is_finite() => write!(
                f,
                "the time scale grows faster than steps can follow: after a step of {h} at σ = {scale} there is no next step \
                 size; give a smaller one at the start of the run"
            ),
            Self::TimeScale { scale, .. } => write!(
                f,
                "the time scale σ is {scale} at the state; it has to be positive and finite wherever the run comes"
            ),
            &Self::NonFinite { quantity, index } => non_finite(f, quantity, index),
            &Self::NoDerivative { function, coordinate, place } => {
                NoDerivative { function, coordinate, place }.fmt(f)
            }
            Self::Overflow { quantity, index } => write!(
                f,
                "the step leads from a finite state to a {quantity} {index} that is NaN or infinite; look at the fields of \
                 the system and its input; if all are finite numbers, try a smaller step"
            ),
            Self::DegenerateLagrangian { column } => {
                write!(
                    f,
                    "∂²L/∂v² is singular (pivot of coordinate {column}): momenta do not determine velocities; give \
                     coordinate {column} a kinetic energy of its own, or remove it; where R damps it, `Midpoint`, `Proximal` \
                     and Gauss rules step it without, of a system with an input as its view"
                )?;
                if cfg!(feature = "std") {
                    return Ok(());
                }
                f.write_str("; if it has one beside this point, start away from the point")
            }
            Self::SingularCoordinates { column } => write!(
                f,
                "the coordinates are singular at this configuration: ∂²L/∂v² is singular there (pivot of coordinate \
                 {column}) and regular beside it, as at a pole of spherical coordinates, at r = 0 of polar ones or in \
                 gimbal lock; start away from that point, or take coordinates that are regular there"
            ),
            Self::MassNotPositiveDefinite { column } => write!(
                f,
                "∂²L/∂v² is not positive definite (pivot of coordinate {column}): the fitted rules and the splittings \
                 need that; step with another rule, or mend the sign of the kinetic energy"
            ),
            Self::OffConstraint { constraint, value } => write!(
                f,
                "the configuration is off constraint {constraint} by {value:.3e}; `nearest` gives the nearest \
                 state on all constraints"
            ),
            Self::LeavesConstraint { constraint, rate } => write!(
                f,
                "the velocity leads off constraint {constraint}, whose value changes at a rate of {rate:.3e}; \
                 `nearest` gives the nearest state on all constraints"
            ),
            Self::DependentConstraints { constraint } => write!(
                f,
                "constraint {constraint} depends on the others, or contradicts them: the configuration is singular, or none in \
                 reach is on all constraints; start away from it, or take another coordinate there"
            ),
            Self::OtherStep { h, taken } => write!(
                f,
                "the step asked about is not that of the state given by h = {h}: from there its mean velocity takes {taken} \
                 to its end; give the state that it was taken from, and ask the system with the step size that it was \
                 taken with"
            ),
            Self::NegativeFriction { component, limit } => write!(
                f,
                "the factor of kink {component} of R is {limit:.3e}: friction would push; give it one that is not negative"
            ),
            Self::NotConvex { component, h, enough } => write!(
                f,
                "the friction of kink {component} of R falls with the velocity faster than a step of {h:.3e} can follow; \
                 one of {enough:.3e} would"
            ),
            Self::AtLimitOfFriction { component } => write!(
                f,
                "the friction of kink {component} of R holds at its limit, so that the step has no derivative there; \
                 ask at another state"
            ),
            Self::NoVelocity { residual } => write!(
                f,
                "no velocity in reach has this momentum (residual {residual:.3e}): ∂L/∂v is bounded or not monotone; \
                 check p and L"
            ),
            Self::SingularNewtonMatrix { iteration, column } => write!(
                f,
                "Newton matrix singular at iteration {iteration} (pivot of coordinate {column}); try a smaller step"
            ),
            Self::NoRealSolution { iteration, residual } => write!(
                f,
                "no real solution in reach: at iteration {iteration} no shorter Newton step lowers the residual \
                 {residual:.3e}; try a smaller step"
            ),
            Self::LostPrecision { residual, floor } => write!(
                f,
                "residual {residual:.3e} stays above its round-off floor {floor:.3e}: digits cancel in L, R or f; \
                 shift or rescale the coordinates"
            ),
            Self::NotConverged { iterations, residual, floor } => write!(
                f,
                "not converged after {iterations} iterations: residual {residual:.3e}, floor {floor:.3e}; \
                 try a smaller step"
            ),
            &Self::GeneratedDiffers { function, compared, generated, written } => {
                GeneratedDiffers { function, compared, generated, written }.fmt(f)
            }
        }
    }
}

/// The text of [`StepError::NonFinite`].
fn non_finite(f: &mut fmt::Formatter<'_>, quantity: Quantity, index: usize) -> fmt::Result {
    match quantity {
        Quantity::Derivatives => write!(
            f,
            "a derivative of L, R, f or a constraint by coordinate {index} is NaN or infinite; look first at the fields of \
             the system and its input: one may be NaN, infinite or too large; then at these functions: √s has no derivative at s = 0 \
             (√(s + ε²) has), a power below 1 and a logarithm have none at 0; if theirs are finite at the state \
             given, the step leaves the region where they are: try a smaller step"
        ),
        Quantity::InputEntry => write!(
            f,
            "entry {index} of the input u is NaN or infinite; look at what gives the input, a controller or a sensor"
        ),
        Quantity::Time => {
            f.write_str("the time given is NaN or infinite; give the time that the step starts at")
        }
        Quantity::Field { name } => {
            write!(f, "`{name}` of the system is NaN, and its functions compute with it; give it a number")
        }
        Quantity::Configuration | Quantity::Velocity | Quantity::Momentum => {
            write!(f, "the {quantity} given is NaN or infinite in coordinate {index}; give finite numbers")
        }
    }
}

debug_by_display!(StepError);

impl core::error::Error for StepError {}
