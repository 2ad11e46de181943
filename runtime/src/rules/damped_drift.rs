//! Free motion under linear damping, exactly: functions of Z = ½h M⁻¹C.
//!
//! ```text
//! M = W Wᵀ,  ½hC = W Λ Wᵀ,   M f(Z) = W f(Λ) Wᵀ,   f(Z)ᵀ = W f(Λ) W⁻¹
//! ```
//!
//! W from the Cholesky factor of M and the eigenvectors of a symmetric matrix, by Jacobi's rotations: own
//! code because a step must neither panic nor allocate, for any N; on arrays, where the compiler sees at
//! every opt-level that no index is out of bounds.

use core::array;
use core::cmp::Ordering;
use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::cause::cause_of;
use crate::step::equation::{Equation, StepEquation};
use crate::step::{
    BoundedStep, Fused, Momenta, Quantity, Segment, State, Step, StepError, StepKernel, step_by,
    step_within_by,
};
use crate::system::{GeneratedDiffers, Lagrangian, Rayleigh};

/// The matrices of a damped free segment, and the terms of first degree: what a step by a fitted rule needs
/// of the system, but for the potential. They depend on h alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DampedDrift<S, const N: usize> {
    /// M(Z coth Z + Z): p0 per unit of v̄.
    pub(crate) before: SMatrix<S, N, N>,
    /// M(Z coth Z − Z): p1 per unit of v̄.
    pub(crate) after: SMatrix<S, N, N>,
    /// I + ℒ(Z)ᵀ, with the Langevin function ℒ(z) = coth z − 1/z.
    pub(super) lag_plus: SMatrix<S, N, N>,
    /// I − ℒ(Z)ᵀ.
    pub(super) lag_minus: SMatrix<S, N, N>,
    /// ∂L/∂v at v = 0.
    pub(crate) shift: SVector<S, N>,
    /// ∂R/∂v at v = 0.
    pub(crate) thrust: SVector<S, N>,
}

impl<S: Scalar, const N: usize> DampedDrift<S, N> {
    /// Of a system with constant ∂²L/∂v², positive definite, and constant ∂²R/∂v². NaN where M is not
    /// positive definite.
    #[inline]
    pub(crate) fn of<L: Rayleigh<N, Scalar = S> + ?Sized>(system: &L, q: &SVector<S, N>, h: S) -> Self {
        let rest = nalgebra::zero();
        let (l, r) = (system.lagrangian_derivatives(q, &rest), system.rayleigh_derivatives(q, &rest));
        let (w, inverse, z) = modes(&l.d22, &(r.d22 * (h * S::constant(0.5))));
        let symmetric = |f: fn(S) -> S| w * SMatrix::from_diagonal(&z.map(f)) * w.transpose();
        let transposed = |f: fn(S) -> S| w * SMatrix::from_diagonal(&z.map(f)) * inverse;
        Self {
            before: symmetric(before),
            after: symmetric(after),
            lag_plus: transposed(lag_plus),
            lag_minus: transposed(lag_minus),
            shift: l.d2,
            thrust: r.d2,
        }
    }

    /// −∇V − ∂R/∂v(0): the force that depends on q, and what friction adds at rest.
    #[inline]
    pub(crate) fn configuration_force<L: Rayleigh<N, Scalar = S> + ?Sized>(
        &self,
        system: &L,
        q: &SVector<S, N>,
    ) -> SVector<S, N> {
        system.lagrangian_gradient(q, &nalgebra::zero()).d1 - self.thrust
    }

    /// M Z coth Z, the fitted mass.
    #[inline]
    pub(super) fn mass(&self) -> SMatrix<S, N, N> {
        (self.before + self.after) * S::constant(0.5)
    }
}

/// A damped free motion: q += `displacement` p and p += `loss` p, with matrices, or their diagonals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drift<M> {
    /// τ M⁻¹ϕ(τCM⁻¹), with ϕ(z) = (1 − e⁻ᶻ)/z.
    pub(crate) displacement: M,
    /// exp(−τCM⁻¹) − I: exactly 0 without damping.
    pub(crate) loss: M,
}

impl<S: Scalar> Drift<S> {
    /// Of mass 1 under damping `rate`.
    fn of_unit_mass(rate: S, time: S) -> Self {
        let loss = (-rate * time).exp_m1();
        Self { displacement: if loss == S::zero() { time } else { -loss / rate }, loss }
    }
}

impl<S: Scalar, const N: usize> Drift<SVector<S, N>> {
    /// Of the diagonals of matrices that have nothing else.
    pub(crate) fn of_diagonal(mass: &SVector<S, N>, damping: &SVector<S, N>, time: S) -> Self {
        let drifts = mass.zip_map(damping, |mass, damping| Drift::of_unit_mass(damping / mass, time));
        Self {
            displacement: drifts.zip_map(mass, |drift, mass| drift.displacement / mass),
            loss: drifts.map(|drift| drift.loss),
        }
    }
}

impl<S: Scalar, const N: usize> Drift<SMatrix<S, N, N>> {
    /// Of symmetric matrices, given W, W⁻¹ and Λ with M = W Wᵀ and C = W Λ Wᵀ.
    pub(crate) fn of_modes(
        (w, inverse, rates): &(SMatrix<S, N, N>, SMatrix<S, N, N>, SVector<S, N>),
        time: S,
    ) -> Self {
        let drifts = rates.map(|rate| Drift::of_unit_mass(rate, time));
        let displacement =
            inverse.transpose() * SMatrix::from_diagonal(&drifts.map(|drift| drift.displacement)) * inverse;
        Self {
            // Rounding must not take the symmetry, and with it that without damping the motion is symplectic.
            displacement: (displacement + displacement.transpose()) * S::constant(0.5),
            loss: w * SMatrix::from_diagonal(&drifts.map(|drift| drift.loss)) * inverse,
        }
    }
}

/// A rule fitted to linear damping: its equation, given the free motion.
pub(crate) trait ByDrift: Sized {
    /// The kind of the step's equation: linear in v̄, or general.
    const EQUATION: Equation;

    /// Where on the segment L is evaluated, as shares of it.
    const NODES: &'static [f64];

    /// p0 and ∂p0/∂v̄.
    fn kernel<L: Rayleigh<N> + ?Sized, const N: usize>(
        drift: &DampedDrift<L::Scalar, N>,
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> StepKernel<L::Scalar, N>;

    /// p0 and p1.
    fn momenta<L: Rayleigh<N> + ?Sized, const N: usize>(
        drift: &DampedDrift<L::Scalar, N>,
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Momenta<L::Scalar, N>;

    /// The step from `state`.
    #[inline]
    fn step_by<L: Fused<Self, N> + Rayleigh<N> + ?Sized, const N: usize>(
        drift: &DampedDrift<L::Scalar, N>,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let equation = Drifting::<L, Self, N> { drift, system, rule: PhantomData };
        let step =
            step_by(system, &equation, state, h, guess).map_err(|error| of_mass(system, &state.q, error));
        if cfg!(debug_assertions)
            && let Ok(step) = &step
        {
            Self::verify(system, state, step, h)?;
        }
        step
    }

    /// Verifies the system at the nodes of `step` from `state`.
    fn verify<L: Rayleigh<N> + ?Sized, const N: usize>(
        system: &L,
        state: &State<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<(), GeneratedDiffers> {
        Self::NODES.iter().try_for_each(|&share| {
            let q = state.q + step.velocity * (h * L::Scalar::constant(share));
            system.verify_generated(&q, &step.velocity)
        })
    }

    /// The cause of numbers that are not finite, by what has no derivative at rest: at the start, where the
    /// free motion is taken from, or at a node.
    #[cold]
    fn cause<L: Lagrangian<N> + ?Sized, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Option<StepError> {
        let at = |share: f64| {
            system.without_derivative(&segment.at(L::Scalar::constant(share)), &nalgebra::zero())
        };
        if cfg!(feature = "std") {
            cause_of(system, at(0.0).or_else(|| Self::NODES.iter().find_map(|&share| at(share))))
        } else {
            None
        }
    }

    /// The step by a bounded number of iterations.
    fn step_within_by<L: Fused<Self, N> + Rayleigh<N> + ?Sized, const N: usize>(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError> {
        let drift = DampedDrift::of(system, &state.q, h);
        let equation = Drifting::<L, Self, N> { drift: &drift, system, rule: PhantomData };
        let bounded = step_within_by(system, &equation, state, h, guess, iterations)
            .map_err(|error| of_mass(system, &state.q, error));
        if cfg!(debug_assertions)
            && let Ok(bounded) = &bounded
        {
            Self::verify(system, state, &bounded.step, h)?;
        }
        bounded
    }
}

/// The equation of a step by a fitted rule, with the drift of the whole step, also in parts of it.
struct Drifting<'a, L: Rayleigh<N> + ?Sized, R, const N: usize> {
    drift: &'a DampedDrift<L::Scalar, N>,
    system: &'a L,
    rule: PhantomData<fn() -> R>,
}

impl<L, R, const N: usize> StepEquation<L::Scalar, N> for Drifting<'_, L, R, N>
where
    L: Fused<R, N> + Rayleigh<N> + ?Sized,
    R: ByDrift,
{
    type Matrix = SMatrix<L::Scalar, N, N>;

    #[inline]
    fn kernel(&self, segment: &Segment<L::Scalar, N>) -> StepKernel<L::Scalar, N> {
        R::kernel(self.drift, self.system, segment)
    }

    #[inline]
    fn momenta(&self, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N> {
        R::momenta(self.drift, self.system, segment)
    }

    /// Under damping that excites, what is left of M in p0 is below any share of it.
    #[inline]
    fn inertia(&self, _: &Segment<L::Scalar, N>) -> SMatrix<L::Scalar, N, N> {
        self.drift.before
    }

    #[inline]
    fn cancelling(&self, segment: &Segment<L::Scalar, N>) -> SVector<L::Scalar, N> {
        Fused::<R, N>::cancelling_terms(self.system, segment)
    }

    #[inline]
    fn kind(&self) -> Equation {
        R::EQUATION
    }

    #[inline]
    fn cause(&self, segment: &Segment<L::Scalar, N>) -> Option<StepError> {
        R::cause(self.system, segment)
    }
}

/// Replaces an error of derivatives that are no numbers by the error of M at (q, 0), if it has one:
/// [`require_positive_definite`].
#[cold]
fn of_mass<L: Rayleigh<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    error: StepError,
) -> StepError {
    match error {
        StepError::NonFinite { quantity: Quantity::Derivatives, .. } => {
            require_positive_definite(&system.lagrangian_derivatives(q, &nalgebra::zero()).d22)
                .err()
                .unwrap_or(error)
        }
        other => other,
    }
}

/// Fails where a finite `mass` has no Cholesky factor.
#[cold]
pub(crate) fn require_positive_definite<S: Scalar, const N: usize>(
    mass: &SMatrix<S, N, N>,
) -> Result<(), StepError> {
    if let Some(index) = (0..N).find(|&i| !NewtonMatrix::row_is_finite(mass, i)) {
        return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
    }
    let factor = cholesky(mass);
    match factor.iter().enumerate().position(|(i, row)| !row.get(i).is_some_and(|pivot| pivot.is_finite())) {
        Some(column) => Err(StepError::MassNotPositiveDefinite { column }),
        None => Ok(()),
    }
}

/// z coth z + z = 2z/(1 − e^{−2z}).
fn before<S: Scalar>(z: S) -> S {
    after(-z)
}

/// z coth z − z = 2z/(e^{2z} − 1).
fn after<S: Scalar>(z: S) -> S {
    let twice = z + z;
    if z == S::zero() { S::one() } else { twice / twice.exp_m1() }
}

/// 1 + ℒ(z).
fn lag_plus<S: Scalar>(z: S) -> S {
    if z.abs() > S::one() { (before(z) - S::one()) / z } else { S::one() + langevin(z) }
}

/// 1 − ℒ(z).
fn lag_minus<S: Scalar>(z: S) -> S {
    lag_plus(-z)
}

/// ℒ(z) = coth z − 1/z = z/(3 + z²/(5 + z²/(7 + …))) for |z| ≤ 1.
fn langevin<S: Scalar>(z: S) -> S {
    let mut tail = S::constant(21.0);
    for odd in [19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0] {
        tail = S::constant(odd) + z * z / tail;
    }
    z / tail
}

/// W, W⁻¹ and λ with `mass` = W Wᵀ and `damping` = W diag(λ) Wᵀ.
pub(crate) fn modes<S: Scalar, const N: usize>(
    mass: &SMatrix<S, N, N>,
    damping: &SMatrix<S, N, N>,
) -> (SMatrix<S, N, N>, SMatrix<S, N, N>, SVector<S, N>) {
    let l = cholesky(mass);
    // The rows of L⁻¹ by forward substitution.
    let mut inverse = [[S::zero(); N]; N];
    for (i, factors) in l.iter().enumerate() {
        let mut row = [S::zero(); N];
        row[i] = S::one();
        for (known, &factor) in inverse.iter().zip(factors).take(i) {
            for (entry, &other) in row.iter_mut().zip(known) {
                *entry -= factor * other;
            }
        }
        inverse[i] = row.map(|entry| entry / factors[i]);
    }
    // Arrays of rows are matrices of columns.
    let (l, inverse) =
        (SMatrix::<S, N, N>::from(l).transpose(), SMatrix::<S, N, N>::from(inverse).transpose());
    let (rotation, eigenvalues) = jacobi(inverse * damping * inverse.transpose());
    (l * rotation, rotation.transpose() * inverse, eigenvalues)
}

/// The rows of the lower triangular L with `matrix` = L Lᵀ.
fn cholesky<S: Scalar, const N: usize>(matrix: &SMatrix<S, N, N>) -> [[S; N]; N] {
    let mut rows = [[S::zero(); N]; N];
    for (i, entries) in matrix.data.0.iter().enumerate() {
        let mut row = [S::zero(); N];
        let mut left = entries[i];
        for (j, known) in rows.iter().enumerate().take(i) {
            let sum = row.iter().zip(known).take(j).fold(entries[j], |sum, (&a, &b)| sum - a * b);
            row[j] = sum / known[j];
            left -= row[j] * row[j];
        }
        row[i] = if left > S::zero() { left.sqrt() } else { S::zero() / S::zero() };
        rows[i] = row;
    }
    rows
}

/// More sweeps than any matrix needs: convergence is quadratic.
const SWEEPS: usize = 30;

/// Eigenvectors (columns) and eigenvalues of a symmetric matrix (C. G. J. Jacobi, 1846).
fn jacobi<S: Scalar, const N: usize>(matrix: SMatrix<S, N, N>) -> (SMatrix<S, N, N>, SVector<S, N>) {
    let (mut a, mut vectors) = (matrix.data.0, SMatrix::<S, N, N>::identity().data.0);
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for j in 0..N {
            for i in (0..N).take(j) {
                let (off, ii, jj) = (a[j][i], a[i][i], a[j][j]);
                // Below the rounding of both diagonal entries nothing is left to rotate; a NaN is left alone.
                let least = S::EPSILON * S::constant(0.25) * (ii.abs() * jj.abs()).sqrt();
                if off.abs().partial_cmp(&least) != Some(Ordering::Greater) {
                    continue;
                }
                rotated = true;
                let theta = (jj - ii) / (off + off);
                let t = if theta == S::zero() {
                    S::one()
                } else {
                    theta.signum() / (theta.abs() + (theta * theta + S::one()).sqrt())
                };
                let c = S::one() / (t * t + S::one()).sqrt();
                let s = t * c;
                let turn = |x: &mut S, y: &mut S| (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
                for columns in [&mut a, &mut vectors] {
                    if let Ok([x, y]) = columns.get_disjoint_mut([i, j]) {
                        x.iter_mut().zip(y).for_each(|(x, y)| turn(x, y));
                    }
                }
                for column in &mut a {
                    if let Ok([x, y]) = column.get_disjoint_mut([i, j]) {
                        turn(x, y);
                    }
                }
            }
        }
        if !rotated {
            break;
        }
    }
    let eigenvalues: [S; N] = array::from_fn(|i| a[i][i]);
    (vectors.into(), eigenvalues.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::matrix;

    #[test]
    fn functions_of_one_number() {
        // By hand: coth 2 = 1.0373147207275481.
        let coth = 1.037_314_720_727_548_1;
        assert!((before(2.0_f64) - 2.0 * (coth + 1.0)).abs() < 4e-15);
        assert!((after(2.0_f64) - 2.0 * (coth - 1.0)).abs() < 1e-15);
        assert!(
            (lag_plus(2.0_f64) - (0.5 + coth)).abs() < 1e-15
                && (lag_minus(2.0_f64) - (1.5 - coth)).abs() < 1e-15
        );
        for z in [1e-200, 1e-9, 0.3, 0.999, 1.001, 3.0, 40.0, 1e3, 1e200_f64] {
            assert!((lag_plus(z) + lag_minus(z) - 2.0).abs() < 1e-15, "{z:e}");
            assert!(((before(z) - after(z)) / (2.0 * z) - 1.0).abs() < 1e-15 / z.min(1.0), "{z:e}");
            assert_eq!((before(-z), lag_plus(-z)), (after(z), lag_minus(z)));
        }
        assert_eq!((before(0.0), lag_plus(0.0)), (1.0, 1.0));
        // The branches meet.
        assert!((lag_plus(1.0_f64) - lag_plus(1.0 + 1e-12)).abs() < 1e-12);
    }

    #[test]
    fn modes_of_a_pair_of_matrices() {
        let mass = matrix![2.0, 0.5, 0.1; 0.5, 1.0, 0.2; 0.1, 0.2, 3.0];
        let damping = matrix![1.0, -0.4, 0.0; -0.4, 1e3, 0.7; 0.0, 0.7, 1e-3];
        let (w, inverse, z) = modes(&mass, &damping);
        assert!((w * w.transpose() - mass).amax() < 1e-14);
        assert!((w * SMatrix::from_diagonal(&z) * w.transpose() - damping).amax() < 1e-11);
        assert!((w * inverse - SMatrix::identity()).amax() < 1e-13);
        // No positive definite mass, no modes.
        assert!(modes(&matrix![1.0, 2.0; 2.0, 1.0], &SMatrix::identity()).0.iter().any(|w: &f64| w.is_nan()));
    }
}
