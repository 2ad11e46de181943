//! The reactions of constraints at an instant of the motion.

use nalgebra::SVector;

use super::nearest::AtPoint;
use crate::numbers::Scalar;
use crate::step::{State, StepError};
use crate::system::{ActingForce, Constrained, is_timed, sizes};

/// Spacings of differences by the time, each a quarter of the one before: from an hour to a picosecond, where
/// seconds are the unit.
const SPACINGS: u32 = 26;

/// The longest of them.
const LONGEST: f64 = 3571.0;

impl<S: Scalar, const N: usize> State<S, N> {
    /// The multipliers λ of the constraints of `system` along the motion through this state, as it is at the
    /// time of the system: Gᵀλ is the force that holds the motion there.
    ///
    /// ```text
    /// M v̇ + ∂p/∂q v + ∂p/∂t = ∂L/∂q + f_L + Gᵀλ,   ∂ρ/∂q v + G v̇ + ∂ρ/∂t = 0        p = ∂L/∂v
    /// ```
    ///
    /// Signs, units and redundant constraints are those of [`reactions`](crate::step::Discretised::reactions)
    /// of a step, of which this is the limit for h → 0. ∂/∂t of a system that takes the time is a difference,
    /// to about 1e-10 in `f64`.
    ///
    /// ```
    /// use dalembert::{State, rayleigh_system};
    ///
    /// struct Pendulum;
    ///
    /// #[rayleigh_system]
    /// impl Pendulum {
    ///     fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
    ///         0.5 * (v[0] * v[0] + v[1] * v[1]) - 9.81 * q[1]
    ///     }
    ///     fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
    ///         [(q[0] * q[0] + q[1] * q[1]).sqrt() - 1.0]
    ///     }
    /// }
    ///
    /// // Weight and v²/r, towards smaller lengths.
    /// let lowest = State::from_velocity(&Pendulum, [0.0, -1.0], [2.0, 0.0])?;
    /// assert!((lowest.reactions(&Pendulum)?[0] + 9.81 + 4.0).abs() < 1e-13);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::DependentConstraints`] where the constraints do not determine λ; those of
    /// [`State::velocity`].
    pub fn reactions<L, const M: usize>(&self, system: &L) -> Result<SVector<S, M>, StepError>
    where
        L: Constrained<N, M> + ActingForce<N, Scalar = S>,
    {
        reactions_at(system, &self.q, &self.velocity(system)?)
    }
}

/// λ of the motion through (q, v): [`State::reactions`].
///
/// # Errors
/// [`StepError::DependentConstraints`]; those of the mass.
pub(crate) fn reactions_at<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<SVector<L::Scalar, M>, StepError>
where
    L: Constrained<N, M> + ActingForce<N>,
{
    let at = AtPoint::<_, N, M>::at(system, q, v)?;
    let l = system.lagrangian_derivatives(q, v);
    let mut force = l.d1 + system.acting_force(q, v) - l.d12.tr_mul(v);
    let mut rate = system.constraint_rates(q, v).1 * v;
    if is_timed(system) {
        let momentum = |system: &L| system.lagrangian_gradient(q, v).d2;
        force -= by_time(l.d2.amax(), |elapsed| system.later(elapsed, momentum));
        // On the constraints ρ is 0, and its terms are not.
        let terms = sizes(&at.gradients, v) + system.constraint_rates(q, &nalgebra::zero()).0.abs();
        let rates = |system: &L| system.constraint_rates(q, v).0;
        rate += by_time(terms.amax(), |elapsed| system.later(elapsed, rates));
    }
    Ok(-at.complement.solve(&(rate + at.gradients * at.inertia.solve(&force))))
}

/// The derivative at 0 of what has terms of this size there: the central difference of order 4 that differs
/// least from that of the spacing before, rounding included, which may make two of them equal by chance.
#[cold]
fn by_time<S: Scalar, const P: usize>(size: S, of: impl Fn(S) -> SVector<S, P>) -> SVector<S, P> {
    let difference = |spacing: S| {
        let across = |spacing: S| of(spacing) - of(-spacing);
        let [near, far] = [across(spacing), across(spacing + spacing)];
        (near * S::constant(8.0) - far) / (spacing * S::constant(12.0))
    };
    let (mut spacing, mut least) = (S::constant(LONGEST), S::constant(f64::INFINITY));
    let (mut best, mut wider) = (nalgebra::zero(), difference(spacing));
    for _ in 1..SPACINGS {
        spacing *= S::constant(0.25);
        let near = difference(spacing);
        let off = (near - wider).amax() + size * S::EPSILON / spacing;
        if off < least {
            (best, least) = (near, off);
        }
        wider = near;
    }
    best
}
