//! Families S_0(q; λ) carried by conformally symplectic steps: Jacobi's constants, and the motion from them.

use nalgebra::{SMatrix, SVector};

use super::conformal::{newton, size};
use super::{
    Characteristic, ConformalHamiltonJacobi, FamilyMember, Frame, GeneratingFamily, HamiltonJacobiError,
};
use crate::numbers::{Scalar, determinant_sign};
use crate::step::{Flow, PhaseMatrix, State, invert};
use crate::system::ScalarField;
use crate::theory::verdict::largest;

/// c^{−k} ∂S_k/∂λ along one trajectory with p = ∂S/∂q.
#[derive(Clone, Debug, PartialEq)]
pub struct JacobiConstants<S, const N: usize> {
    /// The trajectory, with frames and caustics.
    pub characteristic: Characteristic<S, N>,
    /// c^{−k} ∂S_k/∂λ at c_k, k = 0 … K.
    pub values: Vec<SVector<f64, N>>,
    /// Estimated error of the worst of them: by how much the last halving of the spacing of λ changed it.
    pub difference_error: f64,
}

impl<S: Scalar, const N: usize> JacobiConstants<S, N> {
    /// How far they are from constant: the largest difference from those of k = 0.
    #[must_use]
    pub fn drift(&self) -> f64 {
        self.values.iter().fold(0.0, |drift, values| drift.max((values - self.values[0]).amax()))
    }
}

/// Weights of the central difference of order 8.
const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Halvings of the spacing at most: what is left to gain then is below rounding.
const HALVINGS: usize = 8;

/// Rounding of a value of S_k, in units of ε.
const ROUNDINGS: f64 = 4.0;

/// c^{−k} ∂S_k/∂λ as measured.
#[derive(Clone, Copy)]
struct Measured<const N: usize> {
    value: SVector<f64, N>,
    /// Estimated, but for the rounding of S_k.
    error: f64,
    /// The error of the value from the rounding of S_k.
    rounding: f64,
}

/// **Jacobi's theorem under friction.** Along trajectories with p = ∂S_k/∂q the c^{−k} ∂S_k/∂λ are constant.
/// Where det ∂²S_0/∂q∂λ ≠ 0, these constants and λ are 2n coordinates on the motions, and
///
/// ```text
/// c^{−k} ∂S_k/∂λ(q_k; λ) = b,     p_k = ∂S_k/∂q(q_k; λ)
/// ```
///
/// gives the motion: from the functions S_k alone, whatever they were found by.
///
/// *Proof.* Differentiating S_{k+1}(F_k(q; λ); λ) = c S_k(q; λ) + G(q, F_k(q; λ)) by λ at fixed q, the terms
/// with ∂F_k/∂λ cancel, since ∂S_{k+1}/∂q = D2G there. And Q_kᵀ ∂²S_k/∂q∂λ = c^k ∂²S_0/∂q∂λ: what is regular
/// stays so, outside caustics. ∎
///
/// ∂S_k/∂λ at fixed q is measured here, by central differences of order 8 of the values of S_k, each at its
/// own label: nothing of the theorem is put in. `width` is the spacing of λ to begin with; it is halved until
/// the value settles, as near a caustic it does late. A twentieth of the λ is a good one.
impl<S, L, M, const N: usize> ConformalHamiltonJacobi<'_, L, M, N>
where
    S: Scalar,
    L: Flow<M, N, Scalar = S>,
{
    /// c^{−k} ∂S_k/∂λ along the trajectory from `label`, k = 0 … `steps`.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::DegenerateFamily`], [`HamiltonJacobiError::Caustic`] if det Q_k = 0 at a node,
    /// [`HamiltonJacobiError::Unsettled`] if it nearly is,
    /// and those of [`through`](Self::through), for any of the labels.
    pub fn jacobi_constants<F>(
        &self,
        family: &F,
        lambda: &SVector<S, N>,
        label: &SVector<S, N>,
        steps: usize,
        width: S,
    ) -> Result<JacobiConstants<S, N>, HamiltonJacobiError>
    where
        F: GeneratingFamily<N, Scalar = S>,
    {
        require_regular(family, label, lambda)?;
        let characteristic = self.characteristic(&FamilyMember { family, lambda: *lambda }, label, steps)?;
        let mut values = vec![family.by_parameters(label, lambda).map(Scalar::widen)];
        let mut difference_error = 0.0;
        for k in 1..=steps {
            let found = self.scaled_by_parameters(family, lambda, (label, k), width)?;
            values.push(found.value);
            difference_error = largest([difference_error, found.error]);
        }
        Ok(JacobiConstants { characteristic, values, difference_error })
    }

    /// The state after `steps` steps of the motion with the parameters `lambda` and the constants `b` =
    /// c^{−k} ∂S_k/∂λ: the equation is solved for q_k by Newton's method along characteristics, from the one
    /// with the label `near`.
    ///
    /// The equation is one for q_k; it is solved for the label that q_k is a function of, so that
    /// caustics before step k do no harm.
    ///
    /// # Errors
    /// Those of [`jacobi_constants`](Self::jacobi_constants); [`HamiltonJacobiError::NoLabel`] if no state
    /// has these constants near by.
    pub fn integrate<F>(
        &self,
        family: &F,
        (lambda, b): (&SVector<S, N>, &SVector<S, N>),
        steps: usize,
        near: &SVector<S, N>,
        width: S,
    ) -> Result<State<S, N>, HamiltonJacobiError>
    where
        F: GeneratingFamily<N, Scalar = S>,
    {
        let member = FamilyMember { family, lambda: *lambda };
        let label = newton(steps, near, |label| {
            let by_label = require_regular(family, label, lambda)?;
            let found = self.scaled_by_parameters(family, lambda, (label, steps), width)?;
            let miss = b - found.value.map(S::constant);
            Ok((by_label * miss, size(&self.path(&member, label, steps)?.0)))
        })?;
        Ok(self.path(&member, &label, steps)?.0[steps])
    }

    /// c^{−k} ∂S_k/∂λ at c_k from `label`, from differences with spacings `width`, half of it, …: the one
    /// that the last halving changed least.
    fn scaled_by_parameters<F>(
        &self,
        family: &F,
        lambda: &SVector<S, N>,
        (label, k): (&SVector<S, N>, usize),
        mut width: S,
    ) -> Result<Measured<N>, HamiltonJacobiError>
    where
        F: GeneratingFamily<N, Scalar = S>,
    {
        let (states, derivative) = self.path(&FamilyMember { family, lambda: *lambda }, label, k)?;
        let path = Path::new(family, lambda, states, &derivative)?;
        // What is found across a caustic belongs to another branch, and settles on nothing.
        let settles =
            |found: &Measured<N>| found.error <= S::EPSILON.sqrt().widen() * (1.0 + found.value.amax());
        let mut best: Option<Measured<N>> = None;
        let mut last = self.difference(family, lambda, &path, width);
        for _ in 0..HALVINGS {
            width *= S::constant(0.5);
            let next = self.difference(family, lambda, &path, width);
            // Other errors are those of a spacing that is too wide.
            if let Err(stopped @ HamiltonJacobiError::Stopped) = next {
                return Err(stopped);
            }
            if let (Ok(last), Ok(next)) = (last, next) {
                let error = largest((next.value - last.value).iter().copied());
                let found = Measured { error, ..next };
                match best {
                    Some(known) if settles(&known) && error >= known.error => break,
                    Some(known) if error >= known.error => {}
                    _ => best = Some(found),
                }
                if error <= found.rounding {
                    break;
                }
            }
            last = next;
        }
        match (best, last) {
            (Some(best), _) if settles(&best) => Ok(best),
            (None, Err(error)) => Err(error),
            (best, _) => Err(HamiltonJacobiError::Unsettled {
                step: k,
                error: best.map_or(f64::INFINITY, |best| best.error),
            }),
        }
    }

    /// c^{−k} ∂S_k/∂λ with one spacing; its error is not known.
    fn difference<F>(
        &self,
        family: &F,
        lambda: &SVector<S, N>,
        path: &Path<S, N>,
        width: S,
    ) -> Result<Measured<N>, HamiltonJacobiError>
    where
        F: GeneratingFamily<N, Scalar = S>,
    {
        let k = path.states.len() - 1;
        let q = &path.states[k].q;
        let scale = 1.0 / (width.widen() * self.factor().powi(k as i32));
        let (mut value, mut size) = (SVector::zeros(), 0.0_f64);
        for j in 0..N {
            for side in [1.0, -1.0] {
                // Each label from the last one on its side.
                let mut near = path.states[0].q;
                for (m, weight) in WEIGHTS.iter().enumerate() {
                    let mut lambda = *lambda;
                    lambda[j] += width * S::constant(side * (m + 1) as f64);
                    let member = FamilyMember { family, lambda };
                    let (found, reached) = self.value_near(&member, &path.states[..k], q, &near)?;
                    let frame = frame(&member, &found, &self.path(&member, &found, k)?.1);
                    if !path.is_on_its_branch(&found, &(lambda - path.lambda), &frame) {
                        return Err(HamiltonJacobiError::Caustic { step: k });
                    }
                    near = found;
                    value[j] += scale * side * weight * reached;
                    size = size.max(reached.abs());
                }
            }
        }
        let rounding = ROUNDINGS * S::EPSILON.widen() * size * scale.abs();
        Ok(Measured { value, error: f64::INFINITY, rounding })
    }
}

/// A characteristic, and how its label has to move with λ for q_k to stay.
struct Path<S, const N: usize> {
    lambda: SVector<S, N>,
    states: Vec<State<S, N>>,
    frame: Frame<S, N>,
    /// ∂x/∂λ at fixed q_k.
    label_by_parameters: SMatrix<S, N, N>,
}

impl<S: Scalar, const N: usize> Path<S, N> {
    fn new<F: GeneratingFamily<N, Scalar = S>>(
        family: &F,
        lambda: &SVector<S, N>,
        states: Vec<State<S, N>>,
        derivative: &PhaseMatrix<S, N>,
    ) -> Result<Self, HamiltonJacobiError> {
        let label = &states[0].q;
        let frame = frame(&FamilyMember { family, lambda: *lambda }, label, derivative);
        let by_parameters = derivative.q_by_p * family.mixed(label, lambda);
        let label_by_q =
            invert(&frame.q).map_err(|_| HamiltonJacobiError::Caustic { step: states.len() - 1 })?;
        Ok(Self { lambda: *lambda, states, frame, label_by_parameters: -(label_by_q * by_parameters) })
    }

    /// Whether `label`, found for λ + `across`, is where this path's goes: as far as its first derivative
    /// says to half, and on the same side of the nearest caustic.
    fn is_on_its_branch(&self, label: &SVector<S, N>, across: &SVector<S, N>, frame: &Frame<S, N>) -> bool {
        let moved = label - self.states[0].q;
        let expected = self.label_by_parameters * across;
        let bound = self.label_by_parameters.amax() * across.amax() * S::constant(0.5);
        let rounding = S::EPSILON.sqrt() * size(&self.states);
        (moved - expected).amax() <= bound + rounding
            && determinant_sign(frame.q) == determinant_sign(self.frame.q)
    }
}

/// (Q_k, P_k) of the characteristic from `label`.
fn frame<S: Scalar, F: ScalarField<N, Scalar = S>, const N: usize>(
    section: &F,
    label: &SVector<S, N>,
    derivative: &PhaseMatrix<S, N>,
) -> Frame<S, N> {
    Frame { q: SMatrix::identity(), p: section.hessian(label) }.carried(derivative)
}

/// (∂²S_0/∂λ∂q)⁻¹.
fn require_regular<S: Scalar, F: GeneratingFamily<N, Scalar = S>, const N: usize>(
    family: &F,
    label: &SVector<S, N>,
    lambda: &SVector<S, N>,
) -> Result<SMatrix<S, N, N>, HamiltonJacobiError> {
    invert(&family.mixed(label, lambda).transpose()).map_err(|_| HamiltonJacobiError::DegenerateFamily)
}
