//! A segment (q0, q1) of a discretised system: what is asked of it, or why it has none.

use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use crate::numbers::{CovectorDerivatives, Derivatives, Scalar};
use crate::step::discrete::explained_on;
use crate::step::{
    Discrete, DiscreteForce, DiscreteForceDerivatives, DiscreteRayleigh, LegendreDerivatives, State,
    StepError, require_step_size,
};
use crate::system::Quantity;

/// A segment (q0, q1) of a discretised system, by any rule: [`segment`](crate::Discretised::segment).
///
/// Each object is asked for when it is needed, and is an error where it is not finite: derivatives may not
/// exist where values do.
pub struct DiscreteSegment<'a, L, R, const N: usize>
where
    L: Discrete<R, N>,
{
    system: &'a L,
    rule: PhantomData<fn() -> R>,
    q0: SVector<L::Scalar, N>,
    q1: SVector<L::Scalar, N>,
    h: L::Scalar,
}

impl<'a, L, R, const N: usize> DiscreteSegment<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    pub(super) fn between(
        system: &'a L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Self, StepError> {
        require_step_size(h)?;
        StepError::require_finite(q0, Quantity::Configuration)?;
        StepError::require_finite(q1, Quantity::Configuration)?;
        system.require_segment(q0, q1, h)?;
        Ok(Self { system, rule: PhantomData, q0: *q0, q1: *q1, h })
    }

    /// L_d(q0, q1).
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn discrete_lagrangian(&self) -> Result<L::Scalar, StepError> {
        let value = self.system.discrete_lagrangian(&self.q0, &self.q1, self.h);
        self.required(value, |value| number(*value))
    }

    /// L_d with D1, D2, D11, D12, D22.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn discrete_lagrangian_derivatives(&self) -> Result<Derivatives<L::Scalar, N>, StepError> {
        let l = self.system.discrete_lagrangian_derivatives(&self.q0, &self.q1, self.h);
        self.required(l, derivatives)
    }

    /// f_d = (f_d⁻, f_d⁺); 0 where no force acts.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn discrete_force(&self) -> Result<DiscreteForce<L::Scalar, N>, StepError> {
        let force = self.system.discrete_force(&self.q0, &self.q1, self.h);
        self.required(force, |force| finite(&force.minus).and(finite(&force.plus)))
    }

    /// f_d with its derivatives by q0 and q1.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn discrete_force_derivatives(&self) -> Result<DiscreteForceDerivatives<L::Scalar, N>, StepError> {
        let force = self.system.discrete_force_derivatives(&self.q0, &self.q1, self.h);
        self.required(force, |force| covector(&force.minus).and(covector(&force.plus)))
    }

    /// 𝔽⁻: (q0, −D1 L_d − f_d⁻).
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn legendre_minus(&self) -> Result<State<L::Scalar, N>, StepError> {
        let state = self.system.legendre_minus(&self.q0, &self.q1, self.h);
        self.required(state, |state| finite(&state.p))
    }

    /// 𝔽⁺: (q1, D2 L_d + f_d⁺).
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn legendre_plus(&self) -> Result<State<L::Scalar, N>, StepError> {
        let state = self.system.legendre_plus(&self.q0, &self.q1, self.h);
        self.required(state, |state| finite(&state.p))
    }

    /// Both momenta with their derivatives by q0 and q1.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn legendre_derivatives(&self) -> Result<LegendreDerivatives<L::Scalar, N>, StepError> {
        let k = self.system.legendre_derivatives(&self.q0, &self.q1, self.h);
        self.required(k, |k| {
            let blocks = [&k.p0_by_q0, &k.p0_by_q1, &k.p1_by_q0, &k.p1_by_q1];
            finite(&k.momenta.p0)?;
            finite(&k.momenta.p1)?;
            blocks.into_iter().try_for_each(finite)
        })
    }

    /// Energy on the segment: E_L at the points and velocities that the rule sees.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn energy(&self) -> Result<L::Scalar, StepError> {
        let energy = self.system.segment_energy(&self.q0, &self.q1, self.h);
        self.required(energy, |energy| number(*energy))
    }

    /// R_d with D1, D2, D11, D12, D22.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn discrete_rayleigh_derivatives(&self) -> Result<Derivatives<L::Scalar, N>, StepError>
    where
        L: DiscreteRayleigh<R, N>,
    {
        self.required(self.system.discrete_rayleigh_derivatives(&self.q0, &self.q1, self.h), derivatives)
    }

    fn required<T>(&self, value: T, check: impl FnOnce(&T) -> Result<(), StepError>) -> Result<T, StepError> {
        match check(&value) {
            Ok(()) => Ok(value),
            Err(error) => {
                let v = (self.q1 - self.q0) / self.h;
                Err(explained_on(self.system, &self.q0, &v, self.h, error))
            }
        }
    }
}

fn number<S: Scalar>(value: S) -> Result<(), StepError> {
    finite(&SVector::<S, 1>::new(value))
}

fn finite<S: Scalar, const N: usize, const K: usize>(block: &SMatrix<S, N, K>) -> Result<(), StepError> {
    StepError::require_finite(block, Quantity::Derivatives)
}

fn derivatives<S: Scalar, const N: usize>(of: &Derivatives<S, N>) -> Result<(), StepError> {
    number(of.value)?;
    finite(&of.d1)?;
    finite(&of.d2)?;
    [&of.d11, &of.d12, &of.d22].into_iter().try_for_each(finite)
}

fn covector<S: Scalar, const N: usize>(of: &CovectorDerivatives<S, N>) -> Result<(), StepError> {
    finite(&of.value)?;
    [&of.d1, &of.d2].into_iter().try_for_each(finite)
}
