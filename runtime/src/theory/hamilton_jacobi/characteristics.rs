//! Sections carried by the flow: characteristics with their tangent frames.

use core::fmt;

use nalgebra::{SMatrix, SVector};

use super::caustics::TangentPlane;
use super::residual::{Outcome, Worst, line, tolerance_line};
use super::{Caustic, Frame, HamiltonJacobi, HamiltonJacobiError, ImplicitEquation, Section};
use crate::numbers::Scalar;
use crate::step::{Discrete, PhaseMatrix, Quantity, State, StepError, or_without_guess};

/// One characteristic: the trajectory of (x, γ_0(x)), with the tangent frame along it.
#[derive(Clone, Debug, PartialEq)]
pub struct Characteristic<S, const N: usize> {
    /// The label x, its configuration at k = 0.
    pub label: SVector<S, N>,
    /// (c_k, γ_k(c_k)), k = 0 … K.
    pub states: Vec<State<S, N>>,
    /// (Q_k, P_k), k = 0 … K, from (I, Dγ_0(x)).
    pub frames: Vec<Frame<S, N>>,
    /// The zeros of det Q_k, in order.
    ///
    /// One that is less than √ε of a step from a node counts as on it, and zeros closer than that to each
    /// other as one caustic of higher multiplicity.
    pub caustics: Vec<Caustic<N>>,
}

/// A characteristic on its way.
pub(super) struct Carrier<S, const N: usize> {
    pub(super) characteristic: Characteristic<S, N>,
    frame: Frame<S, N>,
    state: State<S, N>,
    plane: TangentPlane<S, N>,
}

impl<S: Scalar, const N: usize> Carrier<S, N> {
    /// At k = 0, on `section` over `label`.
    pub(super) fn new<G>(section: &G, label: &SVector<S, N>) -> Result<Self, HamiltonJacobiError>
    where
        G: Section<N, Scalar = S>,
    {
        let state = State { q: *label, p: section.covector(label) };
        let frame = Frame { q: SMatrix::identity(), p: section.jacobian(label) };
        state.require_finite().map_err(ImplicitEquation::Step.at(0))?;
        require_finite(&frame, 0)?;
        let characteristic =
            Characteristic { label: *label, states: vec![state], frames: vec![frame], caustics: Vec::new() };
        Ok(Self { characteristic, frame, state, plane: TangentPlane::new(&frame) })
    }

    /// Where it is.
    pub(super) fn state(&self) -> &State<S, N> {
        &self.state
    }

    /// Takes the step to `state`, whose derivative is `a`.
    pub(super) fn advance(
        &mut self,
        a: &PhaseMatrix<S, N>,
        state: State<S, N>,
    ) -> Result<(), HamiltonJacobiError> {
        let Characteristic { label, states, frames, caustics } = &mut self.characteristic;
        let step = states.len() - 1;
        let frame = self.frame.carried(a);
        require_finite(&frame, step)?;
        let [from, to] = [self.state.q, state.q].map(|q| q.map(Scalar::widen));
        for (fraction, multiplicity) in self.plane.carry(a) {
            let q = from * (1.0 - fraction) + to * fraction;
            caustics.push(Caustic { label: label.map(Scalar::widen), step, fraction, q, multiplicity });
        }
        (self.state, self.frame) = (state, frame);
        states.push(state);
        frames.push(frame);
        Ok(())
    }
}

fn require_finite<S: Scalar, const N: usize>(
    frame: &Frame<S, N>,
    step: usize,
) -> Result<(), HamiltonJacobiError> {
    match frame.first_non_finite() {
        Some(index) => {
            let cause = StepError::NonFinite { quantity: Quantity::Derivatives, index };
            Err(ImplicitEquation::Derivative.at(step)(cause))
        }
        None => Ok(()),
    }
}

/// Closedness and caustics of a carried section.
#[derive(Clone, Debug, PartialEq)]
pub struct CharacteristicsReport<const N: usize> {
    /// Closedness defect Q_kᵀP_k − P_kᵀQ_k = 0: the section is a differential, locally.
    pub closed: Outcome<N>,
    /// The defect's balance: over a step it grows by the pull-back of d f_d and by nothing else. An
    /// identity.
    pub balance: Outcome<N>,
    /// The caustics met, in the order of the characteristics given.
    pub caustics: Vec<Caustic<N>>,
    /// Number of characteristics.
    pub characteristics: usize,
    /// Relative tolerance used.
    pub relative: f64,
}

impl<S, L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    S: Scalar,
    L: Discrete<R, N, Scalar = S>,
{
    /// Carries the section γ_0 = `section` from the label x over `steps` steps.
    ///
    /// The characteristics of many labels are the solution (F_k, γ_k) that starts from γ_0: F_k(c_k) =
    /// c_{k+1} and γ_k(c_k) = p_k, wherever det Q_k ≠ 0.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] with the step that has no solution or no finite derivative.
    pub fn carry<G>(
        &self,
        section: &G,
        label: &SVector<S, N>,
        steps: usize,
    ) -> Result<Characteristic<S, N>, HamiltonJacobiError>
    where
        G: Section<N, Scalar = S>,
    {
        let mut carried = Carrier::new(section, label)?;
        let mut guess = None;
        for k in 0..steps {
            let state = *carried.state();
            let (step, legendre) = self.at_step(k, |theory| {
                let found = theory.by.system.step(&state, self.by.h, guess.as_ref());
                let step = or_without_guess(guess.is_some(), found, || {
                    theory.by.system.step(&state, self.by.h, None)
                })
                .map_err(ImplicitEquation::Step.at(k))?;
                Ok::<_, HamiltonJacobiError>((step, theory.legendre(&state.q, &step.state.q)))
            })??;
            let a = legendre.step_matrix().map_err(ImplicitEquation::Derivative.at(k))?;
            carried.advance(&a, step.state)?;
            guess = Some(step.velocity);
        }
        Ok(carried.characteristic)
    }

    /// Closedness and caustics of carried characteristics.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Stopped`].
    pub fn characteristics_report(
        &self,
        characteristics: &[Characteristic<S, N>],
    ) -> Result<CharacteristicsReport<N>, HamiltonJacobiError> {
        let mut closed = Worst::new(self.relative);
        let mut balance = Worst::new(self.relative);
        let mut caustics = Vec::new();
        for characteristic in characteristics {
            // Rounding committed at an earlier frame is carried along, so that the sizes add up.
            let mut size = SMatrix::<S, N, N>::zeros();
            for (k, frame) in characteristic.frames.iter().enumerate() {
                size += frame.q.abs().tr_mul(&frame.p.abs());
                let q = &characteristic.states[k].q;
                closed.antisymmetric_part(k, q, &frame.q.tr_mul(&frame.p), &size);
            }
            for k in 1..characteristic.frames.len() {
                self.balance_at(&mut balance, characteristic, k - 1)?;
            }
            caustics.extend_from_slice(&characteristic.caustics);
        }
        Ok(CharacteristicsReport {
            closed: closed.outcome(),
            balance: balance.outcome(),
            caustics,
            characteristics: characteristics.len(),
            relative: self.relative,
        })
    }

    /// Q_{k+1}ᵀP_{k+1} − Q_kᵀP_k − Tᵀ F T is symmetric, T = (Q_k, Q_{k+1}), F = ∂(f_d⁻, f_d⁺)/∂(q_k,
    /// q_{k+1}).
    fn balance_at(
        &self,
        balance: &mut Worst<N>,
        characteristic: &Characteristic<S, N>,
        k: usize,
    ) -> Result<(), HamiltonJacobiError> {
        let [from, to] = [&characteristic.states[k], &characteristic.states[k + 1]];
        let [before, after] = [&characteristic.frames[k], &characteristic.frames[k + 1]];
        let (f, legendre) = self.at_step(k, |theory| {
            let objects = theory.by.objects(&from.q, &to.q);
            (objects.force_derivatives(), objects.legendre())
        })?;
        let work = before.q.tr_mul(&(f.minus.d1 * before.q + f.minus.d2 * after.q))
            + after.q.tr_mul(&(f.plus.d1 * before.q + f.plus.d2 * after.q));
        let difference = after.q.tr_mul(&after.p) - before.q.tr_mul(&before.p) - work;
        let (q0, q1) = (before.q.abs(), after.q.abs());
        let magnitude = q1.tr_mul(&after.p.abs())
            + q0.tr_mul(&before.p.abs())
            + q0.tr_mul(&(legendre.p0_by_q0.abs() * q0 + legendre.p0_by_q1.abs() * q1))
            + q1.tr_mul(&(legendre.p1_by_q0.abs() * q0 + legendre.p1_by_q1.abs() * q1));
        balance.antisymmetric_part(k, &from.q, &difference, &magnitude);
        Ok(())
    }
}

impl<const N: usize> fmt::Display for CharacteristicsReport<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "section carried along {} characteristics", self.characteristics)?;
        line(f, "closed: QᵀP − PᵀQ = 0", &self.closed)?;
        line(f, "balance of the defect: its growth is the pull-back of d f_d", &self.balance)?;
        match self.caustics.as_slice() {
            [] if self.characteristics == 0 => writeln!(f, "  caustics: no characteristic to look at")?,
            [] => writeln!(f, "  no caustic: det Q_k has no zero")?,
            [first, ..] => {
                writeln!(f, "  caustics: {}, the first of the list {first}", self.caustics.len())?;
            }
        }
        tolerance_line(f, self.relative)
    }
}
