//! The discrete objects as checkers ask for them: numbers, NaN where there are none, so that a checker names
//! the sample at which a number is none.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{CovectorDerivatives, Derivatives, Scalar};
use crate::step::{
    Defect, Discrete, DiscreteForce, DiscreteForceDerivatives, DiscreteObjects, Discretised,
    LegendreDerivatives, Momenta, Segment,
};
use crate::system::VectorField;

/// The discrete objects on one segment, solved for once where the rule has points within it.
pub(crate) struct Objects<'a, L: Discrete<R, N> + 'a, R, const N: usize>(Option<L::On<'a>>);

impl<'a, L: Discrete<R, N>, R, const N: usize> Discretised<'a, L, R, N> {
    /// The discrete objects on the segment from q0 to q1.
    pub(crate) fn objects(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Objects<'a, L, R, N> {
        Objects(self.system.on(&Segment::between(q0, q1, self.h)).ok())
    }
}

impl<L: Discrete<R, N>, R, const N: usize> Objects<'_, L, R, N> {
    /// L_d.
    pub(crate) fn lagrangian(&self) -> L::Scalar {
        self.0.as_ref().map_or(nan(), DiscreteObjects::discrete_lagrangian)
    }

    /// L_d with D1, D2, D11, D12, D22.
    pub(crate) fn lagrangian_derivatives(&self) -> Derivatives<L::Scalar, N> {
        let found = self.0.as_ref().and_then(|on| on.discrete_lagrangian_derivatives().ok());
        found.unwrap_or(Derivatives {
            value: nan(),
            d1: vector(),
            d2: vector(),
            d11: matrix(),
            d12: matrix(),
            d22: matrix(),
        })
    }

    /// f_d.
    pub(crate) fn force(&self) -> DiscreteForce<L::Scalar, N> {
        let found = self.0.as_ref().and_then(|on| on.discrete_force().ok());
        found.unwrap_or(DiscreteForce { minus: vector(), plus: vector() })
    }

    /// f_d with its derivatives.
    pub(crate) fn force_derivatives(&self) -> DiscreteForceDerivatives<L::Scalar, N> {
        let found = self.0.as_ref().and_then(|on| on.discrete_force_derivatives().ok());
        let none = || CovectorDerivatives { value: vector(), d1: matrix(), d2: matrix() };
        found.unwrap_or_else(|| DiscreteForceDerivatives { minus: none(), plus: none() })
    }

    /// p0 and p1.
    pub(crate) fn momenta(&self) -> Momenta<L::Scalar, N> {
        let none = Momenta { p0: vector(), p1: vector() };
        self.0.as_ref().map_or(none, DiscreteObjects::momenta)
    }

    /// Both momenta with their derivatives by q0 and q1.
    pub(crate) fn legendre(&self) -> LegendreDerivatives<L::Scalar, N> {
        let found = self.0.as_ref().and_then(|on| on.legendre_derivatives().ok());
        found.unwrap_or_else(|| LegendreDerivatives {
            momenta: self.momenta(),
            p0_by_q0: matrix(),
            p0_by_q1: matrix(),
            p1_by_q0: matrix(),
            p1_by_q1: matrix(),
        })
    }

    /// [`DiscreteObjects::defect`].
    pub(crate) fn defect(
        &self,
        xi: &dyn VectorField<N, Scalar = L::Scalar>,
    ) -> (Defect<L::Scalar>, Defect<L::Scalar>) {
        let none = Defect { lagrangian: nan(), force: nan(), interior: nan() };
        self.0.as_ref().and_then(|on| on.defect(xi).ok()).unwrap_or((none, none))
    }

    /// [`DiscreteObjects::force_contraction`]: one component that is none, where it is none.
    pub(crate) fn force_contraction(
        &self,
        xi: &dyn VectorField<N, Scalar = L::Scalar>,
        component: &mut dyn FnMut(L::Scalar, L::Scalar),
    ) {
        let found = self.0.as_ref().and_then(|on| on.force_contraction(xi, component).ok());
        if found.is_none() {
            component(nan(), nan());
        }
    }
}

/// Left side of the forced discrete Euler–Lagrange equation at q1, 0 along solutions.
///
/// Of a system at a time t, a view, the second segment is that of t + h.
pub(crate) fn del_residual<L: Discrete<R, N>, R, const N: usize>(
    by: &Discretised<'_, L, R, N>,
    q0: &SVector<L::Scalar, N>,
    q1: &SVector<L::Scalar, N>,
    q2: &SVector<L::Scalar, N>,
) -> SVector<L::Scalar, N> {
    let after = by.system.later(by.h, |system| by.of(system).objects(q1, q2).momenta().p0);
    by.objects(q0, q1).momenta().p1 - after
}

fn nan<S: Scalar>() -> S {
    S::constant(f64::NAN)
}

fn vector<S: Scalar, const N: usize>() -> SVector<S, N> {
    SVector::repeat(nan())
}

fn matrix<S: Scalar, const N: usize>() -> SMatrix<S, N, N> {
    SMatrix::repeat(nan())
}
