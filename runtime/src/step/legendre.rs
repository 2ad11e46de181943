//! The Legendre transform of L: states from velocities, and back.

use nalgebra::SVector;

use crate::numbers::{Scalar, linear};
use crate::step::cause::{explained_by_lagrangian, of_violation};
use crate::step::equation::Alone;
use crate::step::massless::{Balance, Massless};
use crate::step::regular::{beside_velocity, require_regular};
use crate::step::{
    State, StepError, StepKernel, newton,
    newton::{estimated_floor, held_against},
};
use crate::system::{Lagrangian, Quantity, derivatives_apart, verification::around};

/// The equations for the velocity at (q, v).
type Equations<'a, S, const N: usize> = &'a dyn Fn(&SVector<S, N>, &SVector<S, N>) -> Balance<S, N>;

impl<S: Scalar, const N: usize> State<S, N> {
    /// The state (q, ∂L/∂v(q, v)), by the Legendre transform of L.
    ///
    /// **Without mass.** L need not hold the velocity of a coordinate that friction damps, the end of a
    /// dashpot, say, or a bead in a fluid without inertia. Its p is 0, and friction makes its velocity what
    /// it is ([`velocity`](Self::velocity)): the v given there is left out, 0 for instance.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] if q, v, p or ∂²L/∂v² is not finite, [`StepError::DegenerateLagrangian`] if
    /// ∂²L/∂v² is singular, at v and next to it: that of |v|⁴ is singular at v = 0 alone; in coordinates
    /// without mass if ∂²R/∂v² is, less ∂f/∂v;
    /// [`StepError::SingularCoordinates`] if it is so at q alone; [`StepError::GeneratedDiffers`] if the
    /// derivatives generated belong to another function; [`StepError::OffConstraint`] and
    /// [`StepError::LeavesConstraint`] where a constraint is violated by more than rounding explains,
    /// [`StepError::NoDerivative`] where one has no gradient. Constraints that take the time are
    /// looked at on the view alone, `system.at_time(t)`.
    pub fn from_velocity<L: Lagrangian<N, Scalar = S>>(
        system: &L,
        q: impl Into<SVector<S, N>>,
        v: impl Into<SVector<S, N>>,
    ) -> Result<Self, StepError> {
        let (q, v) = (q.into(), v.into());
        StepError::require_finite(&q, Quantity::Configuration)?;
        StepError::require_finite(&v, Quantity::Velocity)?;
        around(system, &q, &v)?;
        let l = derivatives_apart(system, &q, &v);
        StepError::require_finite(&l.d2, Quantity::Derivatives)
            .map_err(|error| explained_by_lagrangian(system, &q, &v, error))?;
        if require_regular(&l.d22).is_err() {
            let massless = Massless::of(system, &q);
            let found = massless.require_determined(system, &q, &v);
            found.or_else(|error| require_determined_nearby(system, &massless, &q, &v, error))?;
        }
        if L::IS_CONSTRAINED
            && let Some(violation) = system.violation(&q, &v)
        {
            return Err(of_violation(system, &q, &v, violation));
        }
        Ok(Self { q, p: l.d2 })
    }

    /// The velocity v with ∂L/∂v(q, v) = p, by Newton's method (one iteration where L is quadratic in v).
    ///
    /// It starts at v = 0; where ∂²L/∂v² is singular or not finite there, as that of |v|⁴ and of |v|³ is,
    /// away from it. Such an L has velocities and steps, but a run through a turning point, v = 0, does not
    /// have the order of its rule: v = p^{1/3} for ¼|v|⁴ has no derivative there.
    ///
    /// **Without mass** the velocity of a coordinate is that at which friction balances the other forces,
    /// ∂R/∂v = ∂L/∂q + f, whatever p is there; where f takes an input, of the view that holds it. Where dry
    /// friction alone balances them it is 0, or that by which their force stays at its limit, an input being
    /// held and a time going on; the change of forces with the velocity of a mass is left out.
    ///
    /// # Errors
    /// As [`Discretised::step`](crate::Discretised::step); [`StepError::DegenerateLagrangian`] if ∂²L/∂v² is
    /// singular everywhere and friction does not determine what it leaves open,
    /// [`StepError::SingularCoordinates`] if it is so at q alone, [`StepError::NoVelocity`] if no velocity in
    /// reach has this momentum.
    pub fn velocity<L: Lagrangian<N, Scalar = S> + ?Sized>(
        &self,
        system: &L,
    ) -> Result<SVector<S, N>, StepError> {
        self.velocity_by(system, true)
    }

    /// [`velocity`](Self::velocity), of coordinates without mass where they are `allowed`.
    pub(crate) fn velocity_by<L: Lagrangian<N, Scalar = S> + ?Sized>(
        &self,
        system: &L,
        allowed: bool,
    ) -> Result<SVector<S, N>, StepError> {
        self.require_finite()?;
        let rest = nalgebra::zero();
        let at_rest = system.lagrangian_derivatives(&self.q, &rest);
        if require_regular(&at_rest.d22).is_err() {
            return self.velocity_of_singular(system, allowed);
        }
        let mut v = linear::solve_apart(&at_rest.d22, &(self.p - at_rest.d2)).unwrap_or(rest);
        let mut mass = at_rest.d22;
        if !L::STRUCTURE.constant_mass_matrix {
            // Where L is quadratic in v, this takes the rounding of the first solution back.
            let l = system.lagrangian_derivatives(&self.q, &v);
            v += linear::solve_apart(&l.d22, &(self.p - l.d2)).unwrap_or(rest);
            mass = l.d22;
        }
        let residual = system.lagrangian_gradient(&self.q, &v).d2 - self.p;
        let (_, _, is_root) = held_against(&residual, &estimated_floor(&self.p, &mass, &v));
        if is_root { Ok(v) } else { self.velocity_by_newton(system, &Massless::none(), None) }
    }

    /// Where ∂²L/∂v² is singular or not finite at rest.
    #[cold]
    #[inline(never)]
    fn velocity_of_singular<L: Lagrangian<N, Scalar = S> + ?Sized>(
        &self,
        system: &L,
        allowed: bool,
    ) -> Result<SVector<S, N>, StepError> {
        let rest = nalgebra::zero();
        let massless = if allowed { Massless::of(system, &self.q) } else { Massless::none() };
        if let Some(column) = massless.first()
            && system.massless_force(&self.q, &rest).is_none()
        {
            return Err(StepError::DegenerateLagrangian { column });
        }
        let found = massless.require_determined(system, &self.q, &rest);
        if let Err(error) = found {
            require_determined_nearby(system, &massless, &self.q, &rest, error)?;
        }
        if L::STRUCTURE.kinks > 0 && massless.are_any() {
            // Dry friction acts beside velocities with mass.
            let at_rest = |q: &SVector<S, N>, v: &SVector<S, N>| massless.at_rest(system, q, v);
            if let Ok(others) = self.velocity_of(system, &massless, &at_rest, None)
                && let Some(v) = system.massless_velocity(&self.q, &others)
            {
                return Ok(v);
            }
        }
        self.velocity_by_newton(system, &massless, found.err())
    }

    /// By Newton's method from rest or, with the `error` that this led to, from away from it.
    #[cold]
    #[inline(never)]
    fn velocity_by_newton<L: Lagrangian<N, Scalar = S> + ?Sized>(
        &self,
        system: &L,
        massless: &Massless<N>,
        error: Option<StepError>,
    ) -> Result<SVector<S, N>, StepError> {
        let balance =
            |q: &SVector<S, N>, v: &SVector<S, N>| massless.balance_at(system, q, v, S::constant(1.0));
        self.velocity_of(system, massless, &balance, error)
    }

    /// [`velocity_by_newton`](Self::velocity_by_newton), of these equations.
    #[cold]
    #[inline(never)]
    fn velocity_of<L: Lagrangian<N, Scalar = S> + ?Sized>(
        &self,
        system: &L,
        massless: &Massless<N>,
        balance: Equations<'_, S, N>,
        error: Option<StepError>,
    ) -> Result<SVector<S, N>, StepError> {
        let rest = nalgebra::zero();
        // 𝔽L is the limit h → 0 of the discrete transforms.
        let equation = Alone {
            kernel: |q: &SVector<S, N>, v: &SVector<S, N>| {
                let balance = balance(q, v);
                StepKernel { p0: balance.value, matrix: balance.by_v }
            },
            momentum: |q: &SVector<S, N>, v: &SVector<S, N>| {
                if massless.are_any() { balance(q, v).value } else { system.lagrangian_gradient(q, v).d2 }
            },
            inertia: |q: &SVector<S, N>, v: &SVector<S, N>| balance(q, v).by_v,
        };
        let state = State { q: self.q, p: massless.without(&self.p) };
        newton::root_from_rest(&equation, &state, error).map_err(|error| match error {
            StepError::NoRealSolution { residual, .. } | StepError::NotConverged { residual, .. } => {
                StepError::NoVelocity { residual }
            }
            StepError::SingularNewtonMatrix { column, .. } => {
                explained_by_lagrangian(system, &self.q, &rest, StepError::DegenerateLagrangian { column })
            }
            other => explained_by_lagrangian(system, &self.q, &rest, other),
        })
    }

    /// E_L at this node, with the velocity that p stands for.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn energy<L: Lagrangian<N, Scalar = S>>(&self, system: &L) -> Result<S, StepError> {
        Ok(system.energy(&self.q, &self.velocity(system)?))
    }
}

/// Fails with `error` where ∂²L/∂v², with friction in its place in coordinates without mass, is not finite or
/// cannot be inverted at a point next to (q, v) either. Where it can, (q, v) is a singular point of a system
/// that is regular.
#[cold]
#[inline(never)]
fn require_determined_nearby<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    massless: &Massless<N>,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
    error: StepError,
) -> Result<(), StepError> {
    massless
        .require_determined(system, q, &beside_velocity(v))
        .map_err(|_| explained_by_lagrangian(system, q, v, error))
}
