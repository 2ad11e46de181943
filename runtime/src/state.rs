//! A point of T*Q.

use nalgebra::{SMatrix, SVector};

use crate::error::{Quantity, StepError};
use crate::linear;
use crate::newton;
use crate::{Lagrangian, Momenta, Scalar, StepKernel};

/// Configuration and momentum, a point (q, p) of T*Q.
///
/// Made from (q, v) by [`State::from_velocity`], or from two configurations by
/// [`Discrete::legendre_plus`](crate::Discrete::legendre_plus) (the state at q1) and
/// [`Discrete::legendre_minus`](crate::Discrete::legendre_minus) (the state at q0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<S, const N: usize> {
    /// Configuration.
    pub q: SVector<S, N>,
    /// Momentum, in units of ∂L/∂v.
    pub p: SVector<S, N>,
}

impl<S: Scalar, const N: usize> State<S, N> {
    /// The state (q, ∂L/∂v(q, v)), by the Legendre transform of L.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] if q, v, p or ∂²L/∂v² is not finite, [`StepError::DegenerateLagrangian`] if ∂²L/∂v² is singular.
    pub fn from_velocity<L: Lagrangian<N, Scalar = S>>(
        system: &L,
        q: impl Into<SVector<S, N>>,
        v: impl Into<SVector<S, N>>,
    ) -> Result<Self, StepError> {
        let (q, v) = (q.into(), v.into());
        StepError::require_finite(&q, Quantity::Configuration)?;
        StepError::require_finite(&v, Quantity::Velocity)?;
        let l = system.lagrangian_derivatives(&q, &v);
        StepError::require_finite(&l.d2, Quantity::Momentum)?;
        require_regular(&l.d22)?;
        Ok(Self { q, p: l.d2 })
    }

    /// The velocity v with ∂L/∂v(q, v) = p, by Newton's method from v = 0 (one iteration where L is quadratic in v).
    ///
    /// # Errors
    /// As [`Discrete::step`](crate::Discrete::step); [`StepError::DegenerateLagrangian`] if ∂²L/∂v² is singular.
    pub fn velocity<L: Lagrangian<N, Scalar = S>>(&self, system: &L) -> Result<SVector<S, N>, StepError> {
        self.require_finite()?;
        // 𝔽L is the limit h → 0 of the discrete transforms.
        let transform = |q: &SVector<S, N>, v: &SVector<S, N>| {
            let l = system.lagrangian_derivatives(q, v);
            StepKernel { p0: l.d2, matrix: l.d22 }
        };
        let solution = newton::solve(
            newton::Equation::General,
            transform,
            |q, v| {
                let p = system.lagrangian_gradient(q, v).d2;
                Momenta { p0: p, p1: p }
            },
            |q, v| system.lagrangian_derivatives(q, v).d22.diagonal(),
            self,
            nalgebra::zero(),
        )
        .map_err(|error| match error {
            StepError::SingularNewtonMatrix { column, .. } => StepError::DegenerateLagrangian { column },
            other => other,
        })?;
        Ok(solution.unknown)
    }

    /// Fails with the first entry of q or p that is not finite.
    #[inline]
    pub(crate) fn require_finite(&self) -> Result<(), StepError> {
        StepError::require_finite(&self.q, Quantity::Configuration)?;
        StepError::require_finite(&self.p, Quantity::Momentum)
    }

    /// E_L at this node, with the velocity that p stands for.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn energy<L: Lagrangian<N, Scalar = S>>(&self, system: &L) -> Result<S, StepError> {
        Ok(system.energy(&self.q, &self.velocity(system)?))
    }
}

/// Fails where ∂²L/∂v² is not finite or cannot be inverted.
pub(crate) fn require_regular<S: Scalar, const N: usize>(
    mass_matrix: &SMatrix<S, N, N>,
) -> Result<(), StepError> {
    if let Some(index) = (0..N).find(|&i| mass_matrix.row(i).iter().any(|entry| !entry.is_finite())) {
        return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
    }
    linear::require_regular(mass_matrix)
        .map_err(|singular| StepError::DegenerateLagrangian { column: singular.column })
}
