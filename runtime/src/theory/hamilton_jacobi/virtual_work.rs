//! The virtual work W_k of the discrete force, and the generating functions S_k of a carried section.

use core::num::NonZeroUsize;

use nalgebra::SVector;

use super::{Characteristic, HamiltonJacobi, HamiltonJacobiError};
use crate::numbers::Scalar;
use crate::step::Discrete;
use crate::system::ScalarField;
use crate::theory::legendre::GaussLegendre;

/// W_k of two functions S_k, S_{k+1} at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualWork<S, const N: usize> {
    /// F_k(q), by the minus transform from dS_k(q).
    pub q1: SVector<S, N>,
    /// W_k(q) = S_{k+1}(F_k(q)) − S_k(q) − L_d(q, F_k(q)), in units of action.
    pub value: S,
}

/// The generating functions of a section carried by the flow, along one characteristic.
#[derive(Clone, Debug, PartialEq)]
pub struct CarriedGeneratingFunction<S, const N: usize> {
    /// The characteristic c_k, from the label asked for.
    pub characteristic: Characteristic<S, N>,
    /// S_k(c_k), k = 0 … K.
    pub values: Vec<S>,
    /// W_k(c_k), k = 0 … K − 1, 0 on the reference characteristic.
    pub virtual_work: Vec<S>,
    /// Estimated quadrature error of the last S_k: the difference from a rule of half as many nodes.
    pub quadrature_error: f64,
}

impl<S, L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    S: Scalar,
    L: Discrete<R, N, Scalar = S>,
{
    /// W_k(q) of the functions S_k = `s0` and S_{k+1} = `s1`.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] if the step from (q, dS_k(q)) has no solution.
    pub fn virtual_work<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        s1: &F,
        q: &SVector<S, N>,
    ) -> Result<VirtualWork<S, N>, HamiltonJacobiError> {
        let q1 = self.step(q, &s0.gradient(q), None)?.q;
        let value = s1.value(&q1) - s0.value(q) - self.by.objects(q, &q1).lagrangian();
        Ok(VirtualWork { q1, value })
    }

    /// S_k along the characteristic from `label`, for the section carried from γ_0 = dS_0, S_0 = `s0`.
    ///
    /// W_k is found as a function of the label x, by quadrature along the straight line from `reference` to
    /// `label`:
    ///
    /// ```text
    /// S_{k+1}(c_{k+1}(x)) = S_k(c_k(x)) + L_d(c_k, c_{k+1}) + W_k(c_k(x)),     W_k = 0 on the reference characteristic
    /// d(W_k ∘ c_k) = Q_kᵀ f_d⁻ + Q_{k+1}ᵀ f_d⁺                                   Q_k = ∂c_k/∂x
    /// ```
    ///
    /// S_k goes on through caustics, as a function of the label, since nothing is divided by det Q_k. Where
    /// the section is not closed (n > 1), the value depends on the path of labels. `nodes` Gauss–Legendre
    /// nodes are used; each carries its own characteristic.
    ///
    /// # Errors
    /// Those of [`carry`](Self::carry), for any of the characteristics.
    pub fn carried_generating_function<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        reference: &SVector<S, N>,
        label: &SVector<S, N>,
        steps: usize,
        nodes: NonZeroUsize,
    ) -> Result<CarriedGeneratingFunction<S, N>, HamiltonJacobiError> {
        let characteristic = self.carry(s0, label, steps)?;
        let virtual_work = self.work_between(s0, reference, label, steps, nodes)?;
        let half = NonZeroUsize::MIN.saturating_add(nodes.get() / 2);
        let coarse = self.work_between(s0, reference, label, steps, half)?;
        let difference = virtual_work.iter().zip(&coarse).fold(S::zero(), |sum, (a, b)| sum + *a - *b);
        let mut values = vec![s0.value(label)];
        for (k, work) in virtual_work.iter().enumerate() {
            let [from, to] = [characteristic.states[k].q, characteristic.states[k + 1].q];
            values.push(
                values[k] + self.in_step(k, |theory| theory.by.objects(&from, &to).lagrangian()) + *work,
            );
        }
        Ok(CarriedGeneratingFunction {
            characteristic,
            values,
            virtual_work,
            quadrature_error: difference.widen().abs(),
        })
    }

    /// ∫ (Q_kᵀ f_d⁻ + Q_{k+1}ᵀ f_d⁺)·dx over the labels from `reference` to `label`, for every k.
    fn work_between<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        reference: &SVector<S, N>,
        label: &SVector<S, N>,
        steps: usize,
        nodes: NonZeroUsize,
    ) -> Result<Vec<S>, HamiltonJacobiError> {
        let across = label - reference;
        let mut work = vec![S::zero(); steps];
        for (share, weight) in GaussLegendre::new(nodes).nodes {
            let share = S::constant(share);
            let characteristic = self.carry(s0, &(reference + across * share), steps)?;
            for (k, work) in work.iter_mut().enumerate() {
                let density = self.work_covector(&characteristic, k).dot(&across);
                *work += density * S::constant(weight);
            }
        }
        Ok(work)
    }

    /// d(W_k ∘ c_k) = Q_kᵀ f_d⁻ + Q_{k+1}ᵀ f_d⁺, a covector on the labels.
    fn work_covector(&self, characteristic: &Characteristic<S, N>, k: usize) -> SVector<S, N> {
        let [from, to] = [&characteristic.states[k].q, &characteristic.states[k + 1].q];
        let f = self.in_step(k, |theory| theory.by.objects(from, to).force());
        characteristic.frames[k].q.tr_mul(&f.minus) + characteristic.frames[k + 1].q.tr_mul(&f.plus)
    }
}
