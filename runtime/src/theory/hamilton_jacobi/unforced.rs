//! The right equation for all q: what a family that satisfies it everywhere solves.

use core::fmt;

use nalgebra::SVector;

use super::printed_report::require_lengths;
use super::residual::{MomentumMagnitudes, Outcome, Worst, line, tolerance_line};
use super::{HamiltonJacobi, HamiltonJacobiError, section};
use crate::numbers::Scalar;
use crate::step::Discrete;
use crate::system::ScalarField;
use crate::theory::objects::del_residual;

/// The right equation as an equation of functions, q_{k+1} given by γ⁺ = 𝔽⁺.
///
/// ```text
/// γ⁺ = 𝔽⁺      DS_{k+1}(x) + f_d⁺(q, x) = D2 L_d(q, x) + f_d⁺(q, x): the force drops out
/// right        S_{k+1}(x) − S_k(q) = L_d(q, x) for all q;  its derivative by q is  DS_k(q) = −D1 L_d(q, x)
/// hence        D2 L_d(q, x) + D1 L_d(x, y) = 0: the points solve the unforced Euler–Lagrange equations
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RightEquationReport<const N: usize> {
    /// S_{k+1}(x) − S_k(q) = L_d(q, x).
    pub right_equation: Outcome<N>,
    /// Its derivative, DS_k(q) = −D1 L_d(q, x).
    pub derivative: Outcome<N>,
    /// The unforced Euler–Lagrange equation of the points q, x, y.
    pub unforced: Outcome<N>,
    /// The forced one.
    pub forced: Outcome<N>,
    /// Relative tolerance used.
    pub relative: f64,
}

impl<S, L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    S: Scalar,
    L: Discrete<R, N, Scalar = S>,
{
    /// Evaluates the right equation as an equation of functions: at every sample q for every k of the family.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::FamilyLength`] for fewer than three functions,
    /// [`HamiltonJacobiError::TooFewPoints`] without samples.
    pub fn right_equation_everywhere<F: ScalarField<N, Scalar = S>>(
        &self,
        family: &[F],
        samples: &[SVector<S, N>],
    ) -> Result<RightEquationReport<N>, HamiltonJacobiError> {
        if samples.is_empty() {
            return Err(HamiltonJacobiError::TooFewPoints { needed: 1, found: 0 });
        }
        require_lengths(family.len(), 3, 3)?;
        let new = || Worst::new(self.relative);
        let [mut right, mut derivative, mut unforced, mut forced] = [new(), new(), new(), new()];
        for (k, s) in family.windows(3).enumerate() {
            for q in samples {
                let first = self.at_step(k, |theory| theory.right_characteristic(&s[1], q, None))?;
                let chain = first.and_then(|x| {
                    let guess = self.mean_velocity(q, &x);
                    let y =
                        self.in_step(k + 1, |theory| theory.right_characteristic(&s[2], &x, Some(&guess)))?;
                    Ok((x, y))
                });
                let (x, y) = match chain {
                    Ok(points) => points,
                    Err(error) => {
                        for worst in [&mut right, &mut derivative, &mut unforced, &mut forced] {
                            worst.failure(error);
                        }
                        continue;
                    }
                };
                let (increment, before, l, unforced_here, forced_here) = self.in_step(k, |theory| {
                    (
                        theory.action_increment(&s[0], &s[1], q, &x),
                        theory.legendre(q, &x),
                        theory.by.objects(q, &x).lagrangian_derivatives(),
                        theory.unforced_residual(q, &x, &y),
                        del_residual(&theory.by, q, &x, &y),
                    )
                });
                let after = self.in_step(k + 1, |theory| theory.legendre(&x, &y));
                right.number(k, q, increment.value, increment.magnitude, increment.magnitude);
                let (first, second) =
                    (MomentumMagnitudes::of(&before, q, &x), MomentumMagnitudes::of(&after, &x, &y));
                let terms = first.p0 + s[0].gradient(q).abs();
                let magnitude = first.p0 + section::magnitude(&s[0], q);
                derivative.vector(k, q, &(s[0].gradient(q) + l.d1), &terms, &magnitude);
                let magnitude = first.p1 + second.p0 + section::magnitude(&s[1], &x);
                let terms = first.p1 + second.p0;
                unforced.vector(k, q, &unforced_here, &terms, &magnitude);
                forced.vector(k, q, &forced_here, &terms, &magnitude);
            }
        }
        Ok(RightEquationReport {
            right_equation: right.outcome(),
            derivative: derivative.outcome(),
            unforced: unforced.outcome(),
            forced: forced.outcome(),
            relative: self.relative,
        })
    }
}

impl<const N: usize> fmt::Display for RightEquationReport<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "right equation for all q, x by γ⁺ = 𝔽⁺")?;
        line(f, "S_{k+1}(x) − S_k(q) = L_d(q, x)", &self.right_equation)?;
        line(f, "its derivative DS_k(q) = −D1 L_d(q, x)", &self.derivative)?;
        line(f, "unforced discrete Euler–Lagrange equation", &self.unforced)?;
        line(f, "forced discrete Euler–Lagrange equation", &self.forced)?;
        tolerance_line(f, self.relative)
    }
}
