//! Hamilton–Jacobi theory of conformally symplectic steps: S_{k+1}∘F_k = cS_k + G.

use core::cell::RefCell;

use nalgebra::{SMatrix, SVector};

use super::characteristics::Carrier;
use super::{Characteristic, Frame, HamiltonJacobiError, ImplicitEquation, Section};
use crate::numbers::Scalar;
use crate::step::{Discretised, Flow, PhaseMatrix, State, invert};
use crate::system::ScalarField;
use crate::theory::rayleigh::quadrature::integrate_sum;
use crate::theory::rayleigh::{ConformalStep, ConformalStepError, Integral};
use crate::theory::samples::at_segment;
use crate::theory::verdict::Verdict;

/// The Hamilton–Jacobi theory of a step with AᵀΩA = cΩ, whatever made it:
/// [`conformal_hamilton_jacobi`](crate::Discretised::conformal_hamilton_jacobi).
///
/// Such a step has a generating function G, and every section that is a differential stays one:
///
/// ```text
/// d(p1·dq1 − c p0·dq0) = 0:     p1 = D2G,   c p0 = −D1G
/// S_{k+1}(F_k(q)) = c S_k(q) + G(q, F_k(q))
/// ```
///
/// *Proof.* With p0 = dS_k(q) the differential of the right side along q ↦ (q, F_k(q)) is c p0 + D1G + DF_kᵀ
/// D2G = DF_kᵀ p1. ∎
///
/// **How G is found.** As a function of the state, by quadrature along the straight line in T*Q from a
/// reference state, where it is set to 0:
///
/// ```text
/// G = ∫ p1·dq1 − c p0·dq0,     dq1 = a dq0 + b dp0
/// ```
///
/// The step and its derivative are all that this asks for, so that it serves rules, Gauss, compositions and
/// splittings alike; the line must stay where steps can be taken. Of rules with L_d and R_d G has a closed
/// form, [`ProportionalSplit`](crate::rayleigh::ProportionalSplit), the same but for the constant, and of an
/// angle a stationary S, [`StationaryEquation`](super::StationaryEquation).
///
/// The factor c is found at the states given, and every step of a characteristic is held against it, with an
/// error if it misses: a c that is none is never used.
pub struct ConformalHamiltonJacobi<'a, L, M, const N: usize>
where
    L: Flow<M, N>,
{
    by: Discretised<'a, L, M, N>,
    report: ConformalStep,
    reference: State<L::Scalar, N>,
}

/// A characteristic with the values of the carried generating function.
#[derive(Clone, Debug, PartialEq)]
pub struct ConformalCharacteristic<S, const N: usize> {
    /// c_k, from its label, with tangent frames and caustics.
    pub characteristic: Characteristic<S, N>,
    /// S_k(c_k), k = 0 … K.
    pub values: Vec<f64>,
    /// Estimated error of the last of them, of quadrature.
    pub quadrature_error: f64,
}

impl<S: Scalar, const N: usize> ConformalCharacteristic<S, N> {
    /// (c_K, dS_K(c_K)).
    #[must_use]
    pub fn end(&self) -> State<S, N> {
        *self.characteristic.states.last().expect("a characteristic has its label")
    }

    /// S_K(c_K).
    #[must_use]
    pub fn value(&self) -> f64 {
        *self.values.last().expect("a characteristic has its label")
    }
}

/// Conformally symplectic steps.
impl<'a, L, M, const N: usize> Discretised<'a, L, M, N>
where
    L: Flow<M, N>,
{
    /// The Hamilton–Jacobi theory of this step, if it is conformally symplectic at the `states`: for n = 1 at
    /// two at least. G is 0 at the first.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, ScalarField, Splitting, State, nalgebra, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = trapezoidal)]
    /// fn well(q: [f64; 2], v: [f64; 2], a: f64) -> (f64, f64) {
    ///     let kinetic = 0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1]);
    ///     (kinetic - (q[0] * q[1]).sin() - q[0].powi(4) - q[1] * q[1], 2.0 * a * kinetic)
    /// }
    /// /// S_0 = λ·q.
    /// struct Plane([f64; 2]);
    /// impl ScalarField<2> for Plane {
    ///     type Scalar = f64;
    ///     fn value(&self, q: &nalgebra::SVector<f64, 2>) -> f64 {
    ///         self.0[0] * q[0] + self.0[1] * q[1]
    ///     }
    ///     fn gradient(&self, _q: &nalgebra::SVector<f64, 2>) -> nalgebra::SVector<f64, 2> {
    ///         self.0.into()
    ///     }
    ///     fn hessian(&self, _q: &nalgebra::SVector<f64, 2>) -> nalgebra::SMatrix<f64, 2, 2> {
    ///         nalgebra::SMatrix::zeros()
    ///     }
    /// }
    /// let well = Well { a: 0.3 };
    /// let rest = [State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] }];
    /// let theory = well.by(Splitting::blanes_moan_6(), 0.2).conformal_hamilton_jacobi(&rest)?;
    /// assert!((theory.factor() - (-2.0_f64 * 0.3 * 0.2).exp()).abs() < 1e-15);
    ///
    /// // p = ∂S_k/∂q, by differences of S_3 at points near the characteristic's.
    /// let wave = Plane([0.5, -0.2]);
    /// let end = theory.carry(&wave, &vector![0.3, 0.1], 3)?.end();
    /// let value = |q: nalgebra::SVector<f64, 2>| theory.through(&wave, 3, &q, &vector![0.3, 0.1]);
    /// let (right, left) = (value(end.q + vector![1e-4, 0.0])?, value(end.q - vector![1e-4, 0.0])?);
    /// assert!(((right.value() - left.value()) / 2e-4 - end.p[0]).abs() < 1e-7);
    /// # Ok::<(), dalembert::hamilton_jacobi::HamiltonJacobiError>(())
    /// ```
    ///
    /// # Errors
    /// [`HamiltonJacobiError::NotConformal`] with how much is missing and where,
    /// [`VanishingFactor`](HamiltonJacobiError::VanishingFactor),
    /// [`States`](HamiltonJacobiError::States) where the states do not tell.
    pub fn conformal_hamilton_jacobi(
        &self,
        states: &[State<L::Scalar, N>],
    ) -> Result<ConformalHamiltonJacobi<'a, L, M, N>, HamiltonJacobiError> {
        let report = self.conformal_step(states).map_err(|error| match error {
            ConformalStepError::Stopped => HamiltonJacobiError::Stopped,
            error => HamiltonJacobiError::States(error),
        })?;
        match report.verdict() {
            Verdict::Yes if report.factor != 0.0 => {}
            // Or the tolerance leaves no digit of c.
            Verdict::Yes | Verdict::CannotTell => return Err(HamiltonJacobiError::VanishingFactor),
            Verdict::No => return Err(HamiltonJacobiError::NotConformal { step: None, report }),
        }
        Ok(ConformalHamiltonJacobi { by: *self, report, reference: states[0] })
    }
}

impl<S, L, M, const N: usize> ConformalHamiltonJacobi<'_, L, M, N>
where
    S: Scalar,
    L: Flow<M, N, Scalar = S>,
{
    /// c.
    pub fn factor(&self) -> f64 {
        self.report.factor
    }

    /// G of the first step from `state`, 0 at the reference.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] if a step on the line between cannot be taken.
    pub fn generating_function(&self, state: &State<S, N>) -> Result<Integral, HamiltonJacobiError> {
        self.generating_function_from(&self.reference, 0, state)
    }

    /// G of step k from `state`, less G from `reference`.
    fn generating_function_from(
        &self,
        reference: &State<S, N>,
        k: usize,
        state: &State<S, N>,
    ) -> Result<Integral, HamiltonJacobiError> {
        let State { q, p } = *reference;
        let (across, up) = (state.q - q, state.p - p);
        let failure = RefCell::new(None);
        let integral = at_segment(&self.by, k, |by| {
            integrate_sum(S::EPSILON.widen(), |share| {
                let share = S::constant(share);
                let from = State { q: q + across * share, p: p + up * share };
                match by.linearized_step(&from) {
                    Ok((step, a)) => {
                        let moved = a.q_by_q * across + a.q_by_p * up;
                        let start = from.p * S::constant(self.factor());
                        let value = (step.state.p.dot(&moved) - start.dot(&across)).widen();
                        let terms = step.state.p.abs().dot(&moved.abs()) + start.abs().dot(&across.abs());
                        (value, terms.widen())
                    }
                    Err(error) => {
                        failure.borrow_mut().get_or_insert(error);
                        (f64::NAN, f64::NAN)
                    }
                }
            })
        })?;
        match failure.into_inner() {
            Some(error) => Err(ImplicitEquation::Step.at(k)(error)),
            None => Ok(integral),
        }
    }

    /// Carries S_0 = `s0` along the characteristic from `label` over `steps` steps: the values S_k(c_k),
    /// which go on through caustics as functions of the label.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] with the step that has no solution or no finite derivative;
    /// [`HamiltonJacobiError::NotConformal`] with the step that misses c.
    pub fn carry<F>(
        &self,
        s0: &F,
        label: &SVector<S, N>,
        steps: usize,
    ) -> Result<ConformalCharacteristic<S, N>, HamiltonJacobiError>
    where
        F: ScalarField<N, Scalar = S>,
    {
        let characteristic = self.characteristic(s0, label, steps)?;
        let references = vec![self.reference; steps];
        let (values, quadrature_error) = self.values(s0.value(label), &characteristic.states, &references)?;
        Ok(ConformalCharacteristic { characteristic, values, quadrature_error })
    }

    /// The characteristic that reaches `q` after `steps` steps, found from the label `near` by Newton's
    /// method: its [`value`](ConformalCharacteristic::value) is S_K(q), on the branch through that label.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Caustic`] where det Q_K = 0 on the way, [`HamiltonJacobiError::NoLabel`] if
    /// none is found, and those of [`carry`](Self::carry).
    pub fn through<F>(
        &self,
        s0: &F,
        steps: usize,
        q: &SVector<S, N>,
        near: &SVector<S, N>,
    ) -> Result<ConformalCharacteristic<S, N>, HamiltonJacobiError>
    where
        F: ScalarField<N, Scalar = S>,
    {
        self.carry(s0, &self.label_of(s0, steps, q, near)?, steps)
    }

    /// The label of the characteristic that is at `q` after `steps` steps, and S_K there, G of step k set to
    /// 0 at the k-th of the `references`: near ones make short lines, and S_K another only by a constant.
    pub(super) fn value_near<F>(
        &self,
        s0: &F,
        references: &[State<S, N>],
        q: &SVector<S, N>,
        near: &SVector<S, N>,
    ) -> Result<(SVector<S, N>, f64), HamiltonJacobiError>
    where
        F: ScalarField<N, Scalar = S>,
    {
        let steps = references.len();
        let label = self.label_of(s0, steps, q, near)?;
        let (states, _) = self.path(s0, &label, steps)?;
        let (values, _) = self.values(s0.value(&label), &states, references)?;
        Ok((label, values[steps]))
    }

    fn label_of<F>(
        &self,
        s0: &F,
        steps: usize,
        q: &SVector<S, N>,
        near: &SVector<S, N>,
    ) -> Result<SVector<S, N>, HamiltonJacobiError>
    where
        F: ScalarField<N, Scalar = S>,
    {
        newton(steps, near, |label| {
            let (states, derivative) = self.path(s0, label, steps)?;
            let frame = Frame { q: SMatrix::identity(), p: s0.hessian(label) }.carried(&derivative);
            let label_by_q = invert(&frame.q).map_err(|_| HamiltonJacobiError::Caustic { step: steps })?;
            Ok((label_by_q * (q - states[steps].q), size(&states)))
        })
    }

    /// The states of a characteristic, caustics unlooked for, and the derivative of the last by the first.
    pub(super) fn path<G>(
        &self,
        section: &G,
        label: &SVector<S, N>,
        steps: usize,
    ) -> Result<(Vec<State<S, N>>, PhaseMatrix<S, N>), HamiltonJacobiError>
    where
        G: Section<N, Scalar = S>,
    {
        let mut states = vec![State { q: *label, p: section.covector(label) }];
        let mut derivative = PhaseMatrix::identity();
        for k in 0..steps {
            let (state, a) = self.step(k, &states[k])?;
            derivative = a * derivative;
            states.push(state);
        }
        Ok((states, derivative))
    }

    /// The characteristic alone, without S_k.
    pub(super) fn characteristic<G>(
        &self,
        section: &G,
        label: &SVector<S, N>,
        steps: usize,
    ) -> Result<Characteristic<S, N>, HamiltonJacobiError>
    where
        G: Section<N, Scalar = S>,
    {
        let mut carried = Carrier::new(section, label)?;
        for k in 0..steps {
            let (state, a) = self.step(k, carried.state())?;
            carried.advance(&a, state)?;
        }
        Ok(carried.characteristic)
    }

    /// Step k and its derivative, which has to multiply the symplectic form by c.
    fn step(
        &self,
        k: usize,
        state: &State<S, N>,
    ) -> Result<(State<S, N>, PhaseMatrix<S, N>), HamiltonJacobiError> {
        let (step, a) =
            at_segment(&self.by, k, |by| by.linearized_step(state))?.map_err(ImplicitEquation::Step.at(k))?;
        match ConformalStep::held_against(self.factor(), &[a], None) {
            Some(report) if !report.is_conformal() => {
                Err(HamiltonJacobiError::NotConformal { step: Some(k), report })
            }
            _ => Ok((step.state, a)),
        }
    }

    /// S_k at the `states` of a characteristic by S_{k+1} = cS_k + G, G of step k set to 0 at the k-th of the
    /// `references`; and the error of the last, estimated.
    fn values(
        &self,
        start: S,
        states: &[State<S, N>],
        references: &[State<S, N>],
    ) -> Result<(Vec<f64>, f64), HamiltonJacobiError> {
        let c = self.factor();
        let (mut values, mut error) = (vec![start.widen()], 0.0);
        for (k, reference) in references.iter().enumerate() {
            let g = self.generating_function_from(reference, k, &states[k])?;
            values.push(c * values[k] + g.value);
            error = c.abs() * error + g.error;
        }
        Ok((values, error))
    }
}

/// Iterations of Newton's method for a label.
const ITERATIONS: usize = 40;

/// A label, by corrections that are quadratic in the last: after one below √ε of the `size` of what they move
/// it is found to rounding.
pub(super) fn newton<S: Scalar, const N: usize>(
    step: usize,
    near: &SVector<S, N>,
    correction: impl Fn(&SVector<S, N>) -> Result<(SVector<S, N>, S), HamiltonJacobiError>,
) -> Result<SVector<S, N>, HamiltonJacobiError> {
    let mut label = *near;
    let mut distance = f64::NAN;
    for _ in 0..ITERATIONS {
        let (by, size) = correction(&label)?;
        label += by;
        distance = by.amax().widen();
        if by.amax() <= S::EPSILON.sqrt() * size {
            return Ok(label);
        }
    }
    Err(HamiltonJacobiError::NoLabel { step, distance })
}

/// The largest coordinate that a characteristic comes by.
pub(super) fn size<S: Scalar, const N: usize>(states: &[State<S, N>]) -> S {
    states.iter().fold(S::zero(), |size, state| size.max(state.q.amax()))
}
