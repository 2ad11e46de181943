//! The linear-quadratic regulator, step by step and settled.

use anyhow::{Context, Result};
use dalembert::nalgebra::SMatrix;

use super::Linearised;

/// The feedback u = −K x that minimises Σ xᵀQx + uᵀRu from here on, and what that comes to: xᵀPx.
#[derive(Clone, Copy, Debug)]
pub struct Regulator<const X: usize, const M: usize> {
    /// K.
    pub gain: SMatrix<f64, M, X>,
    /// P.
    pub cost: SMatrix<f64, X, X>,
}

impl<const X: usize, const M: usize> Regulator<X, M> {
    /// The regulator one step earlier than one of this `cost`: a step of the Riccati equation.
    ///
    /// # Errors
    /// R + BᵀPB is not positive definite.
    pub fn before(
        cost: &SMatrix<f64, X, X>,
        Linearised { a, b, .. }: &Linearised<X, M>,
        q: &SMatrix<f64, X, X>,
        r: &SMatrix<f64, M, M>,
    ) -> Result<Self> {
        let weight = (r + b.transpose() * cost * b).cholesky();
        let gain = weight.context("R + BᵀPB is not positive definite")?.solve(&(b.transpose() * cost * a));
        let cost = q + a.transpose() * cost * (a - b * gain);
        Ok(Self { gain, cost: (cost + cost.transpose()) * 0.5 })
    }

    /// The regulator of one model for ever.
    ///
    /// # Errors
    /// Those of [`before`](Self::before), or it does not settle: (A, B) cannot be stabilised.
    pub fn of(model: &Linearised<X, M>, q: &SMatrix<f64, X, X>, r: &SMatrix<f64, M, M>) -> Result<Self> {
        let mut cost = *q;
        for _ in 0..100_000 {
            let found = Self::before(&cost, model, q, r)?;
            if !found.cost.sum().is_finite() {
                break;
            }
            if (found.cost - cost).amax() <= 1e-12 * found.cost.amax() {
                return Ok(found);
            }
            cost = found.cost;
        }
        anyhow::bail!("the Riccati equation does not settle: the system cannot be stabilised by this input")
    }
}
